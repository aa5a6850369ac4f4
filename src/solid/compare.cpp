// compare_volumes: two booleans, and how far what only one mesh claims reaches from the other's surface.
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "core/parallel.h"
#include "core/progress_reporter.h"
#include "core/solid_check.h"
#include "solid/csg.h"
#include "solid/farthest.h"
#include "vantage/error.h"
#include "vantage/solid.h"

namespace vantage {
namespace {

using internal::solid::Farthest;
using internal::solid::LabelledMesh;
using internal::solid::Solid;

/// Volumes from elsewhere may pass through themselves in a few facets: they can be compared all the same, where these
/// are no larger a part of the whole area. (Of 54 spheres, pairs and results of ours, of up to 91,530 facets, none
/// did.)
constexpr double kFolds = 1e-3;

Box bounds_of(const Mesh& a, const Mesh& b) {
  Box box = bounding_box(a);
  box.extend(bounding_box(b));
  return box;
}

/// The triangles as corner positions, each from its least corner on, in order: equal for meshes that differ in nothing
/// but numbering.
std::vector<std::array<Vec3, 3>> canonical(const Mesh& mesh) {
  const auto less = [](const Vec3& a, const Vec3& b) {
    return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
  };
  std::vector<std::array<Vec3, 3>> triangles;
  triangles.reserve(mesh.triangles.size());
  for (const Triangle& t : mesh.triangles) {
    std::array<Vec3, 3> corners = {mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]};
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end(), less), corners.end());
    triangles.push_back(corners);
  }
  internal::parallel::sort(triangles, [&](const auto& a, const auto& b) {
    return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end(), less);
  });
  return triangles;
}

bool are_identical(const Mesh& a, const Mesh& b) {
  return a.triangles.size() == b.triangles.size() && canonical(a) == canonical(b);
}

/// Facets of A, and those of B, keep these labels in the differences.
constexpr std::uint32_t kOfA = 0, kOfB = 1;

Solid solid_of(Mesh mesh, std::uint32_t label, const std::string& name) {
  std::vector<std::uint32_t> labels(mesh.triangles.size(), label);
  return Solid({std::move(mesh), std::move(labels)}, name);
}

/// Facets that lie on each other, nearer than the tolerance of booleans, are mended there, and with them what they
/// bound.
void check_kept(const Solid& solid, double volume_m3, double allowance, const std::string& name) {
  if (std::abs(solid.volume() - volume_m3) <= allowance) return;
  throw Error(ErrorCode::mesh_intersects_itself,
              "neighbouring facets of the mesh lie on each other, so that booleans take it for another solid", name,
              "mend it where it is folded flat");
}

/// What A does not claim alone B claims too, and the other way round: both differences must leave the same. A third
/// boolean would take as long as either and tell nothing new.
double intersection_of(const Comparison& c, double allowance) {
  constexpr double kRounding = 1e-14;  // of the volumes: less than that is nothing
  const double by_a = c.volume_a_m3 - c.only_a_m3, by_b = c.volume_b_m3 - c.only_b_m3;
  if (std::abs(by_a - by_b) > allowance) {
    throw Error(ErrorCode::internal_defect, "the two differences do not leave the same intersection", "comparison", "");
  }
  return by_a <= kRounding * (c.volume_a_m3 + c.volume_b_m3) ? 0 : by_a;
}

}  // namespace

Comparison compare_volumes(const Mesh& mesh_a, const Mesh& mesh_b, const std::string& name_a, const std::string& name_b,
                           const Progress& callback) {
  const internal::core::ProgressReporter progress(callback);
  progress.begin("checking the first mesh");
  Mesh a = internal::core::checked_solid(mesh_a, name_a, progress, kFolds);
  progress.begin("checking the second mesh");
  Mesh b = internal::core::checked_solid(mesh_b, name_b, progress, kFolds);
  const Box box = bounds_of(a, b);
  const Vec3 origin = (box.min + box.max) / 2;
  for (Mesh* mesh : {&a, &b}) {
    for (Vec3& vertex : mesh->vertices) vertex -= origin;
  }

  Comparison result;
  result.volume_a_m3 = enclosed_volume(a);
  result.volume_b_m3 = enclosed_volume(b);
  if (are_identical(a, b)) {
    result.intersection_m3 = result.volume_b_m3 = result.volume_a_m3;
    return result;
  }
  const Solid solid_a = solid_of(a, kOfA, name_a), solid_b = solid_of(b, kOfB, name_b);
  const double allowance = (solid_a.area() + solid_b.area()) * (box.max - box.min).norm() * 1e-9;
  check_kept(solid_a, result.volume_a_m3, allowance, name_a);
  check_kept(solid_b, result.volume_b_m3, allowance, name_b);
  progress.begin("subtracting the second mesh");
  const Solid only_a = subtract(solid_a, solid_b, progress);
  progress.begin("subtracting the first mesh");
  const Solid only_b = subtract(solid_b, solid_a, progress);
  // Sheets that coincide but for rounding may leave a little less than nothing.
  result.only_a_m3 = std::max(only_a.volume(), 0.0);
  result.only_b_m3 = std::max(only_b.volume(), 0.0);
  LabelledMesh part_a = only_a.to_mesh(), part_b = only_b.to_mesh();
  result.intersection_m3 = intersection_of(result, allowance);

  progress.begin("measuring distances");
  const Farthest from_b = internal::solid::farthest_point(part_a, kOfA, b, progress.part(0, 0.5));
  const Farthest from_a = internal::solid::farthest_point(part_b, kOfB, a, progress.part(0.5, 1));
  progress.finish();
  result.worst_only_a_m = from_b.at_least_m;
  result.worst_only_b_m = from_a.at_least_m;
  result.worst_only_a_bound_m = from_b.at_most_m;
  result.worst_only_b_bound_m = from_a.at_most_m;
  if (from_b.at_least_m > 0) result.worst_only_a_point = from_b.point + origin;
  if (from_a.at_least_m > 0) result.worst_only_b_point = from_a.point + origin;
  for (LabelledMesh* part : {&part_a, &part_b}) {
    for (Vec3& vertex : part->mesh.vertices) vertex += origin;
  }
  result.only_a = std::move(part_a.mesh);
  result.only_b = std::move(part_b.mesh);
  return result;
}

}  // namespace vantage
