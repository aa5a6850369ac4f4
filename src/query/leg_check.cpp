#include "query/leg_check.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "vantage/error.h"

namespace vantage::internal::query {

void check_leg(const Leg& leg, double radius_m, std::size_t index) {
  constexpr double kFarthest = 1e9;  // as scenes
  const std::string place = "leg " + std::to_string(index);
  if (!leg.from.allFinite() || !leg.to.allFinite()) {
    throw Error(ErrorCode::coordinate_not_finite, "an end of the leg is not finite", place, "give three numbers");
  }
  if (std::max(leg.from.cwiseAbs().maxCoeff(), leg.to.cwiseAbs().maxCoeff()) > kFarthest) {
    throw Error(ErrorCode::coordinate_too_large, "an end of the leg is farther than 1e9 m from the origin", place,
                "use metres about an origin near the scene");
  }
  if (!(radius_m >= 0) || radius_m > kFarthest) {
    throw Error(ErrorCode::value_out_of_range, "the radius about a leg is negative, too large or not a number", place,
                "give 0 metres or more");
  }
}

}  // namespace vantage::internal::query
