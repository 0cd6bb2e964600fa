// Completion scripts for shells, made of the program's own commands and options. Each completes
// subcommands, options, and the values of an option that is a choice; files for other texts.
#pragma once

#include "cli/command_tree.h"

namespace retrolux::cli {

// `commands` as CommandTree gives them.
std::string BashCompletion(const std::vector<CommandText>& commands);
std::string ZshCompletion(const std::vector<CommandText>& commands);
std::string FishCompletion(const std::vector<CommandText>& commands);

}  // namespace retrolux::cli
