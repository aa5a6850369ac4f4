// Man pages (roff, man macros) of the commands.
#pragma once

#include <string>
#include <vector>

#include "cli/command_table.h"

namespace vantage::cli {

struct ManPage {
  std::string file;  ///< "vantage-compute.1"
  std::string text;
};

/// One page for the program and one for each command, but for "help" and "version": these are in the program's page.
std::vector<ManPage> man_pages(const std::vector<CommandRow>& table);

}  // namespace vantage::cli
