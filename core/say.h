// What the program tells people while it works, on stderr. Never throws: a log on a full disk, or a
// reader that has gone, must not end the work or, worse, half of it.
#pragma once

#include <string_view>

namespace retrolux {

// The text as it is.
void Say(std::string_view text) noexcept;

// A line: "retrolux: TEXT".
void Tell(std::string_view text) noexcept;

}  // namespace retrolux
