#include "prove/shallow.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <utility>

#include "prove/convex_polygon.h"
#include "prove/convex_solid.h"
#include "prove/hull.h"
#include "prove/tree_search.h"
#include "prove/triangle_distance.h"

namespace vantage::internal::prove {
namespace {

constexpr double kDoubleEpsilon = std::numeric_limits<double>::epsilon();

/// A solid that is as thin as rounding may gain more corners by each cut than by the one before. Others stay far below.
constexpr std::size_t kMostSolidCorners = 2000;

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
    double nearest = std::numeric_limits<double>::infinity(), radius = 0;
    for (const Vec3& corner : outline) radius = std::max(radius, corner.norm());
    for (const Vec3& corner : target) radius = std::max(radius, corner.norm());
    double largest = std::max(reach_m, radius);
    for (const Vec3& corner : polygon) largest = std::max(largest, corner.norm());
    Corners3 fan;
    for (std::size_t k = 2; k < polygon.size(); ++k) {
      fan = {polygon[0], polygon[k - 1], polygon[k]};
      const NearestPoints found = nearest_points(fan, {Vec3::Zero(), Vec3::Zero(), Vec3::Zero()});
      nearest = std::min(nearest, found.distance - unsure_over(fan, found.distance));
    }
    unsure_m_ = 16 * kDoubleEpsilon * largest;
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

/// Whether all of a volume that is in a convex solid is nearer than a depth to places outside of the volume: in pieces,
/// each of which is outside when it is moved by no more than the depth; or is near to a part of a facet that has the
/// outside along all of one of its sides; or is outside itself.
class Cover {
 public:
  Cover(const RoundedSurface& surface, double depth_m) : surface_(surface), depth_m_(depth_m) {}

  bool covers(const ConvexSolid& solid) {
    if (solid.empty()) return true;
    if (left_ <= 0 || solid.corner_count() > kMostSolidCorners) return false;
    const Vec3 middle = solid.middle();
    const Box box = solid.box();
    const std::vector<Near> near = facets_near(box, depth_m_, middle);
    left_ -= 10 + static_cast<int>(near.size());
    const double held_m = held_by(solid, box);
    if (!(held_m > 0)) return false;
    if (!near.empty() && moves_out(solid, near, held_m)) return true;
    for (const Near& one : near) {
      if (one.distance <= held_m && holds(one.corners, solid, held_m) && bounds(one.corners, box)) return true;
    }
    if (near.empty() || near[0].distance > depth_m_) {
      if (surface_.turns_round(middle).value_or(1) != 0) return false;  // it is deep, and inside
    }
    const auto meets = std::find_if(near.begin(), near.end(), [&](const Near& one) { return !is_apart(one, solid); });
    if (meets != near.end()) return covers_in_parts(solid, meets->corners);
    if (surface_.turns_round(middle) == 0) return true;
    return !near.empty() && covers_in_parts(solid, near[0].corners);
  }

 private:
  struct Near {
    Corners3 corners;
    double distance = 0;  ///< of the solid's middle, at most
    std::uint32_t index = 0;
  };

  /// So far from a facet the outside begins, where it does.
  double skin_m() const { return depth_m_ / 16; }

  /// What is as near to a facet is near enough to what lies beyond it, whatever was rounded.
  double held_by(const ConvexSolid& solid, const Box& box) const {
    constexpr double kRoundings = 128;
    const double largest = std::max(box.min.cwiseAbs().maxCoeff(), box.max.cwiseAbs().maxCoeff()) + depth_m_;
    return depth_m_ - skin_m() - solid.lost_m() - kRoundings * kDoubleEpsilon * largest;
  }

  /// A distance from a convex set is convex: its corners decide.
  static bool holds(const Corners3& facet, const ConvexSolid& solid, double held_m) {
    for (const ConvexPolygon& face : solid.faces()) {
      for (const Vec3& corner : face) {
        if (!(at_most_from(facet, corner) <= held_m)) return false;
      }
    }
    return true;
  }

  /// Whether all of a solid is outside once it is moved: over the surface, however many facets that has there.
  bool moves_out(const ConvexSolid& solid, const std::vector<Near>& near, double by_m) const {
    std::vector<Vec3> corners;
    for (const ConvexPolygon& face : solid.faces()) corners.insert(corners.end(), face.begin(), face.end());
    std::vector<Vec3> normals;
    add_normals(near, -1, normals);
    std::vector<Vec3> ways = normals;
    for (std::size_t i = 0; i < normals.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) add_way(normals[i] + normals[j], ways);
    }
    for (const double side : {1.0, -1.0}) {
      for (const Vec3& way : ways) {
        if (is_outside(corners, side * by_m * way)) return true;
      }
    }
    return false;
  }

  /// Whether what a facet has near a box, all of it, has the outside of the volume next to it: moved a little it meets
  /// no facet, and lies outside.
  bool bounds(const Corners3& facet, const Box& box) const {
    std::vector<HalfSpace> around;
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      const Vec3 way = Vec3::Unit(axis);
      around.push_back({way, box.max[axis] + 2 * depth_m_});
      around.push_back({-way, 2 * depth_m_ - box.min[axis]});
    }
    const ConvexPolygon part = part_within({facet.begin(), facet.end()}, around);
    if (part.empty()) return false;
    const Vec3 normal = normal_of(facet), middle = middle_of(part);
    if (!(normal.norm() > 0)) return false;
    const std::vector<Vec3> ways = ways_out(part, normal, middle);
    for (const double side : {1.0, -1.0}) {
      for (const Vec3& way : ways) {
        if (is_outside(part, side * skin_m() * way)) return true;
      }
    }
    return false;
  }

  /// Along the normal; where other facets stand on this one at a sharp angle, between it and one or two of them.
  std::vector<Vec3> ways_out(const ConvexPolygon& part, const Vec3& normal, const Vec3& middle) const {
    constexpr double kFlat = 0.5;
    std::vector<Vec3> others = {normal};
    add_normals(facets_near(box_of(part), 2 * skin_m(), middle), kFlat, others);
    others.erase(others.begin());
    std::vector<Vec3> ways = {normal};
    for (std::size_t i = 0; i < others.size(); ++i) {
      add_way(normal + others[i], ways);
      for (std::size_t j = 0; j < i; ++j) add_way(normal + others[i] + others[j], ways);
    }
    return ways;
  }

  static void add_way(const Vec3& way, std::vector<Vec3>& ways) {
    constexpr double kShort = 1e-3;
    if (way.norm() > kShort) ways.push_back(way.normalized());
  }
  /// A few, no two alike. `turned`: the most that the cosine to the first one of `normals` may be; -1: any.
  static void add_normals(const std::vector<Near>& near, double turned, std::vector<Vec3>& normals) {
    constexpr std::size_t kMost = 5;
    constexpr double kAlike = 0.99;
    for (const Near& one : near) {
      if (normals.size() == kMost) return;
      const Vec3 other = normal_of(one.corners);
      if (turned > -1 && normals[0].dot(other) > turned) continue;
      const auto is_alike = [&](const Vec3& known) { return known.dot(other) > kAlike; };
      if (std::none_of(normals.begin(), normals.end(), is_alike)) normals.push_back(other);
    }
  }

  bool is_outside(const std::vector<Vec3>& corners, const Vec3& shift) const {
    if (surface_.turns_round(middle_of(corners) + shift) != 0) return false;
    PointHull hull;
    Box box;
    for (const Vec3& corner : corners) {
      hull.add(corner + shift);
      box.extend(corner + shift);
    }
    bool is_apart = true;
    search_tree(
        surface_.facets(), [&](const Box& other) { return !is_apart || distance_of_boxes(box, other) > 0; },
        [&](std::uint32_t i) {
          const Corners3 facet = surface_.facets().pieces[i].first_three();
          if (is_apart && distance_of_boxes(box, box_of(facet)) == 0) is_apart = are_apart(hull, box, facet);
        });
    return is_apart;
  }

  static Vec3 normal_of(const Corners3& facet) {
    return (facet[1] - facet[0]).cross(facet[2] - facet[0]).stableNormalized();
  }
  static bool are_apart(const PointHull& hull, const Box& box, const Corners3& facet) {
    double largest = std::max(box.min.cwiseAbs().maxCoeff(), box.max.cwiseAbs().maxCoeff());
    for (const Vec3& corner : facet) largest = std::max(largest, corner.cwiseAbs().maxCoeff());
    return separate(hull, Obstacle(std::span<const Vec3>(facet)), largest).has_value();
  }
  static bool is_apart(const Near& one, const ConvexSolid& solid) {
    PointHull hull;
    for (const ConvexPolygon& face : solid.faces()) {
      for (const Vec3& corner : face) hull.add(corner);
    }
    return are_apart(hull, solid.box(), one.corners);
  }

  /// What is over and under the facet, what is beside it, and what is near to it; if that is all of it, in halves.
  bool covers_in_parts(const ConvexSolid& solid, const Corners3& facet) {
    constexpr double kOver = 0.7, kBeside = 0.5;  // of the depth: together less than all of it
    const Vec3 normal = normal_of(facet);
    std::vector<HalfSpace> sides;
    for (const Vec3& way : {normal, Vec3(-normal)}) sides.push_back({way, way.dot(facet[0]) + kOver * depth_m_});
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 outward = (facet[(k + 1) % 3] - facet[k]).cross(normal).stableNormalized();
      sides.push_back({outward, outward.dot(facet[k]) + kBeside * depth_m_});
    }
    ConvexSolid rest = solid;
    bool is_cut = false;
    for (const HalfSpace& side : sides) {
      auto [within, beyond] = rest.split(side);
      if (beyond.empty() || within.empty()) continue;
      is_cut = true;
      if (!covers(beyond)) return false;
      rest = std::move(within);
    }
    if (is_cut) return covers(rest);
    const Box box = solid.box();
    Eigen::Index axis = 0;
    if ((box.max - box.min).maxCoeff(&axis) < skin_m()) return false;
    const auto [low, high] = solid.split({Vec3::Unit(axis), (box.min[axis] + box.max[axis]) / 2});
    return covers(low) && covers(high);
  }

  /// The nearest to `middle` first.
  std::vector<Near> facets_near(const Box& box, double within_m, const Vec3& middle) const {
    const SceneTree& facets = surface_.facets();
    const auto is_far = [&](const Box& other) { return distance_of_boxes(box, other) > within_m; };
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
  int left_ = 3000;  ///< facets that are looked at, solid by solid
};

}  // namespace

Shallow::Shallow(const Mesh& mesh, const View& view)
    : view_(view), surface_(mesh, 0), front_(view.all_sides ? Vec3(Vec3::Zero()) : view.normal) {}

bool Shallow::is_shallow(const std::array<Vec3, 3>& facet, const Piece& obstacle, double depth_m) const {
  if (obstacle.count < 3) return true;
  double reach = 0;
  for (const Vec3& corner : facet) reach = std::max(reach, corner.norm());
  ConvexSolid solid = ConvexSolid::tetrahedron({facet[0], facet[1], facet[2], Vec3::Zero()});
  const Hidden behind(obstacle.polygon(), view_.corners, view_.inner, front_, reach);
  for (const HalfSpace& side : behind.sides()) {
    solid = solid.within(side);
    if (solid.empty()) return true;
    if (solid.corner_count() > kMostSolidCorners) return false;
  }
  return Cover(surface_, depth_m).covers(solid);
}

}  // namespace vantage::internal::prove
