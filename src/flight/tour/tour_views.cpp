#include "flight/tour/tour_views.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include "flight/gimbal.h"
#include "flight/tour/mission_positions.h"
#include "flight/view_aim.h"

namespace vantage::internal::flight::tour {
namespace {

/// On the leg behind a point of the flight; a share of 0 is the point itself.
struct ViewPlace {
  std::size_t point = 0;
  double share = 0;
  const TourVisit* visit = nullptr;
};

ViewPlace place_of(const TourVisit& visit, const Flight& flight) {
  const std::vector<FlightPoint>& points = flight.points;
  ViewPlace place = {visit.first_point, 0, &visit};
  double longest_s = 0, length_m = 0;
  for (std::size_t i = visit.first_point; i <= visit.last_point; ++i) {
    if (i > visit.first_point) length_m += (points[i].position - points[i - 1].position).norm();
    if (points[i].hold_s <= longest_s) continue;
    longest_s = points[i].hold_s;
    place.point = i;
  }
  if (longest_s > 0) return place;
  double left_m = length_m / 2;
  for (std::size_t i = visit.first_point; i < visit.last_point; ++i) {
    const double leg_m = (points[i + 1].position - points[i].position).norm();
    if (left_m < leg_m) return {i, left_m / leg_m, &visit};
    left_m -= leg_m;
  }
  place.point = visit.last_point;
  return place;
}

/// The direction of the camera's axis, of unit length.
Vec3 camera_axis(const Aim& aim) {
  constexpr double kRadian = std::numbers::pi / 180;
  const double yaw = aim.yaw_deg * kRadian, pitch = aim.pitch_deg * kRadian;
  return {std::sin(yaw) * std::cos(pitch), std::cos(yaw) * std::cos(pitch), std::sin(pitch)};
}

class PhotoActions {
 public:
  PhotoActions(const MissionTour& of, const Mission& mission)
      : of_(of), each_(each_of(mission)), is_wing_(of.settings.vehicle.kind == TourVehicle::Kind::fixed_wing) {}

  FlightAction action_at(const Vec3& position, std::size_t number) const {
    const MissionTourTarget& target = of_.targets[number];
    FlightAction action;
    action.sees = target.name;
    if (target.is_volume) return action;
    action.photo = true;
    const AimedCamera camera = ViewAim(each_[number]).at(position, target.centre);
    if (is_wing_) {
      const double distance_m = (target.centre - position).norm();
      action.look_at = camera.is_centred ? target.centre : position + distance_m * camera_axis(camera.aim);
    } else {
      action.yaw_deg = camera.aim.yaw_deg;
      action.gimbal_pitch_deg = camera.aim.pitch_deg;
    }
    return action;
  }

  /// For the camera to turn from one photo to the next one of a place.
  double turn_s(const FlightAction& from, const FlightAction& to) const {
    if (!from.yaw_deg || !to.yaw_deg) return 0;
    const Vec3 a = camera_axis({*from.yaw_deg, *from.gimbal_pitch_deg}),
               b = camera_axis({*to.yaw_deg, *to.gimbal_pitch_deg});
    return std::atan2(a.cross(b).norm(), a.dot(b)) * 180 / std::numbers::pi / of_.settings.gimbal_rate_deg_s;
  }

 private:
  const MissionTour& of_;
  std::vector<Mission> each_;
  bool is_wing_;
};

}  // namespace

void add_views(const MissionTour& of, const Mission& mission, FlightOut& out) {
  const PhotoActions photos(of, mission);
  const std::vector<FlightPoint>& points = of.tour.flight.points;
  std::vector<ViewPlace> places;
  for (const TourVisit& visit : of.tour.visits) places.push_back(place_of(visit, of.tour.flight));
  std::stable_sort(places.begin(), places.end(), [](const ViewPlace& a, const ViewPlace& b) {
    return a.point < b.point || (a.point == b.point && a.share < b.share);
  });
  out.flight.points.clear();
  out.actions.clear();
  auto next = places.begin();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto first = next;
    while (next != places.end() && next->point == i && next->share == 0) ++next;
    FlightPoint here = points[i];
    if (first == next) {
      out.flight.points.push_back(here);
      out.actions.emplace_back();
    }
    const double share_s = here.hold_s / static_cast<double>(std::max<std::ptrdiff_t>(1, next - first));
    for (auto place = first; place != next; ++place) {
      const FlightAction action = photos.action_at(here.position, place->visit->target);
      here.hold_s = std::max(share_s, place == first ? 0 : photos.turn_s(out.actions.back(), action));
      out.flight.points.push_back(here);
      out.actions.push_back(action);
    }
    for (; next != places.end() && next->point == i; ++next) {
      FlightPoint point = points[i + 1];
      point.position = points[i].position + next->share * (points[i + 1].position - points[i].position);
      point.hold_s = 0;
      out.flight.points.push_back(point);
      out.actions.push_back(photos.action_at(point.position, next->visit->target));
    }
  }
}

std::optional<std::string> note_of_pitches(const MissionTour& of, const Mission& mission) {
  FlightOut out;
  add_views(of, mission, out);
  AskedPitches asked;
  for (std::size_t i = 0; i < out.actions.size(); ++i) {
    const FlightAction& action = out.actions[i];
    if (action.gimbal_pitch_deg) asked.add(*action.gimbal_pitch_deg);
    if (action.look_at) asked.add(aim_at(out.flight.points[i].position, *action.look_at).pitch_deg);
  }
  return asked.note(mission);
}

}  // namespace vantage::internal::flight::tour
