#include "app/value_reader.h"

#include <algorithm>
#include <cmath>

#include "vantage/input.h"

namespace vantage::internal::app {

double ValueReader::number(const YamlNode& node, const std::string& what) const {
  if (node.kind != YamlNode::Kind::scalar || node.is_quoted) {
    fail(ErrorCode::wrong_type, node, what + " must be a number, not " + describe(node),
         "write a plain decimal number, such as 12.5");
  }
  const ParsedNumber parsed = parse_number(node.text);
  switch (parsed.fault) {
    case NumberFault::none:
      return parsed.value;
    case NumberFault::not_finite:
      fail(ErrorCode::value_out_of_range, node, what + " is not finite: " + in_quotes(node.text),
           number_advice(node.text, parsed.fault));
    case NumberFault::out_of_range:
      fail(ErrorCode::value_out_of_range, node, what + " is beyond what a double holds: " + in_quotes(node.text),
           number_advice(node.text, parsed.fault));
    case NumberFault::not_a_number:
      break;
  }
  fail(ErrorCode::not_a_number, node, what + " must be a number, not " + in_quotes(node.text),
       number_advice(node.text, parsed.fault));
}

double ValueReader::length(const YamlNode& node, const std::string& what) const {
  const double value = number(node, what);
  if (std::abs(value) > kMaxLength) {
    fail(ErrorCode::value_out_of_range, node,
         what + " is too large: " + shortest(value) + ", at most " + shortest(kMaxLength),
         "lengths are in metres; far from the origin use a local frame");
  }
  return value;
}

double ValueReader::positive(const YamlNode& node, const std::string& what) const {
  const double value = length(node, what);
  if (value <= 0) {
    fail(ErrorCode::value_out_of_range, node, what + " must be greater than 0, not " + shortest(value),
         "write a positive number");
  }
  return value;
}

Vec3 ValueReader::vector(const YamlNode& node, const std::string& what, const char* form) const {
  if (node.kind != YamlNode::Kind::sequence || node.items.size() != 3) {
    fail(ErrorCode::wrong_type, node, what + " must be three numbers, not " + describe(node), form);
  }
  Vec3 result;
  for (int axis = 0; axis < 3; ++axis) {
    result[axis] = length(node.items[static_cast<std::size_t>(axis)], what + "." + "xyz"[axis]);
  }
  return result;
}

std::vector<Eigen::Vector2d> ValueReader::ring(const YamlNode& node, const std::string& what) const {
  const char* const form = "write the corners in order: [[x, y], [x, y], [x, y]]";
  std::vector<Eigen::Vector2d> corners;
  list(node, what, form);
  for (std::size_t i = 0; i < node.items.size(); ++i) {
    const YamlNode& corner = node.items[i];
    const std::string name = what + "[" + std::to_string(i) + "]";
    if (list(corner, name, form).size() != 2) {
      fail(ErrorCode::wrong_type, corner, name + " must be two numbers, not " + describe(corner), form);
    }
    corners.emplace_back(length(corner.items[0], name + ".x"), length(corner.items[1], name + ".y"));
  }
  return corners;
}

std::string ValueReader::text(const YamlNode& node, const std::string& what) const {
  if (node.kind != YamlNode::Kind::scalar || node.text.empty()) {
    fail(ErrorCode::wrong_type, node,
         what + " must be a text, not " + (node.kind == YamlNode::Kind::scalar ? "empty" : describe(node)),
         "write a word; put it in quotes if it holds blanks, colons or brackets");
  }
  const bool has_control = std::any_of(node.text.begin(), node.text.end(),
                                       [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7F; });
  if (has_control) {
    fail(ErrorCode::value_syntax, node, what + " holds a control character: " + in_quotes(node.text),
         "write it without tabs and line breaks");
  }
  return node.text;
}

const std::vector<YamlNode>& ValueReader::list(const YamlNode& node, const std::string& what,
                                               const std::string& fix) const {
  if (node.kind != YamlNode::Kind::sequence)
    fail(ErrorCode::wrong_type, node, what + " must be a list, not " + describe(node), fix);
  return node.items;
}

}  // namespace vantage::internal::app
