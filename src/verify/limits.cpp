#include "verify/limits.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace vantage::internal::verify {
namespace {

bool within(const Box& box, const Vec3& point) {
  return (point.array() >= box.min.array()).all() && (point.array() <= box.max.array()).all();
}

bool strictly_within(const Box& box, const Vec3& point) {
  return (point.array() > box.min.array()).all() && (point.array() < box.max.array()).all();
}

using Plan = Eigen::Vector2d;

/// How often the ring goes round the point, by the angles under which its sides are seen; nothing on a side.
std::optional<int> turns_round(const Zone::Ring& ring, const Plan& point) {
  constexpr double kFullTurn = 2 * std::numbers::pi;
  double sum = 0;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Plan a = ring[i] - point, b = ring[(i + 1) % ring.size()] - point;
    const double across = a.x() * b.y() - a.y() * b.x(), along = a.dot(b);
    if (across == 0 && along <= 0) return std::nullopt;
    sum += std::atan2(across, along);
  }
  return static_cast<int>(std::lround(sum / kFullTurn));
}

/// The box of a zone, without bounds where the zone has none.
Box bounds_of(const Zone& zone) {
  Box box;
  for (const Plan& corner : zone.outer) {
    box.extend(Vec3(corner.x(), corner.y(), zone.min_z_m));
    box.extend(Vec3(corner.x(), corner.y(), zone.max_z_m));
  }
  return box;
}

std::vector<std::optional<GroundProbe>> heights_of(const std::vector<Zone>& zones) {
  std::vector<std::optional<GroundProbe>> probes;
  for (const Zone& zone : zones) {
    std::optional<GroundProbe>& probe = probes.emplace_back();
    if (zone.above_ground) probe.emplace(*zone.above_ground);
  }
  return probes;
}

std::vector<Box> bounds_of(const std::vector<Zone>& zones) {
  std::vector<Box> boxes;
  for (const Zone& zone : zones) boxes.push_back(bounds_of(zone));
  return boxes;
}

/// `on_border`: what to say of points on a side.
bool contains(const Zone& zone, const Box& bounds, const Vec3& point, bool on_border) {
  if (!(on_border ? within(bounds, point) : strictly_within(bounds, point))) return false;
  const Plan plan = point.head<2>();
  const std::optional<int> outer = turns_round(zone.outer, plan);
  if (!outer) return on_border;
  if (*outer == 0) return false;
  for (const Zone::Ring& hole : zone.holes) {
    const std::optional<int> turns = turns_round(hole, plan);
    if (!turns) return on_border;
    if (*turns != 0) return false;
  }
  return true;
}

}  // namespace

Limits::Limits(const Navigation& navigation, const Vec3& origin) : navigation_(navigation), origin_(origin) {
  if (navigation_.above_ground) ground_.emplace(*navigation_.above_ground);
  keep_in_bounds_ = bounds_of(navigation_.keep_in);
  keep_out_bounds_ = bounds_of(navigation_.keep_out);
  keep_in_heights_ = heights_of(navigation_.keep_in);
  keep_out_heights_ = heights_of(navigation_.keep_out);
  if (navigation_.clearance) obstacles_.emplace(*navigation_.clearance);
  for (const KeepInMesh& keep_in : navigation_.meshes) {
    meshes_.emplace_back(keep_in.mesh, origin, "keep-in mesh '" + keep_in.name + "'");
  }
}

// All members are named: a limit that is added does not compile here before it is checked.
std::optional<std::string> Limits::broken_by(const Vec3& point) const {
  const auto& [altitude, keep_in, keep_out, meshes, above_ground, clearance] = navigation_;
  const Vec3 scene_point = point + origin_;
  if (altitude) {
    if (scene_point.z() < altitude->min_m) return "altitude min";
    if (scene_point.z() > altitude->max_m) return "altitude max";
  }
  if (ground_) {
    if (const auto limit = ground_->broken_by(scene_point)) return *limit;
  }
  bool is_kept = keep_in.empty();
  for (std::size_t i = 0; i < keep_in.size() && !is_kept; ++i) {
    is_kept = contains(keep_in[i], keep_in_bounds_[i], scene_point, true) &&
              !(keep_in_heights_[i] && keep_in_heights_[i]->broken_by(scene_point));
  }
  if (!is_kept) return "keep_in";
  for (std::size_t i = 0; i < keep_out.size(); ++i) {
    if (contains(keep_out[i], keep_out_bounds_[i], scene_point, false) &&
        !(keep_out_heights_[i] && keep_out_heights_[i]->is_outside_band(scene_point))) {
      return "keep_out " + zone_name(keep_out, i);
    }
  }
  for (std::size_t i = 0; i < meshes_.size(); ++i) {
    if (meshes_[i].contains(point) == false) return "mesh " + meshes[i].name;
  }
  if (clearance && obstacles_->is_too_near(scene_point)) return "clearance";
  return std::nullopt;
}

bool Limits::may_leave_out(const Vec3& point) const {
  constexpr double kClearanceSlack = 0.16;
  return obstacles_ && obstacles_->is_too_near(point + origin_, kClearanceSlack);
}

}  // namespace vantage::internal::verify
