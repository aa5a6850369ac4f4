#include "verify/limits.h"

#include <algorithm>

#include "vantage/error.h"

namespace vantage::internal::verify {
namespace {

void check(const std::vector<Box>& boxes, const std::string& name) {
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const bool ordered = (boxes[i].min.array() < boxes[i].max.array()).all();  // false for NaN too
    if (ordered) continue;
    throw Error(ErrorCode::limits_reversed, "the box is reversed or flat", name + " " + std::to_string(i),
                "give min smaller than max on every axis");
  }
}

bool within(const Box& box, const Vec3& point) {
  return (point.array() >= box.min.array()).all() && (point.array() <= box.max.array()).all();
}

bool strictly_within(const Box& box, const Vec3& point) {
  return (point.array() > box.min.array()).all() && (point.array() < box.max.array()).all();
}

}  // namespace

Limits::Limits(const Navigation& navigation, const Vec3& origin) : navigation_(navigation), origin_(origin) {
  if (navigation_.altitude && !(navigation_.altitude->min_m < navigation_.altitude->max_m)) {
    throw Error(ErrorCode::limits_reversed, "the altitude band is reversed or empty", "navigation altitude",
                "give the lower altitude first");
  }
  if (const auto& limit = navigation_.above_ground) {
    if (!(limit->min_m < limit->max_m)) {
      throw Error(ErrorCode::limits_reversed, "the band above the ground is reversed or empty", "navigation altitude",
                  "give the lower height first");
    }
    ground_.emplace(*limit);
  }
  check(navigation_.keep_in, "box");
  check(navigation_.keep_out, "keep_out");
  for (const KeepInMesh& keep_in : navigation_.meshes) {
    meshes_.emplace_back(keep_in.mesh, origin, "keep-in mesh '" + keep_in.name + "'");
  }
}

// All members are named: a limit that is added does not compile here before it is checked.
std::optional<std::string> Limits::broken_by(const Vec3& point) const {
  const auto& [altitude, keep_in, keep_out, meshes, above_ground] = navigation_;
  const Vec3 scene_point = point + origin_;
  if (altitude) {
    if (scene_point.z() < altitude->min_m) return "altitude min";
    if (scene_point.z() > altitude->max_m) return "altitude max";
  }
  if (ground_) {
    if (const auto limit = ground_->broken_by(scene_point)) return *limit;
  }
  const auto holds = [&scene_point](const Box& box) { return within(box, scene_point); };
  if (!keep_in.empty() && std::none_of(keep_in.begin(), keep_in.end(), holds)) return "box";
  for (std::size_t i = 0; i < keep_out.size(); ++i) {
    if (strictly_within(keep_out[i], scene_point)) return "keep_out " + std::to_string(i);
  }
  for (std::size_t i = 0; i < meshes_.size(); ++i) {
    if (meshes_[i].contains(point) == false) return "mesh " + meshes[i].name;
  }
  return std::nullopt;
}

}  // namespace vantage::internal::verify
