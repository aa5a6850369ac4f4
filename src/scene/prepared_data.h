// What preparing a scene leaves: convex polygons under a bounding volume hierarchy.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "scene/bvh.h"
#include "vantage/scene.h"

namespace vantage {

struct PreparedScene::Data {
  SceneStatistics statistics;
  std::vector<std::string> objects;
  Vec3 origin =
      Vec3::Zero();  ///< scene frame; everything below is relative to it, so that large coordinates cost nothing

  std::vector<Vec3> vertices;               ///< welded, relative to `origin`
  std::vector<std::uint32_t> first_vertex;  ///< per polygon, into `polygon_vertices`; one more than there are polygons
  std::vector<std::uint32_t> polygon_vertices;  ///< convex, planar, in order round the polygon
  std::vector<std::uint32_t> polygon_object;    ///< index into `objects`
  scene::Bvh bvh;                               ///< over the polygons, which are in its leaf order

  std::size_t polygon_count() const { return polygon_object.size(); }
};

}  // namespace vantage
