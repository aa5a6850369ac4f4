#include "prove/sight.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "core/parallel.h"
#include "prove/hull.h"
#include "prove/orientation.h"
#include "prove/patches.h"

namespace vantage::internal::prove {
namespace {

/// Items of a list are nodes of the tree of obstacles, or with this bit triangles.
constexpr std::uint32_t kTriangle = 1U << 31;

using Items = std::vector<std::uint32_t>;

class SightProver {
 public:
  SightProver(const std::vector<Vec3>& vertices, const std::vector<Triangle>& facets, const View& view,
              const SceneTree& obstacles)
      : vertices_(vertices),
        facets_(facets),
        view_(view),
        obstacles_(obstacles),
        patches_(make_patches(vertices, facets)) {
    Box box = obstacles.nodes.front().box;
    for (const Vec3& vertex : vertices) box.extend(vertex);
    for (const Vec3& corner : view.corners) box.extend(corner);
    largest_ = box.min.cwiseAbs().cwiseMax(box.max.cwiseAbs()).maxCoeff();
  }

  SightProof run(const core::ProgressReporter& progress);

 private:
  struct Separation {
    Vec3 way;
    double low;  ///< no point of the patch's hull lies less far along it
  };
  struct Found {
    std::vector<OpenFacet> open;
    std::size_t separations = 0;
  };

  void collect(std::uint32_t patch, std::vector<std::uint32_t>& roots) const;
  PointHull hull_of(const Patch& patch) const;
  Obstacle obstacle_of(std::uint32_t item) const {
    return (item & kTriangle) != 0 ? Obstacle(obstacles_.triangles[item & ~kTriangle].corners)
                                   : Obstacle(obstacles_.nodes[item].box);
  }
  bool is_narrow(std::uint32_t node, const Patch& patch) const;
  std::optional<Vec3> separate_by_corners(const Patch& patch, std::uint32_t triangle) const;
  void prove(std::uint32_t patch, const Items& items, Found& found) const;

  const std::vector<Vec3>& vertices_;
  const std::vector<Triangle>& facets_;
  const View& view_;
  const SceneTree& obstacles_;
  Patches patches_;
  double largest_ = 0;
};

/// Larger groups are hardly ever free, and to find the farthest of many points takes long.
void SightProver::collect(std::uint32_t patch, std::vector<std::uint32_t>& roots) const {
  constexpr std::uint32_t kMostFacets = 256;
  const Patch& at = patches_.tree[patch];
  if (at.end - at.begin <= kMostFacets) {
    roots.push_back(patch);
    return;
  }
  collect(patch + 1, roots);
  collect(at.second, roots);
}

/// With the origin, about which the volume is cut into cones: it is in the target but for rounding.
PointHull SightProver::hull_of(const Patch& patch) const {
  std::vector<std::uint32_t> used;
  for (std::uint32_t i = patch.begin; i < patch.end; ++i) {
    for (const std::uint32_t v : facets_[patches_.order[i]]) used.push_back(v);
  }
  std::sort(used.begin(), used.end());
  used.erase(std::unique(used.begin(), used.end()), used.end());
  PointHull hull;
  for (const std::uint32_t v : used) hull.add(vertices_[v]);
  for (const Vec3& corner : view_.corners) hull.add(corner);
  hull.add(Vec3::Zero());
  return hull;
}

/// Whether it is the patch that has to be halved, not the node.
bool SightProver::is_narrow(std::uint32_t node, const Patch& patch) const {
  const Box& box = obstacles_.nodes[node].box;
  return (box.max - box.min).norm() < patch.extent * ((box.min + box.max) / 2).norm();
}

/// Where the iteration does not end: sets that are apart are so along the normal of a face of one of them, or across an
/// edge of each.
std::optional<Vec3> SightProver::separate_by_corners(const Patch& patch, std::uint32_t triangle) const {
  std::vector<Vec3> points = view_.corners;
  points.push_back(Vec3::Zero());
  for (const std::uint32_t v : facets_[patches_.order[patch.begin]]) points.push_back(vertices_[v]);
  const std::array<Vec3, 3>& corners = obstacles_.triangles[triangle].corners;
  std::optional<Vec3> best;
  const auto consider = [&](const Vec3& normal) {
    const double length = normal.norm();
    if (best || !(length > 0)) return;
    for (const Vec3& way : {Vec3(normal / length), Vec3(-normal / length)}) {
      double low = way.dot(points[0]), high = way.dot(corners[0]);
      for (const Vec3& point : points) low = std::min(low, way.dot(point));
      for (const Vec3& corner : corners) high = std::max(high, way.dot(corner));
      if (low - high > unsure_along(way, largest_)) best = way;
    }
  };
  for (const Vec3& a : points) {
    for (const Vec3& b : points) {
      for (std::size_t k = 0; k < 3; ++k) {
        consider((b - a).cross(corners[k] - a));
        consider((b - a).cross(corners[(k + 1) % 3] - corners[k]));
      }
      for (const Vec3& c : points) consider((b - a).cross(c - a));
    }
    for (std::size_t k = 0; k < 3; ++k) consider((corners[(k + 1) % 3] - corners[k]).cross(a - corners[k]));
  }
  consider((corners[1] - corners[0]).cross(corners[2] - corners[0]));
  return best;
}

/// What no plane separates from all of a patch is left to its halves. Obstacles that are wide beside the patch are
/// taken apart instead.
void SightProver::prove(std::uint32_t index, const Items& items, Found& found) const {
  constexpr std::size_t kMostKept = 16;
  const Patch& patch = patches_.tree[index];
  const bool is_single = patch.second == 0;
  const PointHull hull = hull_of(patch);
  std::vector<Separation> known;
  std::size_t oldest = 0;
  Items stack(items.rbegin(), items.rend()), left;
  while (!stack.empty()) {
    const std::uint32_t item = stack.back();
    stack.pop_back();
    const Obstacle obstacle = obstacle_of(item);
    const bool is_known = std::any_of(known.begin(), known.end(), [&](const Separation& separation) {
      return obstacle.highest(separation.way).dot(separation.way) < separation.low;
    });
    if (is_known) continue;
    const bool is_triangle = (item & kTriangle) != 0;
    std::optional<Vec3> way = separate(hull, obstacle, largest_);
    if (!way && is_triangle && is_single) way = separate_by_corners(patch, item & ~kTriangle);
    if (way) {
      ++found.separations;
      const Separation separation{*way, hull.lowest(*way).dot(*way) - unsure_along(*way, largest_)};
      if (known.size() < kMostKept) {
        known.push_back(separation);
      } else {
        known[oldest++ % kMostKept] = separation;
      }
    } else if (is_triangle && is_single) {
      found.open.push_back({patches_.order[patch.begin], item & ~kTriangle});
      return;
    } else if (is_triangle || (!is_single && is_narrow(item, patch))) {
      left.push_back(item);
    } else if (const TreeNode& node = obstacles_.nodes[item]; node.second != 0) {
      stack.push_back(node.second);
      stack.push_back(item + 1);
    } else {
      for (std::uint32_t t = node.end; t-- > node.begin;) stack.push_back(t | kTriangle);
    }
  }
  if (left.empty()) return;
  prove(index + 1, left, found);
  prove(patch.second, left, found);
}

SightProof SightProver::run(const core::ProgressReporter& progress) {
  std::vector<std::uint32_t> roots;
  collect(0, roots);
  std::vector<Found> found(roots.size());
  core::ProgressCounter done(progress, roots.size());
  parallel::for_ranges(roots.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      prove(roots[i], {0}, found[i]);
      done.add(1);
    }
  });
  SightProof proof;
  for (const Found& part : found) {
    proof.open.insert(proof.open.end(), part.open.begin(), part.open.end());
    proof.separations += part.separations;
  }
  std::sort(proof.open.begin(), proof.open.end(),
            [](const OpenFacet& a, const OpenFacet& b) { return a.facet < b.facet; });
  return proof;
}

/// Whether a segment passes through the inside of a triangle.
bool passes_through(const Vec3& from, const Vec3& to, const std::array<Vec3, 3>& triangle) {
  const auto& [a, b, c] = triangle;
  if (orientation(a, b, c, from) * orientation(a, b, c, to) >= 0) return false;
  const int first = orientation(from, to, a, b);
  return first != 0 && orientation(from, to, b, c) == first && orientation(from, to, c, a) == first;
}

}  // namespace

SightProof prove_sight(const std::vector<Vec3>& vertices, const std::vector<Triangle>& facets, const View& view,
                       const SceneTree& obstacles, const core::ProgressReporter& progress) {
  if (facets.empty() || obstacles.nodes.empty()) return {};
  return SightProver(vertices, facets, view, obstacles).run(progress);
}

std::optional<Blocked> find_blocked(const std::array<Vec3, 3>& facet, const View& view, const TreeTriangle& obstacle) {
  constexpr int kParts = 4;
  std::vector<Vec3> ends = view.corners;
  for (std::size_t i = 0; i < view.corners.size(); ++i) {
    ends.push_back((view.corners[i] + view.corners[(i + 1) % view.corners.size()]) / 2);
  }
  ends.push_back(Vec3::Zero());
  std::optional<Blocked> deepest;
  const auto is_blocked = [&](const Vec3& from, const Vec3& to) { return passes_through(from, to, obstacle.corners); };
  for (int i = 0; i <= kParts; ++i) {
    for (int k = 0; i + k <= kParts; ++k) {
      const Vec3 from = facet[0] + (facet[1] - facet[0]) * i / kParts + (facet[2] - facet[0]) * k / kParts;
      for (const Vec3& to : ends) {
        if (!is_blocked(from, to)) continue;
        double hidden = 0, open = 1;  // parts of the way to the origin
        for (int step = 0; step < 30; ++step) {
          const double part = (hidden + open) / 2;
          (is_blocked((1 - part) * from, to) ? hidden : open) = part;
        }
        const double depth = hidden * from.norm();
        if (!deepest || depth > deepest->depth_m) deepest = Blocked{from, to, depth};
      }
    }
  }
  return deepest;
}

}  // namespace vantage::internal::prove
