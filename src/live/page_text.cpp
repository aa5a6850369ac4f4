#include "live/page_text.h"

#include <string_view>

#include "vantage/error.h"

namespace vantage::live {
namespace {

constexpr std::string_view kMarker = "<!--LIVE-->";

}  // namespace

void check_page(const std::string& page, const std::string& where) {
  if (page.find(kMarker) != std::string::npos) return;
  throw Error(ErrorCode::page_missing, "this is not the page of vantage, or it is of another version", where,
              "build it anew with 'make web'");
}

std::string with_start(std::string page, const std::string& script) {
  check_page(page, "the page");
  page.replace(page.find(kMarker), kMarker.size(), "<script>" + script + "</script>");
  return page;
}

}  // namespace vantage::live
