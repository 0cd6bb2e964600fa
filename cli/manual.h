// The manual page (man 1), made of the program's own commands and options.
#pragma once

#include "cli/command_tree.h"

namespace retrolux::cli {

// In roff with man's macros. `commands` as CommandTree gives them.
std::string ManualPage(const std::vector<CommandText>& commands);

}  // namespace retrolux::cli
