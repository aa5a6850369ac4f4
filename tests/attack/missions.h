// Random missions of every kind of target, side, combination and limit: docs/verification.md.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "vantage/constraints.h"
#include "vantage/scene.h"

namespace attack {

/// A mission's text without its scene, and what the text cannot hold.
struct DrawnMission {
  std::uint64_t seed = 0;  ///< of the judge's own draws
  std::string text;
  vantage::Scene scene;
  std::vector<vantage::KeepInMesh> meshes;
};

/// The mission `index` of the run `seed`, the same on every machine.
DrawnMission draw_mission(std::uint64_t seed, std::size_t index);

/// What became of a mission: its words ("all", "both sides", "computed", "refused: pierced"), to be counted, and what is
/// wrong with it.
struct MissionJudgement {
  std::vector<std::string> words;
  std::vector<std::string> wrong;
};

/// Resolves and runs the mission. Each volume must be closed by index, two triangles to an edge that run it in opposite
/// directions, and without flat facets. No point of it, deeper inside than is stated, may be outside for PointQuery,
/// nor may the prover find one, where it knows the mission; where all limits are cut exactly no point that is inside for
/// PointQuery, with some room, may be missing. Any error but one of the input is wrong.
MissionJudgement judge_drawn_mission(const DrawnMission& drawn);

/// Into the folder, which is made: mission.yaml and scene.obj.
void write_drawn_mission(const DrawnMission& drawn, const std::string& folder);

/// Draws, judges and prints. Returns how many missions are wrong.
struct MissionRun {
  std::uint64_t seed = 1;
  std::size_t first = 0, count = 0;
  int jobs = 2;
  unsigned seconds = 60;
  std::string out;  ///< where wrong missions are written; may be empty
};
std::size_t run_drawn_missions(const MissionRun& run);

}  // namespace attack
