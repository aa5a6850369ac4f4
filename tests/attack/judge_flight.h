// Judges what check_flight says of a flight: sizes and times here, what is seen in judge_flight_seen.cpp, limits in
// judge_flight_limits.cpp, the camera's turns in judge_flight_gimbal.cpp.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "flight_margins.h"
#include "flight_oracle.h"
#include "flights.h"
#include "random.h"
#include "vantage/mission.h"

namespace attack {

using vantage::FlightCheck;
using vantage::FlightSpan;
using vantage::Leg;

inline constexpr double kRoundoff = std::numeric_limits<double>::epsilon();

inline std::string place_text(const Vec3& p) {
  char text[100];
  std::snprintf(text, sizeof text, "(%.17g, %.17g, %.17g)", p.x(), p.y(), p.z());
  return text;
}

/// Places of each leg that are judged between those at which something may change: the ends of what is told are judged
/// 1 cm to either side, or nearer.
inline constexpr int kDense = 50;

/// A place of a flight.
struct FlightPlace {
  std::size_t leg = 0;
  double share = 0, at_m = 0;
  Vec3 position = Vec3::Zero();
};

inline bool holds(const std::vector<FlightSpan>& spans, double at_m, double slack_m) {
  return std::any_of(spans.begin(), spans.end(), [&](const FlightSpan& span) {
    return at_m >= span.begin_m - slack_m && at_m <= span.end_m + slack_m;
  });
}

using MarginsAt = std::function<std::vector<Margin>(const Vec3&)>;

class FlightJudge {
 public:
  FlightJudge(const DrawnFlight& drawn, const FlightCheck& check, FlightJudgement& result);

  void run();

 private:
  // ---- places ----

  std::size_t leg_count() const { return std::max<std::size_t>(1, drawn_.flight.leg_count()); }
  Leg leg(std::size_t i) const {
    if (drawn_.flight.leg_count() > 0) return drawn_.flight.leg(i);
    return {drawn_.flight.points[0].position, drawn_.flight.points[0].position};
  }
  double length(std::size_t i) const { return (leg(i).to - leg(i).from).norm(); }
  double begin_m(std::size_t i) const { return check_.point_at_m[i]; }
  FlightPlace place(std::size_t i, double share) const {
    const Leg on = leg(i);
    return {i, share, begin_m(i) + share * length(i), share == 1 ? on.to : Vec3(on.from + share * (on.to - on.from))};
  }
  /// Rounding of what is measured along the flight.
  double slack_m() const { return 8 * kRoundoff * check_.length_m; }

  /// The ends of legs, places at random, and beside the ends of spans.
  std::vector<FlightPlace> places(const std::vector<const std::vector<FlightSpan>*>& of, int at_random, int evenly = 0);

  bool is_near_end(const std::vector<FlightSpan>& spans, double at_m) const {
    return std::any_of(spans.begin(), spans.end(), [&](const FlightSpan& span) {
      return std::abs(at_m - span.begin_m) < near_ || std::abs(at_m - span.end_m) < near_;
    });
  }
  Vec3 in_tube(const Vec3& p);

  void wrong(const std::string& what, const std::string& more) { result_.add_wrong(what + ": " + more); }

  // ---- the frame of the answer ----

  bool has_right_frame();

  void judge_spans(const std::vector<FlightSpan>& spans, const std::string& name);

  /// By the times at which points are reached, and holds. Not where several points have the same place.
  void judge_times(const FlightSpan& span, const std::string& name);

  // ---- what is seen ----

  void judge_seen(const FlightOracle& oracle, const vantage::TargetCheck& target);

  /// As a target that is a point, with what the link says of range and zone.
  void judge_link(const vantage::LinkCheck& link);

  void claim(const FlightOracle& oracle, const Vec3& position, const vantage::TargetCheck& target, const char* where);

  double rounding_of(const Vec3& position) const;

  /// Positions that are not claimed and far from the ends of spans: something must be in the way.
  void miss(const FlightOracle& oracle, const FlightPlace& at, const vantage::TargetCheck& target);

  /// Of a tube places are tried: what is found is told, no more.
  void miss_in_tube(const FlightOracle& oracle, const FlightPlace& at, double margin);

  /// What triangles hide, told without samples: it may not meet what is claimed. Beside the ends places are judged.
  void add_hidden(const OneTarget& target, const vantage::TargetCheck& check, std::vector<FlightPlace>& judged);

  // ---- why not ----

  std::vector<FlightSpan> spans_of(const vantage::TargetCheck& check, vantage::NotSeen::Kind kind,
                                   const std::vector<std::string>& names) const;

  void judge_reasons(const vantage::TargetCheck& check, const OneTarget& target);

  void judge_hidden(const vantage::TargetCheck& check, const OneTarget& target);

  /// Spans in which a limit is broken. `is_measured`: its margin is a distance, so that it tells of tubes too.
  void judge_limit(const std::string& limit, const std::vector<FlightSpan>& spans, const MarginsAt& margins,
                   bool is_measured, bool is_searched);

  // ---- navigation ----

  void judge_navigation();

  void judge_ground(const vantage::BrokenLimit* told);

  /// It is what the place says, and hardly less than elsewhere.
  void judge_worst(const vantage::BrokenLimit& limit, const MarginsAt& margins, bool is_measured);

  // ---- the rest ----

  std::vector<std::uint32_t> ground_objects() const;

  /// Of the objects but the ground the largest of how often one is wound round a place: 1 inside of a closed one.
  double most_wound(const Vec3& place, const std::vector<std::uint32_t>& ground) const;

  void judge_nearest();

  void judge_gimbal(const vantage::TargetCheck& target);

  double speed_on(std::size_t i) const;
  /// Degrees in a second by which the line of sight turns.
  FlightPlace beside(FlightPlace at);  ///< in the tube
  double turn_at(const FlightPlace& at, const Vec3& centre) const;

  /// It is seen there, the camera is as fast as that, and where it is so all along the longest stretch, it is no
  /// shorter.
  void judge_followed(const vantage::TargetCheck& target, const FlightSpan& longest);

  void judge_failures();

  const DrawnFlight& drawn_;
  const FlightCheck& check_;
  FlightJudgement& result_;
  vantage::PreparedScene scene_;
  Random random_;
  std::vector<std::unique_ptr<FlightOracle>> oracles_;
  double radius_ = 0, rounding_ = 0, near_ = 0.01;
};

}  // namespace attack
