// The text of the page, which web/build.mjs makes.
#pragma once

#include <string>

namespace vantage::live {

/// Throws Error(page_missing), with `where`, for a text that is not the page's.
void check_page(const std::string& page, const std::string& where);

/// With a script that runs before those of the page. Throws as check_page does.
std::string with_start(std::string page, const std::string& script);

}  // namespace vantage::live
