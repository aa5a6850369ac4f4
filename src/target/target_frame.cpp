// Checks of a target polygon and its local frame.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/convex_corners.h"
#include "core/enclosing_circle.h"
#include "core/text.h"
#include "vantage/error.h"
#include "vantage/target.h"

namespace vantage {
namespace {

using Eigen::Vector2d;

// A normal within this of horizontal belongs to a vertical target, which no side of "up" can be told apart for.
constexpr double kVerticalNormal = 1e-6;
constexpr double kPlanarFraction = 1e-6;  // of the extent
constexpr double kPlanarAtLeast = 1e-3;   // metres
// A vertex this far inside the line between its neighbours, in parts of the extent, is on it. The target only grows.
constexpr double kStraight = 1e-9;
// A part of the extent: four times what the coordinates of a vertex lose on the way into the frame, and so all that a
// target may lose of a corner.
constexpr double kCornerRounding = 0x1p-50;

[[noreturn]] void refuse(ErrorCode code, const Target& target, std::string problem, std::string fix) {
  throw Error(code, std::move(problem), "target \"" + target.name + "\"", std::move(fix));
}

std::string vertex_name(std::size_t index) { return "vertex " + std::to_string(index); }

void check_vertices(const Target& target) {
  const auto& v = target.parts[0];
  if (v.size() < 3 && !target.is_point()) {
    refuse(ErrorCode::target_vertex_count, target,
           "a target needs at least 3 vertices, this one has " + std::to_string(v.size()),
           "add vertices, or give one alone for a point");
  }
  if (v.size() > 64) {
    refuse(ErrorCode::target_vertex_count, target,
           "a target has at most 64 vertices, this one has " + std::to_string(v.size()), "simplify it");
  }
  for (std::size_t i = 0; i < v.size(); ++i) {
    if (!v[i].allFinite()) {
      refuse(ErrorCode::coordinate_not_finite, target, vertex_name(i) + " has a coordinate that is not finite",
             "give three finite numbers");
    }
  }
  if (!std::isfinite(target.offset_m))
    refuse(ErrorCode::value_out_of_range, target, "offset is not finite", "give metres along the normal");
  if (target.front && (!target.front->allFinite() || *target.front == Vec3::Zero())) {
    refuse(ErrorCode::direction_invalid, target, "front is zero or not finite",
           "give a vector on the side that is looked at, such as [0, 0, 1]");
  }
}

double extent_of(const std::vector<Vec3>& vertices) {
  Box box;
  for (const Vec3& v : vertices) box.extend(v);
  return (box.max - box.min).norm();
}

void check_repeats(const Target& target, double extent) {
  const auto& v = target.parts[0];
  for (std::size_t i = 0; i < v.size(); ++i) {
    for (std::size_t j = i + 1; j < v.size(); ++j) {
      if ((v[i] - v[j]).norm() <= 1e-9 * extent || v[i] == v[j]) {
        refuse(ErrorCode::target_vertices_coincide, target,
               vertex_name(i) + " and " + vertex_name(j) + " are the same point", "drop one of them");
      }
    }
  }
}

// Twice the area vector, about the first vertex so that large coordinates do not cancel.
Vec3 area_vector(const std::vector<Vec3>& vertices) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 1; i + 1 < vertices.size(); ++i)
    sum += (vertices[i] - vertices[0]).cross(vertices[i + 1] - vertices[0]);
  return sum;
}

void check_planar(const Target& target, const Vec3& normal, double extent) {
  const auto& v = target.parts[0];
  Vec3 centre = Vec3::Zero();
  for (const Vec3& p : v) centre += (p - v[0]) / static_cast<double>(v.size());
  double worst = 0;
  std::size_t culprit = 0;
  for (std::size_t i = 0; i < v.size(); ++i) {
    const double off = std::abs(normal.dot(v[i] - v[0] - centre));
    if (off > worst) {
      worst = off;
      culprit = i;
    }
  }
  if (worst > std::max(kPlanarAtLeast, kPlanarFraction * extent)) {
    refuse(ErrorCode::target_not_planar, target,
           "the vertices are not in one plane: " + vertex_name(culprit) + " is off by " +
               internal::core::metres_text(worst),
           "move it onto the plane of the others, or split the target");
  }
}

bool are_on_one_line(const std::vector<Vec3>& polygon, double extent) {
  const auto from_first = [&](const Vec3& v) { return Vec3(v - polygon[0]); };
  const auto farther = [&](const Vec3& a, const Vec3& b) { return from_first(a).norm() < from_first(b).norm(); };
  const Vec3 along = from_first(*std::max_element(polygon.begin(), polygon.end(), farther)).normalized();
  return std::all_of(polygon.begin(), polygon.end(),
                     [&](const Vec3& v) { return from_first(v).cross(along).norm() <= 1e-9 * extent; });
}

Vec3 front_normal(const Target& target, const Vec3& normal) {
  if (target.front) {
    const double side = unit(*target.front).dot(normal);
    if (std::abs(side) < 1e-6) {
      refuse(ErrorCode::direction_invalid, target, "front lies in the plane of the target",
             "give a vector that points away from the looked-at side");
    }
    return side > 0 ? normal : Vec3(-normal);
  }
  return normal.z() < -kVerticalNormal && !target.front_by_order ? Vec3(-normal) : normal;
}

// Axes that keep the scene's x and y for a horizontal target, so that boxes of the scene stay boxes.
void make_axes(TargetFrame& frame, const Vec3& normal) {
  frame.normal = normal;
  if (std::abs(normal.x()) < 1e-12 && std::abs(normal.y()) < 1e-12) {
    frame.normal = {0, 0, normal.z() > 0 ? 1.0 : -1.0};
    frame.axis_u = {1, 0, 0};
  } else {
    frame.axis_u = Vec3(0, 0, 1).cross(normal).normalized();
  }
  frame.axis_v = frame.normal.cross(frame.axis_u).normalized();
}

// Where an outline that is not convex turns the wrong way most, or runs back along itself.
std::size_t worst_turn(const std::vector<Vec3>& polygon) {
  const std::size_t n = polygon.size();
  std::size_t worst = 0;
  double most = -1;
  for (std::size_t i = 0; i < n; ++i) {
    const Vec3 in = polygon[i] - polygon[(i + n - 1) % n], out = polygon[(i + 1) % n] - polygon[i];
    const double turn = std::atan2(in.cross(out).z(), in.dot(out));
    const double wrong = std::abs(turn) > std::numbers::pi - 1e-6 ? std::numbers::pi : -turn;
    if (wrong > most) {
      most = wrong;
      worst = i;
    }
  }
  return worst;
}

double whole_turn(const std::vector<Vec3>& polygon) {
  const std::size_t n = polygon.size();
  double turn = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const Vec3 in = polygon[i] - polygon[(i + n - 1) % n], out = polygon[(i + 1) % n] - polygon[i];
    turn += std::atan2(in.cross(out).z(), in.dot(out));
  }
  return turn;
}

// The corners of a counter-clockwise polygon, given with z = 0. What they bound holds every vertex, to rounding: a
// vertex is left out only where the others' outline passes outside it. Refuses what is not convex.
std::vector<Vector2d> corners_of(const Target& target, const std::vector<Vec3>& polygon,
                                 const std::vector<std::size_t>& index, double extent) {
  if (whole_turn(polygon) > 3 * std::numbers::pi) {
    refuse(ErrorCode::target_not_convex, target,
           "not convex: the outline winds round more than once, starting at " + vertex_name(index[0]),
           "give the vertices in order round the polygon");
  }
  double largest = 0;
  for (const Vec3& v : target.parts[0]) largest = std::max(largest, v.cwiseAbs().maxCoeff());
  const internal::core::CornerSlack slack{kStraight * extent + kCornerRounding * largest, kCornerRounding * extent};
  const auto is_corner = internal::core::find_corners(polygon, Vec3::UnitZ(), slack);
  if (!is_corner) {
    refuse(
        ErrorCode::target_not_convex, target,
        "not convex: the outline turns the wrong way at " + vertex_name(index[worst_turn(polygon)]),
        "give the vertices in order round a convex polygon; for a concave polygon on the ground write 'outline: [[x, "
        "y], ...]' instead of 'vertices', for any other concave one several convex 'parts'");
  }
  std::vector<Vector2d> corners;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    if ((*is_corner)[i]) corners.emplace_back(polygon[i].head<2>());
  }
  return corners;
}

TargetFrame make_point_frame(const Target& target) {
  TargetFrame frame;
  make_axes(frame, target.front ? unit(*target.front) : Vec3::UnitZ());
  frame.polygon = {Vector2d::Zero()};
  frame.all_sides = !target.front;
  frame.origin = target.parts[0][0] + frame.normal * target.offset_m;
  return frame;
}

}  // namespace

Target Target::polygon(std::vector<Vec3> vertices) {
  Target target;
  target.parts = {std::move(vertices)};
  return target;
}

Target Target::point(const Vec3& place) { return polygon({place}); }

Target Target::part(std::size_t index) const {
  Target part;
  part.name = index == 0 ? name : name + ", part " + std::to_string(index + 1);
  part.parts = {parts.at(index)};
  part.offset_m = offset_m;
  part.front = front;
  part.front_by_order = front_by_order;
  return part;
}

TargetFrame make_target_frame(const Target& target, std::size_t part) {
  if (target.is_volume()) {
    refuse(
        ErrorCode::not_applicable, target, "the target is a volume to fly through, and nothing of it is to be seen",
        "volumes are targets of 'vantage tour' and 'vantage check' alone: give a polygon or a point, or leave it out");
  }
  if (part >= target.parts.size()) {
    refuse(ErrorCode::target_parts_invalid, target, "the target has no part " + std::to_string(part + 1),
           "give one polygon or more");
  }
  if (target.parts.size() > 1) {
    if (target.parts[part].size() == 1) {
      refuse(ErrorCode::target_parts_invalid, target, "part " + std::to_string(part + 1) + " of the target is a point",
             "give polygons, or one point alone");
    }
    return make_target_frame(target.part(part));
  }
  check_vertices(target);
  if (target.is_point()) return make_point_frame(target);
  const double extent = extent_of(target.parts[0]);
  check_repeats(target, extent);
  const Vec3 area = area_vector(target.parts[0]);
  if (area.norm() <= 1e-9 * extent * extent) {
    refuse(ErrorCode::target_without_area, target, "the polygon has no area",
           are_on_one_line(target.parts[0], extent)
               ? "its vertices must not lie on one line"
               : "its sides cross each other: give the vertices in order round it");
  }
  const Vec3 own_normal = area.normalized();
  check_planar(target, own_normal, extent);

  TargetFrame frame;
  make_axes(frame, front_normal(target, own_normal));
  const Vec3 anchor = target.parts[0][0];
  std::vector<Vec3> outline;
  std::vector<std::size_t> index;
  for (std::size_t i = 0; i < target.parts[0].size(); ++i) {
    const Vec3 d = target.parts[0][i] - anchor;
    outline.emplace_back(frame.axis_u.dot(d), frame.axis_v.dot(d), 0);
    index.push_back(i);
  }
  if (own_normal.dot(frame.normal) < 0) {
    std::reverse(outline.begin(), outline.end());
    std::reverse(index.begin(), index.end());
  }
  std::vector<Vector2d> polygon = corners_of(target, outline, index, extent);

  double height = 0;  // of the plane over the anchor: the mean, which is zero for an exactly planar polygon
  for (const Vec3& v : target.parts[0])
    height += frame.normal.dot(v - anchor) / static_cast<double>(target.parts[0].size());
  const auto circle = internal::core::smallest_enclosing_circle(polygon);
  const Vector2d centre = 0.5 * (circle.centre + internal::core::centroid(polygon));
  for (Vector2d& p : polygon) p -= centre;
  frame.polygon = std::move(polygon);
  frame.enclosing_radius_m = circle.radius;
  frame.origin =
      anchor + frame.axis_u * centre.x() + frame.axis_v * centre.y() + frame.normal * (height + target.offset_m);
  return frame;
}

}  // namespace vantage
