#include "core/say.h"

#include <unistd.h>

#include <cerrno>
#include <string>

namespace retrolux {

void Say(std::string_view text) noexcept {
  // Not through stdio, whose lock another thread may hold when the program is about to end.
  while (!text.empty()) {
    const ssize_t written = ::write(STDERR_FILENO, text.data(), text.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return;
    text.remove_prefix(static_cast<size_t>(written));
  }
}

void Tell(std::string_view text) noexcept {
  Say("retrolux: " + std::string(text) + "\n");
}

}  // namespace retrolux
