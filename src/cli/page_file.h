// The page, which `make web` builds: where it is, and what is in it.
#pragma once

#include <string>

namespace vantage::cli {

/// The text of `name`, "index.html" or "report.html": of the file that is `given`, where it is; else beside the program
/// (share/vantage/web), in the package's resources, or in the tree that the program was built in (web/dist). Throws
/// Error(page_missing), saying how to get it.
std::string read_page(const std::string& name, const std::string& given);

}  // namespace vantage::cli
