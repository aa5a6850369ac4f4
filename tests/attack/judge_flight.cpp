#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>

#include "flight_oracle.h"
#include "flight_rooms.h"
#include "flights.h"
#include "random.h"
#include "vantage/error.h"
#include "vantage/mission.h"

namespace attack {
namespace {

using vantage::FlightCheck;
using vantage::FlightSpan;
using vantage::Leg;

constexpr double kRoundoff = std::numeric_limits<double>::epsilon();

std::string place_text(const Vec3& p) {
  char text[100];
  std::snprintf(text, sizeof text, "(%.17g, %.17g, %.17g)", p.x(), p.y(), p.z());
  return text;
}

/// Places of each leg that are judged between those at which something may change: the ends of what is told are judged
/// 1 cm to either side, or nearer.
constexpr int kDense = 50;

/// A place of a flight.
struct FlightPlace {
  std::size_t leg = 0;
  double share = 0, at_m = 0;
  Vec3 position = Vec3::Zero();
};

bool holds(const std::vector<FlightSpan>& spans, double at_m, double slack_m) {
  return std::any_of(spans.begin(), spans.end(), [&](const FlightSpan& span) {
    return at_m >= span.begin_m - slack_m && at_m <= span.end_m + slack_m;
  });
}

class FlightJudge {
 public:
  FlightJudge(const DrawnFlight& drawn, const FlightCheck& check, FlightJudgement& result)
      : drawn_(drawn), check_(check), result_(result), scene_(drawn.mission.scene()), random_(drawn.seed ^ 0x666c79) {
    for (std::size_t i = 0; i < volume_count(drawn.mission); ++i) {
      oracles_.push_back(std::make_unique<FlightOracle>(one_volume(drawn.mission, i), scene_));
    }
    radius_ = drawn.options.tube_radius_m + drawn.flight.chord_error_m;
    double largest = 0;
    for (const Vec3& v : drawn.mission.scene().mesh.vertices) largest = std::max(largest, v.cwiseAbs().maxCoeff());
    for (const auto& point : drawn.flight.points) largest = std::max(largest, point.position.cwiseAbs().maxCoeff());
    rounding_ = 32 * kRoundoff * largest;
    near_ = std::min(0.01, 1e-4 * drawn.scale);
  }

  void run() {
    if (!has_right_frame()) return;
    for (std::size_t i = 0; i < oracles_.size(); ++i) {
      judge_seen(i);
      if (const OneTarget* single = oracles_[i]->single()) judge_reasons(check_.targets[i], *single);
      judge_gimbal(check_.targets[i]);
    }
    judge_navigation();
    judge_nearest();
    judge_failures();
  }

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
  std::vector<FlightPlace> places(const std::vector<const std::vector<FlightSpan>*>& of, int at_random,
                                  int evenly = 0) {
    std::vector<FlightPlace> result;
    for (std::size_t i = 0; i < leg_count(); ++i) {
      std::vector<double> shares{0, 1};
      const double metres = length(i);
      if (metres > 0) {
        for (int k = 1; k < evenly; ++k) shares.push_back(static_cast<double>(k) / evenly);
        for (int k = 0; k < at_random; ++k) shares.push_back(random_.uniform(0, 1));
        for (const auto* spans : of) {
          for (const FlightSpan& span : *spans) {
            for (const double end : {span.begin_m, span.end_m}) {
              for (const double aside : {-1.01, -0.3, -1e-3, 1e-3, 0.3, 1.01}) {
                shares.push_back((end - begin_m(i) + aside * near_) / metres);
              }
            }
            shares.push_back((random_.uniform(span.begin_m, span.end_m) - begin_m(i)) / metres);
          }
        }
      }
      for (const double share : shares) {
        if (share >= 0 && share <= 1) result.push_back(place(i, share));
      }
    }
    return result;
  }

  bool is_near_end(const std::vector<FlightSpan>& spans, double at_m) const {
    return std::any_of(spans.begin(), spans.end(), [&](const FlightSpan& span) {
      return std::abs(at_m - span.begin_m) < near_ || std::abs(at_m - span.end_m) < near_;
    });
  }
  Vec3 in_tube(const Vec3& p) {
    const double share = random_.chance(0.5) ? 1 : std::cbrt(random_.uniform(0, 1));
    return p + (1 - 1e-9) * share * radius_ * random_.direction();
  }

  void wrong(const std::string& what, const std::string& more) { result_.add_wrong(what + ": " + more); }

  // ---- the frame of the answer ----

  bool has_right_frame() {
    const bool is_right = check_.targets.size() == oracles_.size() &&
                          check_.point_at_m.size() == drawn_.flight.points.size() &&
                          check_.arrival_s.size() == drawn_.flight.points.size();
    if (!is_right) {
      wrong("sizes", "targets or points");
      return false;
    }
    double at = 0;
    for (std::size_t i = 0; i < drawn_.flight.points.size(); ++i) {
      if (i > 0) at += length(i - 1);
      if (!(std::abs(check_.point_at_m[i] - at) <= 1e-12 * (at + rounding_)))
        wrong("length", "of point " + std::to_string(i));
    }
    for (const auto& target : check_.targets) judge_spans(target.seen, target.name);
    for (const auto& limit : check_.broken) judge_spans(limit.spans, limit.name);
    return true;
  }

  void judge_spans(const std::vector<FlightSpan>& spans, const std::string& name) {
    double last = -1;
    for (const FlightSpan& span : spans) {
      if (!(span.begin_m <= span.end_m) || span.begin_m < last - slack_m() || span.begin_m < 0 ||
          span.end_m > check_.length_m * (1 + 1e-12)) {
        wrong("spans", name + " are not sorted, or not on the flight");
      }
      last = span.end_m;
      if (!std::isnan(check_.duration_s)) judge_times(span, name);
    }
  }

  /// By the times at which points are reached, and holds. Not where several points have the same place.
  void judge_times(const FlightSpan& span, const std::string& name) {
    const auto& points = drawn_.flight.points;
    double least = 0, most = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double at = check_.point_at_m[i], slack = 1e-9 * check_.length_m;
      if (std::abs(at - span.begin_m) <= slack || std::abs(at - span.end_m) <= slack) {
        most += points[i].hold_s;
      } else if (at > span.begin_m && at < span.end_m) {
        least += points[i].hold_s;
        most += points[i].hold_s;
      }
      if (i == 0) continue;
      const double from = std::max(span.begin_m, check_.point_at_m[i - 1]), to = std::min(span.end_m, at);
      const double speed =
          std::isnan(points[i].speed_m_s) ? drawn_.options.speed_m_s.value_or(NAN) : points[i].speed_m_s;
      if (to > from) {
        least += (to - from) / speed;
        most += (to - from) / speed;
      }
    }
    const double slack = 1e-9 * (1 + check_.duration_s);
    if (!(span.duration_s() >= least - slack && span.duration_s() <= most + slack)) {
      wrong("times", name + ", " + std::to_string(span.duration_s()) + " s, not from " + std::to_string(least) +
                         " to " + std::to_string(most));
    }
  }

  // ---- what is seen ----

  void judge_seen(std::size_t index) {
    const vantage::TargetCheck& target = check_.targets[index];
    const FlightOracle& oracle = *oracles_[index];
    // Ends are told by their positions, which are not rounded once more.
    for (const FlightSpan& span : target.seen) {
      for (const Vec3& end : {span.begin, span.end}) claim(oracle, end, target, "at an end");
    }
    std::vector<FlightPlace> judged = places({&target.seen}, 10, kDense);
    if (const OneTarget* single = oracle.single()) add_hidden(*single, target, judged);
    for (const FlightPlace& at : judged) {
      if (holds(target.seen, at.at_m, 0)) {
        claim(oracle, at.position, target, "inside");
      } else if (!is_near_end(target.seen, at.at_m)) {
        miss(oracle, at, target);
      }
    }
  }

  void claim(const FlightOracle& oracle, const Vec3& position, const vantage::TargetCheck& target, const char* where) {
    result_.count("positions that are claimed");
    const std::string reason = oracle.surely_not_seen(position, rounding_of(position));
    if (!reason.empty()) {
      wrong("over-claim",
            std::string(where) + " " + place_text(position) + ", " + target.name + " is not seen: " + reason);
    }
    if (!(radius_ > 0)) return;
    for (int i = 0; i < 4; ++i) {
      const Vec3 beside = in_tube(position);
      result_.count("positions of tubes");
      const std::string why = oracle.surely_not_seen(beside, rounding_of(beside));
      if (why.empty()) continue;
      wrong("over-claim of a tube",
            place_text(beside) + " about " + place_text(position) + ", " + target.name + ": " + why);
    }
  }

  double rounding_of(const Vec3& position) const {
    double reach = 0;
    for (const auto& oracle : oracles_) reach = std::max(reach, oracle->lists()[0][0]->reach(position));
    return rounding_ + 1e-11 * reach;
  }

  /// Positions that are not claimed and far from the ends of spans: something must be in the way.
  void miss(const FlightOracle& oracle, const FlightPlace& at, const vantage::TargetCheck& target) {
    result_.count("positions that are not claimed");
    const double reach = oracle.lists()[0][0]->reach(at.position), rounding = rounding_of(at.position);
    // A camera that turns is looked for in parts of a leg that are so long.
    const double parts = 2.5 * std::min(1e-3, 1e-5 * length(at.leg));
    if (radius_ > 0) return miss_in_tube(oracle, at, parts + 4 * rounding);
    const double tight = 1e-9 * reach + 2 * rounding, loose = 1.5e-6 * reach + 2 * rounding;
    if (!oracle.surely_seen(at.position, tight, 1e-6 * reach + 4 * rounding + parts)) return;
    if (!oracle.surely_seen(at.position, loose, 1e-6 * reach + 4 * rounding + parts)) {
      result_.count("not claimed, by less than a millionth of the distance");
      return;
    }
    wrong("under-claim",
          place_text(at.position) + " of leg " + std::to_string(at.leg) + ", " + target.name + " is seen");
  }

  /// Of a tube places are tried: what is found is told, no more.
  void miss_in_tube(const FlightOracle& oracle, const FlightPlace& at, double room) {
    const double larger = 1.02 * radius_ + room;
    for (int i = 0; i < 40; ++i) {
      if (!oracle.surely_seen(at.position + larger * random_.direction(), 0, room)) return;
    }
    result_.count("not claimed, and nothing is found in the tube");
  }

  /// What triangles hide, told without samples: it may not meet what is claimed. Beside the ends places are judged.
  void add_hidden(const OneTarget& target, const vantage::TargetCheck& check, std::vector<FlightPlace>& judged) {
    for (std::size_t i = 0; i < leg_count(); ++i) {
      if (!(length(i) > 0)) continue;
      for (const HiddenPart& part : target.hidden_parts(leg(i))) {
        result_.count("hidden parts of legs");
        for (const FlightSpan& span : check.seen) {
          const double begin = std::max(part.begin, (span.begin_m - begin_m(i)) / length(i));
          const double end = std::min(part.end, (span.end_m - begin_m(i)) / length(i));
          if (begin < end) judged.push_back(place(i, 0.5 * (begin + end)));
        }
        for (const double end : {part.begin, part.end}) {
          for (const double aside : {-1.02, 1.02}) {
            const double share = end + aside * near_ / length(i);
            if (share > 0 && share < 1) judged.push_back(place(i, share));
          }
        }
      }
    }
  }

  // ---- why not ----

  std::vector<FlightSpan> spans_of(const vantage::TargetCheck& check, vantage::NotSeen::Kind kind,
                                   const std::vector<std::string>& names) const {
    std::vector<FlightSpan> spans;
    for (const vantage::NotSeen& reason : check.not_seen) {
      if (reason.kind != kind || std::find(names.begin(), names.end(), reason.name) == names.end()) continue;
      spans.insert(spans.end(), reason.spans.begin(), reason.spans.end());
    }
    return spans;
  }

  void judge_reasons(const vantage::TargetCheck& check, const OneTarget& target) {
    using Kind = vantage::NotSeen::Kind;
    if (!target.sensor().link) judge_hidden(check, target);
    const auto rooms = [&](const Vec3& p) { return target.rooms(p); };
    const bool turns = target.sensor().camera && !target.sensor().mount.is_fixed();
    for (const Room& room : target.rooms(leg(0).from)) {
      const bool is_range = room.limit == "max_range", is_behind = room.limit == "behind";
      const std::vector<std::string> names = is_range || is_behind   ? std::vector<std::string>{""}
                                             : room.limit == "frame" ? std::vector<std::string>{"frame", "gimbal"}
                                                                     : std::vector<std::string>{room.limit};
      const Kind kind = is_range ? Kind::out_of_range : is_behind ? Kind::behind : Kind::limit;
      const bool is_measured = room.limit != "sun" && !(room.limit == "frame" && (turns || radius_ > 0));
      judge_limit(room.limit, spans_of(check, kind, names), rooms, is_measured, turns && room.limit == "frame");
    }
  }

  void judge_hidden(const vantage::TargetCheck& check, const OneTarget& target) {
    const auto& objects = drawn_.mission.scene().objects;
    const auto is_in_view = [&](const Vec3& p) {
      for (const Room& room : target.rooms(p)) {
        const bool counts = room.limit == "max_range" || room.limit == "behind";
        if (counts && room.low < rounding_of(p)) return false;
      }
      return true;
    };
    for (std::size_t i = 0; i < leg_count(); ++i) {
      if (!(length(i) > 0)) continue;
      for (const HiddenPart& part : target.hidden_parts(leg(i))) {
        const FlightPlace at = place(i, random_.uniform(part.begin, part.end));
        const auto spans = spans_of(check, vantage::NotSeen::Kind::hidden, {display_name(objects[part.object])});
        if (!is_in_view(at.position) || holds(spans, at.at_m, slack_m())) continue;
        if (!target.surely_hidden_by(at.position, part.object)) continue;
        wrong("hidden", "not told at " + place_text(at.position) + ": by " + display_name(objects[part.object]));
      }
    }
    if (radius_ > 0) return;
    for (const vantage::NotSeen& reason : check.not_seen) {
      if (reason.kind != vantage::NotSeen::Kind::hidden) continue;
      for (const FlightPlace& at : places({&reason.spans}, 0)) {
        if (!holds(reason.spans, at.at_m, 0) || is_near_end(reason.spans, at.at_m)) continue;
        const double aside = 1.5e-6 * target.reach(at.position) + 2 * rounding_of(at.position);
        bool is_hidden = false;
        for (std::uint32_t object = 0; object < objects.size() && !is_hidden; ++object) {
          is_hidden =
              display_name(objects[object]) == reason.name && target.may_be_hidden_by(at.position, object, aside);
        }
        if (!is_hidden) wrong("blames", place_text(at.position) + " is not hidden by " + reason.name);
      }
    }
  }

  /// Spans in which a limit is broken. `is_measured`: its room is a distance, so that it tells of tubes too.
  template <typename Rooms>
  void judge_limit(const std::string& limit, const std::vector<FlightSpan>& spans, const Rooms& rooms, bool is_measured,
                   bool is_searched) {
    const auto room_at = [&](const Vec3& p) {
      for (const Room& room : rooms(p)) {
        if (room.limit == limit) return room;
      }
      return Room{limit, 1, -1};  // not known
    };
    for (const FlightPlace& at : places({&spans}, 6)) {
      result_.count("positions and limits");
      const Room room = room_at(at.position);
      const double rounding = rounding_of(at.position);
      const bool is_told = holds(spans, at.at_m, slack_m());
      if (!is_told) {
        const double least = is_measured ? radius_ : 0;
        if (room.high < least - rounding - 1e-9 * radius_) {
          wrong("limit", limit + " is not told at " + place_text(at.position) + ", where " + std::to_string(room.high) +
                             " m are left");
        }
        for (int i = 0; i < 2 && radius_ > 0; ++i) {
          const Vec3 beside = in_tube(at.position);
          if (room_at(beside).high < -rounding)
            wrong("limit of a tube", limit + " is not told at " + place_text(beside));
        }
      } else if (!is_near_end(spans, at.at_m) && (is_measured || !(radius_ > 0))) {
        double slack = 4 * rounding + 1e-9 * radius_;
        if (is_searched) slack += 2.5 * std::min(1e-3, 1e-5 * length(at.leg)) + 1e-6 * drawn_.scale;
        if (room.low > radius_ + slack) {
          wrong("limit without need", limit + " is told at " + place_text(at.position) + ", where " +
                                          std::to_string(room.low) + " m are left");
        }
      }
    }
  }

  // ---- navigation ----

  void judge_navigation() {
    const NavigationRooms limits(drawn_.mission.navigation);
    const auto rooms = [&](const Vec3& p) { return limits.at(p); };
    std::map<std::string, const vantage::BrokenLimit*> told;
    for (const vantage::BrokenLimit& limit : check_.broken) told[limit.name] = &limit;
    for (const Room& room : limits.at(leg(0).from)) {
      const auto found = told.find(room.limit);
      const std::vector<FlightSpan> none;
      // Above ground, heights count, not distances.
      const bool is_measured =
          room.limit.find("agl") == std::string::npos && room.limit != "ground edge" && !has_agl(room.limit);
      judge_limit(room.limit, found == told.end() ? none : found->second->spans, rooms, is_measured || !(radius_ > 0),
                  false);
      if (found != told.end()) judge_worst(*found->second, rooms, is_measured);
      told.erase(room.limit);
    }
    for (const auto& [name, limit] : told) wrong("limit", "there is none of the name " + name);
  }

  bool has_agl(const std::string& limit) const {
    const auto has = [](const std::vector<vantage::Zone>& zones) {
      return std::any_of(zones.begin(), zones.end(),
                         [](const vantage::Zone& zone) { return zone.above_ground.has_value(); });
    };
    const vantage::Navigation& navigation = drawn_.mission.navigation;
    return limit.starts_with("keep_out zone") ? has(navigation.keep_out_zones)
                                              : limit == "keep_in" && has(navigation.keep_in_zones);
  }

  /// It is what the place says, and hardly less than elsewhere.
  template <typename Rooms>
  void judge_worst(const vantage::BrokenLimit& limit, const Rooms& rooms, bool is_measured) {
    if (!is_measured || !std::isfinite(limit.worst)) return;
    for (const Room& room : rooms(limit.worst_at)) {
      if (room.limit != limit.name) continue;
      const double there = std::max(0.0, radius_ - room.low);
      if (std::abs(limit.worst - there) > 1e-9 * drawn_.scale + 8 * rounding_of(limit.worst_at)) {
        wrong("worst", limit.name + " " + std::to_string(limit.worst) + " at " + place_text(limit.worst_at) +
                           ", where it is " + std::to_string(there));
      }
    }
  }

  // ---- the rest ----

  std::vector<std::uint32_t> ground_objects() const {
    std::vector<std::uint32_t> left_out;
    const auto& objects = drawn_.mission.scene().objects;
    for (std::uint32_t i = 0; i < objects.size(); ++i) {
      if (objects[i].kind == vantage::ObjectKind::ground) left_out.push_back(i);
    }
    return left_out;
  }

  void judge_nearest() {
    const vantage::Scene& scene = drawn_.mission.scene();
    const std::vector<std::uint32_t> ground = ground_objects();
    const Blockers blockers(
        scene, {drawn_.mission.views.empty() ? drawn_.mission.target.part(0) : drawn_.mission.views[0][0].part(0)});
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < leg_count(); ++i) {
      const Leg local{leg(i).from - blockers.origin, leg(i).to - blockers.origin};
      for (const Blocker& blocker : blockers.triangles) {
        if (std::find(ground.begin(), ground.end(), blocker.object) != ground.end()) continue;
        least = std::min(least, distance_from_leg(local, blocker.corners));
      }
    }
    result_.count("nearest distances");
    const double expected = std::max(0.0, least - radius_), told = check_.nearest.distance_m;
    // LegDistances: twice what rounding may do. Merging: blockers.merging is twice that of half the scene's size.
    const double rounding = 4 * rounding_ + 1e-12 * (std::isfinite(least) ? least : 0) + 4 * blockers.merging;
    if (std::isinf(expected) && std::isinf(told)) return;
    if (told > expected + 1e-14 * expected + kRoundoff * rounding_) {
      // Merging may move corners, and triangles as narrow as rounding are dropped: within that either is right.
      if (told > expected + rounding)
        wrong("nearest", std::to_string(told) + " m, and " + std::to_string(expected) + " m are right");
      result_.count("nearest, above by rounding");
    }
    if (told < expected - rounding)
      wrong("nearest, less", std::to_string((expected - told) * 1e12) + " pm, of " + std::to_string(rounding * 1e12) +
                                 " pm; " + std::to_string(expected) + " m are right");
  }

  void judge_gimbal(const vantage::TargetCheck& target) {
    if (target.gimbal.has_value() != target.longest.has_value())
      return wrong("gimbal", "is there where nothing is seen");
    if (!target.gimbal) return;
    const FlightSpan& span = target.seen[*target.longest];
    for (std::size_t i = 0; i < leg_count(); ++i) {
      for (int k = 0; k < 20; ++k) {
        const FlightPlace at = place(i, random_.uniform(0, 1));
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

  double speed_on(std::size_t i) const {
    const double own = drawn_.flight.leg_count() > 0 ? drawn_.flight.points[i + 1].speed_m_s : NAN;
    return std::isnan(own) ? drawn_.options.speed_m_s.value_or(NAN) : own;
  }
  /// Degrees in a second by which the line of sight turns.
  double turn_at(const FlightPlace& at, const Vec3& centre) const {
    const Vec3 look = centre - at.position, along = leg(at.leg).to - leg(at.leg).from;
    return speed_on(at.leg) * along.normalized().cross(look).norm() / look.squaredNorm() * 180 / std::numbers::pi;
  }

  /// It is seen there, the camera is as fast as that, and where it is so all along the longest stretch, it is no
  /// shorter.
  void judge_followed(const vantage::TargetCheck& target, const FlightSpan& longest) {
    const double rate = *drawn_.options.gimbal_rate_deg_s;
    if (!target.followed) {
      if (target.gimbal->rate_deg_s < rate * (1 - 1e-6))
        wrong("followed", "nowhere, and it turns no faster than it may");
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
        const FlightPlace at = place(i, random_.uniform(0, 1));
        const double distance = (target.centre - at.position).norm();
        if (!holds({span}, at.at_m, -slack_m()) || distance < 1e3 * rounding_) continue;
        const double slack = 60 * speed_on(i) * rounding_ / (distance * distance);
        if (turn_at(at, target.centre) > rate * (1 + 1e-6) + slack) {
          wrong("followed", "too fast at " + place_text(at.position));
        }
      }
    }
  }

  void judge_failures() {
    bool fails = !check_.broken.empty();
    for (const vantage::TargetCheck& target : check_.targets) {
      if (target.seen.empty()) {
        fails = true;
        continue;
      }
      const FlightSpan& longest = target.seen[*target.longest];
      for (const FlightSpan& span : target.seen) {
        const bool by_time = !std::isnan(check_.duration_s);
        if (by_time ? span.duration_s() > longest.duration_s() : span.length_m() > longest.length_m()) {
          wrong("longest", target.name);
        }
      }
      const double dwell = drawn_.options.dwell_s.value_or(0);
      fails = fails || longest.duration_s() < dwell;
      if (!drawn_.options.gimbal_rate_deg_s) continue;
      fails = fails || !target.followed || target.followed->duration_s() < dwell;
      judge_followed(target, longest);
    }
    fails = fails || check_.nearest.distance_m < drawn_.options.clearance_m.value_or(0);
    if (fails == check_.passes()) wrong("verdict", fails ? "it passes" : check_.failures[0]);
  }

  const DrawnFlight& drawn_;
  const FlightCheck& check_;
  FlightJudgement& result_;
  vantage::PreparedScene scene_;
  Random random_;
  std::vector<std::unique_ptr<FlightOracle>> oracles_;
  double radius_ = 0, rounding_ = 0, near_ = 0.01;
};

}  // namespace

void FlightJudgement::count(const std::string& what, double more) {
  for (auto& [name, so_far] : counts) {
    if (name != what) continue;
    so_far += more;
    return;
  }
  counts.emplace_back(what, more);
}

void FlightJudgement::add_wrong(const std::string& text) {
  const std::string kind = text.substr(0, text.find(':') + 1);
  const bool is_known =
      std::any_of(wrong.begin(), wrong.end(), [&](const std::string& w) { return w.starts_with(kind); });
  if (!is_known) wrong.push_back(text);
}

vantage::FlightCheck ask_check_flight(const DrawnFlight& drawn) {
  return check_flight(drawn.mission, drawn.flight, drawn.options);
}

FlightJudgement judge_flight(const DrawnFlight& drawn, const CheckFlight& ask) {
  FlightJudgement result;
  try {
    const FlightCheck check = ask(drawn);
    FlightJudge(drawn, check, result).run();
    result.words.emplace_back("flight");
    bool is_seen = false;
    for (const auto& target : check.targets) is_seen = is_seen || !target.seen.empty();
    result.words.emplace_back(is_seen ? "flight, something is seen" : "flight, nothing is seen");
    if (check.tube_radius_m > 0) result.words.emplace_back("flight, with a tube");
    if (!check.broken.empty()) result.words.emplace_back("flight, limits are broken");
    if (!drawn.mission.navigation.empty()) result.words.emplace_back("flight, with limits of navigation");
    if (drawn.mission.sensor.limits_view() || drawn.mission.sensor.link)
      result.words.emplace_back("flight, with limits of the sensor");
    if (drawn.mission.views.size() > 0) result.words.emplace_back("flight, several targets or both sides");
  } catch (const vantage::Error& error) {
    result.words.push_back(std::string("flight, refused: ") + name_of(error.code()));
    if (error.kind() != vantage::ErrorKind::input) result.add_wrong(std::string("error: ") + error.what());
  }
  return result;
}

}  // namespace attack
