#include "app/value_reader.h"

#include <algorithm>
#include <cmath>

namespace vantage::internal::app {

double ValueReader::parsed(const YamlNode& node, const std::string& what, Parse parse, Advice advice) const {
  // A number in quotes is a text. With a unit it must be in quotes in JSON, so there it is one.
  const bool has_unit = node.kind == YamlNode::Kind::scalar && parse(node.text).fault == NumberFault::none &&
                        parse_number(node.text).fault != NumberFault::none;
  if (node.kind != YamlNode::Kind::scalar || (node.is_quoted && !has_unit)) {
    fail(ErrorCode::wrong_type, node, what + " must be a number, not " + describe(node),
         advice("", NumberFault::not_a_number));
  }
  const ParsedNumber parsed = parse(node.text);
  const std::string text = in_quotes(node.text);
  switch (parsed.fault) {
    case NumberFault::none:
      return parsed.value;
    case NumberFault::not_finite:
      fail(ErrorCode::value_out_of_range, node, what + " is not finite: " + text, advice(node.text, parsed.fault));
    case NumberFault::out_of_range:
      fail(ErrorCode::value_out_of_range, node, what + " is beyond what a double holds: " + text,
           advice(node.text, parsed.fault));
    case NumberFault::unknown_unit:
      fail(ErrorCode::value_syntax, node, what + " has a unit that it cannot have: " + text,
           advice(node.text, parsed.fault));
    case NumberFault::not_a_number:
      break;
  }
  fail(ErrorCode::not_a_number, node, what + " must be a number, not " + text, advice(node.text, parsed.fault));
}

double ValueReader::checked(double value, const YamlNode& node, const std::string& what) const {
  if (std::abs(value) > kMaxLength) {
    fail(ErrorCode::value_out_of_range, node,
         what + " is too large: " + shortest(value) + ", at most " + shortest(kMaxLength),
         "lengths are in metres; far from the origin use a local frame");
  }
  return value;
}

double ValueReader::above_zero(double value, const YamlNode& node, const std::string& what) const {
  if (value <= 0) {
    fail(ErrorCode::value_out_of_range, node, what + " must be greater than 0, not " + shortest(value),
         "write a positive number");
  }
  return value;
}

double ValueReader::number(const YamlNode& node, const std::string& what) const {
  return parsed(node, what, parse_number, number_advice);
}

double ValueReader::bounded(const YamlNode& node, const std::string& what) const {
  return checked(number(node, what), node, what);
}

double ValueReader::positive(const YamlNode& node, const std::string& what) const {
  return above_zero(bounded(node, what), node, what);
}

double ValueReader::length(const YamlNode& node, const std::string& what) const {
  return checked(parsed(node, what, parse_length, length_advice), node, what);
}

double ValueReader::positive_length(const YamlNode& node, const std::string& what) const {
  return above_zero(length(node, what), node, what);
}

double ValueReader::angle(const YamlNode& node, const std::string& what) const {
  return parsed(node, what, parse_angle, angle_advice);
}

double ValueReader::coordinate(const YamlNode& node, const std::string& what) const {
  const bool is_plain = node.kind == YamlNode::Kind::scalar && !node.is_quoted;
  const ParsedNumber with_unit = is_plain ? parse_length(node.text) : ParsedNumber{};
  if (with_unit.fault == NumberFault::none && parse_number(node.text).fault != NumberFault::none) {
    fail(ErrorCode::value_syntax, node, what + " is a coordinate, which takes no unit: " + in_quotes(node.text),
         "write the number alone: " + shortest(with_unit.value) + " in metres; with 'crs', in the unit of that system");
  }
  return bounded(node, what);
}

Vec3 ValueReader::vector(const YamlNode& node, const std::string& what, const char* form) const {
  if (node.kind != YamlNode::Kind::sequence || node.items.size() != 3) {
    fail(ErrorCode::wrong_type, node, what + " must be three numbers, not " + describe(node), form);
  }
  Vec3 result;
  for (int axis = 0; axis < 3; ++axis) {
    result[axis] = coordinate(node.items[static_cast<std::size_t>(axis)], what + "." + "xyz"[axis]);
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
    corners.emplace_back(coordinate(corner.items[0], name + ".x"), coordinate(corner.items[1], name + ".y"));
  }
  return corners;
}

bool ValueReader::flag(const YamlNode& node, const std::string& what) const {
  const std::string word = text(node, what);
  if (word == "true" || word == "false") return word == "true";
  fail(ErrorCode::unknown_choice, node, what + " must be true or false, not " + in_quotes(word), "write true or false");
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
