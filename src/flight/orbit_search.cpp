#include "flight/orbit_search.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace vantage::internal::flight {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();
constexpr std::size_t kX = 0, kY = 1, kZ = 2, kRadius = 3, kStraight = 4, kAngle = 5;

/// Points of a curve that are asked for in a box: as far apart as the box reaches.
std::size_t point_count(const ClosedCurve& curve, double reach) {
  constexpr double kFewest = 16, kMost = 256;
  return static_cast<std::size_t>(std::clamp(std::ceil(curve.length_m() / reach), kFewest, kMost));
}

}  // namespace

double CurveDepth::depth_m(const ClosedCurve& curve, double error_m, double needed) const {
  const double chord_error = error_m / 2;
  const std::vector<Vec3> corners = curve.corners(chord_error);
  double longest = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    if (solid_.at_most_m(corners[i]) < needed) return -kNever;
    longest = std::max(longest, (corners[i] - corners[(i + 1) % corners.size()]).norm());
  }
  constexpr double kAlongEdge = 1e-8;  // SegmentDistance, of a segment's length
  const double slack = error_m / 4;
  const double lost = chord_error + slack + solid_.rounding_m() + kAlongEdge * longest;
  // One point inside, and no facet on the way: all of it is.
  double depth = solid_.depth_m(corners[0]);
  for (std::size_t i = 0; i < corners.size(); ++i) {
    if (!(depth - lost >= needed)) return -kNever;
    depth = solid_.distance().nearest(corners[i], corners[(i + 1) % corners.size()], depth, slack).distance_m;
  }
  return depth - lost >= needed ? depth - lost : -kNever;
}

OrbitSearch::OrbitSearch(const CurveDepth& depth, CurveRequest request) : depth_(depth), request_(std::move(request)) {
  if (request_.most_half_straight_m > 0) angle_scale_ = request_.most_half_straight_m;
}

void OrbitSearch::run(const std::optional<ClosedCurve>& known, const core::ProgressReporter& progress) {
  const Box& bounds = depth_.solid().bounds();
  SearchBox<6> root;
  const auto set = [&](std::size_t number, double low, double high) {
    root.middle[number] = (low + high) / 2;
    root.half[number] = (high - low) / 2;
  };
  set(kX, bounds.min.x(), bounds.max.x());
  set(kY, bounds.min.y(), bounds.max.y());
  set(kZ, bounds.min.z(), bounds.max.z());
  if (request_.centre == OrbitCentre::over_target) {
    set(kX, request_.target.x(), request_.target.x());
    set(kY, request_.target.y(), request_.target.y());
  }
  set(kRadius, request_.least_radius_m, request_.most_radius_m);
  set(kStraight, 0, request_.most_half_straight_m);
  set(kAngle, 0, request_.most_half_straight_m > 0 ? std::numbers::pi * angle_scale_ : 0);
  if (request_.kind == OrbitKind::deepest) {
    const Vec3 size = bounds.max - bounds.min;
    root.weight[kZ] = flatness(size.z(), size.head<2>().minCoeff());
  }
  if (known) {
    offer({known->centre.x(), known->centre.y(), known->centre.z(), known->radius_m, known->half_straight_m,
           known->angle * angle_scale_},
          depth_.solid().size_m() / 20);
  }
  end_ = search_box(*this, root, request_.limits, progress);
  if (curve_) polish();
  end_.bound = std::max(end_.bound, best_);
}

/// The search looks no closer at a curve than it must. Closer, the best one can be made a little better.
void OrbitSearch::polish() {
  constexpr double kFiner = 16;
  request_.error_m /= kFiner;
  const double step = request_.error_m * kFiner;
  request_.limits.tolerance = 0;
  best_ -= 1e-12 * std::abs(best_);  // so that the same curve counts again, as it is deeper by what is known now
  offer({curve_->centre.x(), curve_->centre.y(), curve_->centre.z(), curve_->radius_m, curve_->half_straight_m,
         curve_->angle * angle_scale_},
        step);
}

ClosedCurve OrbitSearch::curve_at(const Numbers& numbers) const {
  return {Vec3(numbers[kX], numbers[kY], numbers[kZ]),
          std::clamp(numbers[kRadius], request_.least_radius_m, request_.most_radius_m),
          std::clamp(numbers[kStraight], 0.0, request_.most_half_straight_m), numbers[kAngle] / angle_scale_};
}

/// No point of a curve in the box is farther from the middle's curve. Both bound convex bodies; the distance of their
/// borders (Hausdorff) is that of the bodies, which are segments grown by the radius.
double OrbitSearch::reach_of(const SearchBox<6>& box) const {
  const double turned = (box.middle[kStraight] + box.half[kStraight]) * box.half[kAngle] / angle_scale_;
  const double in_plan = std::hypot(box.half[kX], box.half[kY]) + box.half[kRadius] + box.half[kStraight] + turned;
  return std::hypot(in_plan, box.half[kZ]);
}

bool OrbitSearch::may_hold_target(const ClosedCurve& curve, const SearchBox<6>& box) const {
  if (request_.centre == OrbitCentre::anywhere) return true;
  const double turned = (box.middle[kStraight] + box.half[kStraight]) * box.half[kAngle] / angle_scale_;
  const double reach = std::hypot(box.half[kX], box.half[kY]) + box.half[kRadius] + box.half[kStraight] + turned;
  return curve.distance_outside(request_.target) <= reach;
}

/// Points of the middle's curve, and how far each may be from one of any curve in the box, in three axes: moved with
/// the centre, along its normal with the radius, and by what a straight grows and turns.
std::vector<OrbitSearch::Place> OrbitSearch::places_on(const ClosedCurve& curve, const SearchBox<6>& box,
                                                       std::size_t count) const {
  const Vec3 direction(std::cos(curve.angle), std::sin(curve.angle), 0);
  const double turned = (box.middle[kStraight] + box.half[kStraight]) * box.half[kAngle] / angle_scale_;
  const double any_way = box.half[kStraight] + turned;
  std::vector<Place> places;
  places.reserve(count);
  for (const Vec3& point : curve.points(count)) {
    const Vec3 offset = point - curve.centre;
    const double along = std::clamp(direction.dot(offset), -curve.half_straight_m, curve.half_straight_m);
    const Vec3 normal = (offset - along * direction) / curve.radius_m;
    places.push_back({point, Vec3(box.half[kX] + box.half[kRadius] * std::abs(normal.x()) + any_way,
                                  box.half[kY] + box.half[kRadius] * std::abs(normal.y()) + any_way, box.half[kZ])});
  }
  return places;
}

/// No curve in the box is deeper than the bound. Looks no closer where that is less than `interesting`. The depth is
/// the least of the middle's curve at the points that were looked at.
SolidDepth::Bounded OrbitSearch::depth_bound(const ClosedCurve& curve, const SearchBox<6>& box,
                                             double interesting) const {
  const SolidDepth& solid = depth_.solid();
  constexpr std::size_t kMostLookedAt = 24, kMostInVain = 3, kFewest = 16;
  SolidDepth::Bounded least{kNever, kNever};
  const double reach = reach_of(box);
  std::vector<Place> places;
  for (const std::size_t count : {kFewest, point_count(curve, reach)}) {
    places = places_on(curve, box, count);
    for (Place& place : places) {
      place.at_least = solid.at_least_m(place.point);
      least.bound_m = std::min(least.bound_m, solid.box_at_most_m(place.point, place.reach));
      if (least.bound_m < interesting) return least;
    }
  }
  // First those that may be the least deep.
  std::sort(places.begin(), places.end(), [](const Place& a, const Place& b) { return a.at_least < b.at_least; });
  std::size_t in_vain = 0;  // looks, since one told something
  for (std::size_t i = 0; i < std::min(kMostLookedAt, places.size()) && in_vain < kMostInVain; ++i) {
    if (least.bound_m < interesting || places[i].at_least > least.depth_m - reach / 4) break;
    const SolidDepth::Bounded one = solid.bounded_m(places[i].point, places[i].reach);
    in_vain = one.bound_m < least.bound_m - reach / 8 ? 0 : in_vain + 1;
    least.bound_m = std::min(least.bound_m, one.bound_m);
    least.depth_m = std::min(least.depth_m, one.depth_m);
  }
  return least;
}

/// Minus the logarithm of the largest pixel: no curve within reach has more.
double OrbitSearch::pixel_value(const ClosedCurve& curve, double reach, std::size_t count) const {
  double largest = 0;
  for (const Vec3& point : curve.points(count)) largest = std::max(largest, request_.pixel_m(point, reach));
  return -std::log(largest);
}

void OrbitSearch::moved_to_target(ClosedCurve& curve) const {
  if (request_.centre == OrbitCentre::anywhere) return;
  const Vec3 direction(std::cos(curve.angle), std::sin(curve.angle), 0);
  Vec3 offset = request_.target - curve.centre;
  offset.z() = 0;
  offset -= std::clamp(direction.dot(offset), -curve.half_straight_m, curve.half_straight_m) * direction;
  const double distance = offset.norm();
  if (distance > curve.radius_m) curve.centre += (1 + 1e-12) * (1 - curve.radius_m / distance) * offset;
}

/// Minus infinity where the curve does not count, or is no better than the best. Makes it wider where that is the aim.
double OrbitSearch::allowed_value(ClosedCurve& curve) const {
  moved_to_target(curve);
  double value = -kNever;
  double needed = request_.margin_m;
  if (request_.kind == OrbitKind::deepest) needed = std::max(needed, best_);
  if (request_.kind == OrbitKind::finest_pixel) {
    value = pixel_value(curve, 0, point_count(curve, 0.01 * curve.radius_m));
    if (!(value > best_)) return -kNever;
  }
  const double depth = depth_.depth_m(curve, request_.error_m, needed);
  if (!(depth >= needed)) return -kNever;
  if (request_.kind == OrbitKind::deepest) value = depth;
  if (request_.kind == OrbitKind::widest) {
    // As much wider as it is deeper: no point of it moves more.
    curve.radius_m = std::min(request_.most_radius_m, curve.radius_m + (depth - request_.margin_m));
    value = curve.radius_m;
  }
  return value > best_ && request_.is_inside(curve) ? value : -kNever;
}

/// A curve to be compared with the best; better ones about it are looked for, where it is much better.
void OrbitSearch::offer(const Numbers& numbers, double step) {
  ClosedCurve curve = curve_at(numbers);
  const double value = allowed_value(curve);
  if (!(value > best_)) return;
  const bool is_much_better = value > best_ + request_.limits.tolerance;
  best_ = value;
  curve_ = curve;
  if (!is_much_better) return;
  const double scaled = request_.most_half_straight_m > 0 ? step : 0;
  const bool is_over = request_.centre == OrbitCentre::over_target;
  const Numbers steps = {is_over ? 0 : step, is_over ? 0 : step, step, step, scaled, scaled};
  Numbers place = {curve.centre.x(), curve.centre.y(),      curve.centre.z(),
                   curve.radius_m,   curve.half_straight_m, curve.angle * angle_scale_};
  climb(place, value, steps, std::min(1.0, request_.error_m / step), [&](const Numbers& next) {
    ClosedCurve other = curve_at(next);
    const double found = allowed_value(other);
    if (found > best_) {
      best_ = found;
      curve_ = other;
    }
    return found;
  });
}

/// Whether the curve could be the best, if it is no deeper than so much: only then it is worth to look closely.
bool OrbitSearch::may_be_better(const ClosedCurve& curve, double depth) const {
  if (request_.kind == OrbitKind::deepest) return depth > best_ + request_.error_m;
  if (request_.kind == OrbitKind::widest) return curve.radius_m + (depth - request_.margin_m) > best_;
  return true;
}

double OrbitSearch::bound_of(const SearchBox<6>& box) {
  const ClosedCurve curve = curve_at(box.middle);
  if (!may_hold_target(curve, box)) return -kNever;
  const double reach = reach_of(box), interesting = best_ + request_.limits.tolerance;
  double needed = request_.margin_m + request_.slack_m, bound = kNever;
  if (request_.kind == OrbitKind::widest) bound = curve.radius_m + box.half[kRadius];
  if (request_.kind == OrbitKind::finest_pixel) bound = pixel_value(curve, reach, point_count(curve, reach));
  if (!(bound > interesting)) return bound;
  if (request_.kind == OrbitKind::deepest) needed = std::max(needed, interesting);
  const SolidDepth::Bounded depth = depth_bound(curve, box, needed);
  if (depth.bound_m < request_.margin_m + request_.slack_m) return -kNever;
  if (request_.kind == OrbitKind::deepest) bound = depth.bound_m;
  if (depth.bound_m < needed) return bound;
  if (depth.depth_m >= request_.margin_m && may_be_better(curve, depth.depth_m)) offer(box.middle, reach);
  return bound;
}

}  // namespace vantage::internal::flight
