// The program: it parses the command line, then runs one command.
#pragma once

#include <string>
#include <vector>

namespace vantage::cli {

/// Where the program runs: the package for Python has a command more, `batch`, which it runs itself.
enum class Host { shell, python };

/// `arguments`: without the program's name. The exit code. To call once in a process.
int run_program(const std::vector<std::string>& arguments, Host host = Host::shell);

}  // namespace vantage::cli
