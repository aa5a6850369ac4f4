// Legs above ground: what is too near below a triangle, or above it, is a prism.
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "core/triangle_distance.h"
#include "core/weld.h"
#include "query/leg_convex.h"
#include "query/leg_limits.h"

namespace vantage::internal::query {
namespace {

using Plan = Eigen::Vector2d;

/// In parts of a triangle, as GroundHeights has it.
constexpr double kBesidePlan = 1e-12;

double plan_turn(const Plan& a, const Plan& b) { return a.x() * b.y() - a.y() * b.x(); }

/// A triangle in plan, with heights.
struct PlanTriangle {
  explicit PlanTriangle(const std::array<Vec3, 3>& corners)
      : a(corners[0]),
        u(corners[1] - corners[0]),
        v(corners[2] - corners[0]),
        area(plan_turn(u.head<2>(), v.head<2>())) {}

  /// In parts of its sides u and v.
  std::array<double, 2> parts_at(const Plan& place) const {
    const Plan p = place - a.head<2>();
    return {plan_turn(p, v.head<2>()) / area, plan_turn(u.head<2>(), p) / area};
  }
  double height_at(const Plan& place) const {
    const auto [along_u, along_v] = parts_at(place);
    return a.z() + along_u * u.z() + along_v * v.z();
  }
  bool holds(const Plan& place) const {
    const auto [along_u, along_v] = parts_at(place);
    return along_u >= -kBesidePlan && along_v >= -kBesidePlan && along_u + along_v <= 1 + kBesidePlan;
  }
  /// The part of a segment that it holds.
  std::optional<LegInterval> part_of(const Plan& from, const Plan& to) const {
    const auto at_from = parts_at(from), at_to = parts_at(to);
    LegInterval part{0, 1};
    const auto keep = [&](double begin, double end) {
      const LegIntervals lost = where_positive(-begin - kBesidePlan, -end - kBesidePlan);
      if (lost.empty()) return true;
      if (lost[0].begin == 0 && lost[0].end == 1) return false;
      (lost[0].begin == 0 ? part.begin : part.end) =
          lost[0].begin == 0 ? std::max(part.begin, lost[0].end) : std::min(part.end, lost[0].begin);
      return part.begin <= part.end;
    };
    const bool is_met = keep(at_from[0], at_to[0]) && keep(at_from[1], at_to[1]) &&
                        keep(1 - at_from[0] - at_from[1], 1 - at_to[0] - at_to[1]);
    return is_met ? std::optional(part) : std::nullopt;
  }

  Vec3 a, u, v;
  double area;
};

double plan_distance_to_side(const Plan& place, const Plan& a, const Plan& side, double& share) {
  const double square = side.squaredNorm();
  share = square > 0 ? std::clamp((place - a).dot(side) / square, 0.0, 1.0) : 0.0;
  return (place - a - share * side).norm();
}

/// Distance from all that lies straight below a triangle.
double distance_to_prism(const Vec3& place, const std::array<Vec3, 3>& corners) {
  const PlanTriangle triangle(corners);
  const bool is_over = triangle.holds(place.head<2>());
  if (is_over && place.z() <= triangle.height_at(place.head<2>())) return 0;
  double least = std::sqrt(core::squared_distance_to_triangle(place, corners[0], corners[1], corners[2]));
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3 &from = corners[k], side = corners[(k + 1) % 3] - from;
    double share = 0;
    const double distance = plan_distance_to_side(place.head<2>(), from.head<2>(), side.head<2>(), share);
    if (place.z() <= from.z() + share * side.z()) least = std::min(least, distance);
  }
  return least;
}

/// Which sides of each triangle lie between it and one other, which is on the other side of it in plan.
std::vector<std::array<bool, 3>> inner_sides(const Mesh& mesh) {
  const std::vector<std::uint32_t> first = core::first_at_position(mesh.vertices);
  using Side = std::pair<std::uint32_t, std::uint32_t>;
  const auto side_of = [&](const Triangle& t, std::size_t k) {
    const std::uint32_t a = first[t[k]], b = first[t[(k + 1) % 3]];
    return Side{std::min(a, b), std::max(a, b)};
  };
  const auto turn_of = [&](const Triangle& t, std::size_t k) {
    const Side side = side_of(t, k);
    const Vec3 &a = mesh.vertices[side.first], &b = mesh.vertices[side.second], &c = mesh.vertices[t[(k + 2) % 3]];
    return plan_turn((b - a).head<2>(), (c - a).head<2>());
  };
  std::map<Side, std::vector<double>> turns;
  for (const Triangle& t : mesh.triangles) {
    for (std::size_t k = 0; k < 3; ++k) turns[side_of(t, k)].push_back(turn_of(t, k));
  }
  std::vector<std::array<bool, 3>> result;
  for (const Triangle& t : mesh.triangles) {
    std::array<bool, 3> is_inner{};
    for (std::size_t k = 0; k < 3; ++k) {
      const std::vector<double>& of_side = turns[side_of(t, k)];
      is_inner[k] = of_side.size() == 2 && of_side[0] * of_side[1] < 0;
    }
    result.push_back(is_inner);
  }
  return result;
}

}  // namespace

LegGround::LegGround(const Ground& ground) : plane_z_(ground.plane_z_m) {
  if (!ground.surface) return;
  triangles_ = std::make_unique<LegTriangles>(*ground.surface, true);
  is_inner_ = inner_sides(triangles_->mesh());
}

LegIntervals LegGround::beyond(const Tube& tube, double above_m, double sign) const {
  if (above_m * sign == -INFINITY) return {};
  if (!triangles_) {
    const double limit = plane_z_ + above_m;
    const auto beyond_at = [&](const Vec3& place) { return sign * (limit - place.z()) + tube.radius; };
    return where_positive(beyond_at(tube.leg.from), beyond_at(tube.leg.to));
  }
  const Tube local = tube.moved(-triangles_->origin());
  LegIntervals parts;
  triangles_->near(local.leg, tube.radius, [&](std::uint32_t index) {
    std::array<Vec3, 3> corners = triangles_->corners(index);
    const PlanTriangle triangle(corners);
    if (triangle.area == 0) return;
    const Plan from = local.leg.from.head<2>(), to = local.leg.to.head<2>();
    if (tube.radius == 0) {
      const auto part = triangle.part_of(from, to);
      if (!part) return;
      const auto beyond_at = [&](double share) {
        const Vec3 place = local.at(share);
        return sign * (triangle.height_at(place.head<2>()) + above_m - place.z());
      };
      const double length = part->end - part->begin;
      for (const LegInterval& beyond : where_positive(beyond_at(part->begin), beyond_at(part->end))) {
        parts.push_back({part->begin + beyond.begin * length, std::min(1.0, part->begin + beyond.end * length)});
      }
      return;
    }
    // Upside down what is above becomes what is below.
    if (std::isfinite(above_m)) {
      for (Vec3& corner : corners) corner.z() = sign * (corner.z() + above_m);
    } else {
      for (Vec3& corner : corners) corner.z() = 0;
    }
    const auto distance = [&](double share) {
      Vec3 place = local.at(share);
      place.z() = std::isfinite(above_m) ? sign * place.z() : 0;
      return distance_to_prism(place, corners);
    };
    if (const auto part = below_level(distance, tube.radius)) parts.push_back(*part);
  });
  return joined(std::move(parts));
}

LegIntervals LegGround::beside(const Tube& tube) const {
  if (!triangles_) return {};
  const Tube local = tube.moved(-triangles_->origin());
  LegIntervals covered;
  triangles_->near(local.leg, 0, [&](std::uint32_t index) {
    const PlanTriangle triangle(triangles_->corners(index));
    if (triangle.area == 0) return;
    if (const auto part = triangle.part_of(local.leg.from.head<2>(), local.leg.to.head<2>())) covered.push_back(*part);
  });
  LegIntervals result = rest_of(joined(std::move(covered)));
  // What rounding leaves between neighbours.
  const double narrow = 4 * kBesidePlan;
  std::erase_if(result, [&](const LegInterval& gap) { return gap.end - gap.begin <= narrow; });
  if (tube.radius > 0) {
    add_borders_near(local, result);
    result = joined(std::move(result));
  }
  return result;
}

/// The ground ends at sides, or parts of sides, beside which there is no triangle.
void LegGround::add_borders_near(const Tube& local, LegIntervals& out) const {
  constexpr double kBeside = 1e-11, kNarrow = 1e-6;  // of a side
  triangles_->near(local.leg, local.radius, [&](std::uint32_t index) {
    const std::array<Vec3, 3> corners = triangles_->corners(index);
    const PlanTriangle triangle(corners);
    if (triangle.area == 0) return;
    for (std::size_t k = 0; k < 3; ++k) {
      if (is_inner_[index][k]) continue;
      const Plan a = corners[k].head<2>(), side = corners[(k + 1) % 3].head<2>() - a;
      const Plan away = (triangle.area > 0 ? Plan(side.y(), -side.x()) : Plan(-side.y(), side.x()));
      const double room = 4 * std::numeric_limits<double>::epsilon() * (a.norm() + side.norm()) / side.norm();
      const Plan from = a + (kBeside + room) * away, to = from + side;
      LegIntervals covered;
      const Leg beside{{from.x(), from.y(), 0}, {to.x(), to.y(), 0}};
      triangles_->near(beside, 0, [&](std::uint32_t other) {
        const PlanTriangle neighbour(triangles_->corners(other));
        if (other == index || neighbour.area == 0) return;
        if (const auto part = neighbour.part_of(from, to)) covered.push_back(*part);
      });
      for (const LegInterval& border : rest_of(joined(std::move(covered)))) {
        if (border.end - border.begin <= kNarrow + 1e3 * room) continue;
        const Plan begin = a + border.begin * side, length = (border.end - border.begin) * side;
        const auto distance = [&](double share) {
          double at = 0;
          return plan_distance_to_side(local.at(share).head<2>(), begin, length, at);
        };
        if (const auto part = below_level(distance, local.radius)) out.push_back(*part);
      }
    }
  });
}

std::optional<LegGround::Heights> LegGround::heights(const Vec3& place) const {
  if (!triangles_) return Heights{place.z() - plane_z_, place.z() - plane_z_};
  const Vec3 local = place - triangles_->origin();
  std::optional<Heights> result;
  triangles_->near({local, local}, 0, [&](std::uint32_t index) {
    const PlanTriangle triangle(triangles_->corners(index));
    if (triangle.area == 0 || !triangle.holds(local.head<2>())) return;
    const double above = local.z() - triangle.height_at(local.head<2>());
    if (!result) result = Heights{above, above};
    result->above_highest = std::min(result->above_highest, above);
    result->above_lowest = std::max(result->above_lowest, above);
  });
  return result;
}

double LegGround::plan_distance(const Vec3& place) const {
  return triangles_ ? triangles_->distance(place - triangles_->origin()) : 0;
}

}  // namespace vantage::internal::query
