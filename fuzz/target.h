// What the fuzz targets share. A target is a file NAME_fuzz.cpp with FuzzOne(): it gives its input
// to the functions that the program reads files with. InputError is a right answer; a crash, any
// other exception, much memory or a long time is a finding.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "core/error.h"

namespace retrolux::fuzz {

void FuzzOne(std::string_view input);

// Writes `bytes` to the file of that name in a folder of this process, and returns its path.
std::filesystem::path FileOf(const std::string& name, std::string_view bytes);

template <typename Call>
void Try(Call call) {
  try {
    call();
  } catch (const InputError&) {
  }
}

// Inputs of several formats say by their first byte which they are.
struct Tagged {
  char tag;
  std::string_view bytes;
};
inline Tagged TaggedInput(std::string_view input) {
  return input.empty() ? Tagged{'\0', ""} : Tagged{input.front(), input.substr(1)};
}

}  // namespace retrolux::fuzz
