// The objects of a scene, for those who look for a target.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "vantage/export.h"
#include "vantage/scene_source.h"

namespace vantage {

struct ListedObject {
  std::uint32_t index = 0;  ///< in Scene::objects
  SceneObject object;
  std::size_t triangles = 0;
  double min_z_m = 0, max_z_m = 0;  ///< of its triangles
  double height_m = 0;              ///< above the ground where a map says where that is, else above min_z_m
  std::optional<double> footprint_m2 = std::nullopt;  ///< where a map says it
  std::string mission;  ///< what a mission writes for it: "target: {osm: way/1, part: roof}"; of ground and surfaces
                        ///< "navigation: {ground: terrain}"; empty for a tree, and for an object without a name
};

/// The objects that have triangles and whose name, source_id or display name contains `pattern`, or is matched by it as
/// a whole where it has '*' (any text) or '?' (a character). Upper and lower case of a to z count as equal. In the
/// order of the scene; an empty pattern takes all. Throws Error(input) where no object is taken: it says the nearest
/// names. Cost: linear.
VANTAGE_API std::vector<ListedObject> list_objects(const LoadedScene& loaded, const std::string& pattern = {});

}  // namespace vantage
