// A convex mesh holds all of a volume if it holds the vertices. Of others it is only tried whether they hold these.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "prove/convex_polygon.h"
#include "prove/limit_proof.h"
#include "prove/triangle_distance.h"
#include "prove/winding.h"

namespace vantage::internal::prove {
namespace {

struct Hold {
  std::vector<LimitedVolume::Corners> facets;
  std::vector<HalfSpace> planes;  ///< of all facets, if it is convex
  double dent_m = 0;              ///< so far a corner of it lies beyond a plane, at most
  Box box;

  Hold(const LimitedVolume& volume, const KeepInMesh& keep_in) {
    for (const Triangle& t : keep_in.mesh.triangles) {
      LimitedVolume::Corners& corners = facets.emplace_back();
      for (std::size_t k = 0; k < 3; ++k) corners[k] = keep_in.mesh.vertices[t[k]] - volume.origin();
      for (const Vec3& corner : corners) box.extend(corner);
      const Vec3 normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
      const double length = normal.norm();
      if (length > 0) planes.push_back({normal / length, normal.dot(corners[0]) / length});
    }
    for (const auto& corners : facets) {
      for (const Vec3& corner : corners) {
        const double beyond = beyond_planes_by(corner);
        if (!(beyond <= volume.tolerance_at(corner))) {
          planes.clear();
          return;
        }
        dent_m = std::max(dent_m, beyond);
      }
    }
  }

  double beyond_planes_by(const Vec3& point) const {
    double most = -std::numeric_limits<double>::infinity();
    for (const HalfSpace& plane : planes) most = std::max(most, plane.over(point));
    return most;
  }

  /// Metres to it from a point outside; nothing where it is inside, or too near to tell.
  std::optional<double> outside_by(const Vec3& point) const {
    Winding winding(point, box);
    for (const auto& corners : facets) winding.add(corners);
    if (winding.turns(0) != 0) return std::nullopt;
    double least = std::numeric_limits<double>::infinity();
    for (const auto& corners : facets) {
      least = std::min(least, nearest_points({point, point, point}, corners).distance);
    }
    return least;
  }
};

}  // namespace

/// The worst of the proofs for each mesh.
template <>
ClaimProof prove_limit<Limit::meshes>(const std::vector<KeepInMesh>& meshes, const Claimant& of,
                                      const core::ProgressReporter& /*progress*/) {
  const LimitedVolume& volume = of.volume;
  std::optional<ClaimProof> all;
  for (const KeepInMesh& keep_in : meshes) {
    const Hold hold(volume, keep_in);
    const std::string what = "the mesh " + keep_in.name;
    ClaimProof claim = not_proved("meshes", what + " is not convex");
    Broken worst;
    bool is_open = false;
    const auto see = [&](double by, const Vec3& vertex) {
      is_open = is_open || !(by <= volume.tolerance_at(vertex));
      if (by - hold.dent_m > volume.tolerance_at(vertex)) worst.see(by - hold.dent_m, vertex);
    };
    if (!hold.planes.empty()) {
      claim = proved("meshes", "every vertex is in each mesh, and these are convex");
      for (const Vec3& vertex : volume.vertices()) see(hold.beyond_planes_by(vertex), vertex);
    } else {
      constexpr std::size_t kMostPairs = 20'000'000;  // about a second
      const std::size_t step = 1 + volume.vertices().size() * hold.facets.size() / kMostPairs;
      for (std::size_t i = 0; i < volume.vertices().size(); i += step) {
        const Vec3& vertex = volume.vertices()[i];
        if (const auto by = hold.outside_by(vertex)) see(*by, vertex);
      }
    }
    if (is_open) claim = not_proved("meshes", "some vertex may be outside of " + what);
    if (worst.by_m > 0) claim = volume.wrong("meshes", worst, what);
    all = all ? worse(*all, claim) : claim;
  }
  return *all;
}

}  // namespace vantage::internal::prove
