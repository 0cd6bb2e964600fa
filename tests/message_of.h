// What an InputError says, for tests of wrong input.
#pragma once

#include <string>

#include "core/error.h"

namespace retrolux {

// The text of the InputError that the call throws, "no error" if it throws none.
template <typename Call>
std::string MessageOf(Call call) {
  try {
    call();
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

}  // namespace retrolux
