#include "flight/plans/geofence.h"

#include <algorithm>
#include <cmath>

#include "vantage/query.h"

namespace vantage::internal::flight::plans {
namespace {

/// What a fence has of a zone.
Zone fence_of(const Zone::Ring& ring) {
  Zone zone;
  zone.outer = ring;
  return zone;
}

/// The legs, circles and home of a flight, each with how far it reaches.
class FlownInPlan {
 public:
  explicit FlownInPlan(const FlightOut& flight) : flight_(flight) {}

  bool keeps(const Navigation& fence) const {
    const LegLimits limits(fence);
    const auto is_kept = [&](const Leg& leg, double reach_m) { return limits.broken(leg, reach_m).empty(); };
    if (flight_.home && !is_kept({*flight_.home, *flight_.home}, 0)) return false;
    const std::vector<FlightPoint>& points = flight_.flight.points;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double radius_m = flight_.actions.empty() ? 0 : std::abs(flight_.actions[i].loiter_radius_m);
      if (!is_kept({points[i].position, points[i].position}, radius_m)) return false;
      if (i > 0 && !is_kept({points[i - 1].position, points[i].position}, flight_.flight.chord_error_m)) return false;
    }
    return true;
  }

 private:
  const FlightOut& flight_;
};

}  // namespace

Geofence geofence_of(const FlightOut& flight) {
  const FlownInPlan flown(flight);
  Geofence fence;
  const auto stay_out = [&](const Zone::Ring& ring, const std::string& name) {
    Navigation limits;
    limits.keep_out = {fence_of(ring)};
    if (flown.keeps(limits)) {
      fence.stay_out.push_back(ring);
    } else if (std::find(fence.left_out.begin(), fence.left_out.end(), name) == fence.left_out.end()) {
      fence.left_out.push_back(name);
    }
  };
  Navigation inside;
  for (const Zone& zone : flight.keep_in) inside.keep_in.push_back(fence_of(zone.outer));
  if (!inside.keep_in.empty() && flown.keeps(inside)) {
    for (std::size_t i = 0; i < flight.keep_in.size(); ++i) {
      fence.stay_in.push_back(flight.keep_in[i].outer);
      for (const Zone::Ring& hole : flight.keep_in[i].holes) {
        stay_out(hole, "the hole of " + zone_name(flight.keep_in, i));
      }
    }
  } else {
    for (std::size_t i = 0; i < flight.keep_in.size(); ++i) fence.left_out.push_back(zone_name(flight.keep_in, i));
  }
  for (std::size_t i = 0; i < flight.keep_out.size(); ++i) {
    stay_out(flight.keep_out[i].outer, zone_name(flight.keep_out, i));
  }
  return fence;
}

}  // namespace vantage::internal::flight::plans
