// Where limits are broken along a flight.
#include <map>
#include <optional>

#include "judge_flight.h"
#include "vantage/error.h"
#include "vantage/ground.h"

namespace attack {

void FlightJudge::judge_limit(const std::string& limit, const std::vector<FlightSpan>& spans, const MarginsAt& margins,
                              bool is_measured, bool is_searched) {
  const auto margin_at = [&](const Vec3& p) {
    for (const Margin& margin : margins(p)) {
      if (margin.limit == limit) return margin;
    }
    return Margin{limit, 1, -1};  // not known
  };
  for (const FlightPlace& at : places({&spans}, 6)) {
    result_.count("positions and limits");
    const Margin margin = margin_at(at.position);
    const double rounding = rounding_of(at.position);
    const bool is_told = holds(spans, at.at_m, slack_m());
    if (!is_told) {
      const double least = is_measured ? radius_ : 0;
      if (margin.high < least - rounding - 1e-9 * radius_) {
        wrong("limit", limit + " is not told at " + place_text(at.position) + ", where " + std::to_string(margin.high) +
                           " m are left");
      }
      for (int i = 0; i < 2 && radius_ > 0; ++i) {
        const Vec3 beside = in_tube(at.position);
        if (margin_at(beside).high < -rounding)
          wrong("limit of a tube", limit + " is not told at " + place_text(beside));
      }
    } else if (!is_near_end(spans, at.at_m) && (is_measured || !(radius_ > 0))) {
      double slack = 4 * rounding + 1e-9 * radius_;
      if (is_searched) slack += 2.5 * std::min(1e-3, 1e-5 * length(at.leg)) + 1e-6 * drawn_.scale;
      if (margin.low > radius_ + slack) {
        wrong("limit without need", limit + " is told at " + place_text(at.position) + ", where " +
                                        std::to_string(margin.low) + " m are left");
      }
    }
  }
}

void FlightJudge::judge_navigation() {
  const NavigationMargins limits(drawn_.mission.navigation);
  const auto margins = [&](const Vec3& p) { return limits.at(p); };
  std::map<std::string, const vantage::BrokenLimit*> told;
  for (const vantage::BrokenLimit& limit : check_.broken) told[limit.name] = &limit;
  for (const Margin& margin : limits.at(leg(0).from)) {
    const auto found = told.find(margin.limit);
    const std::vector<FlightSpan> none;
    judge_limit(margin.limit, found == told.end() ? none : found->second->spans, margins, margin.is_measured, false);
    if (found != told.end()) judge_worst(*found->second, margins, margin.is_measured);
    told.erase(margin.limit);
  }
  judge_ground(told.contains("ground") ? told["ground"] : nullptr);
  told.erase("ground");
  for (const auto& [name, limit] : told) wrong("limit", "there is none of the name " + name);
}

/// No middle of a leg is below the ground, but for 1 m where it takes off or lands. That is a limit of heights above
/// ground from 0 on.
void FlightJudge::judge_ground(const vantage::BrokenLimit* told) {
  const auto& asked = drawn_.mission.navigation.above_ground;
  std::optional<vantage::Ground> ground;
  try {
    if (!asked || asked->min_m < 0) ground = ground_of(drawn_.mission);
  } catch (const vantage::Error&) {  // the scene does not say what of it is ground
  }
  if (!ground) {
    if (told) wrong("ground", "there is none");
    return;
  }
  vantage::Navigation above;
  above.above_ground = vantage::AboveGround{0, 1e9, *ground};
  const NavigationMargins margins(above);
  const auto depth_at = [&](const Vec3& p) {
    for (const Margin& margin : margins.at(p)) {
      if (margin.limit == "agl min") return margin;
    }
    return Margin{"agl min", 0, 0};
  };
  bool is_sure = false;
  for (const FlightPlace& at : places({}, 4, 4)) {
    const Vec3 way = leg(at.leg).to - leg(at.leg).from;
    const bool is_end = at.leg == 0 || at.leg + 1 == leg_count();
    const bool may_touch = std::abs(way.z()) > 1 && (is_end || way.head<2>().norm() < 1);
    is_sure = is_sure || -depth_at(at.position).high > (may_touch ? 1 : 1e-3) + rounding_of(at.position);
  }
  if (is_sure && !told) wrong("ground", "it is not told that the flight is below");
  if (told && -depth_at(told->worst_at).low < 1e-3 - 8 * rounding_of(told->worst_at)) {
    wrong("ground", "told at " + place_text(told->worst_at));
  }
}

void FlightJudge::judge_worst(const vantage::BrokenLimit& limit, const MarginsAt& margins, bool is_measured) {
  if (!is_measured || !std::isfinite(limit.worst)) return;
  for (const Margin& margin : margins(limit.worst_at)) {
    if (margin.limit != limit.name) continue;
    const double there = std::max(0.0, radius_ - margin.low);
    if (std::abs(limit.worst - there) > 1e-9 * drawn_.scale + 8 * rounding_of(limit.worst_at)) {
      wrong("worst", limit.name + " " + std::to_string(limit.worst) + " at " + place_text(limit.worst_at) +
                         ", where it is " + std::to_string(there));
    }
  }
}

}  // namespace attack
