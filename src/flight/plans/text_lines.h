// Lines of a text, without their ends, and names in it.
#pragma once

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <initializer_list>
#include <string>
#include <string_view>

namespace vantage::internal::flight::plans {

class TextLines {
 public:
  explicit TextLines(std::string_view text) : rest_(text) {}

  /// Whether there was one more; it is `line`, and number() counts it.
  bool next(std::string_view& line) {
    if (rest_.empty()) return false;
    const std::size_t end = rest_.find('\n');
    line = rest_.substr(0, end);
    rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    ++number_;
    return true;
  }
  std::size_t number() const { return number_; }  ///< from 1
  std::string place() const { return "line " + std::to_string(number_); }

 private:
  std::string_view rest_;
  std::size_t number_ = 0;
};

inline std::string_view without_blanks(std::string_view text) {
  constexpr std::string_view kBlanks = " \t\r\n";
  const std::size_t begin = text.find_first_not_of(kBlanks);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(kBlanks) + 1 - begin);
}

/// Whether they are the same but for upper and lower case.
inline bool is_alike(std::string_view a, std::string_view b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](char one, char other) {
    return std::tolower(static_cast<unsigned char>(one)) == std::tolower(static_cast<unsigned char>(other));
  });
}

/// Which of `names` is meant, if upper and lower case alone are wrong; else empty.
inline std::string_view meant_name(std::string_view name, std::initializer_list<std::string_view> names) {
  for (const std::string_view known : names) {
    if (is_alike(name, known)) return name == known ? std::string_view() : known;
  }
  return {};
}

}  // namespace vantage::internal::flight::plans
