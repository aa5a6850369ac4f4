// Random missions of every kind of target, side, combination and limit: docs/verification.md.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "vantage/navigation.h"
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

/// What became of a mission: its words ("all", "both sides", "computed", "refused: pierced"), to be counted, and what
/// is wrong with it.
struct MissionJudgement {
  std::vector<std::string> words;
  std::vector<std::string> wrong;
};

/// Resolves and runs the mission. Each volume must be closed by index, two triangles to an edge that run it in opposite
/// directions, and without flat facets. No point of it, deeper inside than is stated, may be outside for PointQuery,
/// nor may the prover find one, where it knows the mission; where all limits are cut exactly no point that is inside
/// for PointQuery, with some room, may be missing. Any error but one of the input is wrong.
MissionJudgement judge_drawn_mission(const DrawnMission& drawn);

/// Into the folder, which is made: mission.yaml, scene.obj and the meshes to stay in.
void write_drawn_mission(const DrawnMission& drawn, const std::string& folder);

/// Whether what is written reads back as what was drawn, and whether a run of refused missions fails. Prints what is
/// wrong. True when nothing is.
bool mission_self_test();

/// What has become of the missions of a run. Missions that are refused, or have no volume, test little: too many of
/// them are a fault, of the draws or of the checks of input.
struct MissionCounts {
  std::size_t all = 0, computed = 0, empty = 0, refused = 0, wrong = 0;

  bool are_enough_computed() const;
};

/// Draws, judges and prints. True when no mission is wrong and enough were computed.
struct MissionRun {
  std::uint64_t seed = 1;
  std::size_t first = 0, count = 0;
  int jobs = 2;
  unsigned seconds = 60;
  std::string out;  ///< where wrong missions are written; may be empty
};
bool run_drawn_missions(const MissionRun& run);

}  // namespace attack
