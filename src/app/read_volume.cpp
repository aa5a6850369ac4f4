#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "app/input_file.h"
#include "app/navigation_meshes.h"
#include "common/input.h"
#include "common/output.h"
#include "core/causes.h"
#include "core/orientation.h"
#include "geo/local_frame.h"
#include "io/output_formats.h"
#include "io/read_causes.h"
#include "vantage/error.h"
#include "vantage/result.h"
#include "vantage/volume.h"

namespace vantage::internal::app {
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
  throw Error(ErrorCode::too_far_away, name + " lies " + std::to_string(std::lround(distance / 1000)) + " km away",
              where, fix);
}

std::string levels_text(const Georeference& mesh, const Georeference& scene) {
  return "measured from another level (" + mesh.vertical + ") than the scene's (" + scene.vertical + ")";
}

}  // namespace

std::vector<KeepInMesh> placed_navigation_meshes(const std::vector<NavigationMesh>& meshes, const Scene& scene) {
  std::vector<KeepInMesh> placed;
  for (const NavigationMesh& given : meshes) {
    KeepInMesh& keep_in = placed.emplace_back(given.keep_in);
    for (Vec3& v : keep_in.mesh.vertices) {
      if (given.in_scene_axes && scene.up == UpAxis::y) v = Vec3(v.x(), -v.z(), v.y());
      if (given.in_scene_unit) v *= scene.scale;
    }
    if (!given.georeference || !scene.georeference) continue;
    check_near(*given.georeference, *scene.georeference, in_quotes(keep_in.name), given.place,
               "give a mesh of the scene's surroundings");
    if (is_on_another_level(*given.georeference, *scene.georeference)) {
      throw Error(
          ErrorCode::heights_differ,
          "the heights of " + in_quotes(keep_in.name) + " are " + levels_text(*given.georeference, *scene.georeference),
          given.place, "make it for a scene with the same ground as this one's");
    }
    geo::move_origin(keep_in.mesh.vertices, *given.georeference, *scene.georeference);
  }
  return placed;
}

}  // namespace vantage::internal::app

namespace vantage {

using namespace internal::app;

namespace {

/// What a number is a whole multiple of: the largest power of two. Infinite for 0.
double step_of(double number) {
  if (number == 0) return std::numeric_limits<double>::infinity();
  int exponent = 0;
  auto digits = static_cast<std::int64_t>(std::ldexp(std::frexp(number, &exponent), 53));
  exponent -= 53;
  for (; digits % 2 == 0; digits /= 2) ++exponent;
  return std::ldexp(1.0, exponent);
}

/// Whether the three lie on one line, or in one place, exactly: they do where their images on the three planes do.
bool are_on_one_line(const Vec3& a, const Vec3& b, const Vec3& c) {
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const auto image = [axis](const Vec3& at) { return Eigen::Vector2d(at[axis], at[(axis + 1) % 3]); };
    if (internal::core::turn(image(a), image(b), image(c)) != 0) return false;
  }
  return true;
}

/// The grid that all numbers of triangles with area lie on, and how far these reach: no file says it, it is seen. Any
/// vertex may be in a file that no triangle with area has.
struct Grid {
  double step_m = std::numeric_limits<double>::infinity();
  Box box;

  explicit Grid(const Mesh& mesh) {
    for (const auto& [i, j, k] : mesh.triangles) {
      const Vec3 &a = mesh.vertices[i], &b = mesh.vertices[j], &c = mesh.vertices[k];
      if (are_on_one_line(a, b, c)) continue;
      for (const Vec3& corner : {a, b, c}) box.extend(corner);
    }
    for (const Triangle& triangle : mesh.triangles) {
      for (const std::uint32_t v : triangle) {
        const Vec3& at = mesh.vertices[v];
        if (box.empty() || (at.array() < box.min.array()).any() || (at.array() > box.max.array()).any()) continue;
        for (const double number : at) step_m = std::min(step_m, step_of(number));
      }
    }
  }
  double largest() const {
    return box.empty() ? 0 : std::max(box.min.cwiseAbs().maxCoeff(), box.max.cwiseAbs().maxCoeff());
  }
  double extent() const { return box.empty() ? 0 : (box.max - box.min).maxCoeff(); }
};

/// No rounding to a format's numbers, and no mending of what it left, moves a surface farther: metres. Whoever made a
/// file may write any number into it.
///
/// Doubles, in units of 2^-53 of the largest coordinate (src/io/stored_mesh.cpp): they stay as they are, and where
/// facets without area are mended vertices move by at most 4 steps between numbers, of up to 2 units each: 8. A unit of
/// length of its own costs 3.5 before that and 3.5 after: 15.
///
/// Single precision is a grid. Its step is seen, and is no more than 2^-23 of the largest number: about the scene's
/// origin in STL, in glTF about a middle of the volume's own, if doubles can tell steps there. Half of its diagonal is
/// 0.87, and a file that was rounded before has that twice.
double most_rounding(const std::filesystem::path& file, const Mesh& mesh) {
  constexpr double kDoubles = 16, kSteps = 2;  // tools/check_certificate.py has the first
  const std::filesystem::path name = format_extension(file) == ".gz" ? file.stem() : file.filename();
  const internal::io::OutputFormat* format = internal::io::find_output_format(name);
  const bool is_single = format ? format->is_single : format_extension(name) == ".gltf";
  const Grid grid(mesh);
  const double of_doubles = std::ldexp(grid.largest(), -53);
  if (!is_single) return kDoubles * of_doubles;
  const bool is_local = !format || format->is_local;
  const double coarsest = std::ldexp(is_local ? grid.extent() : grid.largest(), -23);
  return kSteps * std::min(grid.step_m, std::max(coarsest, 2 * of_doubles));
}

}  // namespace

VolumeFile read_volume(const std::filesystem::path& file, const SceneReadOptions& obj,
                       const std::optional<Georeference>& frame, const Progress& progress) {
  SceneReadOptions options = is_obj(file) ? obj : SceneReadOptions{};
  options.missing = MissingPolicy::warn;  // what would stand in is not claimed
  Scene read = read_scene(file, options, progress);
  VolumeFile result;
  result.file = file;
  result.volume.mesh = std::move(read.mesh);
  result.volume.georeference = std::move(read.georeference);
  result.rounding_m = read.rounding_m.value_or(0);
  if (const double most = most_rounding(file, result.volume.mesh); result.rounding_m > most) {
    result.notes.push_back({WarningCode::rounding_overstated,
                            file.string() + " states a rounding of " + shortest(result.rounding_m) +
                                " m, more than its numbers can be rounded by: " + shortest(most) + " m is allowed"});
    result.rounding_m = most;
  }
  if (auto stated = internal::io::read_causes(file, result.volume)) {
    result.volume.provenance = std::move(stated->provenance);
    result.volume.tolerance_m = stated->tolerance_m;
    result.volume.lift_m = std::move(stated->lift_m);
    result.volume_hash = std::move(stated->volume_hash);
    if (!result.volume_hash.empty() && volume_hash(result.volume.mesh) != result.volume_hash) {
      result.notes.push_back({WarningCode::volume_changed,
                              file.string() + " was changed since vantage wrote it: its mesh is not the one it names"});
    }
  }
  result.volume.frame.origin = internal::core::middle_of(result.volume.mesh);
  if (!frame || !result.volume.georeference) return result;
  check_near(*result.volume.georeference, *frame, "the mesh", file.string(),
             "give the mesh that goes with the other input");
  if (internal::geo::move_origin(result.volume.mesh.vertices, *result.volume.georeference, *frame)) {
    result.notes.push_back(
        {WarningCode::volume_moved,
         file.string() +
             " lies about another origin on the earth: it was moved into the frame (the same map differs by a tenth of "
             "a millimetre from one frame to another, and shadows by more)"});
    result.volume.frame.origin = internal::core::middle_of(result.volume.mesh);
  }
  if (is_on_another_level(*result.volume.georeference, *frame)) {
    result.notes.push_back({WarningCode::heights_differ, "the heights of " + file.string() + " are " +
                                                             levels_text(*result.volume.georeference, *frame) +
                                                             ": they are taken as they are"});
  }
  return result;
}

VolumeFile read_volume(const std::filesystem::path& file, const Scene& scene, const Progress& progress) {
  return read_volume(file, {scene.up, scene.scale}, scene.georeference, progress);
}

}  // namespace vantage
