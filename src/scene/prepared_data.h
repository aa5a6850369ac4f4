// What preparing a scene leaves: convex polygons under a bounding volume hierarchy.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/bvh.h"
#include "vantage/scene.h"

namespace vantage {

struct PreparedScene::Data {
  SceneStatistics statistics;
  std::vector<SceneObject> objects;
  Vec3 origin =
      Vec3::Zero();  ///< scene frame; everything below is relative to it, so that large coordinates cost nothing

  std::vector<Vec3> vertices;               ///< welded, relative to `origin`
  std::vector<std::uint32_t> first_vertex;  ///< per polygon, into `polygon_vertices`; one more than there are polygons
  std::vector<std::uint32_t> polygon_vertices;  ///< convex, planar, in order round the polygon
  std::vector<std::uint32_t> polygon_object;    ///< index into `objects`
  internal::core::Bvh bvh;                      ///< over the polygons, which are in its leaf order

  std::vector<std::uint32_t> first_incident;  ///< per vertex, into `incident`; one more than there are vertices
  std::vector<std::uint32_t> incident;        ///< polygons that have the vertex as a corner

  std::shared_ptr<const Data> overhead;  ///< of Scene::overhead, an object each; nothing where there is none

  std::size_t polygon_count() const { return polygon_object.size(); }
  std::span<const std::uint32_t> corners_of(std::size_t polygon) const {
    return {polygon_vertices.data() + first_vertex[polygon], first_vertex[polygon + 1] - first_vertex[polygon]};
  }
  std::span<const std::uint32_t> polygons_at(std::size_t vertex) const {
    return {incident.data() + first_incident[vertex], first_incident[vertex + 1] - first_incident[vertex]};
  }
};

}  // namespace vantage
