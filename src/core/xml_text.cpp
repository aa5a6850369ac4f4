#include "core/xml_text.h"

#include "common/input.h"
#include "core/format.h"

namespace vantage::internal::core {

std::string xml_text(std::string_view text) {
  std::string escaped, blanked = printable(text);
  for (const char* none : {"\uFFFE", "\uFFFF"}) {  // characters of Unicode, not of XML 1.0
    for (std::size_t at = blanked.find(none); at != std::string::npos; at = blanked.find(none))
      blanked.replace(at, 3, " ");
  }
  for (const char c : blanked) {
    switch (c) {
      case '&':
        escaped += "&amp;";
        break;
      case '<':
        escaped += "&lt;";
        break;
      case '>':
        escaped += "&gt;";
        break;
      case '"':
        escaped += "&quot;";
        break;
      default:
        escaped += c;
    }
  }
  return escaped;
}

std::string decimal(double number, int decimals) {
  std::string text = fmt::format("{:.{}f}", number, decimals);
  if (text.find('.') != std::string::npos) {
    text.erase(text.find_last_not_of('0') + 1);
    if (text.back() == '.') text.pop_back();
  }
  return text == "-0" ? "0" : text;
}

}  // namespace vantage::internal::core
