// How the camera turns along a flight.
#include <numbers>

#include "judge_flight.h"

namespace attack {

void FlightJudge::judge_gimbal(const vantage::TargetCheck& target) {
  if (target.gimbal.has_value() != target.longest.has_value()) return wrong("gimbal", "is there where nothing is seen");
  if (!target.gimbal) return;
  const FlightSpan& span = target.seen[*target.longest];
  for (std::size_t i = 0; i < leg_count(); ++i) {
    for (int k = 0; k < 20; ++k) {
      const FlightPlace at = beside(place(i, random_.uniform(0, 1)));
      if (!holds({span}, at.at_m, -slack_m())) continue;
      const Vec3 look = target.centre - at.position;
      const double pitch = std::atan2(look.z(), look.head<2>().norm()) * 180 / std::numbers::pi;
      if (look.norm() < 1e3 * rounding_) continue;
      const double slack = 1e-6 + rounding_ / look.norm() * 60;
      if (pitch < target.gimbal->min_pitch_deg - slack || pitch > target.gimbal->max_pitch_deg + slack) {
        wrong("pitch", std::to_string(pitch) + " at " + place_text(at.position) + ", not from " +
                           std::to_string(target.gimbal->min_pitch_deg) + " to " +
                           std::to_string(target.gimbal->max_pitch_deg) + ", along " + std::to_string(span.begin_m) +
                           " to " + std::to_string(span.end_m) + " m, place " + std::to_string(at.at_m));
      }
      const double speed = speed_on(i), rate = turn_at(at, target.centre);
      if (rate > target.gimbal->rate_deg_s * (1 + 1e-6) + 1e-9 + 60 * speed * rounding_ / look.squaredNorm()) {
        wrong("rate", std::to_string(rate) + " at " + place_text(at.position));
      }
    }
  }
}

FlightPlace FlightJudge::beside(FlightPlace at) {
  at.position += random_.uniform(0, 1) * drawn_.options.tube_radius_m * random_.direction();
  return at;
}

double FlightJudge::speed_on(std::size_t i) const {
  const double own = drawn_.flight.leg_count() > 0 ? drawn_.flight.points[i + 1].speed_m_s : NAN;
  return std::isnan(own) ? drawn_.options.speed_m_s.value_or(NAN) : own;
}

double FlightJudge::turn_at(const FlightPlace& at, const Vec3& centre) const {
  const Vec3 look = centre - at.position, along = leg(at.leg).to - leg(at.leg).from;
  return speed_on(at.leg) * along.normalized().cross(look).norm() / look.squaredNorm() * 180 / std::numbers::pi;
}

void FlightJudge::judge_followed(const vantage::TargetCheck& target, const FlightSpan& longest) {
  const double rate = *drawn_.options.gimbal_rate_deg_s;
  if (!target.followed) {
    if (target.gimbal->rate_deg_s < rate * (1 - 1e-6)) wrong("followed", "nowhere, and it turns no faster than it may");
    return;
  }
  const FlightSpan& span = *target.followed;
  judge_spans({span}, target.name);
  if (!holds(target.seen, span.begin_m, slack_m()) || !holds(target.seen, span.end_m, slack_m())) {
    wrong("followed", "where it is not seen");
  }
  if (target.gimbal->rate_deg_s < rate * (1 - 1e-6) &&
      span.duration_s() < longest.duration_s() - 1e-6 * (1 + check_.duration_s)) {
    wrong("followed", "for less time than it may be");
  }
  for (std::size_t i = 0; i < leg_count(); ++i) {
    if (!(length(i) > 0)) continue;
    for (int k = 0; k < 20; ++k) {
      const FlightPlace at = beside(place(i, random_.uniform(0, 1)));
      const double distance = (target.centre - at.position).norm();
      if (!holds({span}, at.at_m, -slack_m()) || distance < 1e3 * rounding_) continue;
      const double slack = 60 * speed_on(i) * rounding_ / (distance * distance);
      if (turn_at(at, target.centre) > rate * (1 + 1e-6) + slack) {
        wrong("followed", "too fast at " + place_text(at.position));
      }
    }
  }
}

}  // namespace attack
