// The volume of a target as the search for a tour asks it: where is it touched with the least detour, and does a leg
// stay in it.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/bvh.h"
#include "core/progress_reporter.h"
#include "core/triangle_tree.h"
#include "vantage/flight.h"
#include "vantage/geometry.h"
#include "vantage/tour.h"

namespace vantage::internal::flight::tour {

/// Plans round positions, and are put into the frame again: what only just keeps a limit must keep it then, too.
constexpr double kPlanRoundingM = 0.01;

/// So far from the flight all must hold: the tube, with what plans round.
inline double reach_m(const TourSettings& settings) {
  return settings.tube_m > 0 ? settings.tube_m + kPlanRoundingM : 0;
}

/// What lies at least a margin inside a closed mesh: of several pieces, of any genus. Immutable; any number of threads
/// may ask one. It holds every point that it returns. Scene frame, metres.
///
/// The depth of a point is its distance to the nearest triangle, if the mesh winds round it at least once. Where pieces
/// overlap, triangles inside count too: on the safe side.
class TourRegion {
 public:
  /// Copies the mesh. Throws Error(input) with `name` as the place for a mesh that is empty, not closed, not oriented,
  /// inside out or not finite, and where no point of it is `margin_m` from its surface. Cost: O(n log n).
  TourRegion(std::string name, const Mesh& volume, double margin_m);
  TourRegion(const TourRegion&) = delete;
  TourRegion& operator=(const TourRegion&) = delete;

  const std::string& name() const { return name_; }
  double margin_m() const { return margin_; }
  /// Around all of it; no point of it is outside.
  const Box& box() const { return box_; }
  /// Points of it, the deepest one found first. At least one.
  const std::vector<Vec3>& anchors() const { return anchors_; }
  /// The largest distance of two points, about.
  double size_m() const { return size_; }

  /// The distance to the mesh: positive inside, negative outside.
  double depth_m(const Vec3& point) const { return depth(point - origin_); }
  /// Whether its depth is at least the margin, and a little more for what rounding does to points of a map.
  bool holds(const Vec3& point) const { return depth(point - origin_) >= least_depth_; }

  /// A point of it with a small |a - x| + |x - b|: the least one where the region is convex, else a local minimum near
  /// the least one of the whole mesh. With `smoothing_m` > 0 that is the length of a way whose corners are so far off
  /// the plane of the picture: so points that lie on each other still pull each other along.
  /// `known`, a point of it, is returned where nothing better is found. Cost: some ten microseconds.
  Vec3 touch(const Vec3& a, const Vec3& b, double smoothing_m = 0, const Vec3* known = nullptr) const;

  /// No point x of it has a smaller |a - x| + |x - b|. Cheap: from its box. Metres.
  double touch_bound_m(const Vec3& a, const Vec3& b) const;

  /// The parts of a leg that are in it for sure, in order. What is less than `kGrain` of the region's size deeper than
  /// the margin may be left out.
  std::vector<LegInterval> stretches(const Leg& leg) const;
  /// Whether all of a leg is in it for sure. Any part of a leg's stretch is.
  bool holds_leg(const Leg& leg) const;

  static constexpr double kGrain = 1e-5;

 private:
  struct Surface {
    Vec3 nearest;  ///< of the mesh
    Vec3 inward;   ///< unit, towards more depth
    double depth;
  };
  using Corners = std::array<Vec3, 3>;

  double depth(const Vec3& point) const;
  double signed_depth(double distance, const Vec3& point) const;
  /// The parts of a leg that are at least `least` deep for sure, but for some that are less than `grain` deeper.
  std::vector<LegInterval> parts_deeper(const Leg& leg, double least, double grain) const;
  Surface surface_at(const Vec3& point) const;
  Vec3 touch_of_mesh(const Vec3& a, const Vec3& b, double smoothing) const;
  std::optional<Vec3> on_segment(const Vec3& a, const Vec3& b) const;
  std::optional<Vec3> first_inside(const Vec3& from, const Vec3& to) const;
  std::optional<Vec3> by_cuts(const Vec3& start, const Vec3& a, const Vec3& b, double smoothing) const;
  Vec3 descend(const Vec3& start, const Vec3& a, const Vec3& b, double smoothing) const;
  Vec3 from_anchors(const Vec3& towards, const Vec3& a, const Vec3& b) const;
  void find_anchors();
  void add_anchor(const Vec3& point);

  std::string name_;
  Vec3 origin_ = Vec3::Zero();  ///< the mesh is about it
  Mesh mesh_;
  core::TriangleTree tree_;
  std::vector<Corners> corners_;  ///< in the order of the leaves of `bvh_`
  core::Bvh bvh_;
  double margin_ = 0, size_ = 0, rounding_ = 0;
  double least_depth_ = 0;   ///< of points of the scene frame
  double sought_depth_ = 0;  ///< about the origin: points are still as deep as they must be when they are moved back
  Box box_;
  std::vector<Vec3> anchors_;  ///< scene frame
};

using Regions = std::vector<std::unique_ptr<const TourRegion>>;

/// The regions of all targets of a tour, `margin_m` deep. Throws as TourRegion does, for the first target that is
/// wrong.
Regions make_regions(const std::vector<TourTarget>& targets, double margin_m, const core::ProgressReporter& progress);

}  // namespace vantage::internal::flight::tour
