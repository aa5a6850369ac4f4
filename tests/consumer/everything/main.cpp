// What a program that uses vantage looks like: a target on the ground between two walls; and, given a mission file and
// a file to write, what `vantage compute` and `vantage verify` do.
#include <cmath>
#include <cstdio>

#include "vantage/error.h"
#include "vantage/mission.h"
#include "vantage/query.h"
#include "vantage/result.h"
#include "vantage/scene.h"
#include "vantage/target.h"
#include "vantage/verify.h"
#include "vantage/volume.h"

namespace {

/// Adds the upright rectangle over the segment from a to b, `height` metres tall, as an object of its own.
void add_wall(vantage::Scene& scene, const vantage::Vec3& a, const vantage::Vec3& b, double height, const char* name) {
  const auto first = static_cast<std::uint32_t>(scene.mesh.vertices.size());
  const vantage::Vec3 up(0, 0, height);
  scene.mesh.vertices.insert(scene.mesh.vertices.end(), {a, b, b + up, a + up});
  scene.mesh.triangles.push_back({first, first + 1, first + 2});
  scene.mesh.triangles.push_back({first, first + 2, first + 3});
  const auto object = static_cast<std::uint32_t>(scene.objects.size());
  scene.object_of.insert(scene.object_of.end(), 2, object);
  scene.objects.push_back({name});
}

/// A volume of a scene made in memory, and a point query. Whether both are plausible.
bool between_walls() {
  vantage::Scene scene;
  add_wall(scene, {-20, 10, 0}, {20, 10, 0}, 15, "north wall");
  add_wall(scene, {-20, -10, 0}, {20, -10, 0}, 15, "south wall");
  const vantage::PreparedScene prepared(scene);

  vantage::Target target;
  target.parts = {{{-5, -5, 0}, {5, -5, 0}, {0, 5, 0}}};
  const vantage::PreparedTarget ready(prepared, target, {50});
  const vantage::Volume volume = vantage::compute_visibility(ready);

  const vantage::MeshMeasures measures = vantage::measure(volume.mesh);
  std::printf("volume %.1f m3, %zu facets, %zu causes\n", measures.volume_m3, measures.facets, volume.causes.size());
  // Two walls take something away from the half ball, but not all of it.
  const double half_ball = 2.0 / 3.0 * std::acos(-1.0) * 50 * 50 * 50;
  const auto above = vantage::query_points(ready, {}, {{0, 0, 20}, {0, 30, 5}});
  return measures.closed && measures.euler == 2 && measures.volume_m3 > 0.1 * half_ball &&
         measures.volume_m3 < 0.9 * half_ball && above[0].inside && !above[1].inside &&
         above[1].blocked_by == std::vector<std::string>{"north wall"};
}

/// Computes a mission, writes the volume and has it checked. Whether it passed.
bool compute_and_verify(const char* mission_file, const char* volume_file) {
  const vantage::Mission mission = vantage::resolve_mission(vantage::read_mission(mission_file));
  vantage::Result result = vantage::run_mission(mission);
  vantage::write_results(result.volume, vantage::result_request(mission, result, {volume_file}));

  const vantage::VolumeFile written = vantage::read_volume(volume_file, mission.scene());
  vantage::VerifyOptions options = vantage::verify_options(written, mission);
  options.points = 500;
  const vantage::VerifyReport report = vantage::verify_volume(mission.scene(), mission.target, mission.sensor,
                                                              mission.navigation, written.volume.mesh, options);
  std::printf("%s: %zu points, %zu over-claimed\n", volume_file, report.points, report.over_claimed);
  return report.points > 0 && report.inside > 0 && report.is_right();
}

}  // namespace

int main(int argc, char** argv) try {
  if (!between_walls()) {
    std::puts("this is not the volume of a target between two walls");
    return 1;
  }
  return argc < 3 || compute_and_verify(argv[1], argv[2]) ? 0 : 1;
} catch (const vantage::Error& error) {
  std::puts(error.what());
  return 2;
}
