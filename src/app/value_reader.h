// Values of YAML files, checked: numbers, lengths, vectors, texts, lists.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "app/schema.h"
#include "app/yaml_tree.h"
#include "common/input.h"
#include "vantage/error.h"
#include "vantage/geometry.h"

namespace vantage::internal::app {

/// Largest length that a file may state, in metres: beyond it a coordinate leaves the solar system's inner planets, and
/// squares of lengths begin to lose the millimetres that the engine promises.
inline constexpr double kMaxLength = 1e9;

/// Reads values of one file. `what` is the key as messages call it: "target.vertices[2]". All throw Error(input) with
/// the node's place.
class ValueReader {
 public:
  explicit ValueReader(std::string file) : file_(std::move(file)) {}

  const std::string& file() const { return file_; }

  double number(const YamlNode& node, const std::string& what) const;
  double bounded(const YamlNode& node, const std::string& what) const;   ///< at most kMaxLength either way
  double positive(const YamlNode& node, const std::string& what) const;  ///< likewise, above 0
  /// Metres, at most kMaxLength either way: a number, or one with its unit ("400 ft").
  double length(const YamlNode& node, const std::string& what) const;
  double positive_length(const YamlNode& node, const std::string& what) const;  ///< above 0
  double angle(const YamlNode& node, const std::string& what) const;            ///< degrees, with a unit or without
  /// Takes no unit: a reference system may say what it is.
  double coordinate(const YamlNode& node, const std::string& what) const;
  /// Three coordinates. `form` is what to write instead, where the node is none.
  Vec3 vector(const YamlNode& node, const std::string& what,
              const char* form = "write three numbers in brackets, in metres, z up: [x, y, z]") const;
  /// The corners of a polygon: two coordinates each.
  std::vector<Eigen::Vector2d> ring(const YamlNode& node, const std::string& what) const;
  bool flag(const YamlNode& node, const std::string& what) const;
  std::string text(const YamlNode& node, const std::string& what) const;  ///< not empty, no control characters
  const std::vector<YamlNode>& list(const YamlNode& node, const std::string& what, const std::string& fix) const;

  [[noreturn]] void fail(ErrorCode code, const YamlNode& node, const std::string& problem,
                         const std::string& fix) const {
    fail_at(code, node, file_, problem, fix);
  }

 private:
  using Parse = ParsedNumber (*)(std::string_view);
  using Advice = std::string (*)(std::string_view, NumberFault);
  double parsed(const YamlNode& node, const std::string& what, Parse parse, Advice advice) const;
  double checked(double value, const YamlNode& node, const std::string& what) const;
  double above_zero(double value, const YamlNode& node, const std::string& what) const;

  std::string file_;
};

}  // namespace vantage::internal::app
