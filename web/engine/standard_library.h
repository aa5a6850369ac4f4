// What the engine uses of the C++20 library that libc++ 13 of Emscripten 3.1.6 lacks. Included before every source when
// it is compiled to WebAssembly (-include), so that the sources stay as they are. Not for other compilers.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <iterator>
#include <limits>
#include <string>
#include <system_error>
#include <type_traits>

#if _LIBCPP_VERSION >= 14000
#error "this libc++ is newer: see what of this file it has"
#endif

namespace std {

template <typename To, typename From>
constexpr To bit_cast(const From& from) noexcept {
  return __builtin_bit_cast(To, from);
}

namespace ranges {

template <typename Range, typename Predicate>
bool any_of(Range&& range, Predicate predicate) {
  return std::any_of(std::begin(range), std::end(range), predicate);
}

template <typename Range, typename Predicate>
bool all_of(Range&& range, Predicate predicate) {
  return std::all_of(std::begin(range), std::end(range), predicate);
}

template <typename Range, typename Predicate>
auto find_if(Range&& range, Predicate predicate) {
  return std::find_if(std::begin(range), std::end(range), predicate);
}

template <typename Range, typename Value, typename Projection>
auto find(Range&& range, const Value& value, Projection projection) {
  return std::find_if(std::begin(range), std::end(range),
                      [&](const auto& item) { return std::invoke(projection, item) == value; });
}

template <typename Range, typename Value>
auto count(Range&& range, const Value& value) {
  return std::count(std::begin(range), std::end(range), value);
}

template <typename Range>
void sort(Range&& range) {
  std::sort(std::begin(range), std::end(range));
}

template <typename Range, typename Less>
auto min_element(Range&& range, Less less) {
  return std::min_element(std::begin(range), std::end(range), less);
}

}  // namespace ranges

namespace vantage_numbers {

inline bool is_digit(char c) { return c >= '0' && c <= '9'; }

inline bool starts_with(const char* at, const char* last, const char* word) {
  for (; *word != 0; ++at, ++word) {
    if (at == last || (*at | 32) != *word) return false;
  }
  return true;
}

/// A decimal number as far as it was read: mantissa * 10^exponent, if `is_short`.
struct Decimal {
  const char* end = nullptr;  ///< nullptr: it is none
  std::uint64_t mantissa = 0;
  int exponent = 0;
  bool is_short = true;
};

inline Decimal scan(const char* at, const char* last) {
  Decimal number;
  int digits = 0;
  bool any = false;
  const auto take = [&](int shift) {
    for (; at != last && is_digit(*at); ++at) {
      any = true;
      number.exponent += shift;
      if (number.mantissa == 0 && *at == '0') continue;
      number.is_short = number.is_short && ++digits <= 15;
      if (number.is_short) number.mantissa = 10 * number.mantissa + static_cast<unsigned>(*at - '0');
    }
  };
  take(0);
  if (at != last && *at == '.') {
    ++at;
    take(-1);
  }
  if (!any) return number;
  number.end = at;
  if (at == last || (*at | 32) != 'e') return number;
  ++at;
  const bool is_negative = at != last && *at == '-';
  if (at != last && (*at == '-' || *at == '+')) ++at;
  if (at == last || !is_digit(*at)) return number;
  int power = 0;
  for (; at != last && is_digit(*at); ++at) power = std::min(10 * power + (*at - '0'), 99999);
  number.exponent += is_negative ? -power : power;
  number.end = at;
  return number;
}

/// As the standard says of std::from_chars with chars_format::general: rounded to nearest.
template <typename Real, typename Parse>
from_chars_result parse(const char* first, const char* last, Real& value, const Parse& exactly) {
  const bool is_negative = first != last && *first == '-';
  const char* const start = is_negative ? first + 1 : first;
  const auto set = [&](Real size) { value = is_negative ? -size : size; };
  for (const char* word : {"infinity", "inf", "nan"}) {
    if (!starts_with(start, last, word)) continue;
    set(*word == 'n' ? numeric_limits<Real>::quiet_NaN() : numeric_limits<Real>::infinity());
    return {start + strlen(word), errc()};
  }
  const Decimal number = scan(start, last);
  if (number.end == nullptr) return {first, errc::invalid_argument};
  // Both factors are doubles without rounding, so that their product and their quotient are rounded once (Clinger
  // 1990).
  constexpr double kPowers[] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8,  1e9,  1e10, 1e11,
                                1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};
  if (is_same_v<Real, double> && number.is_short && abs(number.exponent) <= 22) {
    const double size = static_cast<double>(number.mantissa);
    set(static_cast<Real>(number.exponent < 0 ? size / kPowers[-number.exponent] : size * kPowers[number.exponent]));
    return {number.end, errc()};
  }
  errno = 0;
  const Real read = exactly(string(start, number.end).c_str());
  if (errno == ERANGE) return {number.end, errc::result_out_of_range};
  set(read);
  return {number.end, errc()};
}

inline to_chars_result put(char* first, char* last, const string& text) {
  if (last - first < static_cast<ptrdiff_t>(text.size())) return {last, errc::value_too_large};
  return {copy(text.begin(), text.end(), first), errc()};
}

/// The shortest digits that are read as the same number, in fixed notation.
inline string fixed(double value) {
  const auto decimal = fmt::detail::dragonbox::to_decimal(value);
  string digits = fmt::format_int(decimal.significand).str();
  if (decimal.exponent >= 0) return digits.append(static_cast<size_t>(decimal.exponent), '0');
  const auto decimals = static_cast<size_t>(-decimal.exponent);
  if (digits.size() <= decimals) digits.insert(0, decimals + 1 - digits.size(), '0');
  return digits.insert(digits.size() - decimals, ".");
}

inline string scientific(double value) {
  const auto decimal = fmt::detail::dragonbox::to_decimal(value);
  string digits = fmt::format_int(decimal.significand).str();
  const int power = decimal.exponent + static_cast<int>(digits.size()) - 1;
  if (digits.size() > 1) digits.insert(1, ".");
  return digits + fmt::format("e{}{:02}", power < 0 ? '-' : '+', abs(power));
}

inline string text(double value, bool is_fixed) {
  string sign = signbit(value) ? "-" : "";
  if (isnan(value)) return sign + "nan";
  if (isinf(value)) return sign + "inf";
  if (value == 0) return sign + "0";
  const string plain = fixed(abs(value));
  if (is_fixed) return sign + plain;
  const string power = scientific(abs(value));
  return sign + (power.size() < plain.size() ? power : plain);
}

}  // namespace vantage_numbers

inline from_chars_result from_chars(const char* first, const char* last, double& value) {
  return vantage_numbers::parse(first, last, value, [](const char* text) { return strtod(text, nullptr); });
}
inline from_chars_result from_chars(const char* first, const char* last, float& value) {
  return vantage_numbers::parse(first, last, value, [](const char* text) { return strtof(text, nullptr); });
}

/// The shortest text that is read as the same number.
inline to_chars_result to_chars(char* first, char* last, double value) {
  return vantage_numbers::put(first, last, vantage_numbers::text(value, false));
}
inline to_chars_result to_chars(char* first, char* last, double value, chars_format format) {
  return vantage_numbers::put(first, last, vantage_numbers::text(value, format == chars_format::fixed));
}

}  // namespace std
