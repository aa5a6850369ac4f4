// The program: it parses the command line, then runs one command.
#pragma once

#include <string>
#include <vector>

namespace vantage::cli {

/// `arguments`: without the program's name. The exit code. To call once in a process.
int run_program(const std::vector<std::string>& arguments);

}  // namespace vantage::cli
