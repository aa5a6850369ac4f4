#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "query/leg_convex.h"
#include "query/leg_limit.h"
#include "query/zone_place.h"

namespace vantage::internal::query {
namespace {

using Plan = Eigen::Vector2d;

double distance_to_side(const Plan& place, const Plan& a, const Plan& b) {
  const Plan side = b - a;
  const double square = side.squaredNorm();
  const double share = square > 0 ? std::clamp((place - a).dot(side) / square, 0.0, 1.0) : 0.0;
  return (place - a - share * side).norm();
}

/// Distance from a box; inside: how far from leaving it, negative.
double outside_box(const Box& box, const Vec3& place) {
  const Vec3 beyond = (box.min - place).cwiseMax(place - box.max);
  const double farthest = beyond.maxCoeff();
  return farthest <= 0 ? farthest : beyond.cwiseMax(0).norm();
}

LegIntervals kept_in_box(const Box& box, const Tube& tube) {
  LegIntervals kept{{0, 1}};
  for (int axis = 0; axis < 3; ++axis) {
    const double from = tube.leg.from[axis], to = tube.leg.to[axis], r = tube.radius;
    kept = without(kept, where_positive(box.min[axis] - from + r, box.min[axis] - to + r));
    kept = without(kept, where_positive(from - box.max[axis] + r, to - box.max[axis] + r));
  }
  return kept;
}

LegIntervals broken_by_box(const Box& box, const Tube& tube) {
  if (tube.radius > 0) {
    const auto distance = [&](double share) { return std::max(0.0, outside_box(box, tube.at(share))); };
    const auto part = below_level(distance, tube.radius);
    return part ? LegIntervals{*part} : LegIntervals{};
  }
  LegIntervals broken{{0, 1}};
  for (int axis = 0; axis < 3; ++axis) {
    const double from = tube.leg.from[axis], to = tube.leg.to[axis];
    broken = common(broken, where_positive(from - box.min[axis], to - box.min[axis]));
    broken = common(broken, where_positive(box.max[axis] - from, box.max[axis] - to));
  }
  return broken;
}

/// A zone with the ground of its heights.
class LegZone {
 public:
  LegZone(const Zone& zone, LegGroundPool& grounds);

  LegIntervals kept(const Tube& tube) const;    ///< as a zone to stay in: all of the tube is in it
  LegIntervals broken(const Tube& tube) const;  ///< as a zone to stay out of
  /// Distance from the zone; heights above ground vertically. Inside: how far from leaving it, negative. Where the
  /// ground has a step, a zone to stay in is what all of the ground there allows, and one to stay out of is what any of
  /// it forbids.
  double outside(const Vec3& place, bool is_to_stay_in) const;

 private:
  double outside_without_ground(const Vec3& place) const;
  LegIntervals in_plan(const Tube& tube, bool with_border) const;
  LegIntervals near_sides(const Tube& tube, bool within_heights) const;

  Zone zone_;
  Box box_;
  std::shared_ptr<const LegGround> ground_;
};

LegZone::LegZone(const Zone& zone, LegGroundPool& grounds) : zone_(zone), box_(box_of(zone)) {
  if (zone.above_ground) ground_ = grounds.of(zone.above_ground->ground);
}

/// The intervals of the leg itself: between two places where it passes a side, or nearly, all of it is inside or none.
LegIntervals LegZone::in_plan(const Tube& tube, bool with_border) const {
  const Plan from = tube.leg.from.head<2>(), along = tube.leg.to.head<2>() - from;
  constexpr double kNear = 1e-9;  // of a side's length
  std::vector<double> cuts{0, 1};
  for_each_side(zone_, [&](const Plan& a, const Plan& b) {
    const Plan side = b - a, to_a = a - from;
    const double slope = along.x() * side.y() - along.y() * side.x();
    if (slope == 0) {
      // It slides along the side, or passes beside it: from end to end.
      for (const Plan& end : {a, b}) {
        const double square = along.squaredNorm();
        if (square > 0) cuts.push_back((end - from).dot(along) / square);
      }
      return;
    }
    const double at = (to_a.x() * along.y() - to_a.y() * along.x()) / slope;
    if (at >= -kNear && at <= 1 + kNear) cuts.push_back((to_a.x() * side.y() - to_a.y() * side.x()) / slope);
  });
  std::erase_if(cuts, [](double cut) { return !(cut >= 0 && cut <= 1); });
  std::sort(cuts.begin(), cuts.end());
  LegIntervals parts;
  for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
    if (!(cuts[i] < cuts[i + 1])) continue;
    const ZonePlace place = place_in(zone_, from + 0.5 * (cuts[i] + cuts[i + 1]) * along);
    if (place == ZonePlace::inside || (with_border && place == ZonePlace::border)) {
      parts.push_back({cuts[i], cuts[i + 1]});
    }
  }
  return joined(std::move(parts));
}

/// Where the leg is nearer than the radius to a side: in plan, or to the wall that stands on it between the zone's
/// heights.
LegIntervals LegZone::near_sides(const Tube& tube, bool within_heights) const {
  LegIntervals parts;
  const Box near = tube.box();
  for_each_side(zone_, [&](const Plan& a, const Plan& b) {
    const Plan low = a.cwiseMin(b), high = a.cwiseMax(b);
    if (low.x() > near.max.x() || high.x() < near.min.x() || low.y() > near.max.y() || high.y() < near.min.y()) return;
    const auto distance = [&](double share) {
      const Vec3 place = tube.at(share);
      const double aside = distance_to_side(place.head<2>(), a, b);
      const double beyond =
          within_heights ? std::max({0.0, zone_.min_z_m - place.z(), place.z() - zone_.max_z_m}) : 0.0;
      return std::hypot(aside, beyond);
    };
    if (const auto part = below_level(distance, tube.radius)) parts.push_back(*part);
  });
  return joined(std::move(parts));
}

LegIntervals LegZone::kept(const Tube& tube) const {
  if (zone_.is_box) return kept_in_box(box_, tube);
  if (!boxes_meet(box_, tube.box())) return {};
  const double from = tube.leg.from.z(), to = tube.leg.to.z(), radius = tube.radius;
  LegIntervals parts = in_plan(tube, true);
  if (parts.empty()) return parts;
  parts = without(parts, where_positive(zone_.min_z_m - from + radius, zone_.min_z_m - to + radius));
  parts = without(parts, where_positive(from - zone_.max_z_m + radius, to - zone_.max_z_m + radius));
  if (radius > 0) parts = without(parts, near_sides(tube, false));
  if (!zone_.above_ground) return parts;
  parts = without(parts, ground_->below(tube, zone_.above_ground->min_m));
  parts = without(parts, ground_->over(tube, zone_.above_ground->max_m));
  return without(parts, ground_->beside(tube));
}

LegIntervals LegZone::broken(const Tube& tube) const {
  if (zone_.is_box) return broken_by_box(box_, tube);
  if (!boxes_meet(box_, tube.box())) return {};
  const double from = tube.leg.from.z(), to = tube.leg.to.z(), radius = tube.radius;
  LegIntervals parts = in_plan(tube, false);
  parts = common(parts, where_positive(from - zone_.min_z_m + radius, to - zone_.min_z_m + radius));
  parts = common(parts, where_positive(zone_.max_z_m - from + radius, zone_.max_z_m - to + radius));
  if (radius > 0) {
    const LegIntervals near = near_sides(tube, true);
    parts.insert(parts.end(), near.begin(), near.end());
    parts = joined(std::move(parts));
  }
  if (!zone_.above_ground || parts.empty()) return parts;
  // Above the lowest height over some piece of ground, and below the highest one over some other; or without ground.
  LegIntervals between =
      common(ground_->over(tube, zone_.above_ground->min_m), ground_->below(tube, zone_.above_ground->max_m));
  const LegIntervals beside = ground_->beside(tube);
  between.insert(between.end(), beside.begin(), beside.end());
  return common(parts, joined(std::move(between)));
}

double LegZone::outside_without_ground(const Vec3& place) const {
  if (zone_.is_box) return outside_box(box_, place);
  double aside = INFINITY;
  for_each_side(
      zone_, [&](const Plan& a, const Plan& b) { aside = std::min(aside, distance_to_side(place.head<2>(), a, b)); });
  if (place_in(zone_, place.head<2>()) != ZonePlace::outside) aside = -aside;
  const double beyond = std::max(zone_.min_z_m - place.z(), place.z() - zone_.max_z_m);
  if (aside <= 0 && beyond <= 0) return std::max(aside, beyond);
  return std::hypot(std::max(aside, 0.0), std::max(beyond, 0.0));
}

double LegZone::outside(const Vec3& place, bool is_to_stay_in) const {
  const double outside = outside_without_ground(place);
  if (!zone_.above_ground) return outside;
  const auto heights = ground_->heights(place);
  if (!heights) return outside;
  const double low = is_to_stay_in ? heights->above_highest : heights->above_lowest;
  const double high = is_to_stay_in ? heights->above_lowest : heights->above_highest;
  return std::max({outside, zone_.above_ground->min_m - low, high - zone_.above_ground->max_m});
}

std::vector<LegZone> leg_zones(const std::vector<Zone>& zones, LegGroundPool& grounds) {
  std::vector<LegZone> result;
  for (const Zone& zone : zones) result.emplace_back(zone, grounds);
  return result;
}

class KeepInOfLeg : public LegLimit {
 public:
  KeepInOfLeg(const std::vector<Zone>& zones, LegGroundPool& grounds) : zones_(leg_zones(zones, grounds)) {}

  void add_breaks(const Tube& tube, std::vector<LegBreak>& breaks) const override {
    LegIntervals kept;
    const auto add = [&](const LegIntervals& more) { kept.insert(kept.end(), more.begin(), more.end()); };
    for (const LegZone& zone : zones_) add(zone.kept(tube));
    add_break(breaks, "keep_in", LegBreak::Unit::metres, rest_of(joined(std::move(kept))),
              [&](double share) { return outside_all(tube.at(share)) + tube.radius; });
  }

 private:
  double outside_all(const Vec3& place) const {
    double least = INFINITY;
    for (const LegZone& zone : zones_) least = std::min(least, zone.outside(place, true));
    return least;
  }

  std::vector<LegZone> zones_;
};

class KeepOutOfLeg : public LegLimit {
 public:
  KeepOutOfLeg(const std::vector<Zone>& zones, LegGroundPool& grounds) : zones_(leg_zones(zones, grounds)) {
    for (std::size_t i = 0; i < zones.size(); ++i) names_.push_back("keep_out " + zone_name(zones, i));
  }

  void add_breaks(const Tube& tube, std::vector<LegBreak>& breaks) const override {
    for (std::size_t i = 0; i < zones_.size(); ++i) {
      add_break(breaks, names_[i], LegBreak::Unit::metres, zones_[i].broken(tube),
                [&](double share) { return tube.radius - zones_[i].outside(tube.at(share), false); });
    }
  }

 private:
  std::vector<LegZone> zones_;
  std::vector<std::string> names_;
};

}  // namespace

template <>
std::unique_ptr<const LegLimit> leg_limit<Limit::keep_in>(const std::vector<Zone>& zones, LegGroundPool& grounds) {
  return std::make_unique<KeepInOfLeg>(zones, grounds);
}

template <>
std::unique_ptr<const LegLimit> leg_limit<Limit::keep_out>(const std::vector<Zone>& zones, LegGroundPool& grounds) {
  return std::make_unique<KeepOutOfLeg>(zones, grounds);
}

}  // namespace vantage::internal::query
