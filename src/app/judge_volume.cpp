// What it takes to judge the volume of a file: what it says of itself, and the report beside it.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <fstream>
#include <nlohmann/json.hpp>
#include <vector>

#include "app/combine_targets.h"
#include "common/input.h"
#include "vantage/error.h"
#include "vantage/result.h"
#include "vantage/volume.h"

namespace vantage {
namespace {

constexpr double kMostLift = ProveOptions::kMostLift;  // a target is raised by no more than 2.01 mm

/// The lifts of the target's parts, by the report beside the file, if there is one: of a report that does not tell them
/// apart, the largest one for all.
std::vector<double> reported_lifts_m(const std::filesystem::path& volume_file, std::size_t parts) {
  std::filesystem::path volume = volume_file;
  if (volume.extension() == ".gz") volume.replace_extension();
  const std::filesystem::path report = report_file(volume);
  std::error_code ignored;
  if (!std::filesystem::exists(report, ignored)) return std::vector<double>(parts, 0);
  check_readable(report, "the report beside the volume");
  std::ifstream in(report);
  const auto json = nlohmann::json::parse(in, nullptr, false);
  const auto is_lift = [](const nlohmann::json& lift) {
    return lift.is_number() && lift.get<double>() >= 0 && lift.get<double>() <= kMostLift;
  };
  if (json.is_object() && json.contains("lift_m") && is_lift(json["lift_m"])) {
    const nlohmann::json each = json.value("lift_of_part_m", nlohmann::json());
    if (!each.is_array() || each.size() != parts) return std::vector<double>(parts, json["lift_m"].get<double>());
    if (std::all_of(each.begin(), each.end(), is_lift)) return each.get<std::vector<double>>();
  }
  throw Error(ErrorCode::record_garbled, "the report beside the volume gives no lift_m from 0 to 0.01", report.string(),
              "write it again with \"vantage compute\", or say how far the target was raised with --lift");
}

/// A part of a target, raised.
struct RaisedPart {
  TargetFrame frame;
  double lift_m = 0;

  double height(const Vec3& point) const { return frame.to_local(point).z() - lift_m; }

  /// Whether the point, dropped along the normal, falls on the part grown by `margin_m`.
  bool is_over(const Vec3& point, double margin_m) const {
    const Eigen::Vector2d at = frame.to_local(point).head<2>();
    const std::vector<Eigen::Vector2d>& corners = frame.polygon;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const Eigen::Vector2d along = (corners[(i + 1) % corners.size()] - corners[i]).normalized();
      const Eigen::Vector2d way = at - corners[i];
      if (!(along.x() * way.y() - along.y() * way.x() >= -margin_m)) return false;
    }
    return true;
  }
};

/// `lift_m`: of the parts of all targets. Points are left out: what they lie on is thinner than what is forgiven here.
std::vector<RaisedPart> raised_parts(const Mission& mission, const std::vector<double>& lift_m) {
  std::vector<RaisedPart> parts;
  std::size_t next = 0;
  for (const std::vector<Target>& view : internal::app::views_of(mission)) {
    for (const Target& target : view) {
      for (std::size_t i = 0; i < target.parts.size(); ++i, ++next) {
        if (target.is_point()) continue;
        parts.push_back({make_target_frame(target, i), next < lift_m.size() ? lift_m[next] : 0});
      }
    }
  }
  return parts;
}

/// Where the line of sight passes the triangle that hides.
Vec3 passage(const HiddenView& hidden, const Scene& scene) {
  const auto& [a, b, c] = scene.mesh.triangles[hidden.triangle];
  const Vec3& corner = scene.mesh.vertices[a];
  const Vec3 normal = (scene.mesh.vertices[b] - corner).cross(scene.mesh.vertices[c] - corner);
  const Vec3 way = hidden.target_point - hidden.viewpoint;
  return hidden.viewpoint + normal.dot(corner - hidden.viewpoint) / normal.dot(way) * way;
}

/// Whether what hides belongs to the surface that the target lies on (docs/verification.md, "Definitions").
bool is_hidden_by_own_surface(const HiddenView& hidden, const Mission& mission, const std::vector<double>& lift_m) {
  constexpr double kSurfaceHeight = 1e-3, kOnPlane = 1e-6;  // metres
  const Vec3 at = passage(hidden, mission.scene());
  bool has_part = false;
  for (const RaisedPart& part : raised_parts(mission, lift_m)) {
    const Vec3& seen = hidden.target_point;
    if (std::abs(part.height(seen)) > kOnPlane || !part.is_over(seen, kOnPlane)) continue;
    has_part = true;
    if (!(part.height(at) < kSurfaceHeight && part.is_over(at, kSurfaceHeight))) return false;
  }
  return has_part;
}

}  // namespace

ProofReport with_verify_tolerances(ProofReport proof, const Mission& mission, const VerifyOptions& options) {
  const Vec3 centre = make_target_frame(mission.target).origin;
  for (ClaimProof& claim : proof.claims) {
    if (claim.verdict != ProofVerdict::wrong) continue;
    const auto is_forgiven = [&] {
      if (claim.name == "sight") {
        return proof.witness && is_hidden_by_own_surface(*proof.witness, mission, proof.lift_of_part_m);
      }
      return claim.place && claim.broken_by_m <= options.depth_tolerance * (*claim.place - centre).norm();
    };
    if (!is_forgiven()) continue;
    claim.verdict = ProofVerdict::not_proved;
    claim.text = claim.name == "sight" ? "hidden by what lies lower than 1 mm over the target: the rays decide"
                                       : "by no more than the rays forgive: " + claim.text;
  }
  return proof;
}

std::vector<Warning> volume_warnings(const VolumeFile& read, const Mission& mission) {
  if (!read.volume.provenance) return {};
  const VolumeProvenance& made = *read.volume.provenance;
  if (!made.scene_hash.empty() && made.scene_hash != scene_hash(mission.scene())) {
    return {{WarningCode::volume_of_other_scene,
             "the file says that the volume was computed in another scene than the mission's"}};
  }
  if (!made.mission_hash.empty() && made.mission_hash != mission_hash(mission)) {
    return {{WarningCode::volume_of_other_mission, "the file says that the volume was computed for another mission"}};
  }
  return {};
}

VerifyOptions verify_options(const VolumeFile& read, const Mission& mission) {
  VerifyOptions options;
  options.tolerance_m = mission.as_written.exact.tolerance_m;
  options.rounding_m = read.rounding_m;
  options.lift_m = read.volume.lift_m;
  for (const double lift : options.lift_m) {
    if (lift <= kMostLift) continue;
    throw Error(ErrorCode::record_garbled, "the volume says that its target was raised by more than 0.01 m",
                read.file.string(), "compute it again: its header was changed");
  }
  std::size_t parts = 0;
  for (const std::vector<Target>& view : internal::app::views_of(mission)) {
    for (const Target& target : view) parts += target.parts.size();
  }
  if (options.lift_m.size() != parts) options.lift_m = reported_lifts_m(read.file, parts);
  return options;
}

}  // namespace vantage
