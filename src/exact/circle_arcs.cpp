#include "exact/circle_arcs.h"

#include <cmath>
#include <numbers>

#include "exact/segment_cover.h"
#include "target/numerics.h"

namespace vantage::internal::exact {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;

double unrolled(double angle) {
  angle = std::fmod(angle, kTurn);
  return angle < 0 ? angle + kTurn : angle;
}

}  // namespace

CircleArcs::Cut CircleArcs::cut(const Vec3& normal, double height, double margin, Arc& arc) const {
  const double a = circle_.radius * normal.dot(circle_.axis_1), b = circle_.radius * normal.dot(circle_.axis_2);
  const double level = height - normal.dot(circle_.centre), amplitude = std::hypot(a, b);
  if (level >= amplitude - margin) return Cut::none;
  if (level <= -amplitude + margin) return Cut::all;
  arc = {std::atan2(b, a), std::acos(std::clamp(level / amplitude, -1.0, 1.0))};
  return Cut::some;
}

void CircleArcs::keep(const Vec3& normal, double height) {
  Arc arc;
  switch (cut(normal, height, 0, arc)) {
    case Cut::all:
      return;
    case Cut::none:
      parts_.assign(0, 0);
      return;
    case Cut::some: {  // take the rest of the circle away
      const double begin = unrolled(arc.middle + arc.half_width), length = kTurn - 2 * arc.half_width;
      parts_.subtract(begin, std::min(begin + length, kTurn));
      if (begin + length > kTurn) parts_.subtract(-1, begin + length - kTurn);
    }
  }
}

void CircleArcs::subtract_blocker(std::span<const Plane> planes, bool owns_ties) {
  arcs_.clear();
  for (const Plane& plane : planes) {
    const double margin = tie_margin(plane, circle_.centre.norm() + circle_.radius);
    const double level = 1 - plane.dot(circle_.centre);
    const double reach = circle_.radius * std::hypot(plane.dot(circle_.axis_1), plane.dot(circle_.axis_2));
    if (std::abs(level) <= margin && reach <= margin) {
      if (!owns_ties) return;
      continue;
    }
    Arc arc;
    switch (cut(plane, 1, margin, arc)) {
      case Cut::none:
        return;
      case Cut::all:
        break;
      case Cut::some:
        arcs_.push_back(arc);
    }
  }
  // What is hidden is the intersection of the arcs; what stays is the union of their complements.
  if (arcs_.empty()) {
    parts_.assign(0, 0);
    return;
  }
  IntervalSet hidden;
  hidden.assign(0, kTurn);
  for (const Arc& arc : arcs_) {
    const double begin = unrolled(arc.middle + arc.half_width), length = kTurn - 2 * arc.half_width;
    hidden.subtract(begin, std::min(begin + length, kTurn));
    if (begin + length > kTurn) hidden.subtract(-1, begin + length - kTurn);
    if (hidden.empty()) return;
  }
  for (const Interval& part : hidden.parts()) parts_.subtract(part.begin, part.end);
}

}  // namespace vantage::internal::exact
