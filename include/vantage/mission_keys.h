// The keys of mission files: what docs/mission-file.md lists, for programs.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "vantage/export.h"

namespace vantage {

struct MissionKey {
  /// What stands there. Of two words the first is the shorter form: a mount is "gimbal", or a map of angles.
  enum class Kind {
    number,
    whole,  ///< a number without a fraction
    flag,   ///< true or false
    word,   ///< one of a few; `words` where the key takes no others
    text,
    path,     ///< of a file, from the mission file
    vector,   ///< [x, y, z]
    place,    ///< [latitude, longitude], degrees
    numbers,  ///< a list of numbers
    points,   ///< a list of points
    polygons,
    list,
    map,
    maps,  ///< a list of maps
    word_or_number,
    word_or_map,
    text_or_number,
    numbers_or_map
  };

  std::string section;  ///< "sensor"; "links[]" for the entries of a list; empty for the outermost keys
  std::string path;     ///< in the section: "pixel.size"
  Kind kind = Kind::text;
  std::vector<std::string> words = {};
  std::string unit = {};                       ///< "m"; empty without one
  std::optional<double> least, most;           ///< of a number
  bool takes_least = true, takes_most = true;  ///< whether these two are numbers that it takes
  bool is_required = false;                    ///< in its map
  bool is_old = false;                         ///< another key has taken its place
  std::string text = {};                       ///< sentences in Markdown, with the range and the default
};

/// All keys, section by section. Links in their texts start from docs/.
VANTAGE_API std::vector<MissionKey> mission_keys();

/// "word_or_map".
VANTAGE_API const char* name_of(MissionKey::Kind kind);

}  // namespace vantage
