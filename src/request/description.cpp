#include "request/description.h"

#include <cmath>

#include "common/input.h"
#include "vantage/error.h"

namespace vantage::internal::request {
namespace {

/// As errors write them.
std::string_view words_of(Unit unit) {
  switch (unit) {
    case Unit::none:
      return "";
    case Unit::degrees_per_second:
      return "degrees per second";
    case Unit::metres_per_second_squared:
      return "m/s2";
    default:
      return symbol_of(unit);
  }
}

/// "100000", where the shortest text is "1e+05".
std::string plain(double value) {
  const bool is_whole = std::abs(value) < 1e15 && value == std::floor(value);
  return is_whole ? std::to_string(static_cast<long long>(value)) : shortest(value);
}

/// "86,400".
std::string grouped(double value) {
  constexpr std::size_t kGroup = 3, kShortest = 5;  // of digits: 1000, but 10,000
  std::string text = plain(value);
  if (text.find_first_not_of("0123456789") != std::string::npos || text.size() < kShortest) return text;
  for (std::size_t at = text.size() - kGroup;; at -= kGroup) {
    text.insert(at, ",");
    if (at <= kGroup) return text;
  }
}

}  // namespace

std::string_view symbol_of(Unit unit) {
  switch (unit) {
    case Unit::none:
      break;
    case Unit::metres:
      return "m";
    case Unit::millimetres:
      return "mm";
    case Unit::degrees:
      return "degrees";
    case Unit::seconds:
      return "s";
    case Unit::metres_per_second:
      return "m/s";
    case Unit::metres_per_second_squared:
      return "m/s\u00b2";
    case Unit::degrees_per_second:
      return "degrees/s";
    case Unit::gigahertz:
      return "GHz";
  }
  return "";
}

std::string_view suffix_of(Unit unit) {
  switch (unit) {
    case Unit::none:
      break;
    case Unit::metres:
      return "_m";
    case Unit::millimetres:
      return "_mm";
    case Unit::degrees:
      return "_deg";
    case Unit::seconds:
      return "_s";
    case Unit::metres_per_second:
      return "_m_s";
    case Unit::metres_per_second_squared:
      return "_m_s2";
    case Unit::degrees_per_second:
      return "_deg_s";
    case Unit::gigahertz:
      return "_ghz";
  }
  return "";
}

bool Bounds::takes_least() const { return ends == Ends::both || ends == Ends::without_most; }
bool Bounds::takes_most() const { return ends == Ends::both || ends == Ends::without_least; }

bool Bounds::hold(double value) const {
  if (!std::isfinite(value)) return false;
  return (takes_least() ? value >= least : value > least) && (takes_most() ? value <= most : value < most);
}

std::string Bounds::text() const {
  const bool is_above_zero = least == 0 && !takes_least();
  if (is_above_zero && most >= kLongest) return "> 0";
  const std::string end = grouped(most) + (most_word.empty() ? "" : ", " + std::string(most_word));
  if (is_above_zero) return (takes_most() ? "> 0, at most " : "> 0 and < ") + end;
  if (!takes_most()) return (takes_least() ? grouped(least) + " or more" : "> " + grouped(least)) + " and < " + end;
  return (takes_least() ? "" : "> ") + grouped(least) + " to " + end;
}

void check_within(const Bounds& bounds, double value, const std::string& where) {
  if (bounds.hold(value)) return;
  std::string range;
  if (bounds.least >= 0 && !(value > 0 && std::isfinite(value))) {
    range = bounds.least > 0 || !bounds.takes_least() ? "greater than 0" : "0 or more";
  } else {
    const std::string least = plain(bounds.least), most = plain(bounds.most);
    switch (bounds.ends) {
      case Bounds::Ends::both:
        range = "between " + least + " and " + most;
        break;
      case Bounds::Ends::without_least:
        range = "greater than " + least + ", and at most " + most;
        break;
      case Bounds::Ends::without_most:
        range = least + " or more, and less than " + most;
        break;
      case Bounds::Ends::neither:
        range = "greater than " + least + " and less than " + most;
        break;
    }
    if (bounds.unit != Unit::none) range.append(" ").append(words_of(bounds.unit));
    if (!bounds.most_word.empty()) range.append(", ").append(bounds.most_word);
  }
  throw Error(ErrorCode::value_out_of_range, where + " must be " + range + ", not " + plain(value), where,
              std::string(bounds.fix));
}

}  // namespace vantage::internal::request
