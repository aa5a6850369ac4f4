#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/known_data.h"
#include "core/format.h"
#include "core/parallel.h"
#include "core/progress_reporter.h"
#include "core/text.h"
#include "flight/check_gimbal.h"
#include "flight/check_links.h"
#include "flight/flight_timeline.h"
#include "flight/obstacles.h"
#include "scene/viewpoint_check.h"
#include "vantage/error.h"
#include "vantage/flight_check.h"
#include "vantage/query.h"

namespace vantage {
namespace {

using internal::flight::FlightTimeline;
using internal::flight::Stretch;
namespace flight = internal::flight;

using Intervals = std::vector<LegInterval>;

/// Why the target is not seen on one leg: by kind and name.
using Reasons = std::map<std::pair<NotSeen::Kind, std::string>, Intervals>;

/// One target on one leg.
struct TargetOnLeg {
  Intervals seen;
  Reasons reasons;
};

/// All that is found on one leg.
struct OnLeg {
  std::vector<TargetOnLeg> targets;
  std::vector<LegBreak> broken;
  std::vector<LegView> links;
};

Intervals joined(Intervals a, const Intervals& b) {
  a.insert(a.end(), b.begin(), b.end());
  return flight::united(std::move(a));
}

const Intervals& whole() {
  static const Intervals kWhole = {{0, 1}};
  return kWhole;
}

Intervals common(const Intervals& a, const Intervals& b) { return flight::without(a, flight::without(whole(), b)); }

/// A volume to fly through, as a limit that is kept inside it. A little within its surface: more than what rounding
/// does to the ends of intervals.
struct VolumeToFlyThrough {
  explicit VolumeToFlyThrough(const TargetVolume& volume) : limits(inside(volume.mesh)) {
    const Box box = bounding_box(volume.mesh);
    constexpr double kOfSize = 1e-10, kRoundings = 16 * std::numeric_limits<double>::epsilon();
    const double largest = std::max(box.min.cwiseAbs().maxCoeff(), box.max.cwiseAbs().maxCoeff());
    depth_m = kOfSize * (box.max - box.min).norm() + kRoundings * largest;
    centre = (box.min + box.max) / 2;
  }
  static Navigation inside(const Mesh& mesh) {
    Navigation limits;
    limits.meshes.push_back({mesh, "volume"});
    return limits;
  }

  LegLimits limits;
  double depth_m = 0;
  Vec3 centre = Vec3::Zero();
};

/// A position sees it that sees, of each list, one target or more, each within its limits.
class JudgedTarget {
 public:
  JudgedTarget(const Mission& mission, const PreparedScene& scene) : name_(mission.target.name) {
    if (mission.target.is_volume() && mission.views.empty()) {
      volume_.emplace(*mission.target.volume);
      centre_ = volume_->centre;
      return;
    }
    parts_ = mission.target.parts;
    for (const std::vector<PreparedTarget>& list : prepare_views(mission, scene)) {
      std::vector<One>& judged = lists_.emplace_back();
      for (const PreparedTarget& target : list) judged.push_back({LegViews(target), LegLimits(target, {})});
    }
    std::size_t corners = 0;
    for (const std::vector<Vec3>& part : mission.target.parts) {
      for (const Vec3& corner : part) centre_ += corner;
      corners += part.size();
    }
    if (corners > 0) centre_ /= static_cast<double>(corners);
  }

  const std::string& name() const { return name_; }
  bool is_volume() const { return volume_.has_value(); }
  const Vec3& centre() const { return centre_; }
  const std::vector<std::vector<Vec3>>& parts() const { return parts_; }

  TargetOnLeg look(const Leg& leg, double radius_m, const Progress& asked) const {
    if (volume_) return look_inside(*volume_, leg, radius_m);
    TargetOnLeg result{whole(), {}};
    for (const std::vector<One>& list : lists_) {
      const TargetOnLeg any = look_at_any(list, leg, radius_m, asked);
      result.seen = common(result.seen, any.seen);
      for (const auto& [reason, intervals] : any.reasons) {
        result.reasons[reason] = joined(std::move(result.reasons[reason]), intervals);
      }
    }
    return result;
  }

 private:
  struct One {
    LegViews views;
    LegLimits limits;
  };

  static TargetOnLeg look_inside(const VolumeToFlyThrough& volume, const Leg& leg, double radius_m) {
    TargetOnLeg result{whole(), {}};
    for (LegBreak& outside : volume.limits.broken(leg, radius_m + volume.depth_m)) {
      result.seen = flight::without(result.seen, outside.intervals);
      result.reasons[{NotSeen::Kind::outside, ""}] = std::move(outside.intervals);
    }
    return result;
  }

  /// What hides any of them is told; out of range, behind and limits only where that holds for all.
  static TargetOnLeg look_at_any(const std::vector<One>& list, const Leg& leg, double radius_m, const Progress& asked) {
    TargetOnLeg result;
    bool is_first = true;
    for (const One& one : list) {
      TargetOnLeg seen = look_at(one, leg, radius_m, asked);
      result.seen = joined(std::move(result.seen), seen.seen);
      for (auto& [reason, intervals] : result.reasons) {
        if (reason.first == NotSeen::Kind::hidden) continue;
        const auto same = seen.reasons.find(reason);
        intervals = same == seen.reasons.end() ? Intervals() : common(intervals, same->second);
      }
      for (auto& [reason, intervals] : seen.reasons) {
        if (reason.first != NotSeen::Kind::hidden && !is_first) continue;
        result.reasons[reason] = joined(std::move(result.reasons[reason]), intervals);
      }
      is_first = false;
    }
    std::erase_if(result.reasons, [](const auto& entry) { return entry.second.empty(); });
    return result;
  }

  static TargetOnLeg look_at(const One& one, const Leg& leg, double radius_m, const Progress& asked) {
    LegView view = one.views.look(leg, radius_m, asked);
    TargetOnLeg result{std::move(view.seen), {}};
    for (LegBlocker& blocker : view.hidden_by) {
      result.reasons[{NotSeen::Kind::hidden, std::move(blocker.name)}] = std::move(blocker.intervals);
    }
    if (!view.out_of_range.empty()) result.reasons[{NotSeen::Kind::out_of_range, ""}] = std::move(view.out_of_range);
    if (!view.behind_target.empty()) result.reasons[{NotSeen::Kind::behind, ""}] = std::move(view.behind_target);
    for (LegBreak& limit : one.limits.broken(leg, radius_m, asked)) {
      result.seen = flight::without(result.seen, limit.intervals);
      result.reasons[{NotSeen::Kind::limit, std::move(limit.limit)}] = std::move(limit.intervals);
    }
    return result;
  }

  std::string name_;
  Vec3 centre_ = Vec3::Zero();
  std::vector<std::vector<Vec3>> parts_;
  std::vector<std::vector<One>> lists_;
  std::optional<VolumeToFlyThrough> volume_;  ///< instead of lists
};

/// What is judged on every leg.
struct LegChecks {
  std::vector<JudgedTarget> targets;
  std::vector<flight::JudgedLink> links;
  LegLimits limits;
};

void require_number(const std::optional<double>& value, bool may_be_zero, const char* what, const char* fix) {
  if (!value || (std::isfinite(*value) && (*value > 0 || (may_be_zero && *value == 0)))) return;
  throw Error(
      ErrorCode::value_out_of_range,
      std::string(what) + (may_be_zero ? " must be 0 or more and finite" : " must be greater than 0 and finite"), what,
      fix);
}

/// The options with what the mission's tour says where they say nothing.
FlightCheckOptions filled(const Mission& mission, FlightCheckOptions options) {
  require_number(options.tube_radius_m, true, "the radius of the tube", "give metres");
  require_number(options.speed_m_s, false, "the speed", "give metres per second");
  require_number(options.dwell_s, true, "the dwell", "give seconds");
  require_number(options.clearance_m, true, "the clearance", "give metres");
  require_number(options.gimbal_rate_deg_s, false, "the rate of the gimbal", "give degrees per second");
  if (!mission.as_written.tour) return options;
  const TourSettings& tour = *mission.as_written.tour;
  if (!options.speed_m_s) options.speed_m_s = tour.vehicle.speed_m_s;
  if (!options.dwell_s) options.dwell_s = tour.dwell_s;
  if (!options.clearance_m) options.clearance_m = tour.clearance_m;
  if (!options.gimbal_rate_deg_s) options.gimbal_rate_deg_s = tour.gimbal_rate_deg_s;
  return options;
}

/// All that must be known round the flight.
FlownPlaces places_of(const FlightCheck& check, const Mission& mission, const FlightCheckOptions& options) {
  FlownPlaces places{check.positions, {}, mission.links, check.tube_radius_m, options.clearance_m.value_or(0)};
  for (const TargetCheck& target : check.targets) {
    for (const std::vector<Vec3>& part : target.parts) places.seen.insert(places.seen.end(), part.begin(), part.end());
  }
  return places;
}

/// What was found on the legs, leg after leg. From another way nothing counts as seen: it may not be flown.
std::vector<OnLeg> judge_legs(const Flight& flight, const std::vector<Leg>& legs, const LegChecks& judges,
                              double radius_m, const internal::core::ProgressReporter& reporter) {
  std::vector<OnLeg> found(legs.size());
  std::atomic<std::size_t> done = 0;
  const Progress asked = [&](std::string_view, double) {
    reporter.check();
    return true;
  };
  internal::parallel::for_ranges(legs.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      reporter.report(done.load(), legs.size());
      const bool is_other_way = i < flight.leg_count() && flight.points[i + 1].is_other_way;
      for (const JudgedTarget& target : judges.targets) {
        found[i].targets.push_back(is_other_way ? TargetOnLeg() : target.look(legs[i], radius_m, asked));
      }
      for (const flight::JudgedLink& link : judges.links) found[i].links.push_back(link.look(legs[i], radius_m));
      found[i].broken = judges.limits.broken(legs[i], radius_m);
      ++done;
    }
  });
  return found;
}

/// One target, all legs.
TargetCheck check_target(const JudgedTarget& target, std::size_t index, const std::vector<OnLeg>& legs,
                         const Flight& path, const FlightTimeline& along, const FlightCheckOptions& options) {
  TargetCheck check;
  check.name = target.name();
  check.is_volume = target.is_volume();
  check.centre = target.centre();
  check.parts = target.parts();
  std::vector<Stretch> seen;
  std::vector<Intervals> seen_on;
  std::map<std::pair<NotSeen::Kind, std::string>, std::vector<Stretch>> reasons;
  for (std::size_t leg = 0; leg < legs.size(); ++leg) {
    const TargetOnLeg& on = legs[leg].targets[index];
    flight::append(seen, leg, on.seen);
    seen_on.push_back(on.seen);
    for (const auto& [reason, intervals] : on.reasons) flight::append(reasons[reason], leg, intervals);
  }
  check.seen = flight::spans_of(along, seen);
  for (std::size_t i = 0; i < check.seen.size(); ++i) {
    const bool by_time = !std::isnan(along.duration_s());
    const auto measure = [&](const FlightSpan& span) { return by_time ? span.duration_s() : span.length_m(); };
    if (!check.longest || measure(check.seen[i]) > measure(check.seen[*check.longest])) check.longest = i;
  }
  const flight::GimbalCheck gimbal(path, along, options.tube_radius_m + path.chord_error_m);
  if (check.longest && !check.is_volume) check.gimbal = gimbal.use(seen[*check.longest], check.centre);
  if (options.gimbal_rate_deg_s && !check.is_volume) {
    check.followed = gimbal.followed(seen_on, check.centre, *options.gimbal_rate_deg_s);
  }
  for (const auto& [reason, stretches] : reasons) {
    check.not_seen.push_back({reason.first, reason.second, flight::spans_of(along, stretches)});
  }
  std::stable_sort(check.not_seen.begin(), check.not_seen.end(),
                   [](const NotSeen& a, const NotSeen& b) { return a.length_m() > b.length_m(); });
  return check;
}

std::vector<BrokenLimit> broken_limits(const std::vector<OnLeg>& legs, const FlightTimeline& along) {
  std::vector<BrokenLimit> result;
  std::map<std::string, std::pair<std::size_t, std::vector<Stretch>>> by_name;
  for (std::size_t leg = 0; leg < legs.size(); ++leg) {
    for (const LegBreak& limit : legs[leg].broken) {
      const auto [entry, is_new] = by_name.try_emplace(limit.limit, result.size(), std::vector<Stretch>());
      if (is_new) {
        result.push_back({limit.limit,
                          {},
                          limit.worst,
                          limit.unit == LegBreak::Unit::metres ? "m" : "degrees",
                          along.at_m(leg, limit.worst_share),
                          along.position(leg, limit.worst_share)});
      }
      BrokenLimit& broken = result[entry->second.first];
      if (limit.worst > broken.worst) {
        broken.worst = limit.worst;
        broken.worst_at_m = along.at_m(leg, limit.worst_share);
        broken.worst_at = along.position(leg, limit.worst_share);
      }
      flight::append(entry->second.second, leg, limit.intervals);
    }
  }
  for (const auto& [name, entry] : by_name) result[entry.first].spans = flight::spans_of(along, entry.second);
  return result;
}

NearestPass nearest_pass(const std::vector<Leg>& legs, const LegDistances& scene, const FlightTimeline& along,
                         double radius_m, const Progress& progress) {
  const std::vector<LegDistance> distances = scene.nearest(legs, progress);
  NearestPass nearest;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < distances.size(); ++i) {
    const LegDistance& at = distances[i];
    if (!(at.distance_m < least)) continue;
    least = at.distance_m;
    nearest = {std::max(0.0, at.distance_m - radius_m), along.at_m(i, at.share), along.position(i, at.share), at.point,
               at.name};
  }
  return nearest;
}

/// What of the scene is the mission's ground. It is met where a flight takes off; find_below_ground judges it.
std::vector<std::uint32_t> all_ground(const Mission& mission) {
  std::vector<std::uint32_t> ground = flight::named_ground(mission);
  const std::vector<SceneObject>& objects = mission.scene().objects;
  const auto& named = mission.as_written.ground;
  const bool is_whole_scene = named && !named->plane_z_m && ground.empty();
  const bool is_surface = !named && std::none_of(objects.begin(), objects.end(), [](const SceneObject& object) {
    return object.kind == ObjectKind::ground;
  });
  for (std::uint32_t i = 0; i < objects.size(); ++i) {
    if (is_whole_scene || (is_surface && objects[i].kind == ObjectKind::surface)) ground.push_back(i);
  }
  return ground;
}

/// A flight that crosses nothing is inside a solid all along, but for one without a floor, which it may come into from
/// below. Then it is in it where it is highest, or else at one of the ends.
NearestPass inside_of(const Mission& mission, const std::vector<std::uint32_t>& ground, const std::vector<Leg>& legs,
                      const FlightTimeline& along) {
  const Scene& scene = mission.scene();
  if (scene.mesh.empty()) return {};
  std::pair<std::size_t, double> highest = {0, 0}, middle = {0, 0.5};
  const auto length = [&](std::size_t leg) { return (legs[leg].to - legs[leg].from).norm(); };
  for (std::size_t i = 0; i < legs.size(); ++i) {
    if (legs[i].to.z() > along.position(highest.first, highest.second).z()) highest = {i, 1};
    if (length(i) > length(middle.first)) middle.first = i;
  }
  const internal::scene::ViewpointCheck solids(scene, ground);
  for (const auto& [leg, share] : {std::pair<std::size_t, double>(0, 0), highest, middle, {legs.size() - 1, 1}}) {
    const Vec3 at = along.position(leg, share);
    const auto solid = solids.solid_around(at);
    if (!solid || solids.is_ground(*solid)) continue;
    return {0, along.at_m(leg, share), at, at, solids.name_of(*solid)};
  }
  return {};
}

constexpr const char* kBelowGround = "ground";

/// A part of a leg, and how far below the ground it may be.
struct Allowed {
  double begin = 0, end = 1, depth_m = 0;
};

/// The ground is known to a metre where a flight takes off and lands: on legs that go up and down, near its ends or
/// without going aside.
std::vector<Allowed> allowed_on(const Leg& leg, bool is_first, bool is_last) {
  constexpr double kTouchM = 1, kNearM = 20, kRoundingM = 1e-3;
  const Vec3 way = leg.to - leg.from;
  const double aside = way.head<2>().norm(), near = std::min(1.0, kNearM / aside);
  if (!(std::abs(way.z()) > kTouchM)) return {{0, 1, kRoundingM}};
  if (aside < kTouchM) return {{0, 1, kTouchM}};
  const double begin = is_first ? near : 0, end = is_last ? 1 - near : 1;
  if (begin >= end) return {{0, 1, kTouchM}};
  return {{0, begin, kTouchM}, {begin, end, kRoundingM}, {end, 1, kTouchM}};
}

/// Where the middle of the flight is below the ground, whatever heights the mission asks for.
void find_below(const Ground& ground, const std::vector<Leg>& legs, double radius_m, std::vector<OnLeg>& found) {
  constexpr double kAnyHeightM = 1e9;
  std::map<double, LegLimits> limits;  // by the depth that is allowed
  for (std::size_t i = 0; i < legs.size(); ++i) {
    const Vec3 way = legs[i].to - legs[i].from;
    for (const Allowed& part : allowed_on(legs[i], i == 0, i + 1 == legs.size())) {
      if (!(part.begin < part.end)) continue;
      auto judge = limits.find(part.depth_m);
      if (judge == limits.end()) {
        Navigation navigation;
        navigation.above_ground = AboveGround{-part.depth_m, kAnyHeightM, ground};
        judge = limits.emplace(part.depth_m, LegLimits(navigation)).first;
      }
      const auto on_leg = [&](double share) { return part.begin + share * (part.end - part.begin); };
      const Leg flown = {legs[i].from + part.begin * way, part.end < 1 ? legs[i].from + part.end * way : legs[i].to};
      for (LegBreak& broken : judge->second.broken(flown, radius_m)) {
        if (broken.limit != "agl min") continue;
        broken.limit = kBelowGround;
        broken.worst += part.depth_m;
        broken.worst_share = on_leg(broken.worst_share);
        for (LegInterval& interval : broken.intervals) interval = {on_leg(interval.begin), on_leg(interval.end)};
        found[i].broken.push_back(std::move(broken));
      }
    }
  }
}

/// Below what the mission measures heights from, and below what the scene calls its ground.
void find_below_ground(const Mission& mission, const std::vector<Leg>& legs, double radius_m,
                       std::vector<OnLeg>& found) {
  const auto& asked = mission.navigation.above_ground;
  const bool is_asked = asked && asked->min_m >= 0;  // told as that limit
  if (!is_asked) {
    if (const auto ground = flight::ground_if_known(mission)) find_below(*ground, legs, radius_m, found);
  }
  if (!mission.as_written.ground) return;
  if (const auto ground = ground_of(mission.scene())) find_below(*ground, legs, radius_m, found);
}

/// What is required and does not hold.
/// `met`: what the flight meets, at a distance of 0, or else anything.
std::vector<std::string> failures_of(const FlightCheck& check, const NearestPass& met,
                                     const FlightCheckOptions& options) {
  using internal::core::number_text;
  std::vector<std::string> failures;
  const double dwell = options.dwell_s.value_or(0);
  for (const TargetCheck& target : check.targets) {
    if (!target.longest) {
      failures.push_back(target.name + (target.is_volume ? " is not flown through" : " is nowhere seen whole"));
      continue;
    }
    const double longest_s = target.seen[*target.longest].duration_s();
    if (dwell > 0 && !(longest_s >= dwell)) {
      failures.push_back(internal::core::format("{} {} for {} s without a break, and {} s are asked for", target.name,
                                                target.is_volume ? "is flown through" : "is seen whole",
                                                number_text(longest_s), number_text(dwell)));
    } else if (options.gimbal_rate_deg_s && !target.is_volume &&
               !(target.followed && target.followed->duration_s() >= dwell)) {
      const double followed_s = target.followed ? target.followed->duration_s() : 0;
      failures.push_back(internal::core::format(
          "{} is seen whole for {} s without a break while the camera turns by at most {} degrees "
          "per second, and {} s are asked for",
          target.name, number_text(followed_s), number_text(*options.gimbal_rate_deg_s), number_text(dwell)));
    }
  }
  for (const LinkCheck& link : check.links) {
    if (const auto failure = flight::failure_of(link)) failures.push_back(*failure);
  }
  for (const BrokenLimit& limit : check.broken) {
    if (limit.name == kBelowGround) {
      failures.push_back(internal::core::format("the flight is {} m below the ground, {} m along it",
                                                number_text(limit.worst), number_text(limit.worst_at_m)));
      continue;
    }
    failures.push_back(
        std::isfinite(limit.worst)
            ? internal::core::format("{} is broken by {} {}, {} m along the flight", limit.name,
                                     number_text(limit.worst), limit.unit, number_text(limit.worst_at_m))
            : internal::core::format("{} is broken, {} m along the flight", limit.name, number_text(limit.worst_at_m)));
  }
  if (met.distance_m == 0) {
    failures.push_back(internal::core::format("the flight meets {}, {} m along it", met.object, number_text(met.at_m)));
  } else if (options.clearance_m && check.nearest.distance_m < *options.clearance_m) {
    failures.push_back(internal::core::format("{} is {} m away, {} m along the flight, and {} m are asked for",
                                              check.nearest.object.empty() ? "the scene" : check.nearest.object,
                                              number_text(check.nearest.distance_m), number_text(check.nearest.at_m),
                                              number_text(*options.clearance_m)));
  }
  return failures;
}

/// The legs of a flight. One point is a leg without length.
std::vector<Leg> legs_of(const Flight& flight) {
  std::vector<Leg> legs;
  for (std::size_t i = 0; i < flight.leg_count(); ++i) legs.push_back(flight.leg(i));
  if (legs.empty()) legs.push_back({flight.points.front().position, flight.points.front().position});
  return legs;
}

}  // namespace

double NotSeen::length_m() const {
  double length = 0;
  for (const FlightSpan& span : spans) length += span.length_m();
  return length;
}

const char* name_of(NotSeen::Kind kind) {
  switch (kind) {
    case NotSeen::Kind::hidden:
      return "hidden";
    case NotSeen::Kind::out_of_range:
      return "out_of_range";
    case NotSeen::Kind::behind:
      return "behind";
    case NotSeen::Kind::limit:
      return "limit";
    case NotSeen::Kind::outside:
      return "outside";
  }
  return "";
}

FlightCheck check_flight(const Mission& mission, const Flight& flight, const FlightCheckOptions& given,
                         const Progress& progress) {
  check_flight_points(flight);
  const FlightCheckOptions options = filled(mission, given);
  const FlightTimeline along(flight, options.speed_m_s.value_or(std::numeric_limits<double>::quiet_NaN()));
  if ((options.dwell_s.value_or(0) > 0 || options.gimbal_rate_deg_s) && std::isnan(along.duration_s())) {
    const std::string what = options.dwell_s.value_or(0) > 0 ? "a dwell" : "a rate of the gimbal";
    throw Error(ErrorCode::missing_key, what + " is asked for, and the plan does not say how fast it is flown",
                "flight", "give the speed, or ask for none");
  }
  FlightCheck check;
  check.length_m = along.length_m();
  check.duration_s = along.duration_s();
  check.tube_radius_m = options.tube_radius_m + flight.chord_error_m;
  check.point_at_m = along.point_at_m();
  check.arrival_s = along.arrival_s();
  check.departure_s = along.departure_s();
  for (const FlightPoint& point : flight.points) check.positions.push_back(point.position);

  const PreparedScene scene = options.prepared ? *options.prepared : PreparedScene(mission.scene(), progress);
  const std::vector<Leg> legs = legs_of(flight);
  LegChecks judges{{}, {}, LegLimits(mission.navigation)};
  for (std::size_t i = 0; i < volume_count(mission); ++i) judges.targets.emplace_back(one_volume(mission, i), scene);
  const std::vector<MissionLink>& written = mission.as_written.links;
  for (std::size_t i = 0; i < mission.links.size(); ++i) {
    const std::string place = i < written.size() ? written[i].place : "links[" + std::to_string(i) + "]";
    judges.links.emplace_back(mission.links[i], scene, legs, check.tube_radius_m, place);
  }
  const internal::core::ProgressReporter reporter(progress);
  reporter.begin("checking the flight");
  std::vector<OnLeg> found = judge_legs(flight, legs, judges, check.tube_radius_m, reporter);
  reporter.finish();
  find_below_ground(mission, legs, flight.chord_error_m, found);
  for (std::size_t i = 0; i < judges.targets.size(); ++i) {
    check.targets.push_back(check_target(judges.targets[i], i, found, flight, along, options));
  }
  for (std::size_t i = 0; i < judges.links.size(); ++i) {
    std::vector<LegView> views;
    for (const OnLeg& on : found) views.push_back(on.links[i]);
    check.links.push_back(judges.links[i].check(views, legs, along, check.tube_radius_m));
  }
  check.broken = broken_limits(found, along);
  const auto nearest_but = [&](const std::vector<std::uint32_t>& ground) {
    const LegDistances distances(scene, {.without_ground = true, .without_objects = ground});
    return nearest_pass(legs, distances, along, check.tube_radius_m, progress);
  };
  check.nearest = nearest_but(flight::named_ground(mission));
  const std::vector<std::uint32_t> ground = all_ground(mission);
  NearestPass met = check.nearest.distance_m > 0 ? check.nearest : nearest_but(ground);
  if (met.distance_m > 0) {
    if (const NearestPass inside = inside_of(mission, ground, legs, along); !inside.object.empty()) met = inside;
  }
  if (met.distance_m == 0) check.nearest = met;
  check.failures = failures_of(check, met, options);
  check.not_judged = flight.not_judged;
  for (const Warning& note : mission.notes) check.notes.push_back(note.text);
  for (const Warning& note : beyond_data_warnings(mission, places_of(check, mission, options), progress)) {
    check.notes.push_back(note.text);
  }
  return check;
}

}  // namespace vantage
