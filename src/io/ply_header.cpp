#include "io/ply_header.h"

#include <array>
#include <utility>

#include "io/georeference_text.h"
#include "io/object_text.h"
#include "io/rounding_text.h"
#include "io/text_cursor.h"

namespace vantage::internal::io::ply {
namespace {

constexpr std::array<std::pair<std::string_view, Type>, 16> kTypes = {{
    {"char", Type::int8},
    {"int8", Type::int8},
    {"uchar", Type::uint8},
    {"uint8", Type::uint8},
    {"short", Type::int16},
    {"int16", Type::int16},
    {"ushort", Type::uint16},
    {"uint16", Type::uint16},
    {"int", Type::int32},
    {"int32", Type::int32},
    {"uint", Type::uint32},
    {"uint32", Type::uint32},
    {"float", Type::float32},
    {"float32", Type::float32},
    {"double", Type::float64},
    {"float64", Type::float64},
}};

class HeaderReader {
 public:
  explicit HeaderReader(const MeshSource& source) : source_(source), text_(source.bytes()) {}

  Header read() {
    if (text_.rest_of_line() != "ply") fail("the file does not begin with the line \"ply\"");
    const std::string_view line_end = source_.bytes().substr(3, 2) == "\r\n" ? "\r\n" : source_.bytes().substr(3, 1);
    text_.next_line();
    bool has_format = false;
    while (true) {
      if (text_.at_end()) fail("the file ends within its header");
      text_.skip_blanks();
      const std::string_view keyword = text_.word();
      if (keyword == "end_header") break;
      if (keyword == "format") {
        format();
        has_format = true;
      } else if (keyword == "element") {
        element();
      } else if (keyword == "property") {
        property();
      } else if (keyword != "comment" && keyword != "obj_info" && !(keyword.empty() && text_.at_line_end())) {
        fail("unknown header line " + shown_word(keyword));
      }
      if (keyword == "comment") comment(text_.rest_of_line());
      if (keyword == "obj_info") text_.rest_of_line();
      end_line();
    }
    if (!has_format) fail("the header has no \"format\" line");
    // The line end is the one of the first line: in binary files a byte 10 may belong to the rows already.
    const std::size_t end = text_.offset();
    if (!source_.bytes().substr(end).starts_with(line_end)) fail("the line \"end_header\" does not end");
    header_.data = end + line_end.size();
    header_.data_line = text_.line() + 1;
    return std::move(header_);
  }

 private:
  [[noreturn]] void fail(std::string problem) {
    source_.fail_at_line(ErrorCode::mesh_syntax, text_.line(), "not a valid PLY header: " + std::move(problem),
                         "export the mesh again; the file is cut off or garbled");
  }

  void comment(std::string_view text) {
    try {
      read_georeference_comment(text, header_.georeference);
      read_rounding_comment(text, header_.rounding_m);
      read_ledger_comment(text, header_.ledger);
    } catch (const GeoreferenceProblem& problem) {
      source_.fail_at_line(ErrorCode::record_garbled, text_.line(), problem.text,
                           "correct or remove the comment; the mesh is read without");
    } catch (const LedgerProblem& problem) {
      source_.fail_at_line(ErrorCode::record_garbled, text_.line(), problem.text, "correct or remove the comment");
    } catch (const RoundingProblem& problem) {
      source_.fail_at_line(ErrorCode::record_garbled, text_.line(), problem.text, "correct or remove the comment");
    }
  }

  std::string_view next_word() {
    text_.skip_blanks();
    const std::string_view word = text_.word();
    if (word.empty()) fail("the line is too short");
    return word;
  }

  void end_line() {
    text_.skip_blanks();
    if (!text_.at_line_end()) fail("unexpected " + shown_word(text_.word()));
    text_.next_line();
  }

  void format() {
    const std::string_view name = next_word();
    if (name == "ascii") {
      header_.encoding = Encoding::ascii;
    } else if (name == "binary_little_endian") {
      header_.encoding = Encoding::little_endian;
    } else if (name == "binary_big_endian") {
      header_.encoding = Encoding::big_endian;
    } else {
      fail("unknown format " + shown_word(name));
    }
    if (const std::string_view version = next_word(); version != "1.0") fail("unknown version " + shown_word(version));
  }

  void element() {
    Element element;
    element.name = next_word();
    text_.skip_blanks();
    std::int64_t count = 0;
    if (!text_.integer(count) || !text_.at_word_end() || count < 0)
      fail("bad element count " + shown_word(text_.word()));
    element.count = static_cast<std::uint64_t>(count);
    header_.elements.push_back(std::move(element));
  }

  void property() {
    if (header_.elements.empty()) fail("a property comes before the first element");
    Property property;
    std::string_view word = next_word();
    if (word == "list") {
      property.is_list = true;
      property.length_type = type(next_word());
      if (!is_integer(property.length_type)) fail("the length of a list is not a whole number");
      word = next_word();
    }
    property.type = type(word);
    property.name = next_word();
    header_.elements.back().properties.push_back(std::move(property));
  }

  Type type(std::string_view name) {
    for (const auto& [known, type] : kTypes) {
      if (known == name) return type;
    }
    fail("unknown type " + shown_word(name));
  }

  const MeshSource& source_;
  TextCursor text_;
  Header header_;
};

}  // namespace

std::size_t size_of(Type type) {
  switch (type) {
    case Type::int8:
    case Type::uint8:
      return 1;
    case Type::int16:
    case Type::uint16:
      return 2;
    case Type::int32:
    case Type::uint32:
    case Type::float32:
      return 4;
    case Type::float64:
      return 8;
  }
  return 0;
}

int Element::find(std::string_view property) const {
  for (std::size_t i = 0; i < properties.size(); ++i) {
    if (properties[i].name == property) return static_cast<int>(i);
  }
  return -1;
}

std::size_t Element::smallest_row(Encoding encoding) const {
  std::size_t size = 0;
  for (const Property& property : properties) {
    const std::size_t binary = size_of(property.is_list ? property.length_type : property.type);
    size += encoding == Encoding::ascii ? 2 : binary;  // a digit and a space
  }
  return size;
}

Header read_header(const MeshSource& source) { return HeaderReader(source).read(); }

}  // namespace vantage::internal::io::ply
