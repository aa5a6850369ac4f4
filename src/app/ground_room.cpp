#include "app/ground_room.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "app/ground_target.h"
#include "app/scene_lookups.h"
#include "vantage/error.h"

namespace vantage::internal::app {
namespace {

using Vec2 = Eigen::Vector2d;

struct GroundExtent {
  std::vector<std::uint32_t> vertices;
  PlanBox box;

  /// Of a scene with a ground.
  explicit GroundExtent(const Scene& scene) {
    const std::uint32_t ground = *ground_object(scene);
    for (std::size_t i = 0; i < scene.object_of.size(); ++i) {
      if (scene.object_of[i] != ground) continue;
      vertices.insert(vertices.end(), scene.mesh.triangles[i].begin(), scene.mesh.triangles[i].end());
    }
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    if (vertices.empty()) return;
    box.min = box.max = scene.mesh.vertices[vertices.front()].head<2>();
    for (const std::uint32_t vertex : vertices) {
      box.min = box.min.cwiseMin(scene.mesh.vertices[vertex].head<2>());
      box.max = box.max.cwiseMax(scene.mesh.vertices[vertex].head<2>());
    }
  }
};

/// How far a rectangle sticks out of another one, metres, along x or y; at most 0 where it does not.
double sticks_out(const PlanBox& box, const PlanBox& of) {
  return std::max((of.min - box.min).maxCoeff(), (box.max - of.max).maxCoeff());
}

/// Between the nearest points of two rectangles.
double apart(const PlanBox& a, const PlanBox& b) { return (a.min - b.max).cwiseMax(b.min - a.max).cwiseMax(0).norm(); }

/// Whether the ground is the rectangle that a map without terrain gets: its vertices are the corners.
bool is_flat_rectangle(const Scene& scene, const std::vector<std::uint32_t>& vertices, const PlanBox& box) {
  if (!scene.georeference || scene.georeference->vertical != kFlatGround) return false;
  const double level = scene.mesh.vertices[vertices.front()].z();
  return std::all_of(vertices.begin(), vertices.end(), [&](std::uint32_t vertex) {
    const Vec3& at = scene.mesh.vertices[vertex];
    const auto on_side = [&](int axis) { return at[axis] == box.min[axis] || at[axis] == box.max[axis]; };
    return at.z() == level && on_side(0) && on_side(1);
  });
}

}  // namespace

std::optional<std::uint32_t> ground_object(const Scene& scene) {
  const auto found = std::find_if(scene.objects.begin(), scene.objects.end(), [](const SceneObject& object) {
    return object.kind == ObjectKind::ground || object.kind == ObjectKind::surface;
  });
  if (found == scene.objects.end()) return std::nullopt;
  return static_cast<std::uint32_t>(found - scene.objects.begin());
}

std::optional<Warning> make_room(Mission& mission, const PlanBox& wanted) {
  const Scene& scene = mission.scene();
  if (!ground_object(scene)) return std::nullopt;
  const auto& [vertices, box] =
      looked_up<GroundExtent>(*mission.loaded, [&] { return std::make_shared<const GroundExtent>(scene); });
  if (vertices.empty()) return std::nullopt;
  const double missing = sticks_out(wanted, box);
  if (missing <= 0) return std::nullopt;
  const double away = apart(wanted, box);
  const GroundTarget* const ground = only_ground_target(mission.as_written);
  const bool is_of_map = ground && !ground->osm.empty();
  if (away > range_limit_m(mission.sensor) && !is_of_map) {
    fail_off_ground(mission, "the target lies " + std::to_string(std::lround(away)) +
                                 " m from the scene's ground, farther than max_range: nothing would hide it");
  }
  if (mission.loaded->city && !mission.as_written.scene.city.terrain.empty()) throw TerrainTooSmall{missing};
  if (!is_flat_rectangle(scene, vertices, box)) {
    fail_off_ground(mission, "the target reaches beyond the scene's ground");
  }
  const Vec2 margin = Vec2::Constant(mission.as_written.scene.city.ground_margin_m);
  const PlanBox larger{box.min.cwiseMin(wanted.min - margin), box.max.cwiseMax(wanted.max + margin)};
  auto extended = std::make_shared<LoadedScene>(*mission.loaded);
  for (const std::uint32_t vertex : vertices) {
    Vec3& at = extended->scene.mesh.vertices[vertex];
    for (int axis = 0; axis < 2; ++axis) at[axis] = at[axis] == box.min[axis] ? larger.min[axis] : larger.max[axis];
  }
  mission.loaded = std::move(extended);
  return Warning{WarningCode::ground_extended, "the flat ground was extended to hold the target, which reaches " +
                                                   std::to_string(std::lround(std::ceil(missing))) +
                                                   " m beyond it: the map has nothing to build out there"};
}

void fail_off_ground(const Mission& mission, const std::string& problem) {
  const LoadedScene& loaded = *mission.loaded;
  const CityRegion& region = mission.as_written.scene.city.region;
  const bool is_part = region.center_deg || region.bbox_deg;
  std::string fix = "make the scene of a larger area, or move the target";
  if (loaded.city || loaded.raster) {
    const std::string what = loaded.raster ? "raster" : "map";
    fix = is_part ? "choose a larger area of the " + what + " (scene.radius, scene.bbox), or move the target"
                  : "all of the " + what + " is used already: check the target's place, or take a " + what +
                        " that reaches farther";
  }
  throw Error(ErrorCode::target_off_ground, problem, mission.as_written.places.target, fix);
}

}  // namespace vantage::internal::app
