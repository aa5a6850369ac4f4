#include "flight/tour/tour_schedule.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "core/portable_math.h"
#include "flight/gimbal.h"

namespace vantage::internal::flight::tour {
namespace {

/// Longer by so much than it must be, so that rounding of a view's ends does not make it too short.
constexpr double kLonger = 1 + 1e-9;

class Scheduler {
 public:
  Scheduler(const std::vector<Viewing>& viewings, const TourSettings& settings)
      : viewings_(viewings), settings_(settings), needed_(settings.vehicle.speed_m_s * settings.dwell_s * kLonger) {}

  std::vector<Scheduled> run() {
    hovers_.assign(viewings_.size(), false);
    for (std::size_t i = 0; i < viewings_.size(); ++i) hovers_[i] = !find(viewings_[i], {}, {});
    while (!try_all()) {
    }
    std::vector<Scheduled> result;
    for (std::size_t i = 0; i < viewings_.size(); ++i) {
      const auto [begin, end] = placed_[i];
      result.push_back({viewings_[i].target, begin, end, settings_.dwell_s});
    }
    std::stable_sort(result.begin(), result.end(),
                     [](const Scheduled& a, const Scheduled& b) { return a.begin_m < b.begin_m; });
    return result;
  }

 private:
  /// The first place for a view in passing, clear of others and of where the vehicle hovers.
  std::optional<Stretch> find(const Viewing& viewing, const std::vector<Stretch>& taken,
                              const std::vector<double>& hovering) const {
    for (const Stretch& stretch : viewing.stretches) {
      double begin = stretch.begin_m;
      for (bool moved = true; moved;) {
        moved = false;
        for (const Stretch& other : taken) {
          if (begin + needed_ <= other.begin_m || begin >= other.end_m) continue;
          begin = other.end_m;
          moved = true;
        }
        for (const double station : hovering) {
          if (begin + needed_ <= station || begin >= station) continue;
          begin = station;
          moved = true;
        }
      }
      if (begin + needed_ <= stretch.end_m) return Stretch{begin, begin + needed_};
    }
    return std::nullopt;
  }

  /// False where one more target must be hovered for.
  bool try_all() {
    placed_.assign(viewings_.size(), {});
    std::vector<double> hovering;
    for (std::size_t i = 0; i < viewings_.size(); ++i) {
      if (!hovers_[i]) continue;
      placed_[i] = {viewings_[i].stop_m, viewings_[i].stop_m};
      if (settings_.dwell_s > 0 && !settings_.simultaneous) hovering.push_back(viewings_[i].stop_m);
    }
    std::vector<std::size_t> passing;
    for (std::size_t i = 0; i < viewings_.size(); ++i) {
      if (!hovers_[i]) passing.push_back(i);
    }
    // What must end first comes first.
    std::stable_sort(passing.begin(), passing.end(), [&](std::size_t a, std::size_t b) {
      return viewings_[a].stretches.back().end_m < viewings_[b].stretches.back().end_m;
    });
    std::vector<Stretch> taken;
    for (const std::size_t i : passing) {
      const std::optional<Stretch> found = find(viewings_[i], taken, hovering);
      if (!found) {
        hovers_[i] = true;
        return false;
      }
      placed_[i] = *found;
      if (!settings_.simultaneous) taken.push_back(*found);
    }
    return true;
  }

  const std::vector<Viewing>& viewings_;
  const TourSettings& settings_;
  double needed_;
  std::vector<bool> hovers_;
  std::vector<Stretch> placed_;
};

/// Seconds to turn the camera from one target to another as the vehicle flies between two places.
double turning_seconds(const TourRequest& request, const Scheduled& from, const Vec3& at_from, const Scheduled& to,
                       const Vec3& at_to) {
  const std::optional<Vec3>&one = request.targets[from.target].look_at, &other = request.targets[to.target].look_at;
  if (!one || !other || request.settings.simultaneous) return 0;
  const Vec3 a = *one - at_from, b = *other - at_to;
  const double angle = portable::atan2(a.cross(b).norm(), a.dot(b));
  return angle * 180 / std::numbers::pi / request.settings.gimbal_rate_deg_s;
}

}  // namespace

Polyline::Polyline(std::vector<Vec3> points) : points_(std::move(points)) {
  stations_.push_back(0);
  for (std::size_t i = 0; i + 1 < points_.size(); ++i) {
    const double before = stations_.back(), station = before + (points_[i + 1] - points_[i]).norm();
    const bool is_lost = station == before && points_[i + 1] != points_[i];
    stations_.push_back(is_lost ? std::nextafter(before, std::numeric_limits<double>::infinity()) : station);
  }
}

Vec3 Polyline::at(double station_m) const {
  const auto after = std::upper_bound(stations_.begin(), stations_.end(), station_m);
  if (after == stations_.begin()) return points_.front();
  if (after == stations_.end()) return points_.back();
  const auto i = static_cast<std::size_t>(after - stations_.begin());
  const double share = (station_m - stations_[i - 1]) / (stations_[i] - stations_[i - 1]);
  return points_[i - 1] + share * (points_[i] - points_[i - 1]);
}

std::vector<Stretch> stretches_in(const TourRegion& region, const Polyline& way) {
  std::vector<Stretch> found;
  bool goes_on = false;  // the last one ends at the end of a leg
  for (std::size_t i = 0; i + 1 < way.points().size(); ++i) {
    const Leg leg = {way.points()[i], way.points()[i + 1]};
    const double begin = way.station(i), length = way.station(i + 1) - begin;
    const bool is_far = region.touch_bound_m(leg.from, leg.to) > length * (1 + 1e-9);
    bool ends_inside = false;
    for (const LegInterval& part : is_far ? std::vector<LegInterval>() : region.stretches(leg)) {
      const Stretch stretch = {begin + part.begin * length,
                               part.end == 1 ? way.station(i + 1) : begin + part.end * length};
      if (goes_on && part.begin == 0) {
        found.back().end_m = stretch.end_m;
      } else {
        found.push_back(stretch);
      }
      goes_on = false;
      ends_inside = part.end == 1;
    }
    goes_on = ends_inside;
  }
  return found;
}

std::vector<Stretch> stretches_followed(std::vector<Stretch> stretches, const Polyline& way, const TourTarget& target,
                                        const TourRequest& request) {
  const TourSettings& settings = request.settings;
  if (!target.look_at) return stretches;
  std::vector<Stretch> slow;
  for (std::size_t i = 0; i + 1 < way.points().size(); ++i) {
    const double begin = way.station(i), length = way.station(i + 1) - begin;
    for (const LegInterval& part :
         flight::slow_turns({way.points()[i], way.points()[i + 1]}, *target.look_at, settings.vehicle.speed_m_s,
                            settings.gimbal_rate_deg_s, {request.tube_m + kPlanRoundingM, 0})) {
      const Stretch next = {begin + part.begin * length,
                            part.end == 1 ? way.station(i + 1) : begin + part.end * length};
      if (!slow.empty() && slow.back().end_m == next.begin_m) {
        slow.back().end_m = next.end_m;
      } else {
        slow.push_back(next);
      }
    }
  }
  std::vector<Stretch> both;
  for (const Stretch& one : stretches) {
    for (const Stretch& other : slow) {
      const Stretch common = {std::max(one.begin_m, other.begin_m), std::min(one.end_m, other.end_m)};
      if (common.begin_m <= common.end_m) both.push_back(common);
    }
  }
  return both;
}

std::vector<Scheduled> schedule(const std::vector<Viewing>& viewings, const TourSettings& settings) {
  return Scheduler(viewings, settings).run();
}

double seconds_from_rest(double length_m, double speed_m_s, double acceleration_m_s2) {
  const double ramps = speed_m_s * speed_m_s / acceleration_m_s2;  // both, metres
  if (length_m <= ramps) return 2 * std::sqrt(length_m / acceleration_m_s2);
  return length_m / speed_m_s + speed_m_s / acceleration_m_s2;
}

double multirotor_seconds(const Flight& flight, const TourSettings& settings) {
  double seconds = 0, run = 0;
  Vec3 direction = Vec3::Zero();
  const auto rest = [&] {
    seconds += seconds_from_rest(run, settings.vehicle.speed_m_s, settings.vehicle.acceleration_m_s2);
    run = 0;
  };
  for (std::size_t i = 0; i < flight.points.size(); ++i) {
    seconds += flight.points[i].hold_s;
    if (i + 1 == flight.points.size()) break;
    const Vec3 along = flight.points[i + 1].position - flight.points[i].position;
    const double length = along.norm();
    if (flight.points[i].hold_s > 0) rest();
    if (!(length > 0)) continue;
    constexpr double kTurn = 1e-3;
    if (run > 0 && direction.cross(along / length).norm() + (direction.dot(along) < 0 ? 1 : 0) > kTurn) rest();
    run += length;
    direction = along / length;
  }
  rest();
  return seconds;
}

Scheduling flight_of(const Polyline& way, const std::vector<Scheduled>& scheduled, const TourRequest& request) {
  const TourSettings& settings = request.settings;
  // Stations of all points of the flight, without repeats.
  std::vector<std::pair<double, Vec3>> stations;
  for (std::size_t i = 0; i < way.points().size(); ++i) stations.emplace_back(way.station(i), way.points()[i]);
  for (const Scheduled& view : scheduled) {
    for (const double station : {view.begin_m, view.end_m}) stations.emplace_back(station, way.at(station));
  }
  std::stable_sort(stations.begin(), stations.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  const auto same = [](const auto& a, const auto& b) { return a.first == b.first; };
  stations.erase(std::unique(stations.begin(), stations.end(), same), stations.end());

  Scheduling result;
  for (const auto& [station, position] : stations) {
    FlightPoint point;
    point.position = position;
    if (!result.flight.points.empty()) point.speed_m_s = settings.vehicle.speed_m_s;
    result.flight.points.push_back(point);
  }
  const auto index_of = [&](double station) {
    const auto found = std::lower_bound(stations.begin(), stations.end(), station,
                                        [](const auto& a, double value) { return a.first < value; });
    return static_cast<std::size_t>(found - stations.begin());
  };
  for (std::size_t i = 0; i < scheduled.size(); ++i) {
    const Scheduled& view = scheduled[i];
    const std::size_t first = index_of(view.begin_m), last = index_of(view.end_m);
    if (i > 0) {
      const Scheduled& before = scheduled[i - 1];
      const double flying = std::max(0.0, view.begin_m - before.end_m) / settings.vehicle.speed_m_s;
      const double turning = turning_seconds(request, before, way.at(before.end_m), view, way.at(view.begin_m));
      result.flight.points[first].hold_s += std::max(0.0, turning - flying);
    }
    double& hold = result.flight.points[first].hold_s;
    if (first == last) hold = settings.simultaneous ? std::max(hold, view.dwell_s) : hold + view.dwell_s;
    result.visits.push_back({view.target, first, last, view.begin_m, view.end_m, view.dwell_s});
  }
  return result;
}

}  // namespace vantage::internal::flight::tour
