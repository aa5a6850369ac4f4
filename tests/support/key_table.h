// The keys of a described section, as docs/mission-file.md lists them.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "common/input.h"
#include "request/description.h"
#include "vantage/tour.h"

namespace vantage::testing {

/// A visitor. The settings that it visits must be those by default.
class KeyTable : internal::request::Visitor {
  using Key = internal::request::Key;
  using Bounds = internal::request::Bounds;
  using Only = internal::request::Only;

 public:
  explicit KeyTable(std::string_view section) : section_(section) {}

  template <typename Value, typename Choices>
  void choice(const Key& key, const Value& value, const Choices& choices) {
    for (const auto& [one, word] : choices) {
      if (one == value) add(key, "", "", "`" + std::string(word) + "`");
    }
  }
  void number(const Key& key, double value, const Bounds& bounds, const Only& /*only*/) {
    add(key, symbol_of(bounds.unit), ", " + bounds.text(), shortest(value));
  }
  void pair(const Key& key, double low, const Bounds& of_low, double high, const Bounds& /*of_high*/,
            const Only& /*only*/) {
    add(key, symbol_of(of_low.unit), "", "[" + shortest(low) + ", " + shortest(high) + "]");
  }
  void whole(const Key& key, int value, const Bounds& bounds) {
    add(key, "", ", " + bounds.text(), std::to_string(value));
  }
  template <typename Grid>
  void grid(const Key& key, const Grid& /*value*/, const Bounds& /*of_first*/, const Bounds& /*of_second*/) {
    add(key, "", "", "");
  }
  template <typename Device>
  void device(const Key& key, const Device& /*value*/) {
    add(key, "", "", "");
  }
  void flag(const Key& key, bool value) { add(key, "", "", value ? "true" : "false"); }
  void home(const Key& key, const std::optional<TourHome>& /*value*/) { add(key, "", "", ""); }

  const std::string& text() const { return text_; }

 private:
  void add(const Key& key, std::string_view unit, const std::string& range, const std::string& value) {
    std::string line = "- `" + section_ + "." + std::string(key.path) + "`";
    if (!unit.empty()) line += " (" + std::string(unit) + ")";
    line += ": " + std::string(key.says) + range + ".";
    if (!key.more.empty()) line += " " + std::string(key.more);
    line += " Default: " + (key.without.empty() ? value : std::string(key.without)) + ".";
    wrap(line);
  }

  void wrap(std::string line) {
    constexpr std::size_t kMost = 120;
    while (columns(line) > kMost) {
      std::size_t at = line.size();
      do {
        at = line.rfind(' ', at - 1);
      } while (columns(line.substr(0, at)) > kMost);
      text_ += line.substr(0, at) + "\n";
      line = "  " + line.substr(at + 1);
    }
    text_ += line + "\n";
  }

  /// Of UTF-8.
  static std::size_t columns(const std::string& text) {
    std::size_t count = 0;
    for (const char c : text) count += (static_cast<unsigned char>(c) & 0xC0U) != 0x80U ? 1 : 0;
    return count;
  }

  std::string section_, text_;
};

}  // namespace vantage::testing
