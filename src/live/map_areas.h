// The areas of a scene's map: squares, pitches, parking lots.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "vantage/city.h"
#include "vantage/progress.h"
#include "vantage/scene.h"
#include "vantage/scene_source.h"

namespace vantage::live {

/// The areas of one scene. They are read from the map when one is first asked for.
class MapAreas {
 public:
  /// The smallest area, other than buildings, in which a position of the scene frame lies; null: none. Throws Error
  /// where the scene is not of a map, or as read_areas does.
  const MapArea* at(const Eigen::Vector2d& position, const SceneSource& source, const Scene& scene,
                    const Progress& progress = {});

 private:
  std::optional<std::vector<MapArea>> areas_;  ///< the smallest first
};

}  // namespace vantage::live
