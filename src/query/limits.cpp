#include "query/limits.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "query/zone_place.h"

namespace vantage::internal::query {
namespace {

bool strictly_inside(const Box& box, const Vec3& p) {
  return (p.array() > box.min.array()).all() && (p.array() < box.max.array()).all();
}
bool inside(const Box& box, const Vec3& p) {
  return (p.array() >= box.min.array()).all() && (p.array() <= box.max.array()).all();
}

/// Borders too.
bool meet(const Box& a, const Box& b) {
  return (a.min.array() <= b.max.array()).all() && (b.min.array() <= a.max.array()).all();
}

// Winding number by signed solid angles (Van Oosterom and Strackee 1983): 1 inside a closed outward-oriented mesh, else
// 0.
double winding_number(const Mesh& mesh, const Vec3& point) {
  double sum = 0;
  for (const Triangle& t : mesh.triangles) {
    const Vec3 a = mesh.vertices[t[0]] - point, b = mesh.vertices[t[1]] - point, c = mesh.vertices[t[2]] - point;
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    sum += std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return sum / (2 * std::numbers::pi);
}

void add_box_crossings(const Box& box, const ViewRay& line, std::vector<double>& out) {
  for (int axis = 0; axis < 3; ++axis) {
    if (line.direction[axis] == 0) continue;
    out.push_back((box.min[axis] - line.origin[axis]) / line.direction[axis]);
    out.push_back((box.max[axis] - line.origin[axis]) / line.direction[axis]);
  }
}

/// Where the line passes a triangle, or nearly: a crossing too many does no harm, one too few would. Triangles that the
/// line slides along are left out; where they end it passes their neighbours.
void add_mesh_crossings(const Mesh& mesh, const ViewRay& line, std::vector<double>& out) {
  constexpr double kNear = 1e-9;  // of the triangle's size
  for (const Triangle& t : mesh.triangles) {
    const Vec3 a = mesh.vertices[t[0]] - line.origin, u = mesh.vertices[t[1]] - mesh.vertices[t[0]],
               v = mesh.vertices[t[2]] - mesh.vertices[t[0]];
    const Vec3 normal = u.cross(v);
    const double slope = normal.dot(line.direction);
    if (slope == 0) continue;
    const double distance = normal.dot(a) / slope;
    const Vec3 p = distance * line.direction - a;
    const double scale = normal.squaredNorm();
    const double along_u = p.cross(v).dot(normal) / scale, along_v = u.cross(p).dot(normal) / scale;
    if (along_u >= -kNear && along_v >= -kNear && along_u + along_v <= 1 + kNear) out.push_back(distance);
  }
}

bool strictly_inside(const Zone& zone, const Box& box, const Vec3& p) {
  return strictly_inside(box, p) && (zone.is_box || place_in(zone, p.head<2>()) == ZonePlace::inside);
}
bool inside(const Zone& zone, const Box& box, const Vec3& p) {
  return inside(box, p) && (zone.is_box || place_in(zone, p.head<2>()) != ZonePlace::outside);
}

/// Where the line passes a side or a height, or nearly, as for meshes.
void add_zone_crossings(const Zone& zone, const ViewRay& line, std::vector<double>& out) {
  constexpr double kNear = 1e-9;  // of a side's length
  if (line.direction.z() != 0) {
    out.push_back((zone.min_z_m - line.origin.z()) / line.direction.z());
    out.push_back((zone.max_z_m - line.origin.z()) / line.direction.z());
  }
  const Eigen::Vector2d origin = line.origin.head<2>(), direction = line.direction.head<2>();
  for_each_side(zone, [&](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    const Eigen::Vector2d side = b - a, from = a - origin;
    const double slope = direction.x() * side.y() - direction.y() * side.x();
    if (slope == 0) return;
    const double along = (from.x() * direction.y() - from.y() * direction.x()) / slope;
    if (along < -kNear || along > 1 + kNear) return;
    out.push_back((from.x() * side.y() - from.y() * side.x()) / slope);
  });
}

bool is_same(const Ground& a, const Ground& b) { return a.surface == b.surface && a.plane_z_m == b.plane_z_m; }

/// The part of the line from one cut to the next.
struct Part {
  double begin, end;
  double distance_from(double at) const { return std::max({begin - at, at - end, 0.0}); }
};

}  // namespace

Limits::Limits(Navigation navigation, sensor::SensorLimits sensor)
    : navigation_(std::move(navigation)), sensor_(std::move(sensor)) {
  for (const KeepInMesh& mesh : navigation_.meshes) mesh_boxes_.push_back(bounding_box(mesh.mesh));
  if (navigation_.above_ground) add_ground(navigation_.above_ground->ground);
  for (const std::vector<Zone>* zones : {&navigation_.keep_in, &navigation_.keep_out}) {
    for (const Zone& zone : *zones) {
      if (zone.above_ground) add_ground(zone.above_ground->ground);
    }
  }
  if (navigation_.clearance) obstacles_.emplace(*navigation_.clearance);
  for (const Zone& zone : navigation_.keep_in) keep_in_boxes_.push_back(box_of(zone));
  for (const Zone& zone : navigation_.keep_out) keep_out_boxes_.push_back(box_of(zone));
}

void Limits::add_ground(const Ground& ground) {
  const bool is_known =
      std::any_of(grounds_.begin(), grounds_.end(), [&](const auto& known) { return is_same(known.first, ground); });
  if (!is_known) grounds_.emplace_back(ground, GroundHeights(ground));
}

const GroundHeights& Limits::heights_of(const Ground& ground) const {
  return std::find_if(grounds_.begin(), grounds_.end(), [&](const auto& known) { return is_same(known.first, ground); })
      ->second;
}

// All members of Navigation are named, here and below: a limit that is added does not compile before it is answered.

void Limits::add_above_ground_crossings(const AboveGround& limit, const ViewRay& line,
                                        std::vector<double>& cuts) const {
  for (const double above_m : {limit.min_m, limit.max_m}) {
    // If the height is infinite, the ends of the ground are left: any finite one has them too.
    heights_of(limit.ground)
        .add_crossings(line.origin, line.direction, line.reach, std::isfinite(above_m) ? above_m : 0, cuts);
  }
}

/// The line within reach, cut wherever it passes a limit: between neighbours all of it is allowed or none.
std::vector<double> Limits::cut_line(const ViewRay& line) const {
  const auto& [altitude, keep_in, keep_out, meshes, above_ground, clearance] = navigation_;
  std::vector<double> cuts;
  if (altitude) {
    Box band;
    band.min = {-INFINITY, -INFINITY, altitude->min_m};
    band.max = {INFINITY, INFINITY, altitude->max_m};
    add_box_crossings(band, line, cuts);
  }
  Box within_reach;
  within_reach.extend(line.origin);
  within_reach.extend(line.at(line.reach));
  const auto add_zones = [&](const std::vector<Zone>& zones, const std::vector<Box>& boxes) {
    for (std::size_t i = 0; i < zones.size(); ++i) {
      if (zones[i].is_box) {
        add_box_crossings(boxes[i], line, cuts);
        continue;
      }
      if (!meet(boxes[i], within_reach)) continue;
      add_zone_crossings(zones[i], line, cuts);
      if (zones[i].above_ground) add_above_ground_crossings(*zones[i].above_ground, line, cuts);
    }
  };
  add_zones(keep_in, keep_in_boxes_);
  add_zones(keep_out, keep_out_boxes_);
  for (const KeepInMesh& mesh : meshes) add_mesh_crossings(mesh.mesh, line, cuts);
  if (above_ground) add_above_ground_crossings(*above_ground, line, cuts);
  if (clearance) obstacles_->add_crossings(line.origin, line.direction, line.reach, cuts);
  if (!sensor_.none()) {
    const std::vector<double> changes = sensor_.changes(line.origin, line.direction, line.reach);
    cuts.insert(cuts.end(), changes.begin(), changes.end());
  }
  std::erase_if(cuts, [&](double cut) { return !(cut > 0 && cut < line.reach); });
  cuts.push_back(0);
  cuts.push_back(line.reach);
  std::sort(cuts.begin(), cuts.end());
  return cuts;
}

double Limits::signed_margin(const ViewRay& line, double at, bool is_inside) const {
  if (!(line.reach > 0)) return -INFINITY;
  const std::vector<double> cuts = cut_line(line);
  std::vector<Part> parts;
  for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
    if (cuts[i] < cuts[i + 1]) parts.push_back({cuts[i], cuts[i + 1]});
  }
  const auto is_allowed = [&](const Part& part) { return broken(line.at((part.begin + part.end) / 2)).empty(); };
  // Nearest first: outside, the first part that is allowed ends the search; inside, the first that is not, or the
  // reach.
  std::stable_sort(parts.begin(), parts.end(),
                   [&](const Part& a, const Part& b) { return a.distance_from(at) < b.distance_from(at); });
  for (const Part& part : parts) {
    const double distance = part.distance_from(at);
    if (is_inside && distance >= line.reach - at) break;
    if (is_allowed(part) != is_inside) return is_inside ? distance : 0.0 - distance;
  }
  return is_inside ? std::max(line.reach - at, 0.0) : -INFINITY;
}

void Limits::add_broken_above_ground(const Vec3& point, std::vector<std::string>& broken) const {
  const auto ground = heights_of(navigation_.above_ground->ground).at(point.x(), point.y());
  if (!ground) {
    broken.push_back("ground edge");
    return;
  }
  if (point.z() < ground->highest_m + navigation_.above_ground->min_m) broken.push_back("agl min");
  if (point.z() > ground->lowest_m + navigation_.above_ground->max_m) broken.push_back("agl max");
}

/// Whether a point is within the heights of a zone to stay in.
bool Limits::is_at_height(const Zone& zone, const Vec3& point) const {
  if (!zone.above_ground) return true;
  const auto ground = heights_of(zone.above_ground->ground).at(point.x(), point.y());
  return ground && point.z() >= ground->highest_m + zone.above_ground->min_m &&
         point.z() <= ground->lowest_m + zone.above_ground->max_m;
}

/// Whether a point is outside of the heights of a zone to stay out of.
bool Limits::is_clear_of_heights(const Zone& zone, const Vec3& point) const {
  if (!zone.above_ground) return false;
  const auto ground = heights_of(zone.above_ground->ground).at(point.x(), point.y());
  return ground && (point.z() <= ground->lowest_m + zone.above_ground->min_m ||
                    point.z() >= ground->highest_m + zone.above_ground->max_m);
}

std::vector<std::string> Limits::broken(const Vec3& point) const {
  const auto& [altitude, keep_in, keep_out, meshes, above_ground, clearance] = navigation_;
  std::vector<std::string> broken;
  if (altitude) {
    if (point.z() < altitude->min_m) broken.push_back("altitude min");
    if (point.z() > altitude->max_m) broken.push_back("altitude max");
  }
  if (above_ground) add_broken_above_ground(point, broken);
  bool is_kept = keep_in.empty();
  for (std::size_t i = 0; i < keep_in.size() && !is_kept; ++i) {
    is_kept = inside(keep_in[i], keep_in_boxes_[i], point) && is_at_height(keep_in[i], point);
  }
  if (!is_kept) broken.push_back("keep_in");
  for (std::size_t i = 0; i < keep_out.size(); ++i) {
    if (strictly_inside(keep_out[i], keep_out_boxes_[i], point) && !is_clear_of_heights(keep_out[i], point))
      broken.push_back("keep_out " + zone_name(keep_out, i));
  }
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    // Also because the winding number overflows far away.
    const bool is_in = inside(mesh_boxes_[i], point) && !(winding_number(meshes[i].mesh, point) < 0.5);
    if (!is_in) broken.push_back("mesh " + meshes[i].name);
  }
  if (clearance && obstacles_->is_too_near(point)) broken.push_back("clearance");
  if (!sensor_.none()) {
    for (std::string& name : sensor_.broken(point)) broken.push_back(std::move(name));
  }
  return broken;
}

}  // namespace vantage::internal::query
