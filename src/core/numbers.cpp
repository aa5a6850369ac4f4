#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <span>

#include "common/input.h"
#include "common/shown_address.h"

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

/// Times over a divisor: 400 * 3048 / 10000 is rounded once, 400 * 0.3048 twice.
struct Unit {
  std::string_view name;  // lower case
  double times, over;
};
constexpr std::array kLengths = {Unit{"m", 1, 1},    Unit{"km", 1000, 1}, Unit{"ft", 3048, 10000},
                                 Unit{"cm", 1, 100}, Unit{"mm", 1, 1000}, Unit{"mi", 1609344, 1000}};
constexpr std::array kAngles = {Unit{"deg", 1, 1}, Unit{"\u00b0", 1, 1}};

/// A number and what follows it, without the blanks between them.
struct Quantity {
  std::string_view number, unit;
};

Quantity split_quantity(std::string_view text) {
  constexpr std::string_view kBlanks = " \t";
  std::string_view rest = text;
  if (!rest.empty() && (rest.front() == '+' || rest.front() == '-')) rest.remove_prefix(1);
  double ignored = 0;
  const char* const end = std::from_chars(rest.data(), rest.data() + rest.size(), ignored).ptr;
  const std::string_view unit(end, static_cast<std::size_t>(text.data() + text.size() - end));
  const std::size_t first = unit.find_first_not_of(kBlanks);
  return {text.substr(0, static_cast<std::size_t>(end - text.data())),
          first == std::string_view::npos ? std::string_view() : unit.substr(first)};
}

ParsedNumber parse_quantity(std::string_view text, std::span<const Unit> units) {
  const auto [number, unit] = split_quantity(text);
  // Words that begin as those for what is not finite do: nano, info.
  if (!unit.empty() && spells_not_finite(number)) return parse_number(text);
  const ParsedNumber parsed = parse_number(number);
  if (parsed.fault != NumberFault::none) return parsed.fault == NumberFault::not_a_number ? parse_number(text) : parsed;
  if (unit.empty()) return number.size() == text.size() ? parsed : ParsedNumber{};  // blanks after a number
  // What goes on with digits is a number of another kind: 1,5, 0x10, 1:30.
  if (unit.find_first_of("0123456789") != std::string_view::npos) return {};
  // "M" stands for nautical miles, too, and "Mm" for a million metres.
  const std::string name = unit == "M" || unit == "Mm" ? "" : lower_case(unit);
  const auto known = std::find_if(units.begin(), units.end(), [&](const Unit& one) { return one.name == name; });
  if (known == units.end()) return {0.0, NumberFault::unknown_unit};
  double value = parsed.value * known->times / known->over;
  if (!std::isfinite(value)) value = parsed.value / known->over * known->times;  // 1e308 ft
  if (!std::isfinite(value)) return {0.0, NumberFault::out_of_range};
  return {value, NumberFault::none};
}

/// What to do about digits that are not those of a plain decimal number.
std::string advice_for_digits(const std::string& lower) {
  if (lower.find("0x") != std::string::npos || lower.find("0o") != std::string::npos) {
    return "write it in decimal digits";
  }
  if (lower.find('_') != std::string::npos) return "write the digits without underscores, such as 1000";
  if (lower.find(',') != std::string::npos) return "write no comma: 1000 for a thousand, 1.5 with a decimal point";
  return "";
}

std::string quantity_advice(std::string_view text, NumberFault fault, const char* form) {
  if (fault == NumberFault::not_finite || fault == NumberFault::out_of_range) return number_advice(text, fault);
  const std::string digits = advice_for_digits(lower_case(text));
  return digits.empty() ? form : digits;
}

}  // namespace

ParsedNumber parse_length(std::string_view text) { return parse_quantity(text, kLengths); }
ParsedNumber parse_angle(std::string_view text) { return parse_quantity(text, kAngles); }

std::string length_advice(std::string_view text, NumberFault fault) {
  return quantity_advice(text, fault, "write metres, or a number with mm, cm, m, km, ft or mi: 120, 120 m, 400 ft");
}

std::string angle_advice(std::string_view text, NumberFault fault) {
  return quantity_advice(text, fault, "write degrees, with or without their unit: 60, 60 deg");
}

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
  if (std::string digits = advice_for_digits(lower); !digits.empty()) return digits;
  const ParsedNumber number = parse_number(split_quantity(text).number);
  if (number.fault == NumberFault::none) return "write the number alone, without a unit: " + shortest(number.value);
  return "write a plain decimal number, such as 12.5";
}

std::string csv_field(std::string_view text) {
  const auto first = static_cast<unsigned char>(text.empty() ? 'a' : text.front());
  const bool is_formula =
      first < ' ' || std::string_view("=+-@'").find(static_cast<char>(first)) != std::string_view::npos;
  std::string field = (is_formula ? "'" : "") + std::string(text);
  if (field.find_first_of(",\"\r\n") == std::string::npos) return field;
  std::string quoted = "\"";
  for (const char c : field) quoted.append(c == '"' ? 2 : 1, c);
  return quoted + "\"";
}

std::string in_quotes(std::string_view text) {
  constexpr std::size_t kLongest = 60, kMost = 10'000;
  const std::string whole = without_secrets(text.substr(0, kMost), true);  // before it is cut
  text = whole;
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
