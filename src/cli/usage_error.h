// What to say of a command line that cannot be parsed.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "vantage/error.h"

namespace vantage::cli {

/// `arguments`: without the program's name. Names the option or the command that was probably meant.
Error usage_error(const CLI::App& app, const CLI::ParseError& error, const std::vector<std::string>& arguments);

/// The error for a word that is not a command.
Error unknown_command(const CLI::App& app, const std::string& word);

/// The command of that name; nullptr where there is none.
const CLI::App* find_command(const CLI::App& app, const std::string& name);

}  // namespace vantage::cli
