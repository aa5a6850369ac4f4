#include "core/causes.h"

#include <Eigen/Geometry>
#include <utility>

#include "vantage/geometry.h"

namespace vantage {

Cause cause_of_object(std::uint32_t index, const SceneObject& object) {
  return {CauseKind::scene, display_name(object), 0, index, object.source_id, object.kind};
}

Volume volume_of_mesh(Mesh mesh, const std::string& cause) {
  Volume volume;
  volume.causes = {{CauseKind::scene, cause, surface_area(mesh)}};
  volume.cause_of.assign(mesh.triangles.size(), 0);
  volume.frame.origin = internal::core::middle_of(mesh);
  volume.mesh = std::move(mesh);
  return volume;
}

}  // namespace vantage

namespace vantage::internal::core {

Vec3 middle_of(const Mesh& mesh) {
  const Box box = bounding_box(mesh);
  return box.empty() ? Vec3(Vec3::Zero()) : Vec3((box.min + box.max) / 2);
}

std::uint32_t CauseList::add(const Cause& cause) {
  const auto next = static_cast<std::uint32_t>(causes_.size());
  // An object is known by its number: two may have the same name.
  const std::string name = cause.object ? "" : cause.name;
  const auto [entry, is_new] = index_.try_emplace({cause.kind, cause.object, name}, next);
  if (is_new) causes_.push_back(cause);
  return entry->second;
}

void compact_causes(const Mesh& mesh, std::vector<std::uint32_t>& cause_of, std::vector<Cause>& causes) {
  std::vector<double> area(causes.size(), 0);
  std::vector<bool> is_used(causes.size(), false);
  for (std::size_t t = 0; t < cause_of.size(); ++t) {
    const auto& [a, b, c] = mesh.triangles[t];
    const Vec3& corner = mesh.vertices[a];
    area[cause_of[t]] += (mesh.vertices[b] - corner).cross(mesh.vertices[c] - corner).norm() / 2;
    is_used[cause_of[t]] = true;
  }
  std::vector<std::uint32_t> number(causes.size(), 0);
  std::vector<Cause> kept;
  for (std::size_t cause = 0; cause < causes.size(); ++cause) {
    if (!is_used[cause]) continue;
    number[cause] = static_cast<std::uint32_t>(kept.size());
    kept.push_back(std::move(causes[cause]));
    kept.back().area_m2 = area[cause];
  }
  for (std::uint32_t& cause : cause_of) cause = number[cause];
  causes = std::move(kept);
}

}  // namespace vantage::internal::core
