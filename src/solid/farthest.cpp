// Two parts. On the region's own facets: they are split until bounds agree. Inside of it: a point that is farther from
// the other solid than any point of the region's surface would be a local maximum of the distance, and there is none
// where the other solid's surface is star-shaped, nearby, about some point.
#include "solid/farthest.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "core/parallel.h"
#include "core/triangle_distance.h"
#include "core/triangle_tree.h"
#include "solid/kernel_point.h"
#include "solid/numerics.h"

namespace vantage::internal::solid {
namespace {

using Corners = std::array<Vec3, 3>;

/// What both parts know of the answer.
struct Answer {
  double least = 0;  // reached
  Vec3 point = Vec3::Zero();
  double most = 0;        // of all that has been settled
  double negligible = 0;  // rounding: bounds need not agree better

  void reach(double distance, const Vec3& at) {
    if (distance <= least) return;
    least = distance;
    point = at;
  }
  /// Whether a bound is good enough, or can never matter.
  bool is_settled(double bound) const { return bound <= (1 + numerics::kFarthestPart) * least + negligible; }
  void settle(double bound) { most = std::max(most, bound); }
};

Corners corners_of(const Mesh& mesh, std::uint32_t t) {
  const Triangle& triangle = mesh.triangles[t];
  return {mesh.vertices[triangle[0]], mesh.vertices[triangle[1]], mesh.vertices[triangle[2]]};
}

Vec3 normal_of(const Corners& c) { return (c[1] - c[0]).cross(c[2] - c[0]).stableNormalized(); }

double distance(const Vec3& point, const Corners& c) {
  return std::sqrt(core::squared_distance_to_triangle(point, c[0], c[1], c[2]));
}

// ---- on the surface ----

/// A piece of a facet.
struct Patch {
  Corners corners;
  std::array<double, 3> distances;  // of the corners
  std::uint32_t nearest = 0;        // facet of the other solid that is nearest to the middle
  double middle_distance = 0, bound = 0;
  int depth = 0;

  Vec3 middle() const { return (corners[0] + corners[1] + corners[2]) / 3; }
};

class SurfaceSearch {
 public:
  SurfaceSearch(const Mesh& other, const core::TriangleTree& tree, Answer& answer)
      : other_(other), tree_(tree), answer_(answer) {}

  void run(const LabelledMesh& region, std::uint32_t own, const core::ProgressReporter& progress);

 private:
  Patch make_patch(const Corners& corners, const std::array<double, 3>& distances, int depth) const;
  void split(const Patch& patch, std::vector<Patch>& pieces) const;
  std::optional<std::pair<Vec3, double>> cut(const Patch& patch) const;
  std::vector<Patch> first_patches(const LabelledMesh& region, std::uint32_t own,
                                   const core::ProgressReporter& progress) const;
  void take_in(std::vector<Patch>& patches);

  const Mesh& other_;
  const core::TriangleTree& tree_;
  Answer& answer_;
};

/// The distance from one facet of the other solid is convex: over a patch it is largest at a corner. And no point of
/// the patch is nearer to the other solid than that facet is.
Patch SurfaceSearch::make_patch(const Corners& corners, const std::array<double, 3>& distances, int depth) const {
  Patch patch{corners, distances};
  patch.depth = depth;
  const Vec3 middle = patch.middle();
  const core::TriangleTree::Nearest nearest = tree_.nearest(middle);
  patch.nearest = nearest.triangle;
  patch.middle_distance = nearest.distance;
  const Corners facet = corners_of(other_, nearest.triangle);
  double by_facet = 0, by_middle = 0;
  for (const Vec3& corner : corners) {
    by_facet = std::max(by_facet, distance(corner, facet));
    by_middle = std::max(by_middle, nearest.distance + (corner - middle).norm());
  }
  patch.bound = std::min(by_facet, by_middle);
  return patch;
}

/// A plane that cuts the patch where it leaves the prism over its nearest facet: normal and height. Nothing where the
/// corners are all over that facet, or the cut would be no progress.
std::optional<std::pair<Vec3, double>> SurfaceSearch::cut(const Patch& patch) const {
  const Corners facet = corners_of(other_, patch.nearest);
  const Vec3 normal = normal_of(facet);
  double farthest = 0;
  std::optional<std::pair<Vec3, double>> best;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3 side = (facet[(i + 1) % 3] - facet[i]).cross(normal).stableNormalized();
    const double at = side.dot(facet[i]);
    double low = 0, high = 0;
    for (const Vec3& corner : patch.corners) {
      low = std::min(low, side.dot(corner) - at);
      high = std::max(high, side.dot(corner) - at);
    }
    if (std::min(-low, high) <= answer_.negligible || high <= farthest) continue;
    farthest = high;
    best = {side, at};
  }
  return best;
}

/// Along the cut, where there is one and not too often in a row, or else across the longest side.
void SurfaceSearch::split(const Patch& patch, std::vector<Patch>& pieces) const {
  const Corners& c = patch.corners;
  const std::array<double, 3>& d = patch.distances;
  const auto point = [&](std::size_t i, std::size_t j, double share) { return Vec3(c[i] + share * (c[j] - c[i])); };
  const auto add = [&](const Corners& corners, const std::array<double, 3>& distances) {
    pieces.push_back(make_patch(corners, distances, patch.depth + 1));
  };
  const std::optional<std::pair<Vec3, double>> plane = patch.depth % 4 == 3 ? std::nullopt : cut(patch);
  if (!plane) {
    std::size_t i = 0;
    for (std::size_t k = 1; k < 3; ++k) {
      if ((c[(k + 1) % 3] - c[k]).squaredNorm() > (c[(i + 1) % 3] - c[i]).squaredNorm()) i = k;
    }
    const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
    const Vec3 half = point(i, j, 0.5);
    const double at_half = tree_.nearest(half).distance;
    add({c[i], half, c[k]}, {d[i], at_half, d[k]});
    add({half, c[j], c[k]}, {at_half, d[j], d[k]});
    return;
  }
  std::array<double, 3> height{};
  for (std::size_t k = 0; k < 3; ++k) height[k] = plane->first.dot(c[k]) - plane->second;
  std::size_t alone = 0;  // the corner that has the others on the other side
  for (std::size_t k = 1; k < 3; ++k) {
    const auto differs = [&](std::size_t m) {
      return (height[m] > 0) != (height[(m + 1) % 3] > 0) && (height[m] > 0) != (height[(m + 2) % 3] > 0);
    };
    if (differs(k)) alone = k;
  }
  const std::size_t j = (alone + 1) % 3, k = (alone + 2) % 3;
  const Vec3 p = point(alone, j, height[alone] / (height[alone] - height[j]));
  const Vec3 q = point(alone, k, height[alone] / (height[alone] - height[k]));
  const double at_p = tree_.nearest(p).distance, at_q = tree_.nearest(q).distance;
  add({c[alone], p, q}, {d[alone], at_p, at_q});
  add({p, c[j], q}, {at_p, d[j], at_q});
  add({c[j], c[k], q}, {d[j], d[k], at_q});
}

std::vector<Patch> SurfaceSearch::first_patches(const LabelledMesh& region, std::uint32_t own,
                                                const core::ProgressReporter& progress) const {
  constexpr std::size_t kGrain = 256;
  const Mesh& mesh = region.mesh;
  const std::vector<std::uint32_t>& labels = region.labels;
  std::vector<std::uint32_t> facets;
  std::vector<char> is_used(mesh.vertices.size(), 0);
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    if (labels[t] != own) continue;
    facets.push_back(t);
    for (const std::uint32_t v : mesh.triangles[t]) is_used[v] = 1;
  }
  std::vector<double> distances(mesh.vertices.size(), 0);
  std::vector<Patch> patches(facets.size());
  core::ProgressCounter counter(progress, mesh.vertices.size() + facets.size());
  parallel::for_ranges(mesh.vertices.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      if (is_used[v]) distances[v] = tree_.nearest(mesh.vertices[v]).distance;
    }
    counter.add(end - begin);
  });
  parallel::for_ranges(facets.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Triangle& t = mesh.triangles[facets[i]];
      patches[i] = make_patch(corners_of(mesh, facets[i]), {distances[t[0]], distances[t[1]], distances[t[2]]}, 0);
    }
    counter.add(end - begin);
  });
  return patches;
}

/// Notes what the patches reach, and leaves those that are not settled.
void SurfaceSearch::take_in(std::vector<Patch>& patches) {
  for (const Patch& patch : patches) {
    for (std::size_t i = 0; i < 3; ++i) answer_.reach(patch.distances[i], patch.corners[i]);
    answer_.reach(patch.middle_distance, patch.middle());
  }
  std::erase_if(patches, [&](const Patch& patch) {
    if (!answer_.is_settled(patch.bound)) return false;
    answer_.settle(patch.bound);
    return true;
  });
}

void SurfaceSearch::run(const LabelledMesh& region, std::uint32_t own, const core::ProgressReporter& progress) {
  std::vector<Patch> open = first_patches(region, own, progress.part(0, 0.8));
  take_in(open);
  constexpr std::size_t kGrain = 64;
  for (std::size_t steps = 0; !open.empty() && steps < numerics::kMostPatches;) {
    progress.report(0.8 + 0.2 * static_cast<double>(steps) / numerics::kMostPatches);
    std::vector<std::vector<Patch>> pieces(open.size());
    parallel::for_ranges(open.size(), kGrain, [&](std::size_t from, std::size_t to) {
      for (std::size_t i = from; i < to; ++i) split(open[i], pieces[i]);
    });
    open.clear();
    for (const std::vector<Patch>& of_one : pieces) open.insert(open.end(), of_one.begin(), of_one.end());
    steps += open.size();
    take_in(open);
  }
  for (const Patch& patch : open) answer_.settle(patch.bound);
}

// ---- inside ----

/// A cube that the region may be in.
struct Cell {
  Vec3 middle;
  double half = 0;  // of its side
};

class InsideSearch {
 public:
  InsideSearch(const LabelledMesh& region, const Mesh& other, const core::TriangleTree& tree, Answer& answer)
      : region_(region.mesh), region_tree_(region.mesh), other_(other), tree_(tree), answer_(answer) {}

  void run(const core::ProgressReporter& progress);

 private:
  /// What is known of a cell.
  struct Finding {
    double bound = 0, reached = 0;
    bool is_closed = false;  // holds no maximum, or nothing of the region
  };

  Finding look(const Cell& cell) const;
  bool is_star_shaped_near(const Vec3& point, double radius) const;

  const Mesh& region_;
  const core::TriangleTree region_tree_;
  const Mesh& other_;
  const core::TriangleTree& tree_;
  Answer& answer_;
};

/// Adds the half space of a facet that has an area; one without is part of its neighbours' sides.
void add_half_space(const Corners& c, std::vector<HalfSpace>& half_spaces) {
  const Vec3 normal = normal_of(c);
  if (normal.squaredNorm() > 0.5) half_spaces.push_back({normal, normal.dot(c[0])});
}

/// Whether some point lies behind all facets of the other solid that come within the radius.
bool InsideSearch::is_star_shaped_near(const Vec3& point, double radius) const {
  const Box box{point - Vec3::Constant(radius), point + Vec3::Constant(radius)};
  std::vector<HalfSpace> half_spaces;
  bool are_too_many = false;
  tree_.for_each_near(box, 0, [&](std::uint32_t t) {
    if (are_too_many) return;
    const Corners c = corners_of(other_, t);
    if (distance(point, c) > radius) return;
    add_half_space(c, half_spaces);
    are_too_many = half_spaces.size() > numerics::kMostFacetsOfCell;
  });
  if (are_too_many) return false;
  // The point may be far away: behind a wall that is all but flat.
  const Box wide{point - Vec3::Constant(100 * radius), point + Vec3::Constant(100 * radius)};
  return kernel_point(half_spaces, wide, numerics::kKernelMargin * radius).has_value();
}

InsideSearch::Finding InsideSearch::look(const Cell& cell) const {
  Finding finding;
  const double radius = cell.half * std::sqrt(3.0), from_surface = region_tree_.nearest(cell.middle).distance;
  const double from_other = tree_.nearest(cell.middle).distance;
  finding.bound = from_other + radius;
  finding.is_closed = answer_.is_settled(finding.bound);
  if (finding.is_closed) return finding;
  const bool is_on_surface = from_surface <= answer_.negligible;
  const bool is_inside = is_on_surface || region_tree_.winding_number(cell.middle) > 0;
  if (is_inside) finding.reached = from_other;
  finding.is_closed =
      (!is_inside && from_surface > radius) || is_star_shaped_near(cell.middle, from_other + 2 * radius);
  if (finding.is_closed) finding.bound = finding.reached;
  return finding;
}

void InsideSearch::run(const core::ProgressReporter& progress) {
  std::vector<HalfSpace> all;
  all.reserve(other_.triangles.size());
  for (std::uint32_t t = 0; t < other_.triangles.size(); ++t) {
    add_half_space(corners_of(other_, t), all);
  }
  const Box box = bounding_box(other_);
  progress.check();
  if (kernel_point(all, box, numerics::kKernelMargin * (box.max - box.min).norm())) return;

  const Box outer = bounding_box(region_);
  // A little larger and beside the middle: so that points do not lie in the planes of what was drawn on a grid.
  const double half = (outer.max - outer.min).maxCoeff() * 0.5173;
  std::vector<Cell> open{{(outer.min + outer.max) / 2 + half * Vec3(0.0137, -0.0091, 0.0113), half}};
  constexpr std::size_t kGrain = 16;
  for (std::size_t steps = 0; !open.empty(); steps += open.size()) {
    progress.report(std::min(1.0, static_cast<double>(steps) / numerics::kMostCells));
    std::vector<Finding> findings(open.size());
    parallel::for_ranges(open.size(), kGrain, [&](std::size_t from, std::size_t to) {
      for (std::size_t i = from; i < to; ++i) findings[i] = look(open[i]);
    });
    for (std::size_t i = 0; i < open.size(); ++i) answer_.reach(findings[i].reached, open[i].middle);
    std::vector<Cell> next;
    const bool is_last = steps + open.size() > numerics::kMostCells;
    for (std::size_t i = 0; i < open.size(); ++i) {
      if (findings[i].is_closed || is_last || answer_.is_settled(findings[i].bound)) {
        answer_.settle(findings[i].bound);
        continue;
      }
      for (unsigned corner = 0; corner < 8; ++corner) {
        const double h = open[i].half / 2;
        const Vec3 step((corner & 1) ? h : -h, (corner & 2) ? h : -h, (corner & 4) ? h : -h);
        next.push_back({open[i].middle + step, h});
      }
    }
    open = std::move(next);
  }
}

}  // namespace

Farthest farthest_point(const LabelledMesh& region, std::uint32_t own, const Mesh& other,
                        const core::ProgressReporter& progress) {
  if (region.mesh.empty()) return {};
  Answer answer;
  Box box = bounding_box(region.mesh);
  box.extend(bounding_box(other));
  answer.negligible = numerics::kNegligible * (box.max - box.min).norm();
  const core::TriangleTree tree(other);
  SurfaceSearch(other, tree, answer).run(region, own, progress.part(0, 0.6));
  InsideSearch(region, other, tree, answer).run(progress.part(0.6, 1));
  return {answer.least, std::max(answer.least, answer.most), answer.point};
}

}  // namespace vantage::internal::solid
