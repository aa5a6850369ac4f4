#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "vantage/input.h"

namespace vantage {
namespace {

std::string lower_case(std::string_view text) {
  std::string lower(text);
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return lower;
}

bool spells_not_finite(std::string_view text) {
  static constexpr std::array<std::string_view, 5> kSpellings = {".inf", "inf", "infinity", ".nan", "nan"};
  if (!text.empty() && (text.front() == '+' || text.front() == '-')) text.remove_prefix(1);
  const std::string lower = lower_case(text);
  return std::find(kSpellings.begin(), kSpellings.end(), lower) != kSpellings.end();
}

}  // namespace

ParsedNumber parse_number(std::string_view text) {
  if (spells_not_finite(text)) return {0.0, NumberFault::not_finite};
  // std::from_chars takes no leading plus, and would take the minus of "+-1".
  if (!text.empty() && text.front() == '+') {
    text.remove_prefix(1);
    if (!text.empty() && text.front() == '-') return {};
  }
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (end != text.data() + text.size() || error == std::errc::invalid_argument) return {};
  if (error == std::errc::result_out_of_range) return {0.0, NumberFault::out_of_range};
  if (!std::isfinite(value)) return {0.0, NumberFault::not_finite};  // "nan(123)" and the like
  return {value, NumberFault::none};
}

std::vector<std::string_view> split_at_commas(std::string_view text) {
  constexpr std::string_view kBlanks = " \t";
  std::vector<std::string_view> parts;
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t end = std::min(text.find(',', at), text.size());
    const std::string_view part = text.substr(at, end - at);
    const std::size_t first = part.find_first_not_of(kBlanks);
    parts.push_back(first == std::string_view::npos ? std::string_view()
                                                    : part.substr(first, part.find_last_not_of(kBlanks) - first + 1));
    at = end + 1;
  }
  return parts;
}

std::string number_advice(std::string_view text, NumberFault fault) {
  if (fault == NumberFault::not_finite) return "write a finite number";
  if (fault == NumberFault::out_of_range) return "write a number that fits a double, or 0";
  const std::string lower = lower_case(text);
  if (lower.find("0x") != std::string::npos || lower.find("0o") != std::string::npos) {
    return "write it in decimal digits";
  }
  if (lower.find('_') != std::string::npos) return "write the digits without underscores, such as 1000";
  if (lower.find(',') != std::string::npos) return "write a decimal point, such as 1.5";
  if (lower.size() > 1 && lower.back() == 'm' &&
      parse_number(text.substr(0, text.find_first_of(" m"))).fault == NumberFault::none) {
    return "leave the unit out: lengths are in metres";
  }
  return "write a plain decimal number, such as 12.5";
}

std::string in_quotes(std::string_view text) {
  constexpr std::size_t kLongest = 60;
  std::string shown(text.substr(0, kLongest));
  // Never cut in the middle of a UTF-8 sequence: continuation bytes are 10xxxxxx.
  if (text.size() > kLongest) {
    while (!shown.empty() && (static_cast<unsigned char>(text[shown.size()]) & 0xC0) == 0x80) shown.pop_back();
    shown += "...";
  }
  for (char& c : shown) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7F) c = '?';
  }
  shown.insert(0, 1, '\'');
  shown.push_back('\'');
  return shown;
}

std::string shortest(double value) {
  std::array<char, 32> digits;
  const auto [end, error] = std::to_chars(digits.data(), digits.data() + digits.size(), value);
  return error == std::errc() ? std::string(digits.data(), end) : std::string("nan");
}

}  // namespace vantage
