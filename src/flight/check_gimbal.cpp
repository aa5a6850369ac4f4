#include "flight/check_gimbal.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

namespace vantage::internal::flight {

GimbalUse GimbalCheck::use(const Stretch& stretch, const Vec3& centre) const {
  GimbalUse use;
  const FlightSpan span = along_.span(stretch);
  use.begin_yaw_deg = aim_at(span.begin, centre).yaw_deg;
  use.end_yaw_deg = aim_at(span.end, centre).yaw_deg;
  use.min_pitch_deg = std::numeric_limits<double>::infinity();
  use.max_pitch_deg = -use.min_pitch_deg;
  for (std::size_t leg = stretch.begin_leg; leg <= stretch.end_leg; ++leg) {
    const Leg piece = {along_.position(leg, leg == stretch.begin_leg ? stretch.begin_share : 0),
                       along_.position(leg, leg == stretch.end_leg ? stretch.end_share : 1)};
    const PitchRange pitch = pitch_range(piece, centre, radius_m_);
    use.min_pitch_deg = std::min(use.min_pitch_deg, pitch.min_deg);
    use.max_pitch_deg = std::max(use.max_pitch_deg, pitch.max_deg);
    if (!along_.has_legs()) continue;
    const double rate = fastest_turn_deg_s(piece, centre, along_.speed_m_s(leg), off(leg));
    if (!std::isnan(use.rate_deg_s) && !(rate <= use.rate_deg_s)) use.rate_deg_s = rate;  // NaN stays
  }
  return use;
}

std::optional<FlightSpan> GimbalCheck::followed(const std::vector<std::vector<LegInterval>>& seen, const Vec3& centre,
                                                double rate_deg_s) const {
  std::vector<Stretch> stretches;
  for (std::size_t leg = 0; leg < seen.size(); ++leg) {
    std::vector<LegInterval> slow = {{0, 1}};
    if (along_.has_legs()) {
      slow = slow_turns(path_.leg(leg), centre, along_.speed_m_s(leg), rate_deg_s, off(leg));
      // Where it stays nothing turns, however fast it comes and goes.
      if (path_.points[leg].hold_s > 0) slow.push_back({0, 0});
      if (path_.points[leg + 1].hold_s > 0) slow.push_back({1, 1});
      slow = united(std::move(slow));
    }
    append(stretches, leg, in_both(seen[leg], slow));
  }
  std::optional<FlightSpan> longest;
  for (const FlightSpan& span : spans_of(along_, stretches)) {
    if (!longest || span.duration_s() > longest->duration_s()) longest = span;
  }
  return longest;
}

}  // namespace vantage::internal::flight
