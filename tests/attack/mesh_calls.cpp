// What the attack by meshes asks of vantage, and how it writes a case down.
#include <Eigen/Geometry>
#include <algorithm>
#include <fstream>
#include <map>

#include "limit_attack.h"
#include "mesh_case.h"
#include "vantage/error.h"
#include "vantage/mission.h"
#include "vantage/query.h"
#include "vantage/target.h"

namespace attack {
namespace {

using namespace vantage;

/// The claim that a name of PointAnswer::outside_of belongs to.
std::string claim_of(const std::string& name, const Sensor& sensor) {
  const auto limit = facts_named(name);
  if (!limit) return name;
  const bool is_range = sensor.pixel && sensor.pixel->kind == PixelLimit::Kind::perpendicular;
  return is_range && name == "pixel" ? "range" : limit->claim;
}

std::vector<std::string> claims_of(const PointAnswer& answer, const Sensor& sensor) {
  std::vector<std::string> claims;
  if (!answer.blocked_by.empty()) claims.emplace_back("sight");
  if (answer.out_of_range) claims.emplace_back("range");
  if (answer.behind_target) claims.emplace_back("front");
  for (const std::string& name : answer.outside_of) claims.push_back(claim_of(name, sensor));
  if (claims.empty() && !answer.inside) claims.emplace_back("sight");
  return claims;
}

void write_obj(const Mesh& mesh, const std::vector<std::string>& names, const std::vector<std::uint32_t>& object_of,
               const std::filesystem::path& file) {
  std::ofstream out(file);
  for (const Vec3& v : mesh.vertices)
    out << "v " << exact_text(v.x()) << " " << exact_text(v.y()) << " " << exact_text(v.z()) << "\n";
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    if (!object_of.empty() && (i == 0 || object_of[i] != object_of[i - 1])) out << "o " << names[object_of[i]] << "\n";
    const auto& [a, b, c] = mesh.triangles[i];
    out << "f " << a + 1 << " " << b + 1 << " " << c + 1 << "\n";
  }
}

Mesh without_unused(const Mesh& mesh) {
  Mesh used;
  std::map<std::uint32_t, std::uint32_t> number;
  for (Triangle t : mesh.triangles) {
    for (std::uint32_t& v : t) {
      const auto [entry, is_new] = number.try_emplace(v, static_cast<std::uint32_t>(used.vertices.size()));
      if (is_new) used.vertices.push_back(mesh.vertices[v]);
      v = entry->second;
    }
    used.triangles.push_back(t);
  }
  return used;
}

}  // namespace

std::vector<Target> sides_of(const MeshCase& c) {
  std::vector<Target> sides = {c.target};
  if (c.both_sides) {
    sides.push_back(c.target);
    sides.back().front = -*c.target.front;
  }
  return sides;
}

std::vector<std::string> Verdicts::names() const {
  std::vector<std::string> names;
  if (reports.empty()) return names;
  for (const ClaimProof& claim : reports[0].claims) names.push_back(claim.name);
  return names;
}

ProofVerdict Verdicts::of(const std::string& name) const {
  ProofVerdict worst = ProofVerdict::proved;
  bool is_there = false;
  for (const ProofReport& report : reports) {
    for (const ClaimProof& claim : report.claims) {
      if (claim.name != name) continue;
      worst = std::max(worst, claim.verdict);
      is_there = true;
    }
  }
  return is_there ? worst : ProofVerdict::not_proved;
}

ProofVerdict Verdicts::of_all() const {
  ProofVerdict worst = reports.empty() ? ProofVerdict::not_proved : ProofVerdict::proved;
  for (const ProofReport& report : reports) worst = std::max(worst, report.verdict());
  return worst;
}

Verdicts prove(const MeshCase& c) {
  Verdicts verdicts;
  try {
    for (const Target& side : sides_of(c)) {
      ProveOptions options{.shrink = c.shrink, .rounding_m = c.rounding_m};
      if (c.lift_m > 0) options.lift_m.assign(side.parts.size(), c.lift_m);
      if (c.both_sides) options.other_side_m = 2 * c.lift_m;
      verdicts.reports.push_back(prove_volume(c.scene, side, c.sensor, c.navigation, c.volume, options));
    }
  } catch (const Error& error) {
    verdicts.reports.clear();
    verdicts.refusal = error.what();
    if (error.kind() != ErrorKind::input) verdicts.refusal = "defect: " + verdicts.refusal;
  }
  return verdicts;
}

struct QueryOracle::Data {
  std::vector<TargetFrame> frames;
  std::vector<PointQuery> sides;
  Sensor sensor;
};

QueryOracle::QueryOracle(const MeshCase& c) : data_(std::make_shared<Data>()) {
  const PreparedScene scene(c.scene);
  for (const Target& side : sides_of(c)) {
    const PreparedTarget target(scene, side, c.sensor);
    data_->frames.push_back(make_target_frame(side));
    data_->sides.emplace_back(target, c.navigation);
  }
  data_->sensor = c.sensor;
}

std::vector<std::vector<std::string>> QueryOracle::broken(const std::vector<Vec3>& points) {
  std::vector<std::vector<PointAnswer>> answers;
  for (PointQuery& side : data_->sides) answers.push_back(side.answer(points));
  std::vector<std::vector<std::string>> broken;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const bool is_behind = answers.size() > 1 && data_->frames[0].to_local(points[i]).z() < 0;
    broken.push_back(claims_of(answers[is_behind ? 1 : 0][i], data_->sensor));
  }
  return broken;
}

void write_ply(const Mesh& whole, const std::filesystem::path& file) {
  const Mesh mesh = without_unused(whole);
  std::ofstream out(file, std::ios::binary);
  out << "ply\nformat ascii 1.0\nelement vertex " << mesh.vertices.size()
      << "\nproperty double x\nproperty double y\nproperty double z\nelement face " << mesh.triangles.size()
      << "\nproperty list uchar int vertex_indices\nend_header\n";
  for (const Vec3& v : mesh.vertices)
    out << exact_text(v.x()) << " " << exact_text(v.y()) << " " << exact_text(v.z()) << "\n";
  for (const auto& [a, b, c] : mesh.triangles) out << "3 " << a << " " << b << " " << c << "\n";
}

void write_mesh_case(const MeshCase& c, const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  std::vector<std::string> names;
  for (const SceneObject& object : c.scene.objects) names.push_back(object.name);
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (std::count(names.begin(), names.end(), names[i]) > 1) names[i] += std::to_string(i);
  }
  write_obj(without_unused(c.scene.mesh), names, c.scene.object_of, folder / "scene.obj");
  write_ply(c.volume, folder / "volume.ply");
  if (c.lift_m > 0) std::ofstream(folder / "volume.report.json") << "{\"lift_m\": " << exact_text(c.lift_m) << "}\n";
  MissionFile mission;
  mission.scene.file = std::filesystem::absolute(folder / "scene.obj");
  mission.targets[0].target = c.target;
  mission.targets[0].both_sides = c.both_sides;
  if (c.both_sides) mission.targets[0].target.front.reset();
  mission.sensor = c.sensor;
  mission.navigation = c.navigation;
  WrittenClaim claim{c, folder, mission};
  const auto write = [&](auto limit, const auto& value) { write_beside<limit>(value, claim); };
  each_limit(c.navigation, write);
  each_limit(c.sensor, write);
  const auto& ground = claim.ground;
  if (ground && !ground->surface) mission.ground = GroundSource{ground->plane_z_m};
  const bool is_named = ground ? ground->surface != nullptr : claim.names_ground;
  if (is_named) mission.ground = GroundSource{std::nullopt, names[*c.ground]};
  std::ofstream(folder / "mission.yaml") << mission_text(mission, folder);
}

}  // namespace attack
