#include "prove/sight.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <span>

#include "core/parallel.h"
#include "prove/corner_planes.h"
#include "prove/hull.h"
#include "prove/orientation.h"
#include "prove/patches.h"

namespace vantage::internal::prove {
namespace {

/// Items of a list are nodes of the tree of obstacles, or with this bit pieces.
constexpr std::uint32_t kPiece = 1U << 31;

using Items = std::vector<std::uint32_t>;

/// CertificatePart::steps; smaller numbers are those of known planes.
enum Step : std::int64_t { kPlane = 16, kDescend = 17, kLeave = 18, kNothing = 19 };
constexpr std::size_t kMostKept = 16;  // known planes
constexpr std::size_t kMostMet = 8;    // pieces that a facet is open for, and that may give a witness

bool blocks(const Piece& obstacle, const Vec3& from, const Vec3& to) {
  for (std::size_t i = 2; i < obstacle.count; ++i) {
    if (passes_through(from, to, {obstacle.corners[0], obstacle.corners[i - 1], obstacle.corners[i]})) return true;
  }
  return false;
}

class SightProver {
 public:
  SightProver(const std::vector<Vec3>& vertices, const std::vector<Triangle>& facets, const View& view,
              const Scene& scene, const SceneTree& obstacles, const SightTelling& telling)
      : vertices_(vertices),
        facets_(facets),
        view_(view),
        scene_(scene),
        obstacles_(obstacles),
        is_recorded_(telling.is_recorded),
        most_pieces_(telling.most_pieces),
        patches_(make_patches(vertices, facets)) {
    Box box = obstacles.nodes.front().box;
    for (const Vec3& vertex : vertices) box.extend(vertex);
    for (const Vec3& corner : view.corners) box.extend(corner);
    largest_ = box.min.cwiseAbs().cwiseMax(box.max.cwiseAbs()).maxCoeff();
  }

  SightProof run(const core::ProgressReporter& progress);

 private:
  using Whole = std::array<std::int64_t, 3>;  ///< a direction
  struct Separation {
    Vec3 way;
    double low;  ///< no point of the patch's hull lies less far along it
  };
  struct Found {
    std::vector<OpenFacet> open;
    std::size_t separations = 0;
    std::vector<std::int64_t> steps;
  };
  /// The planes that were found last for a patch, in a ring.
  struct Known {
    std::vector<Separation> planes;
    std::size_t oldest = 0;
  };

  void collect(std::uint32_t patch, std::vector<std::uint32_t>& roots) const;
  PointHull hull_of(const Patch& patch) const;
  Obstacle obstacle_of(std::uint32_t item) const {
    return (item & kPiece) != 0 ? Obstacle(obstacles_.pieces[item & ~kPiece].polygon())
                                : Obstacle(obstacles_.nodes[item].box);
  }
  bool is_nothing(std::uint32_t item) const {
    return (item & kPiece) != 0 ? obstacles_.pieces[item & ~kPiece].count == 0 : obstacles_.nodes[item].box.empty();
  }
  void record(Found& found, std::int64_t step) const {
    if (is_recorded_) found.steps.push_back(step);
  }
  bool is_narrow(std::uint32_t node, const Patch& patch) const;
  std::optional<Whole> separate_by_corners(const Patch& patch, std::uint32_t piece) const;
  std::optional<Whole> short_way(const Vec3& way, const PointHull& hull, const Obstacle& obstacle) const;
  bool is_separated(const Patch& patch, const PointHull& hull, std::uint32_t item, bool is_open, Known& known,
                    Found& found) const;
  void prove(std::uint32_t patch, const Items& items, Found& found) const;

  const std::vector<Vec3>& vertices_;
  const std::vector<Triangle>& facets_;
  const View& view_;
  const Scene& scene_;
  const SceneTree& obstacles_;
  bool is_recorded_;
  std::size_t most_pieces_;
  mutable std::atomic<std::size_t> pieces_{0};  ///< that were told
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

/// Where the search in doubles ends without a plane. It takes long, and is in vain if a line of sight is blocked.
std::optional<SightProver::Whole> SightProver::separate_by_corners(const Patch& patch, std::uint32_t piece) const {
  const auto& [a, b, c] = facets_[patches_.order[patch.begin]];
  const Vec3 middle = (vertices_[a] + vertices_[b] + vertices_[c]) / 3;
  if (blocks(obstacles_.pieces[piece], middle, Vec3::Zero())) return std::nullopt;
  std::vector<Vec3> points = view_.corners;
  points.push_back(Vec3::Zero());
  for (const std::uint32_t v : facets_[patches_.order[patch.begin]]) points.push_back(vertices_[v]);
  const std::vector<FineVec3> polygon = fine_corners_in_front(scene_, obstacles_.pieces[piece].of, view_);
  return polygon.size() < 3 ? std::nullopt : find_corner_plane(points, polygon, largest_);
}

/// A way with the same use in whole numbers that are as small as they can be.
std::optional<SightProver::Whole> SightProver::short_way(const Vec3& way, const PointHull& hull,
                                                         const Obstacle& obstacle) const {
  const Vec3 largest_one = way / way.cwiseAbs().maxCoeff();
  for (const int bits : {4, 7, 10, 13, 16, 20, 25, 32, 45, 60}) {
    const Vec3 whole = (largest_one * std::ldexp(1.0, bits)).array().round();
    if (hull.lowest(whole).dot(whole) - obstacle.highest(whole).dot(whole) > unsure_along(whole, largest_)) {
      return Whole{static_cast<std::int64_t>(whole.x()), static_cast<std::int64_t>(whole.y()),
                   static_cast<std::int64_t>(whole.z())};
    }
  }
  return std::nullopt;
}

/// By a known plane, or by a new one. `is_open`: the facet is so already.
bool SightProver::is_separated(const Patch& patch, const PointHull& hull, std::uint32_t item, bool is_open,
                               Known& known, Found& found) const {
  const Obstacle obstacle = obstacle_of(item);
  for (std::size_t i = 0; i < known.planes.size(); ++i) {
    const Separation& plane = known.planes[i];
    if (!(obstacle.highest(plane.way).dot(plane.way) < plane.low)) continue;
    record(found, static_cast<std::int64_t>(i));
    return true;
  }
  std::optional<Vec3> way = separate(hull, obstacle, largest_);
  std::optional<Whole> whole;
  if (way && is_recorded_) whole = short_way(*way, hull, obstacle);
  const bool is_found = is_recorded_ ? whole.has_value() : way.has_value();
  const bool is_last = (item & kPiece) != 0 && patch.second == 0;
  if (!is_found && is_last && !is_open) whole = separate_by_corners(patch, item & ~kPiece);
  if (whole) {
    way = Vec3(static_cast<double>((*whole)[0]), static_cast<double>((*whole)[1]), static_cast<double>((*whole)[2]));
    if (is_recorded_) found.steps.insert(found.steps.end(), {kPlane, (*whole)[0], (*whole)[1], (*whole)[2]});
  } else if (!is_found) {
    return false;
  }
  ++found.separations;
  const Separation plane{*way, hull.lowest(*way).dot(*way) - unsure_along(*way, largest_)};
  if (known.planes.size() < kMostKept) {
    known.planes.push_back(plane);
  } else {
    known.planes[known.oldest++ % kMostKept] = plane;
  }
  return true;
}

/// What no plane separates from all of a patch is left to its halves. Obstacles that are wide beside the patch are
/// taken apart instead.
void SightProver::prove(std::uint32_t index, const Items& items, Found& found) const {
  const Patch& patch = patches_.tree[index];
  if (most_pieces_ != 0 && pieces_ > most_pieces_) return;
  const bool is_single = patch.second == 0;
  const PointHull hull = hull_of(patch);
  Known known;
  std::size_t met = 0;
  Items stack(items.rbegin(), items.rend()), left;
  while (!stack.empty()) {
    const std::uint32_t item = stack.back();
    stack.pop_back();
    const bool is_piece = (item & kPiece) != 0;
    if (is_nothing(item)) {
      record(found, kNothing);
    } else if (is_separated(patch, hull, item, met > 0, known, found)) {
      continue;
    } else if (is_piece && is_single) {
      found.open.push_back({patches_.order[patch.begin], item & ~kPiece});
      if (is_recorded_ || (++met == kMostMet && most_pieces_ == 0)) return;
      if (most_pieces_ != 0 && ++pieces_ > most_pieces_) return;
    } else if (is_piece || (!is_single && is_narrow(item, patch))) {
      left.push_back(item);
      record(found, kLeave);
    } else {
      record(found, kDescend);
      const TreeNode& node = obstacles_.nodes[item];
      if (node.second != 0) {
        stack.insert(stack.end(), {node.second, item + 1});
      } else {
        for (std::uint32_t t = node.end; t-- > node.begin;) stack.push_back(t | kPiece);
      }
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
    proof.steps.insert(proof.steps.end(), part.steps.begin(), part.steps.end());
  }
  if (is_recorded_) proof.order = patches_.order;
  std::sort(proof.open.begin(), proof.open.end(), [](const OpenFacet& a, const OpenFacet& b) {
    return a.facet < b.facet || (a.facet == b.facet && a.piece < b.piece);
  });
  return proof;
}

}  // namespace

SightProof prove_sight(const std::vector<Vec3>& vertices, const std::vector<Triangle>& facets, const View& view,
                       const Scene& scene, const SceneTree& obstacles, const SightTelling& telling,
                       const core::ProgressReporter& progress) {
  if (facets.empty()) return {};
  if (obstacles.nodes.empty()) return {{}, 0, make_patches(vertices, facets).order, {}};
  return SightProver(vertices, facets, view, scene, obstacles, telling).run(progress);
}

std::optional<Blocked> find_blocked(const std::array<Vec3, 3>& facet, const View& view, const Piece& obstacle) {
  constexpr int kParts = 4;
  std::vector<Vec3> ends = view.corners;
  for (std::size_t i = 0; i < view.corners.size(); ++i) {
    ends.push_back((view.corners[i] + view.corners[(i + 1) % view.corners.size()]) / 2);
  }
  ends.push_back(Vec3::Zero());
  // And some that lie on no line of symmetry: a segment that meets an edge of two triangles passes through neither.
  for (const double ratio : {0.37, 0.61}) {
    Vec3 sum = Vec3::Zero();
    double weight = 1, all = 0;
    for (const Vec3& corner : view.corners) {
      sum += weight * corner;
      all += weight;
      weight *= ratio;
    }
    ends.push_back(sum / all);
  }
  std::optional<Blocked> deepest;
  for (int i = 0; i <= kParts; ++i) {
    for (int k = 0; i + k <= kParts; ++k) {
      const Vec3 from = facet[0] + (facet[1] - facet[0]) * i / kParts + (facet[2] - facet[0]) * k / kParts;
      for (const Vec3& to : ends) {
        if (!blocks(obstacle, from, to)) continue;
        double hidden = 0, open = 1;  // parts of the way to the origin
        for (int step = 0; step < 30; ++step) {
          const double part = (hidden + open) / 2;
          (blocks(obstacle, (1 - part) * from, to) ? hidden : open) = part;
        }
        const double depth = hidden * from.norm();
        if (!deepest || depth > deepest->depth_m) deepest = Blocked{from, to, depth};
      }
    }
  }
  return deepest;
}

}  // namespace vantage::internal::prove
