#include "app/into_frame.h"

#include <cmath>

#include "app/input_file.h"
#include "app/numbers.h"
#include "geo/local_frame.h"
#include "vantage/error.h"

namespace vantage::app {
namespace {

/// Whether z = 0 is surely not the same height: one counts from flat ground, and the other is known not to.
bool is_on_another_level(const Georeference& a, const Georeference& b) {
  const bool is_known = !a.vertical.empty() && !b.vertical.empty();
  return is_known && (a.vertical == kFlatGround) != (b.vertical == kFlatGround);
}

/// Refuses a mesh of another city.
void check_near(const Georeference& mesh, const Georeference& frame, const std::string& name, const std::string& where,
                const char* fix) {
  const double distance =
      geo::geodesic_m({mesh.longitude_deg, mesh.latitude_deg}, {frame.longitude_deg, frame.latitude_deg});
  if (distance <= geo::kFarthestM) return;
  throw Error(ErrorKind::input, name + " lies " + std::to_string(std::lround(distance / 1000)) + " km away", where,
              fix);
}

std::string levels_text(const Georeference& mesh, const Georeference& scene) {
  return "measured from another level (" + mesh.vertical + ") than the scene's (" + scene.vertical + ")";
}

}  // namespace

MeshInFrame read_into_frame(const std::filesystem::path& file, const SceneReadOptions& obj,
                            const std::optional<Georeference>& frame, const Progress& progress) {
  Scene read = read_scene(file, is_obj(file) ? obj : SceneReadOptions{}, progress);
  MeshInFrame result{std::move(read.mesh), std::move(read.georeference), read.rounding_m.value_or(0), {}};
  if (!frame || !result.georeference) return result;
  check_near(*result.georeference, *frame, "the mesh", file.string(), "give the mesh that goes with the other input");
  if (geo::move_origin(result.mesh.vertices, *result.georeference, *frame)) {
    result.notes.push_back(file.string() +
                           " lies about another origin on the earth: it was moved into the frame (the same map differs "
                           "by a tenth of a millimetre from one frame to another, and shadows by more)");
  }
  if (is_on_another_level(*result.georeference, *frame)) {
    result.notes.push_back("the heights of " + file.string() + " are " + levels_text(*result.georeference, *frame) +
                           ": they are taken as they are");
  }
  return result;
}

MeshInFrame read_into_frame(const std::filesystem::path& file, const Scene& scene, const Progress& progress) {
  return read_into_frame(file, {scene.up, scene.scale}, scene.georeference, progress);
}

void place_navigation_meshes(Mission& mission, const Scene& scene) {
  for (std::size_t i = 0; i < mission.navigation_files.size() && i < mission.navigation.meshes.size(); ++i) {
    NavigationFile& file = mission.navigation_files[i];
    KeepInMesh& keep_in = mission.navigation.meshes[i];
    for (Vec3& v : keep_in.mesh.vertices) {
      if (file.in_scene_axes && scene.up == UpAxis::y) v = Vec3(v.x(), -v.z(), v.y());
      if (file.in_scene_unit) v *= scene.scale;
    }
    file.in_scene_axes = file.in_scene_unit = false;
    if (!file.georeference || !scene.georeference) continue;
    check_near(*file.georeference, *scene.georeference, in_quotes(keep_in.name), file.place,
               "give a mesh of the scene's surroundings");
    if (is_on_another_level(*file.georeference, *scene.georeference)) {
      throw Error(
          ErrorKind::input,
          "the heights of " + in_quotes(keep_in.name) + " are " + levels_text(*file.georeference, *scene.georeference),
          file.place, "make it for a scene with the same ground as this one's");
    }
    geo::move_origin(keep_in.mesh.vertices, *file.georeference, *scene.georeference);
    file.georeference = scene.georeference;
  }
}

}  // namespace vantage::app
