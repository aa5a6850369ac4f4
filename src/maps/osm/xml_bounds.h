// What an OpenStreetMap XML text may not be, whatever it says: found while its bytes go by, before a parser holds them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace vantage::internal::osm {

/// Follows the markup of a text that comes in parts. Expat keeps a tag or a comment whole and looks at it again with
/// every part that comes; libosmium keeps an object whole and counts its bytes in 32 bits. Both are bounded here:
/// - a tag, a comment or a processing instruction has at most 1 MiB
/// - what lies between the tags of one object of the map (a child of the root) has at most 64 MiB
/// The largest of the planet have some kilobytes and some megabytes.
class XmlBounds {
 public:
  static constexpr std::uint64_t kMostOfTag = std::uint64_t{1} << 20;
  static constexpr std::uint64_t kMostOfObject = std::uint64_t{64} << 20;

  /// Throws RefusedInput. What is not well-formed is left to the parser.
  void add(std::string_view part);

 private:
  enum class Inside { text, opening, tag, comment, character_data, instruction };

  std::size_t skip_text(std::string_view part, std::size_t at);
  std::size_t open(std::string_view part, std::size_t at);
  std::size_t pass_tag(std::string_view part, std::size_t at);
  std::size_t pass_until(std::string_view part, std::size_t at, std::string_view end);
  void close_tag();
  void check(std::uint64_t position) const;

  Inside inside_ = Inside::text;
  std::string opening_;              // the first bytes after "<", until they tell what begins
  std::string tail_;                 // the last two bytes of what is passed
  char quote_ = 0;                   // that ends the value of an attribute; 0 outside of values
  std::uint64_t passed_ = 0;         // bytes of the parts before
  std::uint64_t tag_begins_ = 0;     // of what is not text: the place of "<"
  std::uint64_t object_begins_ = 0;  // where the root's last child ended
  std::uint64_t depth_ = 0;
};

}  // namespace vantage::internal::osm
