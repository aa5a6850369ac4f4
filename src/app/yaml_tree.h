// A small tree of a YAML document with the place of every node, read under bounds that keep hostile input harmless.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace vantage::internal::app {

/// Where something stands in a text file, counted from 1.
struct Place {
  int line = 1, column = 1;
};

struct YamlEntry;

struct YamlNode {
  enum class Kind { null, scalar, sequence, map };
  Kind kind = Kind::null;
  Place place;
  std::string text;                ///< of a scalar
  bool is_quoted = false;          ///< a scalar in quotes: text, even where it looks like a number
  std::vector<YamlNode> items;     ///< of a sequence
  std::vector<YamlEntry> entries;  ///< of a map, in the file's order; no key twice, see YamlDialect
};

struct YamlEntry {
  std::string key;
  Place place;  ///< of the key
  YamlNode value;
};

/// Longest text that parse_yaml takes, in bytes: room for some 20,000 boxes. yaml-cpp was seen to take up to 240 times
/// its input in memory (for "[[[["...), so that much more would be felt.
inline constexpr std::size_t kMaxYamlBytes = std::size_t{1} << 20;

/// Deepest nesting that parse_yaml takes; a mission needs 5. yaml-cpp descends recursively, so that depth costs stack.
inline constexpr int kMaxYamlDepth = 16;

/// What kind of file is read: how messages call it, where it is described, and which keys it may repeat.
struct YamlDialect {
  std::string name = "mission file";
  std::string page = "docs/mission-file.md";
  std::vector<std::string> repeatable;  ///< keys of the outermost map that may stand there many times
};

/// Most keys of the outermost map of a file that may repeat some.
inline constexpr std::size_t kMaxRepeated = 10000;

/// Parses one YAML document. `file` is only for messages.
/// Throws Error(input) with file, line and column for: text that is not UTF-8 or holds control characters, a text
/// longer than kMaxYamlBytes, nothing in the text, more than one document, bad syntax, nesting deeper than
/// kMaxYamlDepth, a key that is not a word or stands twice, aliases (a few lines of them can stand for gigabytes) and
/// tags.
YamlNode parse_yaml(std::string_view text, const std::string& file, const YamlDialect& dialect = {});

/// "mission.yaml:4:9", as compilers write it.
std::string place_in(const std::string& file, Place place);

}  // namespace vantage::internal::app
