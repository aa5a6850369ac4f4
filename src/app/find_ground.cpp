#include "app/find_ground.h"

#include <algorithm>
#include <string>
#include <vector>

#include "app/named_objects.h"
#include "common/input.h"
#include "geo/local_frame.h"
#include "vantage/error.h"
#include "vantage/ground.h"

namespace vantage::internal::app {
namespace {

std::uint32_t named_object(const Scene& scene, const std::string& name, const std::string& where) {
  const std::vector<std::uint32_t> found = objects_named(scene, name);
  if (found.size() == 1) return found.front();
  if (found.size() > 1) {
    throw Error(ErrorCode::unknown_choice,
                std::to_string(found.size()) + " objects of the scene go by the name of " + in_quotes(name), where,
                "name one that is alone with its name, or give the ground's z");
  }
  throw Error(
      ErrorCode::object_missing, "the scene has no object " + in_quotes(name), where,
      advice_for_object(scene, name,
                        "give the ground's z, or 'all' if the scene is terrain alone: its objects have no names"));
}

/// For scenes that are terrain alone, whose objects may have no names. An object of this name comes first.
constexpr const char* kWholeScene = "all";

bool is_whole_scene(const Scene& scene, const std::string& name) {
  return name == kWholeScene && objects_named(scene, name).empty();
}

Ground ground_named(const Scene& scene, const std::string& name, const std::string& where) {
  if (is_whole_scene(scene, name)) return {0, std::make_shared<const Mesh>(scene.mesh)};
  return ground_of(scene, named_object(scene, name, where));
}

}  // namespace

Ground ground_for(const Mission& mission, const std::string& where) {
  const Scene& scene = mission.scene();
  if (const auto& source = mission.as_written.ground) {
    return source->plane_z_m ? Ground{*source->plane_z_m} : ground_named(scene, source->object, where);
  }
  if (auto ground = ground_of(scene)) return *std::move(ground);
  throw Error(ErrorCode::ground_missing, "the scene does not say what of it is ground, so nothing is above it", where,
              "write 'ground: 0' under 'navigation' for flat ground at z = 0, 'ground: NAME' for an object of the "
              "scene, or 'ground: all' if the scene is terrain alone; or give z: 'altitude: [20, 120]'");
}

/// Whether heights are measured from a raster's surface, which may have roofs and trees in it.
bool is_above_surface(const Mission& mission) {
  const auto& objects = mission.scene().objects;
  return !mission.as_written.ground && std::any_of(objects.begin(), objects.end(), [](const SceneObject& object) {
    return object.kind == ObjectKind::surface;
  });
}

void find_ground(Mission& mission) {
  Navigation& navigation = mission.navigation;
  std::vector<AboveGround*> limits;
  if (navigation.above_ground) limits.push_back(&*navigation.above_ground);
  for (std::vector<Zone>* zones : {&navigation.keep_in, &navigation.keep_out}) {
    for (Zone& zone : *zones) {
      if (zone.above_ground) limits.push_back(&*zone.above_ground);
    }
  }
  if (limits.empty()) return;
  const Ground ground = ground_for(mission, mission.as_written.places.above_ground);
  for (AboveGround* limit : limits) limit->ground = ground;
  if (!is_above_surface(mission)) return;
  mission.notes.push_back({WarningCode::above_surface,
                           "heights above the ground (agl) are measured from the surface of the raster: where that "
                           "holds roofs and trees, they are heights above these"});
}

void find_obstacles(Mission& mission) {
  auto& clearance = mission.navigation.clearance;
  if (!clearance) return;
  const Scene& scene = mission.scene();
  std::vector<std::uint32_t> ground;
  const auto& source = mission.as_written.ground;
  if (source && !source->plane_z_m && !is_whole_scene(scene, source->object)) {
    ground.push_back(named_object(scene, source->object, mission.as_written.places.above_ground));
  }
  clearance->obstacles = obstacles_of(scene, ground);
  std::size_t all = scene.mesh.triangles.size();
  for (const OverheadLine& line : scene.overhead) all += line.mesh.triangles.size();
  const bool is_all = clearance->obstacles->triangles.size() == all;
  const bool has_flat_ground = mission.loaded->city.has_value();
  if (!is_all || has_flat_ground) return;
  mission.notes.push_back({WarningCode::clearance_from_all,
                           "the scene does not say what of it is ground: the clearance is kept from all of it"});
}

}  // namespace vantage::internal::app

namespace vantage {

std::optional<double> sea_level_m(const Mission& mission) {
  if (mission.as_written.sea_level_m) return mission.as_written.sea_level_m;
  const auto& georeference = mission.scene().georeference;
  if (!georeference) return std::nullopt;
  const std::string& vertical = georeference->vertical;
  // A mesh whose reference system has no heights: they are measured from anywhere.
  const bool is_as_in_mesh =
      mission.as_written.scene.kind == SceneSource::Kind::mesh && vertical.compare(0, 6, "as in ") == 0;
  const bool is_unknown =
      vertical.empty() || vertical == kFlatGround || vertical == internal::geo::kEllipsoidalHeight || is_as_in_mesh;
  return is_unknown ? std::nullopt : std::optional(0.0);
}

Ground ground_of(const Mission& mission) {
  return internal::app::ground_for(mission, mission.as_written.places.above_ground);
}

}  // namespace vantage
