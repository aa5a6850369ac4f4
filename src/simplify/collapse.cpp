// Inner progressive hulls (Sander, Gu, Gortler, Hoppe and Snyder, "Silhouette clipping", 2000).
#include "simplify/collapse.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "simplify/inner_point.h"

namespace vantage::internal::simplify {
namespace {

constexpr double kFarAway = 30;  // lengths of the edge: from so far outside the nearest inner point is looked for

/// The facets of a patch, relative to the middle of its edge.
struct Cone {
  Vec3 middle = Vec3::Zero();
  std::vector<HalfSpace> half_spaces;  ///< a little smaller than they are
  std::vector<Vec3> areas;             ///< normals of the length of the area
  std::vector<double> reach;           ///< areas . a corner
  Vec3 area = Vec3::Zero();            ///< their sum
  double step = 0;                     ///< by how much the half-spaces are smaller

  double loss_m3(const Vec3& point) const {
    double loss = 0;
    for (std::size_t i = 0; i < areas.size(); ++i) loss += std::max(0.0, reach[i] - areas[i].dot(point));
    return loss / 3;
  }
  double lowest(const Vec3& point) const {
    double lowest = std::numeric_limits<double>::infinity();
    for (const HalfSpace& half : half_spaces) lowest = std::min(lowest, half.offset + step - half.normal.dot(point));
    return lowest;
  }
};

void make_cone(const Surface& surface, const Patch& patch, Cone& cone) {
  const std::vector<Vec3>& vertices = surface.vertices();
  cone.middle = (vertices[patch.from] + vertices[patch.to]) / 2;
  cone.half_spaces.clear();
  cone.areas.clear();
  cone.reach.clear();
  cone.area.setZero();
  double size = 0;
  for (const std::uint32_t f : patch.facets) {
    const Corners corners = surface.corners(f);
    for (const Vec3& corner : corners) size = std::max(size, (corner - cone.middle).cwiseAbs().maxCoeff());
    const Vec3 area = (corners[1] - corners[0]).cross(corners[2] - corners[0]) / 2;
    const double reach = area.dot(corners[0] - cone.middle), norm = area.norm();
    cone.areas.push_back(area);
    cone.reach.push_back(reach);
    cone.area += area;
    if (norm > 0) cone.half_spaces.push_back({area / norm, reach / norm});
  }
  // Roundings of the point's coordinates, and of the planes.
  cone.step = std::ldexp(cone.middle.cwiseAbs().maxCoeff() + size, -51) + std::ldexp(size, -46);
  for (HalfSpace& half : cone.half_spaces) half.offset -= cone.step;
}

constexpr double kNearly = 64;  // steps that an end may lie outside of a plane that should hold it

}  // namespace

void find_places(const Surface& surface, const Patch& patch, std::vector<Place>& places) {
  thread_local Cone cone;
  make_cone(surface, patch, cone);
  places.clear();
  const std::array<std::uint32_t, 2> ends = {patch.from, patch.to};
  for (const std::uint32_t end : ends) {
    const Vec3 local = surface.vertices()[end] - cone.middle;
    if (cone.lowest(local) < -kNearly * cone.step) continue;
    places.push_back({surface.vertices()[end], cone.loss_m3(local), false});
    if (const auto found = nearest_inner_point(cone.half_spaces, local)) {
      places.push_back({cone.middle + *found, cone.loss_m3(*found), true});
    }
  }
  const double length = (surface.vertices()[patch.from] - surface.vertices()[patch.to]).norm(), all = cone.area.norm();
  const Vec3 wanted = all > 0 ? Vec3(kFarAway * length / all * cone.area) : Vec3(Vec3::Zero());
  if (const std::optional<Vec3> found = nearest_inner_point(cone.half_spaces, wanted)) {
    places.push_back({cone.middle + *found, cone.loss_m3(*found), true});
  }
  // A new place must gain more than what the smaller half-spaces cost: the ends keep their numbers.
  double area = 0;
  for (const Vec3& one : cone.areas) area += one.norm();
  const double slack = 2 * cone.step * area;
  std::stable_sort(places.begin(), places.end(), [&](const Place& a, const Place& b) {
    return a.loss_m3 + (a.is_new ? slack : 0) < b.loss_m3 + (b.is_new ? slack : 0);
  });
}

bool is_inner(const Surface& surface, const Patch& patch, const Vec3& place) {
  return std::all_of(patch.facets.begin(), patch.facets.end(),
                     [&](std::uint32_t f) { return side_of(surface.corners(f), place) >= 0; });
}

namespace {

Box box_of(const Corners& corners) {
  Box box;
  for (const Vec3& corner : corners) box.extend(corner);
  return box;
}

bool is_wide(const Corners& corners, double narrowest) {
  const double longest = std::max({(corners[1] - corners[0]).squaredNorm(), (corners[2] - corners[1]).squaredNorm(),
                                   (corners[0] - corners[2]).squaredNorm()});
  const double area = (corners[1] - corners[0]).cross(corners[2] - corners[0]).squaredNorm();
  return area > narrowest * narrowest * longest;
}

bool is_corner(const Corners& corners, const Vec3& point) {
  return corners[0] == point || corners[1] == point || corners[2] == point;
}

/// Whether two triangles with a common side lie on each other, or so nearly that writers and booleans take them for it.
bool is_flap(const Vec3& start, const Vec3& end, const Vec3& third, const Vec3& other_third, double narrowest) {
  if (is_folded(start, end, third, other_third)) return true;
  const Vec3 side = (end - start).normalized();
  const auto from_side = [&](const Vec3& point) { return Vec3(point - start - side.dot(point - start) * side); };
  const Vec3 a = from_side(third), b = from_side(other_third);
  return a.dot(b) > 0 && a.cross(b).squaredNorm() <= narrowest * narrowest * std::max(a.squaredNorm(), b.squaredNorm());
}

/// Whether two triangles with an area have more in common than corners and sides that both have.
bool collide(const Corners& a, const Corners& b, double narrowest) {
  std::array<bool, 3> is_shared_a = {}, is_shared_b = {};
  int shared = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    is_shared_a[i] = is_corner(b, a[i]);
    is_shared_b[i] = is_corner(a, b[i]);
    shared += is_shared_a[i] ? 1 : 0;
  }
  if (shared == 3) return true;
  if (shared == 2) {
    std::size_t own_a = 0, own_b = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      if (!is_shared_a[i]) own_a = i;
      if (!is_shared_b[i]) own_b = i;
    }
    return is_flap(a[(own_a + 1) % 3], a[(own_a + 2) % 3], a[own_a], b[own_b], narrowest);
  }
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t next = (i + 1) % 3;
    if (!is_shared_a[i] && !is_shared_a[next] && meet(a[i], a[next], b)) return true;
    if (!is_shared_b[i] && !is_shared_b[next] && meet(b[i], b[next], a)) return true;
  }
  return false;
}

/// Whether two facets that both have the new place as a corner, and a side in common, lie on each other.
bool has_flap_round(const Surface& surface, const Patch& patch, const Vec3& place, double narrowest) {
  thread_local std::vector<std::pair<std::uint32_t, std::uint32_t>> sides;  // opposite to the place, by their start
  sides.clear();
  for (std::size_t i = patch.gone; i < patch.facets.size(); ++i) {
    const Triangle& facet = surface.facet(patch.facets[i]);
    for (std::size_t k = 0; k < 3; ++k) {
      if (facet[k] == patch.from || facet[k] == patch.to) sides.push_back({facet[(k + 1) % 3], facet[(k + 2) % 3]});
    }
  }
  std::sort(sides.begin(), sides.end());
  const std::vector<Vec3>& vertices = surface.vertices();
  return std::any_of(sides.begin(), sides.end(), [&](const auto& side) {
    const auto next = std::lower_bound(sides.begin(), sides.end(), std::pair(side.second, 0U));
    return next != sides.end() && next->first == side.second &&
           is_flap(place, vertices[side.second], vertices[side.first], vertices[next->second], narrowest);
  });
}

/// Whether a vertex of another piece lies in what is lost.
bool swallows(const Surface& surface, const Patch& patch, const Vec3& place, const Vec3& point) {
  return std::any_of(patch.facets.begin(), patch.facets.end(), [&](std::uint32_t f) {
    const Corners facet = surface.corners(f);
    return side_of(facet, point) >= 0 && side_of({facet[1], facet[0], place}, point) >= 0 &&
           side_of({facet[2], facet[1], place}, point) >= 0 && side_of({facet[0], facet[2], place}, point) >= 0;
  });
}

}  // namespace

bool is_clean(const Surface& surface, const Patch& patch, const Vec3& place, double narrowest_m) {
  thread_local std::vector<Corners> after;
  thread_local std::vector<std::uint32_t> near, own;
  after.clear();
  for (std::size_t i = patch.gone; i < patch.facets.size(); ++i) {
    after.push_back(surface.corners_after(patch, patch.facets[i], place));
    if (!is_wide(after.back(), narrowest_m)) return false;
  }
  if (has_flap_round(surface, patch, place, narrowest_m)) return false;
  // Other new facets need not be compared with each other, which all have the place as a corner: where one passes
  // through another, the side opposite to the place does, or a spoke does, and meets a facet outside of the patch, too.
  own = patch.facets;
  std::sort(own.begin(), own.end());
  const auto is_own = [&](std::uint32_t f) { return std::binary_search(own.begin(), own.end(), f); };
  for (const Corners& facet : after) {
    near.clear();
    surface.tree().find(box_of(facet), near);
    if (std::any_of(near.begin(), near.end(),
                    [&](std::uint32_t f) { return !is_own(f) && collide(facet, surface.corners(f), narrowest_m); })) {
      return false;
    }
  }
  if (surface.pieces() < 2) return true;
  Box lost;
  for (const std::uint32_t f : patch.facets) lost.extend(box_of(surface.corners(f)));
  lost.extend(place);
  near.clear();
  surface.tree().find(lost, near);
  const std::uint32_t piece = surface.piece_of(patch.facets[0]);
  return std::none_of(near.begin(), near.end(), [&](std::uint32_t f) {
    return surface.piece_of(f) != piece && swallows(surface, patch, place, surface.corners(f)[0]);
  });
}

}  // namespace vantage::internal::simplify
