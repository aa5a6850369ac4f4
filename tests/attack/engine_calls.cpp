#include "engine_calls.h"

#include <fstream>

#include "limit_attack.h"
#include "vantage/error.h"
#include "vantage/mission.h"
#include "vantage/scene_source.h"
#include "vantage/solid.h"
#include "vantage/volume.h"

namespace attack {
namespace {

using namespace vantage;

/// What the engine itself takes: the range and a link.
Sensor sensor_of_engine(const Case& c) { return {.max_range_m = c.range, .link = c.sensor.link}; }

Volume compute(const Case& c, const Target& target) {
  return compute_visibility(PreparedTarget(PreparedScene(c.scene), target, sensor_of_engine(c)), {c.tolerance, 1});
}

Volume cut(const Case& c, const Volume& volume) {
  if (!c.sensor.limits_view()) return cut_to_navigation(volume, c.navigation);
  Sensor sensor = c.sensor;
  sensor.max_range_m = c.range;
  return cut_to_limits(volume, PreparedTarget(PreparedScene(c.scene), c.parts[0], sensor), c.navigation);
}

bool holds(const std::string& text, const char* words) { return text.find(words) != std::string::npos; }

std::string refusal_of(const Error& error) {
  const std::string& problem = error.problem();
  if (holds(problem, "stands on or passes through")) return "pierced";
  if (holds(problem, "under the ground")) return "under the ground";
  if (holds(error.where(), "target") || holds(problem, "target")) return "target";
  if (holds(problem, "tolerance")) return "tolerance";
  return "other";
}

// The attack draws no cameras.
void write_limits(const Case& c, std::ostream& out) {
  const MissionLines lines = lines_of(c.navigation, c.sensor);
  out << "sensor:\n  max_range: " << exact_text(c.range) << "\n" << lines.sensor;
  if (const auto& link = c.sensor.link) {
    out << "  link: {frequency: " << exact_text(link->frequency_ghz) << ", clear: " << exact_text(link->clear) << "}\n";
  }
  if (!lines.navigation.empty()) out << "navigation:\n" << lines.navigation;
}

void write_mission(const Case& c, const Target& target, const std::filesystem::path& file) {
  std::ofstream out(file);
  out << "scene: {mesh: scene.obj}\ntarget:\n";
  if (target.is_point()) {
    out << "  point: " << exact_text(target.parts[0][0]) << "\n";
  } else {
    out << "  vertices:\n";
    for (const Vec3& v : target.parts[0]) out << "    - " << exact_text(v) << "\n";
  }
  if (target.offset_m != 0) out << "  offset: " << exact_text(target.offset_m) << "\n";
  if (target.front) out << "  front: " << exact_text(*target.front) << "\n";
  write_limits(c, out);
  out << "exact: {tolerance: " << exact_text(c.tolerance) << "}\n";
}

}  // namespace

Answer ask_engine(const Case& c) {
  Answer answer;
  try {
    for (const Target& part : c.parts) answer.parts.push_back(compute(c, part));
    answer.volume = c.parts.size() == 1 ? answer.parts[0] : intersect_volumes(answer.parts);
    const bool is_cut = c.sensor.limits_view() || !c.navigation.empty();
    if (is_cut && answer.volume.outcome == Outcome::computed) answer.volume = cut(c, answer.volume);
  } catch (const Error& error) {
    answer.thrown = true;
    answer.defect = error.kind() != ErrorKind::input;
    answer.refusal = refusal_of(error);
    answer.message = error.what();
  } catch (const std::exception& error) {
    answer.thrown = answer.defect = true;
    answer.message = error.what();
  }
  return answer;
}

std::optional<std::vector<PointAnswer>> ask_query(const Case& c, std::size_t part, const std::vector<Vec3>& points,
                                                  std::string& message) {
  try {
    return query_points(PreparedTarget(PreparedScene(c.scene), c.parts[part], sensor_of_engine(c)), {}, points);
  } catch (const std::exception& error) {
    message = error.what();
    return std::nullopt;
  }
}

std::string reversed_differs(const Case& c, const Volume& volume) {
  Target target = c.parts[0];
  target.front = volume.frame.normal;
  target.parts[0].assign(c.parts[0].parts[0].rbegin(), c.parts[0].parts[0].rend());
  try {
    const Volume reversed = compute(c, target);
    if (reversed.outcome != volume.outcome) return "the outcome is another one";
    if (volume.outcome != Outcome::computed) return {};
    const Comparison comparison = compare_volumes(volume.mesh, reversed.mesh);
    const double worst = std::max(comparison.only_a_m3, comparison.only_b_m3) / comparison.volume_a_m3;
    const double allowed = 3 * c.tolerance * surface_area(volume.mesh) / comparison.volume_a_m3 + 1e-4;
    if (worst > allowed) return exact_text(100 * worst) + " % of the volume differ";
  } catch (const std::exception& error) {
    return std::string("throws: ") + error.what();
  }
  return {};
}

void write_case(const Case& c, const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  std::ofstream out(folder / "scene.obj");
  for (const Vec3& v : c.scene.mesh.vertices)
    out << "v " << exact_text(v.x()) << " " << exact_text(v.y()) << " " << exact_text(v.z()) << "\n";
  std::uint32_t last = ~0u;
  for (std::size_t i = 0; i < c.scene.mesh.triangles.size(); ++i) {
    const std::uint32_t object = c.scene.object_of.empty() ? 0 : c.scene.object_of[i];
    if (object != last) out << "o " << display_name(c.scene.objects[object]) << "\n";
    last = object;
    const Triangle& t = c.scene.mesh.triangles[i];
    out << "f " << t[0] + 1 << " " << t[1] + 1 << " " << t[2] + 1 << "\n";
  }
  for (std::size_t k = 0; k < c.parts.size(); ++k)
    write_mission(c, c.parts[k], folder / (k == 0 ? "mission.yaml" : "mission" + std::to_string(k + 1) + ".yaml"));
}

Case read_case(const std::filesystem::path& file) {
  const vantage::Mission mission = resolve_mission(read_mission(file));
  Case c;
  c.kind = "mission";
  c.scene = mission.scene();
  for (std::size_t i = 0; i < mission.target.parts.size(); ++i) c.parts.push_back(mission.target.part(i));
  c.range = mission.sensor.max_range_m;
  c.tolerance = mission.as_written.exact.tolerance_m;
  c.sensor = mission.sensor;
  c.navigation = mission.navigation;
  return c;
}

}  // namespace attack
