// Walks over text: blanks, words, numbers, lines. For OBJ, ASCII PLY and ASCII STL.
#pragma once

#include <charconv>
#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>

namespace vantage::internal::io {

/// The value of a number that is too large (infinite) or too small (zero, or nearly) for std::from_chars, which does
/// not say which.
double number_out_of_range(std::string_view number);

/// Lines end with LF, CR LF or CR and count from 1. The numbers are read correctly rounded, whatever the locale.
class TextCursor {
 public:
  explicit TextCursor(std::string_view text, std::uint64_t line = 1)
      : begin_(text.data()), at_(begin_), end_(begin_ + text.size()), line_(line) {}

  bool at_end() const { return at_ == end_; }
  char peek() const { return *at_; }
  std::uint64_t line() const { return line_; }
  std::uint64_t offset() const { return static_cast<std::uint64_t>(at_ - begin_); }
  std::uint64_t left() const { return static_cast<std::uint64_t>(end_ - at_); }

  static bool is_line_end(char c) { return c == '\n' || c == '\r'; }
  static bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\v' || c == '\f'; }
  static bool is_space(char c) { return is_blank(c) || is_line_end(c); }
  bool at_line_end() const { return at_ == end_ || is_line_end(*at_); }
  bool at_word_end() const { return at_ == end_ || is_space(*at_); }

  void skip_blanks() {
    while (at_ != end_ && is_blank(*at_)) ++at_;
  }
  void skip_spaces() {
    while (at_ != end_ && is_space(*at_)) {
      if (is_line_end(*at_)) {
        next_line();
      } else {
        ++at_;
      }
    }
  }
  bool skip(char c) {
    if (at_ == end_ || *at_ != c) return false;
    ++at_;
    return true;
  }

  /// Moves past the line end that the cursor stands on.
  void next_line() {
    if (at_ == end_) return;
    const char c = *at_++;
    if (c == '\r' && at_ != end_ && *at_ == '\n') ++at_;
    ++line_;
  }

  /// Everything up to the next space or line end; may be empty.
  std::string_view word() {
    const char* first = at_;
    while (at_ != end_ && !is_space(*at_)) ++at_;
    return {first, static_cast<std::size_t>(at_ - first)};
  }

  /// The whole word that the cursor stands in, for messages; the cursor moves to its end.
  std::string_view word_around() {
    while (at_ != begin_ && !is_space(at_[-1])) --at_;
    return word();
  }

  /// Everything up to the line end.
  std::string_view rest_of_line() {
    const char* first = at_;
    while (at_ != end_ && !is_line_end(*at_)) ++at_;
    return {first, static_cast<std::size_t>(at_ - first)};
  }

  /// A number. Returns false, and does not move, if there is none. What is too large becomes infinite.
  bool number(double& value) {
    const char* first = at_;
    if (first != end_ && *first == '+') ++first;
    const auto [last, error] = std::from_chars(first, end_, value);
    if (error == std::errc::result_out_of_range) {
      value = number_out_of_range({first, static_cast<std::size_t>(last - first)});
    } else if (error != std::errc()) {
      return false;
    }
    at_ = last;
    return true;
  }

  /// A whole number. Returns false, and does not move, if there is none or it does not fit.
  bool integer(std::int64_t& value) {
    const char* first = at_;
    if (first != end_ && *first == '+') ++first;
    const auto [last, error] = std::from_chars(first, end_, value);
    if (error != std::errc()) return false;
    at_ = last;
    return true;
  }

 private:
  const char* begin_;
  const char* at_;
  const char* end_;
  std::uint64_t line_;
};

/// A word of the file for a message: shortened, unprintable characters as '?'.
inline std::string shown_word(std::string_view word) {
  constexpr std::size_t kLongest = 40;
  std::string text = "\"";
  for (const char c : word.substr(0, kLongest)) text += c >= 0x20 && c < 0x7f ? c : '?';
  return text + (word.size() > kLongest ? "...\"" : "\"");
}

}  // namespace vantage::internal::io
