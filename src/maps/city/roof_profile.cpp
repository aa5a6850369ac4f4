#include "maps/city/roof_profile.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace vantage::internal::city {
namespace {

constexpr double kSideWithin = std::numbers::pi / 6;  // of a direction that means a side of the rectangle
constexpr double kFill = 0.8;                         // from which an outline counts as that rectangle
constexpr double kLeastHalf = 1e-3;                   // metres: no rectangle is narrower, so that nothing divides by 0
constexpr double kArcError = 0.05;                    // metres
constexpr int kFewestChords = 4, kMostChords = 16;

double cross(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

/// Counter-clockwise, without points in the middle of sides. A. M. Andrew's monotone chain (1979).
Ring convex_hull(Ring points) {
  std::sort(points.begin(), points.end(),
            [](const Vec2& a, const Vec2& b) { return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y(); });
  Ring hull;
  for (int pass = 0; pass < 2; ++pass) {
    const std::size_t first = hull.size();
    for (const Vec2& p : points) {
      while (hull.size() >= first + 2 && cross(hull.back() - hull[hull.size() - 2], p - hull.back()) <= 0) {
        hull.pop_back();
      }
      hull.push_back(p);
    }
    hull.pop_back();
    std::reverse(points.begin(), points.end());
  }
  return hull;
}

/// The rectangle about `hull` with a side along a unit vector.
RoofFrame frame_along(const Ring& hull, const Vec2& along) {
  const Vec2 across(-along.y(), along.x()), origin = hull[0];
  Eigen::AlignedBox2d box;
  for (const Vec2& p : hull) box.extend(Vec2((p - origin).dot(along), (p - origin).dot(across)));
  const Vec2 centre = box.center(), half = (box.sizes() / 2).cwiseMax(kLeastHalf);
  return {origin + along * centre.x() + across * centre.y(), along, across, half.x(), half.y()};
}

RoofFrame least_rectangle(const Ring& hull) {
  RoofFrame best{};
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const RoofFrame frame = frame_along(hull, (hull[(i + 1) % hull.size()] - hull[i]).normalized());
    const double area = frame.half_length * frame.half_width;
    // If areas are equal, the first one is taken, though rounding differs.
    if (area < least * (1 - 1e-9)) {
      least = area;
      best = frame;
    }
  }
  return best;
}

/// The same rectangle with u where v was.
RoofFrame quarter_turned(const RoofFrame& frame) {
  return {frame.centre, frame.across, -frame.along, frame.half_width, frame.half_length, frame.fill};
}

RoofFrame half_turned(const RoofFrame& frame) {
  return {frame.centre, -frame.along, -frame.across, frame.half_length, frame.half_width, frame.fill};
}

}  // namespace

Ring enclosing_rectangle(const Ring& points, double least_m) {
  constexpr double kPad = 1e-3;  // metres: rounding of the corners takes away less
  const Ring hull = convex_hull(points);
  const bool is_line = hull.size() > 1 && hull[0] != hull[1];
  const RoofFrame frame = is_line ? least_rectangle(hull) : frame_along(points, {1, 0});
  const Vec2 u = frame.along * (std::max(frame.half_length, least_m / 2) + kPad);
  const Vec2 v = frame.across * (std::max(frame.half_width, least_m / 2) + kPad);
  return {frame.centre - u - v, frame.centre + u - v, frame.centre + u + v, frame.centre - u + v};
}

RoofFrame roof_frame(const Footprint& footprint, const BuildingForm& form) {
  const Ring hull = convex_hull(footprint.outer);
  RoofFrame frame = least_rectangle(hull);
  double filled = 0;
  for (std::size_t i = 1; i + 1 < footprint.outer.size(); ++i) {
    filled += cross(footprint.outer[i] - footprint.outer[0], footprint.outer[i + 1] - footprint.outer[0]) / 2;
  }
  const double fill = filled / (4 * frame.half_length * frame.half_width);
  if (form.roof_direction_deg) {
    const double angle = *form.roof_direction_deg * std::numbers::pi / 180;
    const Vec2 falls(std::sin(angle), std::cos(angle));
    for (int quarter = 0; quarter < 4 && fill >= kFill; ++quarter, frame = quarter_turned(frame)) {
      if (frame.across.dot(falls) < std::cos(kSideWithin)) continue;
      frame.fill = fill;
      return frame;
    }
    frame = frame_along(hull, Vec2(falls.y(), -falls.x()));
  } else {
    if ((frame.half_length < frame.half_width) != form.roof_across) frame = quarter_turned(frame);
    const bool south = frame.across.y() < 0 || (frame.across.y() == 0 && frame.across.x() > 0);
    if (!south) frame = half_turned(frame);
  }
  frame.fill = fill;
  return frame;
}

namespace {

/// The planes of a profile that rises from two opposite sides of the frame alike.
class Slopes {
 public:
  Slopes(const RoofFrame& frame, std::vector<RoofPlane>& planes) : frame_(frame), planes_(planes) {}

  /// `slope` upwards from height `base` at the distance `inside` from the sides v = W and v = -W.
  void from_eaves(double slope, double inside = 0, double base = 0) {
    for (const double side : {1.0, -1.0})
      planes_.push_back({0, -side * slope, base + slope * (frame_.half_width - inside)});
  }
  /// Likewise from the sides u = L and u = -L.
  void from_ends(double slope, double inside = 0, double base = 0) {
    for (const double side : {1.0, -1.0})
      planes_.push_back({-side * slope, 0, base + slope * (frame_.half_length - inside)});
  }

 private:
  const RoofFrame& frame_;
  std::vector<RoofPlane>& planes_;
};

/// Chords of the arc over v from -W to W.
std::vector<RoofPlane> round_planes(double half_width, double rise) {
  const bool circle = rise <= half_width;
  const double radius = circle ? (half_width * half_width + rise * rise) / (2 * rise) : rise;
  const double half_angle = circle ? std::atan2(half_width, radius - rise) : std::numbers::pi / 2;
  const auto point = [&](double angle) {
    const double wide = circle ? radius : half_width;
    return Vec2(wide * std::sin(angle), rise - radius + radius * std::cos(angle));
  };
  const int chords = 2 * ((arc_chords(radius, 2 * half_angle) + 1) / 2);  // even: one corner is the ridge
  std::vector<RoofPlane> planes;
  for (int k = 0; k < chords; ++k) {
    const Vec2 from = point(half_angle * (2.0 * k / chords - 1)), to = point(half_angle * (2.0 * (k + 1) / chords - 1));
    const double slope = (to - from).y() / (to - from).x();
    planes.push_back({0, slope, from.y() - slope * from.x()});
  }
  return planes;
}

}  // namespace

int arc_chords(double radius_m, double angle) {
  const double widest = 2 * std::acos(std::clamp(1 - kArcError / radius_m, -1.0, 1.0));
  return static_cast<int>(std::clamp(std::ceil(angle / widest), double{kFewestChords}, double{kMostChords}));
}

std::vector<RoofPlane> roof_planes(RoofShape shape, const RoofFrame& frame, double roof_m) {
  const double R = roof_m, L = frame.half_length, W = frame.half_width, m = std::min(L, W);
  std::vector<RoofPlane> planes;
  Slopes slopes(frame, planes);
  switch (shape) {
    case RoofShape::gabled:
      slopes.from_eaves(R / W);
      break;
    case RoofShape::hipped:
      slopes.from_eaves(R / m);
      slopes.from_ends(R / m);
      break;
    case RoofShape::half_hipped:
      slopes.from_eaves(R / W);
      slopes.from_ends(std::max(R / W, R / (2 * L)), 0, R / 2);
      break;
    case RoofShape::pyramidal:
      slopes.from_eaves(R / W);
      slopes.from_ends(R / L);
      break;
    case RoofShape::skillion:
      planes.push_back({0, -R / (2 * W), R / 2});
      break;
    case RoofShape::gambrel:
      slopes.from_eaves(R * 4 / (3 * W));
      slopes.from_eaves(R * 2 / (3 * W), W / 2, R * 2 / 3);
      break;
    case RoofShape::mansard:
      slopes.from_eaves(R * 4 / (3 * m));
      slopes.from_ends(R * 4 / (3 * m));
      slopes.from_eaves(R * 2 / (3 * m), m / 2, R * 2 / 3);
      slopes.from_ends(R * 2 / (3 * m), m / 2, R * 2 / 3);
      break;
    case RoofShape::round:
      return round_planes(W, R);
    case RoofShape::saltbox:
      planes.push_back({0, -R * 3 / (4 * W), R * 3 / 4});
      planes.push_back({0, R * 3 / (2 * W), R * 3 / 2});
      break;
    case RoofShape::flat:
    case RoofShape::dome:
    case RoofShape::onion:
    case RoofShape::cone:
      break;
  }
  return planes;
}

BuildingForm settled(const BuildingForm& form, const RoofFrame& frame) {
  BuildingForm result = form;
  if (form.pitch && form.roof != RoofShape::flat) {
    const bool ridge = form.roof == RoofShape::gabled || form.roof == RoofShape::half_hipped ||
                       form.roof == RoofShape::gambrel || form.roof == RoofShape::round ||
                       form.roof == RoofShape::saltbox;
    const double run = form.roof == RoofShape::skillion ? 2 * frame.half_width
                       : ridge                          ? frame.half_width
                                                        : std::min(frame.half_length, frame.half_width);
    const double rise = std::tan(form.pitch->angle_deg * std::numbers::pi / 180) * run;
    const double share = form.pitch->most_share, body = form.top_m - form.bottom_m;
    if (form.pitch->on_top) {
      result.roof_m = share < 1 ? std::min(rise, body * share / (1 - share)) : rise;
      result.top_m += result.roof_m;
    } else {
      result.roof_m = std::min(rise, body * share);
    }
  }
  if (form.roof == RoofShape::flat) result.roof_m = 0;
  result.pitch.reset();
  if (form.deck_m > 0) result.bottom_m = std::max(form.bottom_m, result.top_m - result.roof_m - form.deck_m);
  result.deck_m = 0;
  return result;
}

}  // namespace vantage::internal::city
