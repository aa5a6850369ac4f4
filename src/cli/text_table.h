// Plain tables for people.
#pragma once

#include <string>
#include <vector>

#include "common/input.h"
#include "vantage/geometry.h"

namespace vantage::cli {

std::string count(std::size_t number);

/// `value` with `digits` decimals.
std::string fixed(double value, int digits);

/// "x y z" with two decimals.
std::string vector(const Vec3& value);

/// "12 ms", "3.4 s".
std::string duration(double seconds);

/// Rows of a name, a value (right-aligned) and a remark, under headings.
class TextTable {
 public:
  // Texts may come from files: they are made printable().
  void heading(const std::string& text) { rows_.push_back({printable(text), "", "", true}); }
  void row(const std::string& name, const std::string& value, const std::string& remark) {
    rows_.push_back({printable(name), printable(value), printable(remark), false});
  }
  std::string text() const;

 private:
  struct Row {
    std::string name, value, remark;
    bool is_heading = false;
  };
  std::vector<Row> rows_;
};

}  // namespace vantage::cli
