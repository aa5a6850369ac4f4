// Completion scripts of the program for shells.
#pragma once

#include <string>
#include <vector>

#include "cli/command_table.h"

namespace vantage::cli {

std::string bash_completion(const std::vector<CommandRow>& table);
std::string zsh_completion(const std::vector<CommandRow>& table);
std::string fish_completion(const std::vector<CommandRow>& table);

}  // namespace vantage::cli
