// The text of the page, which web/build.mjs makes.
#pragma once

#include <string>

namespace vantage::live {

/// With a script that runs before those of the page. Throws Error(page_missing) for a text that is not the page's.
std::string with_start(std::string page, const std::string& script);

}  // namespace vantage::live
