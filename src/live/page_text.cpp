#include "live/page_text.h"

#include <string_view>

#include "vantage/error.h"

namespace vantage::live {

std::string with_start(std::string page, const std::string& script) {
  constexpr std::string_view kMarker = "<!--LIVE-->";
  const std::size_t at = page.find(kMarker);
  if (at == std::string::npos) {
    throw Error(ErrorCode::page_missing, "this is not the page of vantage, or it is of another version", "the page",
                "build it anew with 'make web'");
  }
  page.replace(at, kMarker.size(), "<script>" + script + "</script>");
  return page;
}

}  // namespace vantage::live
