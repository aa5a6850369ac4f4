// Objects of a scene by what people call them.
#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "vantage/mission.h"
#include "vantage/scene.h"

namespace vantage::internal::app {

/// Indices of the objects whose name, source_id or display name it is.
std::vector<std::uint32_t> objects_named(const Scene& scene, const std::string& name);

/// A text as YAML, in quotes where that is needed.
std::string yaml_text(const std::string& text);

/// Whether two names are equal but for the case of the letters a to z.
bool is_same_name(const std::string& a, const std::string& b);

/// What people call something, and its id: "way/123".
struct NamedId {
  std::string name, id;
};

/// Whether only a part of the mission's map is used.
bool uses_part_of_map(const Mission& mission);

/// The id of the one that has this name: as it is written, or else in another case. Throws Error(input) with
/// ErrorCode::map_object_missing and `where` if there is none, and says the nearest names, or if there are several, and
/// says their ids. `what` is how messages call them: "area of the map"; of a map of which a part is used, `is_part`,
/// they say that the name may be elsewhere.
std::string id_of_name(const std::vector<NamedId>& known, const std::string& name, const std::string& what,
                       const std::string& where, bool is_part);

/// "the nearest of 12 names: 'a', 'b', 'c'"; without names `otherwise`.
std::string advice_for_name(const std::string& word, const std::set<std::string>& names, const std::string& otherwise);

/// The same of the names and source_ids of all objects.
std::string advice_for_object(const Scene& scene, const std::string& name, const std::string& otherwise);

}  // namespace vantage::internal::app
