// What of a tour does not keep its limits, and which target to leave out because of it.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "vantage/tour.h"

namespace vantage::internal::flight::tour {

/// One leg of the flight, or one visit.
struct Breach {
  std::optional<std::size_t> leg = std::nullopt;
  std::size_t visit = 0;  ///< where it is no leg: of Tour::visits
};

/// Legs that the airspace of the request does not allow; of a flight that is one point, its first visit.
std::vector<Breach> breaches_of_legs(const Tour& tour, const TourRequest& request, double deviation_m);

/// Where a tour without visits breaks a limit nothing can be left out: throws Error(internal_defect).
void check_has_visits(const Tour& tour);

/// The problem of the target that is viewed on a leg, or next, else last; or that is visited. For a tour with a visit.
TourProblem problem_of(const Tour& tour, const Breach& breach, const TourRequest& request, double deviation_m);

}  // namespace vantage::internal::flight::tour
