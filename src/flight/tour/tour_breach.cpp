#include "flight/tour/tour_breach.h"

#include <algorithm>
#include <string>

#include "vantage/error.h"

namespace vantage::internal::flight::tour {

std::vector<Breach> breaches_of_legs(const Tour& tour, const TourRequest& request, double deviation_m) {
  std::vector<Breach> breaches;
  if (!request.airspace) return breaches;
  const Flight& flight = tour.flight;
  for (std::size_t i = 0; i < flight.leg_count(); ++i) {
    if (!request.airspace->allows(flight.leg(i), deviation_m)) breaches.push_back({i});
  }
  if (flight.points.size() != 1) return breaches;
  const Vec3& only = flight.points.front().position;
  if (!request.airspace->allows({only, only}, deviation_m)) breaches.push_back({});
  return breaches;
}

void check_has_visits(const Tour& tour) {
  if (tour.visits.empty()) throw Error(ErrorCode::internal_defect, "a tour breaks its own limits", "", "");
}

TourProblem problem_of(const Tour& tour, const Breach& breach, const TourRequest& request, double deviation_m) {
  using Kind = TourProblem::Kind;
  const auto obstacle = [&](const Leg& leg) {
    return request.airspace ? request.airspace->obstacle(leg, deviation_m) : std::string();
  };
  const std::vector<TourVisit>& visits = tour.visits;
  if (!breach.leg) {
    const TourVisit& visit = visits[breach.visit];
    const Vec3& place = tour.flight.points[visit.first_point].position;
    return {Kind::no_place, visit.target, std::nullopt, obstacle({place, place})};
  }
  const std::size_t leg = *breach.leg;
  const auto next = std::find_if(visits.begin(), visits.end(), [&](const TourVisit& v) { return v.last_point > leg; });
  const TourVisit& gone = next != visits.end() ? *next : visits.back();
  std::optional<std::size_t> neighbour;
  for (const TourVisit& visit : visits) {
    if (visit.last_point <= leg && visit.target != gone.target) neighbour = visit.target;
  }
  const bool is_viewed = gone.first_point <= leg && leg < gone.last_point;
  const bool is_alone = !neighbour && !request.home;
  if (is_viewed || is_alone) return {Kind::no_place, gone.target, std::nullopt, obstacle(tour.flight.leg(leg))};
  return {Kind::no_way, gone.target, neighbour, obstacle(tour.flight.leg(leg))};
}

}  // namespace vantage::internal::flight::tour
