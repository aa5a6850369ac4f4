#include "app/zone_places.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/text.h"
#include "core/zone_check.h"
#include "geo/local_frame.h"
#include "vantage/error.h"

namespace vantage::internal::app {
namespace {

using Point = Eigen::Vector2d;

constexpr double kFineM = 0.0001;  // what a part of a side may curve by
constexpr int kMostParts = 256;
constexpr double kRoundingM = 1e-6;  // of positions in the frame: 15 nm, and what else is added up

// Of the ellipsoid's curvature and of levels from 20 km below it to 40 km above: along the meridian at the equator, and
// at the poles.
constexpr double kLeastRadiusM = 6315e3, kLargestRadiusM = 6440e3;

/// How far a sphere that touches a plane is from it at this distance in plan.
double drop_m(double distance_m, double radius_m) {
  const double d = std::min(distance_m, radius_m);
  return d * d / (radius_m + std::sqrt(radius_m * radius_m - d * d));
}

/// A curve in the frame, by points at equal steps of the system.
struct Curve {
  std::vector<Point> points;

  /// How far it may be from the chords between its points: an eighth of the second difference, taken twice since the
  /// curve may bend more in between.
  double bulge() const {
    double most = 0;
    for (std::size_t i = 1; i + 1 < points.size(); ++i) {
      most = std::max(most, (points[i - 1] - 2 * points[i] + points[i + 1]).norm() / 4);
    }
    return most;
  }
};

class SideCutter {
 public:
  explicit SideCutter(const ToFrame& to_frame) : to_frame_(to_frame) {}

  /// What a side curves by, times the square of the parts that it would be cut into.
  double curving(const Point& from, const Point& to) const {
    const Curve side = probe(from, to);
    const auto steps = static_cast<double>(side.points.size() - 1);
    return side.bulge() * steps * steps;
  }

  /// What a side takes up, z aside: one along a parallel leaves its ends' chord by far.
  Box around(const Point& from, const Point& to) const {
    const Curve side = probe(from, to);
    const double bulge = side.bulge();
    Box box;
    for (const Point& p : side.points) {
      box.extend(Vec3(p.x() - bulge, p.y() - bulge, 0));
      box.extend(Vec3(p.x() + bulge, p.y() + bulge, 0));
    }
    return box;
  }

  /// Appends the side without its end. Returns how far the curve may be from the parts.
  double add(const Point& from, const Point& to, int parts, double curving, Zone::Ring& ring) const {
    const Curve cut = curve(from, to, parts);
    ring.insert(ring.end(), cut.points.begin(), cut.points.end() - 1);
    return std::max(curving / (1.0 * parts * parts), cut.bulge());
  }

 private:
  static constexpr double kProbeM = 500;

  Curve probe(const Point& from, const Point& to) const {
    const double length = (to_frame_(to) - to_frame_(from)).norm();
    return curve(from, to, static_cast<int>(std::clamp(std::ceil(length / kProbeM), 4.0, 1.0 * kMostParts)));
  }

  Curve curve(const Point& from, const Point& to, int steps) const {
    Curve result;
    for (int i = 0; i < steps; ++i) result.points.push_back(to_frame_(from + (to - from) * i / steps));
    result.points.push_back(to_frame_(to));
    return result;
  }

  const ToFrame& to_frame_;
};

int parts_for(double curving, double fine_m) {
  return static_cast<int>(std::clamp(std::ceil(std::sqrt(curving / fine_m)), 1.0, 1.0 * kMostParts));
}

template <typename Visit>
void for_each_side_of(const Zone::Ring& ring, const Visit& visit) {
  for (std::size_t i = 0; i < ring.size(); ++i) visit(ring[i], ring[(i + 1) % ring.size()]);
}

/// What all the sides of a zone curve by, in the order of its rings.
std::vector<double> curvings_of(const Zone& zone, const SideCutter& cutter) {
  std::vector<double> curvings;
  const auto add = [&](const Point& from, const Point& to) { curvings.push_back(cutter.curving(from, to)); };
  for_each_side_of(zone.outer, add);
  for (const Zone::Ring& hole : zone.holes) for_each_side_of(hole, add);
  return curvings;
}

/// As fine as corners suffice.
double fineness(const std::vector<double>& curvings) {
  for (double fine_m = kFineM;; fine_m *= 2) {
    std::size_t corners = 0;
    for (const double curving : curvings) corners += static_cast<std::size_t>(parts_for(curving, fine_m));
    if (corners <= std::max(Zone::kMostCorners, curvings.size())) return fine_m;
  }
}

Point left_of(const Point& direction) { return {-direction.y(), direction.x()}; }

/// The ring with its sides moved to their left; to the right where `distance` is negative. Tips that would move more
/// than ten times as far away from the ring are cut off, outside of the moved sides' distance. Nothing where a side
/// would turn round: it is shorter than what the corners at its ends move.
std::optional<Zone::Ring> moved_left(const Zone::Ring& ring, double distance) {
  constexpr double kSharp = 0.02;  // 1 + the cosine of the turn
  struct Corner {
    Point in, out;  ///< the same but where the tip is cut off
  };
  std::vector<Corner> corners;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Point& corner = ring[i];
    const Point in = (corner - ring[(i + ring.size() - 1) % ring.size()]).normalized();
    const Point out = (ring[(i + 1) % ring.size()] - corner).normalized();
    const double opening = 1 + in.dot(out), turn = in.x() * out.y() - in.y() * out.x();
    if (opening < kSharp && turn * distance < 0) {
      corners.push_back({corner + distance * left_of(in) + std::abs(distance) * in,
                         corner + distance * left_of(out) - std::abs(distance) * out});
    } else {
      const Point moved = corner + distance / opening * (left_of(in) + left_of(out));
      corners.push_back({moved, moved});
    }
  }
  Zone::Ring result;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const std::size_t next = (i + 1) % ring.size();
    if (!((corners[next].in - corners[i].out).dot(ring[next] - ring[i]) > 0)) return std::nullopt;
    result.push_back(corners[i].in);
    if (corners[i].out != corners[i].in) result.push_back(corners[i].out);
  }
  return result;
}

/// From the frame's origin to the nearest point of the ring's sides, or 0 inside.
void check_distance(const Zone::Ring& ring, const char* order_advice) {
  Box box;
  double farthest = 0;
  for (const Point& p : ring) {
    box.extend(Vec3(p.x(), p.y(), 0));
    farthest = std::max(farthest, p.norm());
  }
  const Point nearest = Point::Zero().cwiseMax(box.min.head<2>()).cwiseMin(box.max.head<2>());
  if (nearest.norm() > geo::kFarthestM) {
    throw Error(ErrorCode::too_far_away,
                "it lies " + std::to_string(std::lround(nearest.norm() / 1000)) + " km from the scene's origin", "",
                order_advice);
  }
  if (farthest > kFarthestCornerM) {
    throw Error(ErrorCode::too_far_away,
                "it reaches as far as " + std::to_string(std::lround(farthest / 1000)) + " km from the scene's origin",
                "", std::string(order_advice) + "; at most 3000 km are possible");
  }
}

}  // namespace

Extent extent_of(const Box& box) {
  const Point low = box.min.head<2>(), high = box.max.head<2>();
  const Point nearest = Point::Zero().cwiseMax(low).cwiseMin(high);
  return {nearest.norm(), low.cwiseAbs().cwiseMax(high.cwiseAbs()).norm()};
}

Extent extent_of(const Zone::Ring& ring, const ToFrame& to_frame) {
  const SideCutter cutter(to_frame);
  Box box;
  for_each_side_of(ring, [&](const Point& from, const Point& to) { box.extend(cutter.around(from, to)); });
  return extent_of(box);
}

ZoneWalls::ZoneWalls(const geo::OnGlobe& globe, const Mission& mission)
    : is_map_(!globe.is_cartesian()), reach_(is_map_ ? geo::ZoneReach{} : geo::zone_reach(mission)) {}

Heights ZoneWalls::within_reach(const Heights& heights) const {
  const double low = std::max(heights.low_m - drop_m(reach_.farthest_m, kLeastRadiusM), reach_.lowest_m);
  return {low, std::max(low, std::min(heights.high_m, reach_.highest_m))};
}

double ZoneWalls::middle_z_m(const Heights& heights) const {
  if (is_map_) return 0;
  const Heights z = within_reach(heights);
  return (z.low_m + z.high_m) / 2;
}

double ZoneWalls::lean_m(const Heights& heights, double farthest_m) const {
  if (is_map_) return 0;
  constexpr double kSlack = 1.05;  // sides bulge, and a tangent is more than its angle
  const Heights z = within_reach(heights);
  return kSlack * std::min(farthest_m, reach_.farthest_m) / kLeastRadiusM * (z.high_m - z.low_m) / 2 + kRoundingM;
}

Heights ZoneWalls::z_of(const Heights& heights, const Extent& extent, ZoneUse use) const {
  if (is_map_) return heights;
  // Levels lie between spheres of these radii that touch them above the origin.
  const double most = drop_m(std::min(extent.farthest_m, reach_.farthest_m), kLeastRadiusM) + kRoundingM;
  const double least = drop_m(std::min(extent.nearest_m, reach_.farthest_m), kLargestRadiusM) - kRoundingM;
  if (use == ZoneUse::keep_out) return {heights.low_m - most, heights.high_m - least};
  const Heights z{heights.low_m - least, heights.high_m - most};
  if (z.low_m < z.high_m || !(heights.low_m < heights.high_m)) return z;  // else the caller says what is wrong
  throw Error(ErrorCode::limits_empty,
              "it is " + core::metres_text(heights.high_m - heights.low_m) + " high, and its floor falls away by " +
                  core::metres_text(most - least) + " there, so that nothing level is within it",
              "", "make it higher, cut it into smaller parts, or give it in the scene frame");
}

Zone placed_zone(const Zone& zone, ZoneUse use, const ToFrame& to_frame, const char* order_advice, double lean_m) {
  const SideCutter cutter(to_frame);
  const std::vector<double> curvings = curvings_of(zone, cutter);
  const double fine_m = fineness(curvings);
  double bulge = 0;
  auto curving = curvings.begin();
  const auto cut = [&](const Zone::Ring& ring, bool counter_clockwise) {
    Zone::Ring result;
    for_each_side_of(ring, [&](const Point& from, const Point& to) {
      bulge = std::max(bulge, cutter.add(from, to, parts_for(*curving, fine_m), *curving, result));
      ++curving;
    });
    if (core::is_counter_clockwise(result) != counter_clockwise) std::reverse(result.begin(), result.end());
    return result;
  };
  Zone placed = zone;
  placed.outer = cut(zone.outer, true);  // what the zone holds lies to the left of its sides, and so of its holes'
  for (Zone::Ring& hole : placed.holes) hole = cut(hole, false);
  check_distance(placed.outer, order_advice);  // with what its sides curve; one from 179 to -179 degrees goes round
  const double margin = 2 * bulge + kRoundingM + lean_m;
  const double distance = use == ZoneUse::keep_in ? margin : -margin;
  const char* const narrow = "it is too narrow in places to be converted to the scene frame";
  const char* const fix = "leave out the narrow part, simplify the zone, or give it in the scene frame";
  const auto move = [&](Zone::Ring& ring) {
    std::optional<Zone::Ring> moved_ring = moved_left(ring, distance);
    if (!moved_ring) throw Error(ErrorCode::zone_not_simple, narrow, "", fix);
    ring = std::move(*moved_ring);
  };
  move(placed.outer);
  for (Zone::Ring& hole : placed.holes) move(hole);
  // Where no side has turned round, and none crosses another one, the moved sides bound what lies that far within, or
  // about, the zone.
  if (const auto fault = core::fault_of(placed)) throw Error(fault->code, narrow, "", fix);
  return placed;
}

}  // namespace vantage::internal::app
