// How far a target may have been raised: docs/proof.md, "The lift". The same is said of the engine in docs/theory.md,
// "Numerics"; here it is worked out again, from triangles, and does not come out less.
#include "prove/lift.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "core/parallel.h"
#include "prove/convex_polygon.h"
#include "prove/orientation.h"
#include "prove/scene_tree.h"
#include "prove/tree_search.h"
#include "vantage/prove.h"

namespace vantage::internal::prove {
namespace {

/// Metres. In worlds with a range below the full one the first three are smaller in proportion.
constexpr double kOwnSurface = 2e-3;   ///< what rises no higher over the target is the surface that it lies on
constexpr double kClear = 1e-6;        ///< so far over it the target is raised
constexpr double kPointRadius = 5e-4;  ///< of what stands for a point
constexpr double kFullRange = 20;
constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

struct OwnLengths {
  double own_m = 0, clear_m = 0;
};

/// `largest`: no coordinate of the scene is larger. `radius_m`: of the target.
OwnLengths own_lengths(double largest, const TargetFrame& frame, double radius_m, double range_m) {
  constexpr double kOnTarget = 1e-9, kRoundings = 8;
  largest = std::max(largest, frame.origin.cwiseAbs().maxCoeff());
  // The rounding of the target, of the scene about a middle of its own, and of the two about each other.
  const double rounded = kRoundings * kEpsilon * (3 * largest + radius_m + (std::isfinite(range_m) ? range_m : 0));
  const double small = std::min(1.0, range_m / kFullRange);
  const double clear = std::max(kClear * small, 4 * std::max(rounded, kOnTarget * std::min(1.0, radius_m)));
  // Wherever a scene lies, no more than 2 mm of it is the target's own surface.
  return {std::min(kOwnSurface, std::max(kOwnSurface * small, 4 * clear)), std::min(kOwnSurface / 4, clear)};
}

/// The triangles that have area: others hide nothing, and vertices that no triangle has are not there.
struct SceneTriangles {
  explicit SceneTriangles(const Scene& scene, const core::ProgressReporter& progress) {
    const std::vector<Vec3>& vertices = scene.mesh.vertices;
    std::vector<Piece> pieces;
    for (std::uint32_t t = 0; t < scene.mesh.triangles.size(); ++t) {
      progress.tick();
      const auto& [a, b, c] = scene.mesh.triangles[t];
      if (are_on_a_line(vertices[a], vertices[b], vertices[c])) continue;
      pieces.push_back(Piece::triangle({vertices[a], vertices[b], vertices[c]}, t));
      for (const std::uint32_t v : {a, b, c}) largest = std::max(largest, vertices[v].cwiseAbs().maxCoeff());
    }
    tree = make_tree(std::move(pieces));
  }
  SceneTree tree;  ///< scene frame
  double largest = 0;
};

/// What of the scene lies straight over and under a convex polygon, and how high.
class Surroundings {
 public:
  /// What ends below `floor_m`, or begins above `ceiling_m`, is not asked for.
  Surroundings(const SceneTriangles& scene, const TargetFrame& frame, const std::vector<Eigen::Vector2d>& polygon,
               double floor_m, double ceiling_m, const core::ProgressReporter& progress)
      : frame_(frame), ceiling_m_(ceiling_m) {
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const Eigen::Vector2d& from = polygon[i];
      const Eigen::Vector2d along = polygon[(i + 1) % polygon.size()] - from;
      const Vec3 outward = Vec3(along.y(), -along.x(), 0).stableNormalized();
      column_.push_back({outward, outward.head<2>().dot(from)});
      around_.extend(Vec3(from.x(), from.y(), 0));
    }
    constexpr double kRoundings = 32;  // of a height
    const double unsure = kRoundings * kEpsilon * (scene.largest + frame.origin.cwiseAbs().maxCoeff());
    const auto is_far = [&](const Box& box) {
      const Vec3 middle = (box.min + box.max) / 2 - frame.origin, half = (box.max - box.min) / 2;
      const double height = frame.normal.dot(middle), reach = frame.normal.cwiseAbs().dot(half) + unsure;
      return height + reach < floor_m || height - reach > ceiling_m;
    };
    search_tree(scene.tree, is_far, [&](std::uint32_t i) {
      progress.tick();
      see(scene.tree.pieces[i].first_three());
    });
    std::sort(highest_.begin(), highest_.end());
  }

  /// The highest of what reaches more than `above_m` and at most `to_m` high over the polygon.
  std::optional<double> top_over(double above_m, double to_m) const {
    std::optional<double> top;
    for (const double height : over_) {
      if (height > above_m && height <= to_m && (!top || height > *top)) top = height;
    }
    return top;
  }
  /// Heights above 0 of the highest corners of all triangles, beside the polygon as well, ascending.
  const std::vector<double>& highest() const { return highest_; }

 private:
  void see(const std::array<Vec3, 3>& triangle) {
    ConvexPolygon corners;
    Box box;
    for (const Vec3& corner : triangle) {
      corners.push_back(frame_.to_local(corner));
      box.extend(corners.back());
    }
    if (box.max.z() > 0 && box.max.z() <= ceiling_m_) highest_.push_back(box.max.z());
    if (box.min.x() > around_.max.x() || box.max.x() < around_.min.x()) return;
    if (box.min.y() > around_.max.y() || box.max.y() < around_.min.y()) return;
    corners = part_within(std::move(corners), column_);
    if (corners.empty()) return;
    over_.push_back(box_of(corners).max.z());
  }

  const TargetFrame& frame_;
  double ceiling_m_;
  Box around_;
  std::vector<HalfSpace> column_;
  std::vector<double> over_, highest_;
};

double needed_of(const SceneTriangles& scene, const TargetFrame& frame, double range_m,
                 const core::ProgressReporter& progress) {
  const bool is_point = frame.polygon.size() < 3;
  const double half = kPointRadius * std::min(1.0, range_m / kFullRange);
  const std::vector<Eigen::Vector2d> square = {{-half, -half}, {half, -half}, {half, half}, {-half, half}};
  const OwnLengths lengths = own_lengths(scene.largest, frame, is_point ? half : frame.enclosing_radius_m, range_m);
  const double clear_of_point = lengths.clear_m + 4 * half;
  const Surroundings near(scene, frame, is_point ? square : frame.polygon, -clear_of_point,
                          3 * (lengths.own_m + 3 * lengths.clear_m) + 4 * half, progress);
  double needed = 0, own = lengths.own_m;
  if (frame.all_sides) {
    // So high over a ridge that a small polygon about the point is clear of it, however it is turned. What is higher is
    // no surface that it lies on.
    if (const auto top = near.top_over(-clear_of_point, own)) needed = *top + clear_of_point;
    own = lengths.clear_m;
  }
  const double most = needed + own + 3 * lengths.clear_m;
  if (const auto top = near.top_over(needed - lengths.clear_m, needed + own)) {
    needed = std::max(needed, *top + lengths.clear_m);
  }
  // What hardly rises above the plane, beside the target as well, is cleared for the sake of its shadow.
  for (const double top : near.highest()) {
    if (top > needed + lengths.clear_m) break;
    needed = std::max(needed, top + lengths.clear_m);
  }
  // And a little, as polygons of several triangles are not flat to the last digit.
  return std::min(needed, most) + lengths.clear_m;
}

}  // namespace

std::vector<double> lifts_needed_m(const Scene& scene, const Target& target, double range_m,
                                   const core::ProgressReporter& progress) {
  std::vector<TargetFrame> frames;
  for (std::size_t part = 0; part < target.parts.size(); ++part) frames.push_back(make_target_frame(target, part));
  const SceneTriangles triangles(scene, progress);
  std::vector<double> needed(frames.size());
  parallel::for_ranges(frames.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t part = begin; part < end; ++part) {
      needed[part] = needed_of(triangles, frames[part], range_m, progress);
    }
  });
  return needed;
}

}  // namespace vantage::internal::prove

namespace vantage {

std::vector<double> lifts_needed_m(const Scene& scene, const Target& target, double range_m, const Progress& progress) {
  return internal::prove::lifts_needed_m(scene, target, range_m, internal::core::ProgressReporter(progress));
}

}  // namespace vantage
