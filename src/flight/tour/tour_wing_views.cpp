#include "flight/tour/tour_wing_views.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/portable_math.h"
#include "flight/gimbal.h"

namespace vantage::internal::flight::tour {
namespace {

constexpr double kPi = std::numbers::pi;

Vec3 direction_of_flight(const SpacePose& pose) {
  const auto [sine, cosine] = portable::sine_cosine(pose.heading_rad);
  const auto [rise, level] = portable::sine_cosine(pose.climb_rad);
  return {cosine * level, sine * level, rise};
}

double bell(SplitMix64& draw) { return draw.unit() + draw.unit() + draw.unit() + draw.unit() - 2; }  // -2 to 2

}  // namespace

SpacePose leave(const View& view) {
  SpacePose pose = view.enter;
  pose.position += view.straight_m * direction_of_flight(pose);
  return pose;
}

WingSpace::WingSpace(const TourRequest& request, const Regions& regions) : request_(request), regions_(regions) {
  const TourVehicle& vehicle = request.settings.vehicle;
  limits_ = {vehicle.turn_radius_m, vehicle.min_climb_deg * kPi / 180, vehicle.max_climb_deg * kPi / 180};
  view_m_ = vehicle.speed_m_s * request.settings.dwell_s * (1 + 1e-9);
}

bool WingSpace::is_allowed(const std::vector<Vec3>& points, double deviation) const {
  if (!request_.airspace) return true;
  if (points.size() == 1) return request_.airspace->allows({points[0], points[0]}, deviation);
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    if (!request_.airspace->allows({points[i], points[i + 1]}, deviation)) return false;
  }
  return true;
}

int WingSpace::circle_pieces() const {
  const double step = std::sqrt(8 * request_.chord_error_m / limits_.turn_radius_m);  // k s^2 / 8, in radians
  return static_cast<int>(std::ceil(std::max(3.0, 2 * kPi / step)));
}

std::vector<Vec3> WingSpace::chords(const View& view) const {
  if (view.circles_m <= 0) {
    const Vec3 end = leave(view).position;
    return end == view.enter.position ? std::vector<Vec3>{end} : std::vector<Vec3>{view.enter.position, end};
  }
  const double radius = limits_.turn_radius_m;
  const int pieces = circle_pieces();
  const Vec3 ahead = direction_of_flight(view.enter), out = view.side * Vec3(ahead.y(), -ahead.x(), 0);
  const Vec3 centre = view.enter.position - radius * out;
  std::vector<Vec3> points;
  for (int i = 0; i < pieces; ++i) {
    const auto [sine, cosine] = portable::sine_cosine(2 * kPi * i / pieces);
    points.push_back(centre + radius * (cosine * out + sine * ahead));
  }
  points[0] = view.enter.position;
  points.push_back(points[0]);
  return points;
}

std::vector<Vec3> WingSpace::chords(const DubinsAirplanePath& path, const View& from, const View& to) const {
  std::vector<Vec3> points;
  for (const double station : path.stations(request_.chord_error_m)) points.push_back(path.at(station).position);
  points.front() = leave(from).position;
  points.back() = to.enter.position;
  return points;
}

bool WingSpace::is_valid(const View& view) const {
  if (view.enter.climb_rad < limits_.lowest_climb_rad || view.enter.climb_rad > limits_.highest_climb_rad) return false;
  const std::vector<Vec3> points = chords(view);
  if (view.region != Stop::kFixed) {
    const TourRegion& region = *regions_[static_cast<std::size_t>(view.region)];
    if (!region.holds(points.front()) || !region.holds(points.back())) return false;
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
      if (!region.holds_leg({points[i], points[i + 1]})) return false;
    }
  }
  if (!can_follow(view.region, points, direction_of_flight(view.enter))) return false;
  return is_allowed(points, request_.chord_error_m);
}

bool WingSpace::can_follow(int region, const std::vector<Vec3>& points, const Vec3& direction) const {
  if (region == Stop::kFixed) return true;
  const std::optional<Vec3>& to = request_.targets[static_cast<std::size_t>(region)].look_at;
  if (!to) return true;
  constexpr double kPoint = 1e-3;
  const double reach = request_.chord_error_m + request_.tube_m + kPlanRoundingM;
  const auto is_slow = [&](const Leg& leg, double chord_error_m) {
    return flight::fastest_turn_deg_s(leg, *to, request_.settings.vehicle.speed_m_s,
                                      flight::off_chord(leg, reach, chord_error_m)) <=
           request_.settings.gimbal_rate_deg_s;
  };
  if (points.size() == 1) return is_slow({points[0] - kPoint * direction, points[0] + kPoint * direction}, 0);
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    if (!is_slow({points[i], points[i + 1]}, request_.chord_error_m)) return false;
  }
  return true;
}

View WingSpace::drawn(int region, const ViewHint& hint, SplitMix64& draw) const {
  const TourRegion& shape = *regions_[static_cast<std::size_t>(region)];
  View view;
  view.region = region;
  Vec3 place = hint.place;
  if (hint.spread >= 1 && draw.unit() < 0.3) {
    place = shape.anchors()[draw.below(shape.anchors().size())];
  } else {
    place += 0.25 * hint.spread * shape.size_m() * Vec3(bell(draw), bell(draw), 0.5 * bell(draw));
  }
  if (!shape.holds(place)) place = shape.touch(place, place);
  const double turn = hint.spread >= 1 && draw.unit() < 0.5 ? kPi : 0;
  view.enter.heading_rad = hint.heading_rad + turn + 0.75 * kPi * std::min(1.0, hint.spread) * bell(draw);
  view.enter.position = place;
  view.straight_m = view_m_;
  if (view_m_ > 0) view.enter.position -= draw.unit() * view_m_ * direction_of_flight(view.enter);
  return view;
}

std::vector<View> WingSpace::draw_views(int region, const ViewHint& hint, std::size_t count, SplitMix64& draw) const {
  std::vector<View> views;
  const std::size_t most = 30 * count;
  for (std::size_t i = 0; i < most && views.size() < count; ++i) {
    ViewHint near = hint;
    near.spread = std::min(hint.spread, 0.05 + 2.0 * static_cast<double>(i) / static_cast<double>(most));
    if (hint.spread >= 1 && i > most / 2) near.spread = 1;
    const View view = drawn(region, near, draw);
    if (is_valid(view)) views.push_back(view);
  }
  if (!views.empty() || view_m_ <= 0) return views;
  // The chords are long enough, too.
  const double round = 2 * kPi * limits_.turn_radius_m;
  const double chords = 2 * limits_.turn_radius_m * circle_pieces() * portable::sin(kPi / circle_pieces());
  for (std::size_t i = 0; i < most && views.size() < count; ++i) {
    View view = drawn(region, hint, draw);
    view.straight_m = 0;
    view.circles_m = std::ceil(view_m_ / chords) * round;
    view.side = draw.unit() < 0.5 ? 1 : -1;
    // The drawn place is the middle.
    const Vec3 ahead = direction_of_flight(view.enter);
    const Vec3 middle = regions_[static_cast<std::size_t>(region)]->touch(view.enter.position, view.enter.position);
    view.enter.position = middle + limits_.turn_radius_m * view.side * Vec3(ahead.y(), -ahead.x(), 0);
    if (is_valid(view)) views.push_back(view);
  }
  return views;
}

std::optional<DubinsAirplanePath> WingSpace::path(const View& from, const View& to) const {
  return dubins_airplane(leave(from), to.enter, limits_);
}

double WingSpace::path_m(const View& from, const View& to) const {
  const std::optional<DubinsAirplanePath> found = path(from, to);
  return found ? found->length_m() : std::numeric_limits<double>::infinity();
}

double WingSpace::path_bound_m(const View& from, const View& to) const {
  const SpacePose a = leave(from), &b = to.enter;
  // A path with wider arcs is no shorter: the ones of the turn radius could follow it.
  const double above = shortest_dubins({a.position.x(), a.position.y(), a.heading_rad},
                                       {b.position.x(), b.position.y(), b.heading_rad}, limits_.turn_radius_m)
                           .length_m();
  return std::hypot(above, b.position.z() - a.position.z());
}

bool WingSpace::is_clear(const View& from, const View& to) const {
  const bool is_looking = from.region != Stop::kFixed && to.region != Stop::kFixed && !request_.settings.simultaneous;
  if (!request_.airspace && !is_looking) return true;
  const std::optional<DubinsAirplanePath> found = path(from, to);
  if (!found) return false;
  if (is_looking) {
    const std::optional<Vec3>&one = request_.targets[static_cast<std::size_t>(from.region)].look_at,
          &other = request_.targets[static_cast<std::size_t>(to.region)].look_at;
    if (one && other) {
      const Vec3 a = *one - leave(from).position, b = *other - to.enter.position;
      const double degrees = portable::atan2(a.cross(b).norm(), a.dot(b)) * 180 / kPi;
      const double seconds = found->length_m() / request_.settings.vehicle.speed_m_s;
      if (degrees > seconds * request_.settings.gimbal_rate_deg_s) return false;
    }
  }
  return !request_.airspace || is_allowed(chords(*found, from, to), request_.chord_error_m);
}

}  // namespace vantage::internal::flight::tour
