#include "simplify/lost_distance.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/bounds_distance.h"
#include "core/parallel.h"
#include "core/triangle_distance.h"
#include "core/walk_bvh.h"

namespace vantage::internal::simplify {
namespace {

constexpr double kRoundings = 256;  // of a step: lost_distance.h
constexpr int kMostHalvings = 6;
constexpr std::size_t kMostWork = 2000;  // parts times facets that they are compared with, in one collapse
constexpr double kTight = 1.5;           // a bound so many times what it must be is made tighter

/// A convex polygon: a part of a facet.
struct Part {
  static constexpr Eigen::Index kMost = 12;
  Eigen::Matrix<double, 3, kMost> corners = Eigen::Matrix<double, 3, kMost>::Zero();
  Eigen::Index count = 0;
  int halvings = 0;

  void add(const Vec3& corner) { corners.col(count++) = corner; }
};

/// The part on either side of a plane through `point`; false where one of them would be empty, or have too many
/// corners.
bool split(const Part& part, const Vec3& point, const Vec3& normal, Part& below, Part& above) {
  if (part.count + 2 > Part::kMost) return false;
  std::array<double, Part::kMost> height = {};
  double low = 0, high = 0;
  for (Eigen::Index i = 0; i < part.count; ++i) {
    height[i] = normal.dot(part.corners.col(i) - point);
    low = std::min(low, height[i]);
    high = std::max(high, height[i]);
  }
  const double least = 1e-9 * (high - low);
  if (!(low < -least && high > least)) return false;
  int cuts = 0;  // of a polygon that roundings have left convex: two
  for (Eigen::Index i = 0; i < part.count; ++i) cuts += height[i] * height[i + 1 < part.count ? i + 1 : 0] < 0 ? 1 : 0;
  if (cuts > 2) return false;
  below.count = above.count = 0;
  for (Eigen::Index i = 0; i < part.count; ++i) {
    const Eigen::Index next = i + 1 < part.count ? i + 1 : 0;
    const Vec3 a = part.corners.col(i), b = part.corners.col(next);
    if (height[i] <= 0) below.add(a);
    if (height[i] >= 0) above.add(a);
    if (height[i] * height[next] >= 0) continue;
    const Vec3 cut = a + height[i] / (height[i] - height[next]) * (b - a);
    below.add(cut);
    above.add(cut);
  }
  return true;
}

Corners about(const Vec3& place, const Corners& corners) {
  return {corners[0] - place, corners[1] - place, corners[2] - place};
}

/// The facets round a new place, and the planes that part what lies over one of them from what lies over the next.
/// Relative to the place: what is rounded does not grow with the coordinates.
struct Fan {
  Vec3 place = Vec3::Zero();
  std::vector<Corners> facets;
  std::vector<std::uint32_t> numbers;  ///< of the facets
  bool has_border = false;             ///< after them come the facets round the patch
  std::vector<Vec3> walls;             ///< normals of planes through the place

  double squared_distance(const Vec3& point, std::size_t facet) const {
    const auto& [a, b, c] = facets[facet];
    return core::squared_distance_to_triangle(point, a, b, c);
  }
};

void make_fan(const Surface& surface, const Patch& patch, const Vec3& place, Fan& fan) {
  fan.place = place;
  fan.facets.clear();
  fan.numbers.clear();
  fan.has_border = false;
  fan.walls.clear();
  Vec3 upward = Vec3::Zero();
  for (std::size_t i = patch.gone; i < patch.facets.size(); ++i) {
    const Corners corners = about(place, surface.corners_after(patch, patch.facets[i], place));
    upward += (corners[1] - corners[0]).cross(corners[2] - corners[0]);
    fan.facets.push_back(corners);
    fan.numbers.push_back(patch.facets[i]);
  }
  for (const Corners& corners : fan.facets) {
    for (std::size_t k = 0; k < 3; ++k) {  // each facet gives the wall over one of its two sides at the place
      if (corners[k].isZero(0)) fan.walls.push_back(corners[(k + 1) % 3].cross(upward));
    }
  }
}

/// What a collapse takes away may lie along facets that it does not change.
void add_border(const Surface& surface, const Patch& patch, Fan& fan) {
  fan.has_border = true;
  for (const std::uint32_t f : patch.facets) {
    for (const std::uint32_t v : surface.facet(f)) {
      if (v == patch.from || v == patch.to) continue;
      for (const std::uint32_t other : surface.star(v)) {
        if (std::find(patch.facets.begin(), patch.facets.end(), other) != patch.facets.end()) continue;
        if (std::find(fan.numbers.begin(), fan.numbers.end(), other) != fan.numbers.end()) continue;
        fan.facets.push_back(about(fan.place, surface.corners(other)));
        fan.numbers.push_back(other);
      }
    }
  }
}

/// Cuts a facet by the walls.
void cut(const Corners& facet, const Fan& fan, std::vector<Part>& parts) {
  constexpr std::size_t kMostParts = 32;
  parts.assign(1, Part{});
  for (const Vec3& corner : facet) parts[0].add(corner);
  Part below, above;
  for (const Vec3& wall : fan.walls) {
    const std::size_t count = parts.size();
    if (count >= kMostParts) return;
    for (std::size_t i = 0; i < count && parts.size() < kMostParts; ++i) {
      if (!split(parts[i], Vec3::Zero(), wall, below, above)) continue;
      parts[i] = below;
      parts.push_back(above);
    }
  }
}

double farthest_corner(const Corners& facet, const Fan& fan, std::size_t k) {
  double farthest = 0;
  for (const Vec3& corner : facet) farthest = std::max(farthest, fan.squared_distance(corner, k));
  return std::sqrt(farthest);
}

/// The facet of the fan that a part is bound to.
struct Bound {
  std::size_t facet = 0;
  double farthest = 0;  ///< the part's distance from it
  double least = 0;     ///< of the part's corners, the one farthest from the whole fan is so far from it
};

Bound bind(const Part& part, const Fan& fan) {
  Bound bound;
  bound.farthest = std::numeric_limits<double>::infinity();
  std::array<double, Part::kMost> nearest;
  nearest.fill(std::numeric_limits<double>::infinity());
  for (std::size_t k = 0; k < fan.facets.size(); ++k) {
    double farthest = 0;  // of a convex set to a convex set: a corner is farthest. The place is a corner of each facet
    for (Eigen::Index i = 0; i < part.count && farthest < bound.farthest; ++i) {
      const double squared = fan.squared_distance(part.corners.col(i), k);
      farthest = std::max(farthest, squared);
      nearest[i] = std::min(nearest[i], squared);
    }
    if (farthest >= bound.farthest) continue;
    bound.farthest = farthest;
    bound.facet = k;
  }
  bound.farthest = std::sqrt(bound.farthest);
  bound.least = std::sqrt(*std::max_element(nearest.begin(), nearest.begin() + part.count));
  return bound;
}

/// However small it is cut: the corner farthest from all facets is so far from them.
double least_m(const Part& part, const Fan& fan) {
  double farthest = 0;
  for (Eigen::Index i = 0; i < part.count; ++i) {
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < fan.facets.size() && nearest > farthest; ++k) {
      nearest = std::min(nearest, fan.squared_distance(part.corners.col(i), k));
    }
    farthest = std::max(farthest, nearest);
  }
  return std::sqrt(farthest);
}

/// Across its longest diagonal or side.
bool halve(const Part& part, Part& below, Part& above) {
  double longest = 0;
  Vec3 along = Vec3::Zero(), middle = Vec3::Zero();
  for (Eigen::Index i = 0; i < part.count; ++i) {
    for (Eigen::Index k = 0; k < i; ++k) {
      const Vec3 between = part.corners.col(i) - part.corners.col(k);
      if (between.squaredNorm() <= longest) continue;
      longest = between.squaredNorm();
      along = between;
      middle = (part.corners.col(i) + part.corners.col(k)) / 2;
    }
  }
  if (!split(part, middle, along, below, above)) return false;
  below.halvings = above.halvings = part.halvings + 1;
  return true;
}

}  // namespace

LostDistance::LostDistance(std::size_t facets, const Lengths& lengths)
    : bounds_(facets), lengths_(lengths), rounding_m_(std::ldexp(kRoundings * lengths.size_m, -53)) {
  for (std::uint32_t f = 0; f < facets; ++f) bounds_[f].facet = f;
}

bool LostDistance::is_allowed(const FacetBound& bound) const {
  return !lengths_.limit_m || bound.bound_m <= lengths_.flat_m || with_rounding(bound) <= *lengths_.limit_m;
}

bool LostDistance::after(const Surface& surface, const Patch& patch, const Vec3& place,
                         std::vector<FacetBound>& bounds) const {
  const double worth_m = lengths_.worth_m;
  const double limit_m =
      lengths_.limit_m ? std::max(*lengths_.limit_m, lengths_.flat_m) : std::numeric_limits<double>::infinity();
  thread_local Fan fan;
  thread_local std::vector<Part> parts;
  make_fan(surface, patch, place, fan);
  bounds.clear();
  for (const std::uint32_t f : fan.numbers) bounds.push_back({f, 0, 0});
  std::size_t work = 0;
  for (std::size_t i = 0; i < patch.facets.size(); ++i) {
    const std::uint32_t f = patch.facets[i];
    const double before = bounds_[f].bound_m;
    const Corners corners = about(place, surface.corners(f));
    const auto bind_to = [&](FacetBound& facet, double bound) {
      facet.bound_m = std::max(facet.bound_m, bound);
      facet.steps = std::max(facet.steps, bounds_[f].steps + 1);
    };
    if (i >= patch.gone) {  // most facets hardly move
      FacetBound& own = bounds[i - patch.gone];
      const double bound = before + farthest_corner(corners, fan, i - patch.gone);
      if (bound <= std::max(own.bound_m, worth_m)) {
        bind_to(own, bound);
        continue;
      }
    }
    cut(corners, fan, parts);
    while (!parts.empty()) {
      const Part part = parts.back();
      parts.pop_back();
      const Bound bound = bind(part, fan);
      work += fan.facets.size();
      if (work < kMostWork && before + bound.farthest > worth_m && bound.farthest > kTight * bound.least) {
        if (!fan.has_border) {
          add_border(surface, patch, fan);
          for (std::size_t k = bounds.size(); k < fan.numbers.size(); ++k) {
            bounds.push_back(bounds_[fan.numbers[k]]);
          }
          parts.push_back(part);
          continue;
        }
        const bool may_pass = before + bound.farthest <= limit_m || before + least_m(part, fan) <= limit_m;
        Part below, above;
        if (may_pass && part.halvings < kMostHalvings && halve(part, below, above)) {
          parts.push_back(below);
          parts.push_back(above);
          continue;
        }
      }
      bind_to(bounds[bound.facet], before + bound.farthest);
      if (!is_allowed(bounds[bound.facet])) return false;
    }
  }
  return std::all_of(bounds.begin(), bounds.end(), [&](const FacetBound& bound) { return is_allowed(bound); });
}

void LostDistance::set(const std::vector<FacetBound>& bounds) {
  for (const FacetBound& bound : bounds) {
    bounds_[bound.facet] = bound;
    if (!lengths_.limit_m) lengths_.worth_m = std::max(lengths_.worth_m, bound.bound_m / 2);
  }
}

FacetBound LostDistance::after_drop(const Surface& surface, std::span<const std::uint32_t> facets,
                                    std::uint32_t to) const {
  const Vec3 corner = surface.corners(to)[0];
  FacetBound bound = bounds_[to];
  for (const std::uint32_t f : facets) {  // balls are convex: what is inside is no farther than the corners
    for (const Vec3& v : surface.corners(f)) {
      bound.bound_m = std::max(bound.bound_m, (v - corner).norm() + bounds_[f].bound_m);
    }
    bound.steps = std::max(bound.steps, bounds_[f].steps + 1);
  }
  return bound;
}

double LostDistance::largest_m(const Surface& surface) const {
  double largest = 0;
  for (const FacetBound& bound : bounds_) {
    if (!surface.is_gone(bound.facet)) largest = std::max(largest, with_rounding(bound));
  }
  return largest;
}

double farthest_m(const std::vector<Vec3>& points, const Mesh& mesh, const core::ProgressReporter& progress) {
  std::vector<core::Bounds> items;
  items.reserve(mesh.triangles.size());
  constexpr float kFar = std::numeric_limits<float>::infinity();
  for (const Triangle& t : mesh.triangles) {
    Box box;
    for (const std::uint32_t v : t) box.extend(mesh.vertices[v]);
    core::Bounds bounds = {};
    for (int axis = 0; axis < 3; ++axis) {
      bounds.min[axis] = std::nextafter(static_cast<float>(box.min[axis]), -kFar);
      bounds.max[axis] = std::nextafter(static_cast<float>(box.max[axis]), kFar);
    }
    items.push_back(bounds);
  }
  std::vector<std::uint32_t> order;
  const core::Bvh bvh = core::build_bvh(items, order);
  std::vector<double> squared(points.size());
  parallel::for_ranges(points.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      progress.tick();
      double nearest = std::numeric_limits<double>::infinity();
      core::walk_nearer_first(
          bvh, [&](const core::Bounds& bounds) { return core::squared_distance_to(bounds, points[i]); },
          [&](const core::BvhNode&, double distance) { return distance < nearest; },
          [&](std::uint32_t item) {
            const auto& [a, b, c] = mesh.triangles[order[item]];
            nearest = std::min(nearest, core::squared_distance_to_triangle(points[i], mesh.vertices[a],
                                                                           mesh.vertices[b], mesh.vertices[c]));
          });
      squared[i] = nearest;
    }
  });
  double farthest = 0;
  for (const double one : squared) farthest = std::max(farthest, one);
  return std::sqrt(farthest);
}

}  // namespace vantage::internal::simplify
