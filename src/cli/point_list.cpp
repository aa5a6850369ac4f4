#include "cli/point_list.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <optional>

#include "mission/numbers.h"
#include "vantage/error.h"

namespace vantage::cli {
namespace {

using mission_io::in_quotes;
using mission_io::NumberFault;
using mission_io::parse_number;

constexpr std::array<std::string_view, 3> kAxes = {"x", "y", "z"};

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r'; }

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

/// ',' or ';', or ' ' for any run of blanks. A semicolon wins: where it separates, commas are decimal ones.
char separator_of(std::string_view row) {
  if (row.find(';') != std::string_view::npos) return ';';
  return row.find(',') != std::string_view::npos ? ',' : ' ';
}

/// The fields of a row, without blanks round them and without their quotes.
std::vector<std::string> split(std::string_view row, char separator) {
  std::vector<std::string> fields;
  std::size_t at = 0;
  const auto ends_field = [&](char c) { return separator == ' ' ? is_blank(c) : c == separator; };
  while (at <= row.size()) {
    while (at < row.size() && is_blank(row[at])) ++at;
    std::string field;
    if (at < row.size() && row[at] == '"') {
      for (++at; at < row.size(); ++at) {
        if (row[at] != '"') {
          field += row[at];
        } else if (at + 1 < row.size() && row[at + 1] == '"') {
          field += row[at++];  // "" stands for one quote
        } else {
          ++at;
          break;
        }
      }
      while (at < row.size() && !ends_field(row[at])) ++at;
    } else {
      const std::size_t start = at;
      while (at < row.size() && !ends_field(row[at])) ++at;
      field = trimmed(row.substr(start, at - start));
    }
    fields.push_back(std::move(field));
    ++at;  // past the separator; past the end after the last field
  }
  return fields;
}

class PointParser {
 public:
  explicit PointParser(const std::string& file) : file_(file) {}

  void take_row(std::string_view row, int line) {
    if (row.empty() || row.front() == '#') return;
    if (!separator_) {
      separator_ = separator_of(row);
      if (take_header(split(row, *separator_), line)) return;
    }
    take_point(split(row, *separator_), line);
  }

  std::vector<Vec3> take_points() { return std::move(points_); }

 private:
  [[noreturn]] void fail(const std::string& problem, int line, const std::string& fix) const {
    throw Error(ErrorKind::input, problem, file_ + ":" + std::to_string(line), fix);
  }

  /// Whether the first row is a header; finds the columns if so.
  bool take_header(const std::vector<std::string>& fields, int line) {
    const std::size_t looked_at = std::min<std::size_t>(fields.size(), 3);
    const bool has_word = std::any_of(fields.begin(), fields.begin() + static_cast<std::ptrdiff_t>(looked_at),
                                      [](const std::string& field) { return is_word(field); });
    if (!has_word) return false;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto column = std::find_if(fields.begin(), fields.end(), [&](const std::string& field) {
        return field == kAxes[axis] || (field.size() == 1 && field[0] == kAxes[axis][0] - 'a' + 'A');
      });
      if (column == fields.end()) {
        fail("the first row is neither a point nor a header with a column " + std::string(kAxes[axis]), line,
             "begin with the header 'x,y,z', or with a point such as 1.5,2,30");
      }
      columns_[axis] = static_cast<std::size_t>(column - fields.begin());
    }
    return true;
  }

  /// Begins like a name and is no spelling of infinity or not-a-number, which is a point's mistake, not a header.
  static bool is_word(const std::string& field) {
    if (field.empty() || parse_number(field).fault != NumberFault::not_a_number) return false;
    const auto c = static_cast<unsigned char>(field.front());
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || c >= 0x80;
  }

  void take_point(const std::vector<std::string>& fields, int line) {
    Vec3 point;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::string axis_name(kAxes[axis]);
      if (columns_[axis] >= fields.size()) {
        fail("the row has " + std::to_string(fields.size()) + " columns, but " + axis_name + " is column " +
                 std::to_string(columns_[axis] + 1),
             line, "write x, y and z in every row, separated like the first row");
      }
      const std::string& field = fields[columns_[axis]];
      const mission_io::ParsedNumber parsed = parse_number(field);
      if (parsed.fault != NumberFault::none) {
        fail(axis_name + (parsed.fault == NumberFault::not_finite ? " is not finite: " : " is not a number: ") +
                 in_quotes(field),
             line, mission_io::number_advice(field, parsed.fault));
      }
      point[static_cast<Eigen::Index>(axis)] = parsed.value;
    }
    points_.push_back(point);
  }

  const std::string& file_;
  std::optional<char> separator_;
  std::array<std::size_t, 3> columns_ = {0, 1, 2};
  std::vector<Vec3> points_;
};

std::string joined(const std::vector<std::string>& parts, char separator) {
  std::string text;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (i > 0) text += separator;
    text += parts[i];
  }
  return text;
}

/// In double quotes where the text would break the row; RFC 4180.
std::string field_text(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string field = "\"";
  for (const char c : text) field += c == '"' ? "\"\"" : std::string(1, c);
  return field + "\"";
}

/// Nine significant digits: a micrometre in a kilometre.
std::string metres(double value) {
  std::array<char, 32> digits;
  const auto [end, error] =
      std::to_chars(digits.data(), digits.data() + digits.size(), value, std::chars_format::general, 9);
  return error == std::errc() ? std::string(digits.data(), end) : mission_io::shortest(value);
}

}  // namespace

std::vector<Vec3> parse_points(std::string_view text, const std::string& file) {
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);  // a byte order mark, as spreadsheets write it
  PointParser parser(file);
  int line = 0;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    parser.take_row(trimmed(text.substr(0, end)), ++line);
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return parser.take_points();
}

std::string answers_text(const std::vector<Vec3>& points, const std::vector<PointAnswer>& answers) {
  const auto truth = [](bool value) { return value ? "true" : "false"; };
  std::string text = "x,y,z,inside,margin_m,blocked_by,out_of_range,behind_target,outside_of\n";
  for (std::size_t i = 0; i < points.size(); ++i) {
    const PointAnswer& answer = answers[i];
    std::vector<std::string> fields;
    for (const double coordinate : points[i]) fields.push_back(mission_io::shortest(coordinate));
    fields.push_back(truth(answer.inside));
    fields.push_back(metres(answer.margin_m));
    fields.push_back(field_text(joined(answer.blocked_by, ';')));
    fields.push_back(truth(answer.out_of_range));
    fields.push_back(truth(answer.behind_target));
    fields.push_back(field_text(joined(answer.outside_of, ';')));
    text += joined(fields, ',');
    text += '\n';
  }
  return text;
}

}  // namespace vantage::cli
