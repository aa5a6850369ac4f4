// A sequence of points, each in the region that it serves: the way of a multirotor without obstacles.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "flight/tour/tour_region.h"
#include "vantage/geometry.h"

namespace vantage::internal::flight::tour {

struct Stop {
  static constexpr int kFixed = -1;  ///< home

  int region = kFixed;
  Vec3 point = Vec3::Zero();  ///< of the region
};

/// What a tour looks like as a whole.
struct CourseKind {
  bool closed = true;                           ///< it ends where it begins
  std::optional<Vec3> home = std::nullopt;  ///< it begins there
};

struct Course {
  bool closed = true;
  std::vector<Stop> stops;  ///< home comes first, if there is one

  std::size_t first_free() const { return !stops.empty() && stops[0].region == Stop::kFixed ? 1 : 0; }
  /// Neighbours; null at the ends of a course that is open.
  const Vec3* before(std::size_t i) const;
  const Vec3* after(std::size_t i) const;
  double length_m() const;
};

/// Moves every stop in its region where the way past it is shortest, one after the other. Returns the length then.
/// `smoothing_m`: see TourRegion::touch.
double settle_once(Course& course, const Regions& regions, double smoothing_m);
/// One stop.
void settle_stop(Course& course, const Regions& regions, std::size_t i, double smoothing_m);

/// settle_once until it gains nothing, with less and less smoothing. The length is that of the course with the best
/// points seen. In convex regions that is the shortest one of this order, but for some 1e-6 of it.
Course settled(const Course& course, const Regions& regions);

/// Where a region joins a course with the least detour.
struct Place {
  std::size_t before = 0;  ///< it comes before this stop; the number of stops: last
  Vec3 point = Vec3::Zero();
  double detour_m = 0;
};
/// `skip`: this many of the promising places are passed over, to try others. The course must have a stop.
Place best_place(const Course& course, const TourRegion& region, std::size_t skip = 0);
void insert(Course& course, int region, const Place& place);

/// Reverses parts and moves stops, up to three at a time, while that shortens the way between the points as they are
/// (2-opt and Or-opt). Returns whether anything changed.
bool exchange(Course& course);

}  // namespace vantage::internal::flight::tour
