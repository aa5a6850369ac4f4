// When which target is viewed along a way that is given, and how long it takes.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "flight/tour/tour_course.h"
#include "vantage/tour.h"

namespace vantage::internal::flight::tour {

/// A polyline, with where it is after each point. Points that differ are at different stations, also where they are
/// nearer to each other than rounding of a long way.
class Polyline {
 public:
  explicit Polyline(std::vector<Vec3> points);

  const std::vector<Vec3>& points() const { return points_; }
  double length_m() const { return stations_.back(); }
  double station(std::size_t point) const { return stations_[point]; }
  Vec3 at(double station_m) const;

 private:
  std::vector<Vec3> points_;
  std::vector<double> stations_;
};

struct Stretch {
  double begin_m = 0, end_m = 0;  ///< stations
};

/// The parts of the way that are in a region for sure. Sorted.
std::vector<Stretch> stretches_in(const TourRegion& region, const Polyline& way);

/// Those of the stretches that are flown so slowly, at the vehicle's speed, that the camera can follow the target.
std::vector<Stretch> stretches_followed(std::vector<Stretch> stretches, const Polyline& way, const TourTarget& target,
                                        const TourRequest& request);

/// A target to be viewed, and where its stop is.
struct Viewing {
  std::size_t target = 0;
  double stop_m = 0;               ///< station of a point of the region
  std::vector<Stretch> stretches;  ///< stretches_in
};

struct Scheduled {
  std::size_t target = 0;
  double begin_m = 0, end_m = 0;  ///< equal: hovering
  double dwell_s = 0;
};

/// In the order of their beginning; hovering ones at the same place in the order of `viewings`. In passing only where a
/// stretch is as long as the dwell at full speed, with nobody else viewed meanwhile, unless `simultaneous`.
std::vector<Scheduled> schedule(const std::vector<Viewing>& viewings, const TourSettings& settings);

/// Seconds that a vehicle takes from rest to rest over `length_m`: it speeds up, keeps its speed, slows down.
double seconds_from_rest(double length_m, double speed_m_s, double acceleration_m_s2);

/// The duration of a multirotor's flight: from rest to rest between the points where it holds or turns by more than
/// 1e-3 radians.
double multirotor_seconds(const Flight& flight, const TourSettings& settings);

/// The flight along the way, with a point wherever a view begins and ends, and the visits. Where turning the camera
/// from one target to the next one takes longer than flying, the vehicle waits before.
struct Scheduling {
  Flight flight;
  std::vector<TourVisit> visits;
};
Scheduling flight_of(const Polyline& way, const std::vector<Scheduled>& scheduled, const TourRequest& request);

}  // namespace vantage::internal::flight::tour
