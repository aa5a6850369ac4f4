// The best closed curve in a volume by one measure: branch and bound over centres, heights, radii and, for racetracks,
// straights and headings.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "flight/box_search.h"
#include "flight/closed_curve.h"
#include "flight/solid_depth.h"
#include "vantage/geometry.h"
#include "vantage/standpoints.h"

namespace vantage::internal::flight {

/// How deep all of a curve lies in a solid. Curves are about the solid's origin.
class CurveDepth {
 public:
  explicit CurveDepth(const SolidDepth& solid) : solid_(solid) {}

  /// No more than the smallest depth, and less by `error_m` > 0 and rounding at most; minus infinity where it is less
  /// than `needed`, which is more than 0. Chords are compared with the facets; they are as far from the arcs as the
  /// error.
  double depth_m(const ClosedCurve& curve, double error_m, double needed) const;
  const SolidDepth& solid() const { return solid_; }

 private:
  const SolidDepth& solid_;
};

/// What curves are asked for. Lengths are metres, about the solid's origin.
struct CurveRequest {
  OrbitKind kind = OrbitKind::deepest;
  OrbitCentre centre = OrbitCentre::around_target;
  Vec3 target = Vec3::Zero();
  double least_radius_m = 0, most_radius_m = 0;  ///< 0 < least <= most
  double most_half_straight_m = 0;               ///< 0: circles alone
  double margin_m = 0;                           ///< > 0: curves count that are so deep
  double slack_m = 0;                            ///< the bound is of curves that are so much deeper than that
  double error_m = 0;                            ///< > 0: depths of curves may be so much too small
  SearchLimits limits;                           ///< the tolerance is of the value
  /// For OrbitKind::finest_pixel: the value at a point, or no more than that of any point within reach; the smaller the
  /// better.
  std::function<double(const Vec3& point, double reach_m)> pixel_m;
  std::function<bool(const ClosedCurve&)> is_inside;  ///< asked of each curve before it counts
};

class OrbitSearch {
 public:
  OrbitSearch(const CurveDepth& depth, CurveRequest request);

  /// `known`: a curve to begin with, where there is one; it counts if it keeps the margin.
  void run(const std::optional<ClosedCurve>& known, const core::ProgressReporter& progress);

  const std::optional<ClosedCurve>& curve() const { return curve_; }
  /// What is made as large as possible: the radius, the depth, or minus the logarithm of the pixel.
  double best() const { return best_; }
  const SearchEnd& end() const { return end_; }
  double bound_of(const SearchBox<6>& box);

 private:
  using Numbers = std::array<double, 6>;  ///< centre x, y and z; radius; half of a straight; its angle times scale

  struct Place {
    Vec3 point, reach;
    double at_least = 0;  ///< no more than the depth of the point
  };

  ClosedCurve curve_at(const Numbers& numbers) const;
  double reach_of(const SearchBox<6>& box) const;
  bool may_hold_target(const ClosedCurve& curve, const SearchBox<6>& box) const;
  SolidDepth::Bounded depth_bound(const ClosedCurve& curve, const SearchBox<6>& box, double interesting) const;
  std::vector<Place> places_on(const ClosedCurve& curve, const SearchBox<6>& box, std::size_t count) const;
  bool may_be_better(const ClosedCurve& curve, double depth) const;
  double pixel_value(const ClosedCurve& curve, double reach, std::size_t count) const;
  double allowed_value(ClosedCurve& curve) const;
  void moved_to_target(ClosedCurve& curve) const;
  void offer(const Numbers& numbers, double step);
  void polish();

  const CurveDepth& depth_;
  CurveRequest request_;
  double angle_scale_ = 1;  ///< metres for a radian: angles are halved as lengths are
  SearchEnd end_;
  std::optional<ClosedCurve> curve_;
  double best_ = -std::numeric_limits<double>::infinity();
};

}  // namespace vantage::internal::flight
