#include "flight/tour/tour_views.h"

#include <algorithm>
#include <cstddef>
#include <vector>

#include "flight/gimbal.h"

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

FlightAction action_at(const Vec3& position, const MissionTourTarget& target) {
  FlightAction action;
  action.sees = target.name;
  if (target.is_volume) return action;
  const Aim aim = aim_at(position, target.centre);
  action.yaw_deg = aim.yaw_deg;
  action.gimbal_pitch_deg = aim.pitch_deg;
  action.photo = true;
  return action;
}

}  // namespace

void add_views(const MissionTour& of, FlightOut& out) {
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
    here.hold_s /= static_cast<double>(std::max<std::ptrdiff_t>(1, next - first));
    for (auto place = first; place != next; ++place) {
      out.flight.points.push_back(here);
      out.actions.push_back(action_at(here.position, of.targets[place->visit->target]));
    }
    for (; next != places.end() && next->point == i; ++next) {
      FlightPoint point = points[i + 1];
      point.position = points[i].position + next->share * (points[i + 1].position - points[i].position);
      point.hold_s = 0;
      out.flight.points.push_back(point);
      out.actions.push_back(action_at(point.position, of.targets[next->visit->target]));
    }
  }
}

}  // namespace vantage::internal::flight::tour
