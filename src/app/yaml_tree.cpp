#include "app/yaml_tree.h"

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/parser.h>

#include <algorithm>
#include <istream>
#include <streambuf>

#include "common/input.h"
#include "vantage/error.h"

namespace vantage::internal::app {
namespace {

std::string save_as_utf8(const YamlDialect& dialect) {
  return "save it as plain text in UTF-8; " + dialect.page + " shows an example";
}

std::string see_example(const YamlDialect& dialect) { return "compare with the example in " + dialect.page; }

/// Length of the UTF-8 sequence that starts at `at`, or 0 when there is none (bad lead or continuation byte, overlong
/// form, surrogate, beyond U+10FFFF). Source: RFC 3629, section 4.
std::size_t utf8_length(std::string_view text, std::size_t at) {
  const auto byte = [&](std::size_t i) {
    return i < text.size() ? static_cast<unsigned>(static_cast<unsigned char>(text[i])) : 0U;
  };
  const auto is_tail = [&](std::size_t i) { return (byte(i) & 0xC0U) == 0x80U; };
  const unsigned lead = byte(at), second = byte(at + 1);
  if (lead < 0x80) return 1;
  if (lead >= 0xC2 && lead <= 0xDF) return is_tail(at + 1) ? 2 : 0;
  if (lead >= 0xE0 && lead <= 0xEF) {
    if (lead == 0xE0 && second < 0xA0) return 0;
    if (lead == 0xED && second > 0x9F) return 0;
    return is_tail(at + 1) && is_tail(at + 2) ? 3 : 0;
  }
  if (lead >= 0xF0 && lead <= 0xF4) {
    if (lead == 0xF0 && second < 0x90) return 0;
    if (lead == 0xF4 && second > 0x8F) return 0;
    return is_tail(at + 1) && is_tail(at + 2) && is_tail(at + 3) ? 4 : 0;
  }
  return 0;
}

/// yaml-cpp replaces bad bytes without a word and takes byte 4 for the end of the file, so both are caught here.
void check_is_text(std::string_view text, const std::string& file, const YamlDialect& dialect) {
  if (text.size() > kMaxYamlBytes) {
    throw Error(ErrorCode::file_too_large,
                "the " + dialect.name + " is too large: " + std::to_string(text.size()) + " bytes, at most " +
                    std::to_string(kMaxYamlBytes),
                file, "give the " + dialect.name + ", not a mesh; geometry belongs into mesh files that it names");
  }
  if (text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF")) {
    throw Error(ErrorCode::not_utf8_text, "the " + dialect.name + " is UTF-16 text, not UTF-8", file,
                save_as_utf8(dialect));
  }
  int line = 1;
  std::size_t line_start = 0;
  for (std::size_t at = 0; at < text.size();) {
    const auto byte = static_cast<unsigned char>(text[at]);
    const bool is_control = (byte < 0x20 && byte != '\t' && byte != '\n' && byte != '\r') || byte == 0x7F;
    const std::size_t length = is_control ? 0 : utf8_length(text, at);
    if (length == 0) {
      const std::string what = is_control ? "a control character" : "a byte that is not UTF-8";
      throw Error(
          ErrorCode::not_utf8_text,
          "the " + dialect.name + " is not text: it holds " + what + " (byte value " + std::to_string(byte) + ")",
          place_in(file, {line, static_cast<int>(at - line_start) + 1}), save_as_utf8(dialect));
    }
    at += length;
    if (byte == '\n') {
      ++line;
      line_start = at;
    }
  }
}

/// Builds the tree from yaml-cpp's events. Its own YAML::Node would follow aliases and keep duplicate keys unseen.
class TreeBuilder : public YAML::EventHandler {
 public:
  TreeBuilder(const std::string& file, const YamlDialect& dialect) : file_(file), dialect_(dialect) {}

  YamlNode take_root() { return std::move(root_); }

  void OnDocumentStart(const YAML::Mark&) override {}
  void OnDocumentEnd() override {}

  void OnNull(const YAML::Mark& mark, YAML::anchor_t) override { add(make(YamlNode::Kind::null, mark)); }

  void OnAlias(const YAML::Mark& mark, YAML::anchor_t) override {
    throw Error(ErrorCode::yaml_unsupported, "YAML aliases (*name) are not understood in a " + dialect_.name, at(mark),
                "write the value out where it is used");
  }

  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t, const std::string& value) override {
    YamlNode node = make(YamlNode::Kind::scalar, mark);
    node.text = value;
    node.is_quoted = tag == "!";  // yaml-cpp: "?" is a plain scalar, "!" one in quotes, all else a tag
    if (!node.is_quoted) refuse_tag(mark, tag);
    add(std::move(node));
  }

  void OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t,
                       YAML::EmitterStyle::value) override {
    refuse_tag(mark, tag);
    open(make(YamlNode::Kind::sequence, mark));
  }
  void OnSequenceEnd() override { close(); }

  void OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t, YAML::EmitterStyle::value) override {
    refuse_tag(mark, tag);
    open(make(YamlNode::Kind::map, mark));
  }
  void OnMapEnd() override { close(); }

 private:
  /// A map or sequence whose end has not been seen.
  struct Open {
    YamlNode node;
    std::string key;  ///< read, and waiting for its value
    Place key_place;
    bool has_key = false;
  };

  std::string at(const YAML::Mark& mark) const { return place_in(file_, {mark.line + 1, mark.column + 1}); }

  static YamlNode make(YamlNode::Kind kind, const YAML::Mark& mark) {
    YamlNode node;
    node.kind = kind;
    node.place = {mark.line + 1, mark.column + 1};
    return node;
  }

  void refuse_tag(const YAML::Mark& mark, const std::string& tag) const {
    if (tag.empty() || tag == "?" || tag == "!") return;
    throw Error(ErrorCode::yaml_unsupported,
                "YAML tags (" + in_quotes(tag) + ") are not understood in a " + dialect_.name, at(mark),
                "write the value without the tag");
  }

  void open(YamlNode node) {
    if (static_cast<int>(open_.size()) >= kMaxYamlDepth) {
      throw Error(ErrorCode::yaml_unsupported,
                  "the " + dialect_.name + " nests more than " + std::to_string(kMaxYamlDepth) + " levels deep",
                  place_in(file_, node.place), see_example(dialect_));
    }
    if (expects_key()) refuse_key(node);
    open_.push_back({std::move(node), {}, {}, false});
  }

  void close() {
    YamlNode node = std::move(open_.back().node);
    open_.pop_back();
    add(std::move(node));
  }

  bool expects_key() const {
    return !open_.empty() && open_.back().node.kind == YamlNode::Kind::map && !open_.back().has_key;
  }

  [[noreturn]] void refuse_key(const YamlNode& node) const {
    throw Error(ErrorCode::yaml_syntax, "a key must be a word", place_in(file_, node.place), see_example(dialect_));
  }

  void add(YamlNode node) {
    if (open_.empty()) {
      root_ = std::move(node);
      return;
    }
    Open& parent = open_.back();
    if (parent.node.kind == YamlNode::Kind::sequence) {
      parent.node.items.push_back(std::move(node));
    } else if (!parent.has_key) {
      if (node.kind != YamlNode::Kind::scalar) refuse_key(node);
      refuse_second(parent.node, node);
      parent.key = std::move(node.text);
      parent.key_place = node.place;
      parent.has_key = true;
    } else {
      if (node.kind == YamlNode::Kind::null) node.place = parent.key_place;  // yaml-cpp tells the next token's
      parent.node.entries.push_back({std::move(parent.key), parent.key_place, std::move(node)});
      parent.has_key = false;
      const std::size_t most = may_repeat() ? kMaxRepeated : kMaxEntries;
      if (parent.node.entries.size() > most) {
        throw Error(ErrorCode::yaml_unsupported, "a mapping has more than " + std::to_string(most) + " keys",
                    place_in(file_, parent.node.place), see_example(dialect_));
      }
    }
  }

  /// Whether the innermost open map is the outermost one of a file that repeats keys there.
  bool may_repeat() const { return open_.size() == 1 && !dialect_.repeatable.empty(); }

  void refuse_second(const YamlNode& map, const YamlNode& key) const {
    if (may_repeat() &&
        std::find(dialect_.repeatable.begin(), dialect_.repeatable.end(), key.text) != dialect_.repeatable.end()) {
      return;
    }
    const auto first = std::find_if(map.entries.begin(), map.entries.end(),
                                    [&](const YamlEntry& entry) { return entry.key == key.text; });
    if (first == map.entries.end()) return;
    throw Error(ErrorCode::duplicate_key, "key " + in_quotes(key.text) + " is given twice", place_in(file_, key.place),
                "keep one of them; the first is at line " + std::to_string(first->place.line));
  }

  /// No map of a mission has more than a dozen keys. Bounds the cost of looking for a key given twice.
  static constexpr std::size_t kMaxEntries = 100;

  const std::string& file_;
  const YamlDialect& dialect_;
  YamlNode root_;
  std::vector<Open> open_;
};

/// Reads from memory without a copy.
class ViewBuffer : public std::streambuf {
 public:
  explicit ViewBuffer(std::string_view text) {
    char* begin = const_cast<char*>(text.data());  // never written to: only the get area is set
    setg(begin, begin, begin + text.size());
  }
};

}  // namespace

std::string place_in(const std::string& file, Place place) {
  return file + ":" + std::to_string(place.line) + ":" + std::to_string(place.column);
}

YamlNode parse_yaml(std::string_view text, const std::string& file, const YamlDialect& dialect) {
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);  // a byte order mark, as some editors write it
  check_is_text(text, file, dialect);
  try {
    ViewBuffer buffer(text);
    std::istream stream(&buffer);
    YAML::Parser parser(stream);
    TreeBuilder builder(file, dialect);
    if (!parser.HandleNextDocument(builder))
      throw Error(ErrorCode::file_empty, "the " + dialect.name + " is empty", file, see_example(dialect));
    YamlNode root = builder.take_root();
    TreeBuilder rest(file, dialect);
    if (parser.HandleNextDocument(rest)) {
      throw Error(ErrorCode::yaml_unsupported, "the " + dialect.name + " holds more than one YAML document",
                  place_in(file, rest.take_root().place), "keep one in a file: remove the '---' between them");
    }
    return root;
  } catch (const YAML::Exception& error) {
    const Place place{error.mark.line + 1, error.mark.column + 1};
    throw Error(ErrorCode::yaml_syntax, "the " + dialect.name + " is not valid YAML: " + error.msg,
                error.mark.is_null() ? file : place_in(file, place),
                "check brackets, colons and indentation (blanks, not tabs) here and on the line before");
  }
}

}  // namespace vantage::internal::app
