// What of a flight is linked: docs/theory.md, "Along a leg".
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "flight/flight_timeline.h"
#include "vantage/flight_check.h"
#include "vantage/mission.h"
#include "vantage/query.h"
#include "vantage/scene.h"

namespace vantage::internal::flight {

/// One link of a mission, ready for the legs of one flight.
class JudgedLink {
 public:
  /// Throws as PreparedTarget does for a point that a link cannot begin at. `place`: where it is written, for errors.
  JudgedLink(const FlightLink& link, const PreparedScene& scene, const std::vector<Leg>& legs, double radius_m,
             const std::string& place);

  LegView look(const Leg& leg, double radius_m) const { return views_.look(leg, radius_m); }

  /// `views`: of each leg.
  LinkCheck check(const std::vector<LegView>& views, const std::vector<Leg>& legs, const FlightTimeline& along,
                  double radius_m) const;

 private:
  FlightLink link_;
  LegViews views_;
};

/// Why a link does not hold everywhere, a sentence; nothing where it does.
std::optional<std::string> failure_of(const LinkCheck& link);

}  // namespace vantage::internal::flight
