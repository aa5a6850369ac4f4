// LegLimits: each limit by itself along a leg.
#include "query/leg_limits.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "core/parallel.h"
#include "core/progress_reporter.h"
#include "query/leg_check.h"
#include "query/leg_convex.h"

namespace vantage {
namespace internal::query {
namespace {

/// The place of an interval where a function is largest, among 17 and about the best of these.
double greatest_place(const LegInterval& interval, const Amount& amount) {
  constexpr int kPlaces = 16;
  const double step = (interval.end - interval.begin) / kPlaces;
  const auto place = [&](double i) { return std::min(interval.end, interval.begin + i * step); };
  int best = 0;
  double most = -INFINITY;
  for (int i = 0; i <= kPlaces; ++i) {
    if (const double value = amount(place(i)); value > most) {
      most = value;
      best = i;
    }
  }
  const double low = std::max(0, best - 1), high = std::min(kPlaces, best + 1);
  constexpr double kGolden = 0.6180339887498949;
  double begin = low, end = high, result = place(best);
  for (int i = 0; i < 24 && step > 0; ++i) {
    const double a = end - kGolden * (end - begin), b = begin + kGolden * (end - begin);
    const double at_a = amount(place(a)), at_b = amount(place(b));
    if (std::max(at_a, at_b) > most) {
      most = std::max(at_a, at_b);
      result = place(at_a >= at_b ? a : b);
    }
    (at_a >= at_b ? end : begin) = at_a >= at_b ? b : a;
  }
  return result;
}

}  // namespace

Box Tube::box() const {
  Box box;
  box.extend(leg.from);
  box.extend(leg.to);
  box.min.array() -= radius;
  box.max.array() += radius;
  return box;
}

void add_break(std::vector<LegBreak>& breaks, const std::string& limit, LegBreak::Unit unit, LegIntervals intervals,
               const Amount& amount) {
  if (intervals.empty()) return;
  LegBreak result{limit, std::move(intervals), -INFINITY, unit, 0};
  for (const LegInterval& interval : result.intervals) {
    const double place = greatest_place(interval, amount);
    if (const double value = amount(place); value > result.worst) {
      result.worst = value;
      result.worst_share = place;
    }
  }
  result.worst = std::max(0.0, result.worst);
  breaks.push_back(std::move(result));
}

}  // namespace internal::query

namespace {

namespace query = internal::query;
using query::add_break;
using query::LegGround;
using query::LegIntervals;
using query::LegZone;
using query::Tube;
using Unit = LegBreak::Unit;

/// Where some of the tube is strictly below a height, or above one.
LegIntervals below_height(const Tube& tube, double z) {
  return query::where_positive(z - tube.leg.from.z() + tube.radius, z - tube.leg.to.z() + tube.radius);
}
LegIntervals above_height(const Tube& tube, double z) {
  return query::where_positive(tube.leg.from.z() - z + tube.radius, tube.leg.to.z() - z + tube.radius);
}

}  // namespace

struct LegLimits::Data {
  Data(const Navigation& given, std::optional<internal::sensor::SensorLimits> sensor_limits)
      : navigation(given), sensor(std::move(sensor_limits)) {
    if (navigation.above_ground) ground = ground_for(navigation.above_ground->ground);
    for (const Zone& zone : navigation.keep_in) keep_in.emplace_back(zone, ground_of_zone(zone));
    for (const Zone& zone : navigation.keep_out) keep_out.emplace_back(zone, ground_of_zone(zone));
    for (const KeepInMesh& mesh : navigation.meshes) meshes.push_back(std::make_unique<query::LegMesh>(mesh));
    if (navigation.clearance) obstacles.emplace(*navigation.clearance->obstacles);
  }

  std::shared_ptr<const LegGround> ground_for(const Ground& of) {
    for (const auto& [known, made] : grounds) {
      if (known.surface == of.surface && known.plane_z_m == of.plane_z_m) return made;
    }
    return grounds.emplace_back(of, std::make_shared<const LegGround>(of)).second;
  }
  std::shared_ptr<const LegGround> ground_of_zone(const Zone& zone) {
    return zone.above_ground ? ground_for(zone.above_ground->ground) : nullptr;
  }

  // All members of Navigation are named: a limit that is added does not compile before it is answered.
  std::vector<LegBreak> broken(const Tube& tube) const {
    const auto& [altitude, keep_in_zones, keep_out_zones, keep_in_meshes, above_ground, clearance] = navigation;
    std::vector<LegBreak> breaks;
    if (altitude) {
      const double low = altitude->min_m, high = altitude->max_m;
      add_break(breaks, "altitude min", Unit::metres, below_height(tube, low),
                [&](double share) { return low - tube.at(share).z() + tube.radius; });
      add_break(breaks, "altitude max", Unit::metres, above_height(tube, high),
                [&](double share) { return tube.at(share).z() - high + tube.radius; });
    }
    if (above_ground) add_above_ground(tube, breaks);
    if (!keep_in_zones.empty()) add_keep_in(tube, breaks);
    for (std::size_t i = 0; i < keep_out.size(); ++i) {
      add_break(breaks, "keep_out " + zone_name(keep_out_zones, i), Unit::metres, keep_out[i].broken(tube),
                [&](double share) { return tube.radius - outside_zone(keep_out[i], tube.at(share), false); });
    }
    for (std::size_t i = 0; i < keep_in_meshes.size(); ++i) {
      add_break(breaks, "mesh " + keep_in_meshes[i].name, Unit::metres, meshes[i]->broken(tube),
                [&](double share) { return meshes[i]->outside(tube.at(share)) + tube.radius; });
    }
    if (clearance) {
      const double distance = clearance->distance_m;
      add_break(breaks, "clearance", Unit::metres, query::too_near(*obstacles, tube, distance), [&](double share) {
        return distance + tube.radius - obstacles->distance(tube.at(share) - obstacles->origin());
      });
    }
    if (sensor) query::add_sensor_breaks(*sensor, tube, breaks);
    return breaks;
  }

  void add_above_ground(const Tube& tube, std::vector<LegBreak>& breaks) const {
    const double low = navigation.above_ground->min_m, high = navigation.above_ground->max_m;
    add_break(breaks, "ground edge", Unit::metres, ground->beside(tube),
              [&](double share) { return ground->plan_distance(tube.at(share)) + tube.radius; });
    add_break(breaks, "agl min", Unit::metres, ground->below(tube, low), [&](double share) {
      const auto heights = ground->heights(tube.at(share));
      return heights ? low - heights->above_highest + tube.radius : 0;
    });
    add_break(breaks, "agl max", Unit::metres, ground->over(tube, high), [&](double share) {
      const auto heights = ground->heights(tube.at(share));
      return heights ? heights->above_lowest - high + tube.radius : 0;
    });
  }

  void add_keep_in(const Tube& tube, std::vector<LegBreak>& breaks) const {
    LegIntervals kept;
    const auto add = [&](const LegIntervals& more) { kept.insert(kept.end(), more.begin(), more.end()); };
    for (const LegZone& zone : keep_in) add(zone.kept(tube));
    LegIntervals outside = query::rest_of(query::joined(std::move(kept)));
    add_break(breaks, "keep_in", Unit::metres, std::move(outside),
              [&](double share) { return outside_all(tube.at(share)) + tube.radius; });
  }

  /// How far a place is from what it may be in.
  double outside_all(const Vec3& place) const {
    double least = INFINITY;
    for (const LegZone& zone : keep_in) least = std::min(least, outside_zone(zone, place, true));
    return least;
  }
  /// How far a place is from a zone; heights vertically. Where the ground has a step, a zone to stay in is what all of
  /// the ground there allows, and one to stay out of is what any of it forbids.
  double outside_zone(const LegZone& zone, const Vec3& place, bool is_to_stay_in) const {
    double outside = zone.outside(place);
    const std::optional<AboveGround>& limit = zone.zone().above_ground;
    if (!limit) return outside;
    for (const auto& [known, made] : grounds) {
      if (known.surface != limit->ground.surface || known.plane_z_m != limit->ground.plane_z_m) continue;
      if (const auto heights = made->heights(place)) {
        const double low = is_to_stay_in ? heights->above_highest : heights->above_lowest;
        const double high = is_to_stay_in ? heights->above_lowest : heights->above_highest;
        outside = std::max({outside, limit->min_m - low, high - limit->max_m});
      }
    }
    return outside;
  }

  Navigation navigation;
  std::optional<internal::sensor::SensorLimits> sensor;
  std::vector<std::pair<Ground, std::shared_ptr<const LegGround>>> grounds;
  std::shared_ptr<const LegGround> ground;
  std::vector<LegZone> keep_in, keep_out;
  std::vector<std::unique_ptr<query::LegMesh>> meshes;
  std::optional<query::LegTriangles> obstacles;
};

LegLimits::LegLimits(const Navigation& navigation) {
  check_navigation(navigation);
  data_ = std::make_unique<Data>(navigation, std::nullopt);
}
LegLimits::LegLimits(const PreparedTarget& target, const Navigation& navigation) {
  check_navigation(navigation);
  data_ = std::make_unique<Data>(navigation,
                                 internal::sensor::SensorLimits(internal::sensor::viewed_of(target), target.sensor()));
}
LegLimits::~LegLimits() = default;
LegLimits::LegLimits(LegLimits&&) noexcept = default;
LegLimits& LegLimits::operator=(LegLimits&&) noexcept = default;

std::vector<LegBreak> LegLimits::broken(const Leg& leg, double radius_m) const {
  query::check_leg(leg, radius_m);
  return data_->broken({leg, radius_m});
}

std::vector<std::vector<LegBreak>> LegLimits::broken(std::span<const Leg> legs, double radius_m,
                                                     const Progress& progress) const {
  for (std::size_t i = 0; i < legs.size(); ++i) query::check_leg(legs[i], radius_m, i);
  const internal::core::ProgressReporter reporter(progress, "legs");
  reporter.begin("legs and limits");
  internal::core::ProgressCounter done(reporter, legs.size());
  std::vector<std::vector<LegBreak>> result(legs.size());
  internal::parallel::for_ranges(legs.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      result[i] = data_->broken({legs[i], radius_m});
      done.add();
    }
  });
  reporter.finish();
  return result;
}

std::vector<LegInterval> kept_parts(std::span<const LegBreak> broken) {
  LegIntervals all;
  for (const LegBreak& one : broken) all.insert(all.end(), one.intervals.begin(), one.intervals.end());
  return query::rest_of(query::joined(std::move(all)));
}

}  // namespace vantage
