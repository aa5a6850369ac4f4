#include "prove/shallow.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>

#include "prove/convex_solid.h"
#include "prove/hull.h"
#include "prove/tree_search.h"
#include "prove/triangle_distance.h"

namespace vantage::internal::prove {
namespace {

using Corners3 = std::array<Vec3, 3>;

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

/// Half-spaces that hold all positions from which a convex polygon hides something of the target: planes that have the
/// polygon on one side and the target on the other, through an edge of one and a corner of the other. Of those that
/// numbers cannot tell so the position's distance counts: it is as much farther behind the polygon as that is before
/// the target.
class Hidden {
 public:
  /// `outline`: planes through its corners are tried. `target`: what is seen, a little less, so that numbers can tell
  /// these planes from it. `front`: the target's normal, or zero.
  Hidden(std::span<const Vec3> polygon, const std::vector<Vec3>& outline, const std::vector<Vec3>& target,
         const Vec3& front, double reach_m)
      : polygon_(polygon), outline_(outline), target_(target), front_(front) {
    double largest = reach_m, nearest = std::numeric_limits<double>::infinity(), radius = 0;
    for (const Vec3& corner : polygon) largest = std::max(largest, corner.norm());
    for (const Vec3& corner : target) radius = std::max(radius, corner.norm());
    Corners3 fan;
    for (std::size_t k = 2; k < polygon.size(); ++k) {
      fan = {polygon[0], polygon[k - 1], polygon[k]};
      const NearestPoints found = nearest_points(fan, {Vec3::Zero(), Vec3::Zero(), Vec3::Zero()});
      nearest = std::min(nearest, found.distance - unsure_over(fan, found.distance));
    }
    unsure_m_ = 16 * kEpsilon * largest;
    behind_ = nearest > radius + unsure_m_ ? (reach_m + largest) / (nearest - radius - unsure_m_)
                                           : std::numeric_limits<double>::infinity();
    find();
  }

  const std::vector<HalfSpace>& sides() const { return sides_; }

 private:
  void find() {
    const std::size_t n = polygon_.size(), m = outline_.size();
    Vec3 normal = Vec3::Zero();
    for (std::size_t k = 2; k < n; ++k) {
      normal += (polygon_[k - 1] - polygon_[0]).cross(polygon_[k] - polygon_[0]);
    }
    consider(normal);
    consider(front_);
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j < m; ++j) {
        consider((polygon_[(i + 1) % n] - polygon_[i]).cross(polygon_[i] - outline_[j]));
        if (m > 1) consider((outline_[(j + 1) % m] - outline_[j]).cross(polygon_[i] - outline_[j]));
      }
    }
  }
  void consider(const Vec3& across) {
    if (!(across.norm() > 0)) return;
    for (const Vec3& way : {across.normalized(), Vec3(-across.normalized())}) {
      if (!accept(way)) accept_less(way);
    }
  }
  double least_of_polygon(const Vec3& way) const {
    double least = std::numeric_limits<double>::infinity();
    for (const Vec3& corner : polygon_) least = std::min(least, way.dot(corner));
    return least;
  }
  double most_of_target(const Vec3& way) const {
    double most = 0;  // its centre is one of its points
    for (const Vec3& corner : target_) most = std::max(most, way.dot(corner));
    return most;
  }
  /// Where it surely has the two on two sides.
  bool accept(const Vec3& way) {
    const double least = least_of_polygon(way) - unsure_m_;
    if (!(most_of_target(way) + unsure_m_ <= least)) return false;
    sides_.push_back({-way, unsure_m_ - least});
    return true;
  }
  /// Where it touches both, as far as numbers can tell: turned a little towards the target's front, where the polygon
  /// is; or as it is, with what a position may then be in front by.
  void accept_less(const Vec3& way) {
    constexpr double kMostTurned = 1e-3;
    const double least = least_of_polygon(way), lost = most_of_target(way) - least + 2 * unsure_m_;
    if (std::isfinite(behind_) && lost <= 8 * unsure_m_) {
      sides_.push_back({-way, behind_ * lost + 2 * unsure_m_ - least});
      return;
    }
    double turned = 0;
    for (const Vec3& corner : polygon_) {
      const double needed = lost + 2 * unsure_m_ - (way.dot(corner) - least), height = front_.dot(corner);
      if (needed > 0) turned = height > 0 ? std::max(turned, needed / height) : kMostTurned;
    }
    if (turned < kMostTurned) accept(way + turned * front_);
  }

  std::span<const Vec3> polygon_;
  const std::vector<Vec3>&outline_, &target_;
  Vec3 front_;
  double unsure_m_ = 0, behind_ = 0;
  std::vector<HalfSpace> sides_;
};

/// Whether nothing of a volume that is in a convex solid is deeper than a depth: in pieces, each of which is near to one
/// facet, or meets none and is not in the volume.
class Cover {
 public:
  Cover(const RoundedSurface& surface, double depth_m) : surface_(surface), depth_m_(depth_m) {}

  bool covers(const ConvexSolid& solid) {
    if (solid.empty()) return true;
    if (left_-- <= 0) return false;
    const Vec3 middle = solid.middle();
    const std::vector<Near> near = facets_near(solid, middle);
    for (const Near& one : near) {
      if (one.distance <= depth_m_ && holds(one.corners, solid)) return true;
    }
    if (near.empty() || near[0].distance > depth_m_) {
      if (surface_.turns_round(middle).value_or(1) != 0) return false;  // it is deep, and inside
    }
    const auto meets = std::find_if(near.begin(), near.end(), [&](const Near& one) { return !is_apart(one, solid); });
    if (meets == near.end()) return surface_.turns_round(middle) == 0;
    return covers_in_parts(solid, meets->corners);
  }

 private:
  struct Near {
    Corners3 corners;
    double distance = 0;  ///< of the solid's middle, at most
    std::uint32_t index = 0;
  };

  bool holds(const Corners3& facet, const ConvexSolid& solid) const {
    for (const ConvexPolygon& face : solid.faces()) {
      for (const Vec3& corner : face) {
        if (!(at_most_from(facet, corner) <= depth_m_)) return false;
      }
    }
    return true;
  }

  static bool is_apart(const Near& one, const ConvexSolid& solid) {
    PointHull hull;
    double largest = 0;
    for (const ConvexPolygon& face : solid.faces()) {
      for (const Vec3& corner : face) {
        hull.add(corner);
        largest = std::max(largest, corner.cwiseAbs().maxCoeff());
      }
    }
    for (const Vec3& corner : one.corners) largest = std::max(largest, corner.cwiseAbs().maxCoeff());
    return separate(hull, Obstacle(std::span<const Vec3>(one.corners)), largest).has_value();
  }

  /// What is over and under the facet, what is beside it, and what is near to it, which it holds.
  bool covers_in_parts(const ConvexSolid& solid, const Corners3& facet) {
    constexpr double kOver = 0.7, kBeside = 0.5;  // of the depth: together less than all of it
    const Vec3 normal = (facet[1] - facet[0]).cross(facet[2] - facet[0]).stableNormalized();
    std::vector<HalfSpace> sides;
    for (const Vec3& way : {normal, Vec3(-normal)}) sides.push_back({way, way.dot(facet[0]) + kOver * depth_m_});
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 outward = (facet[(k + 1) % 3] - facet[k]).cross(normal).stableNormalized();
      sides.push_back({outward, outward.dot(facet[k]) + kBeside * depth_m_});
    }
    ConvexSolid rest = solid;
    bool is_cut = false;
    for (const HalfSpace& side : sides) {
      const ConvexSolid beyond = rest.within({-side.normal, -side.offset}), within = rest.within(side);
      if (beyond.empty() || within.empty()) continue;
      is_cut = true;
      if (!covers(beyond)) return false;
      rest = within;
    }
    if (is_cut) return covers(rest);
    const Box box = solid.box();
    Eigen::Index axis = 0;
    (box.max - box.min).maxCoeff(&axis);
    const HalfSpace half{Vec3::Unit(axis), (box.min[axis] + box.max[axis]) / 2};
    return covers(solid.within(half)) && covers(solid.within({-half.normal, -half.offset}));
  }

  /// The nearest to the middle first.
  std::vector<Near> facets_near(const ConvexSolid& solid, const Vec3& middle) const {
    const SceneTree& facets = surface_.facets();
    const Box box = solid.box();
    const auto is_far = [&](const Box& other) { return distance_of_boxes(box, other) > depth_m_; };
    std::vector<Near> near;
    search_tree(facets, is_far, [&](std::uint32_t i) {
      const Corners3 corners = facets.pieces[i].first_three();
      if (!is_far(box_of(corners))) near.push_back({corners, at_most_from(corners, middle), i});
    });
    std::sort(near.begin(), near.end(), [](const Near& a, const Near& b) {
      return a.distance < b.distance || (a.distance == b.distance && a.index < b.index);
    });
    return near;
  }

  const RoundedSurface& surface_;
  double depth_m_;
  int left_ = 1000;  ///< solids that are looked at
};

}  // namespace

Shallow::Shallow(const Mesh& mesh, const View& view)
    : surface_(mesh, 0), front_(view.all_sides ? Vec3(Vec3::Zero()) : view.normal) {
  double radius = 0;
  for (const Vec3& corner : view.corners) radius = std::max(radius, corner.norm());
  constexpr double kStrip = 4;  // in margins
  const double kept = std::max(0.0, 1 - kStrip * view.margin_m / radius);
  for (const Vec3& corner : view.corners) {
    outline_.push_back(corner);
    target_.push_back(radius > 0 ? Vec3(kept * corner) : corner);
  }
}

bool Shallow::is_shallow(const std::array<Vec3, 3>& facet, const Piece& obstacle, double depth_m) const {
  if (obstacle.count < 3) return true;
  double reach = 0;
  for (const Vec3& corner : facet) reach = std::max(reach, corner.norm());
  ConvexSolid solid = ConvexSolid::tetrahedron({facet[0], facet[1], facet[2], Vec3::Zero()});
  const Hidden behind(obstacle.polygon(), outline_, target_, front_, reach);
  for (const HalfSpace& side : behind.sides()) {
    solid = solid.within(side);
    if (solid.empty()) return true;
  }
  return Cover(surface_, depth_m).covers(solid);
}

}  // namespace vantage::internal::prove
