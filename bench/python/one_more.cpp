// One more target in a scene that is loaded and prepared: the target is resolved in the scene, and the mission run.
// Prints milliseconds for one such call, the mean. For bench/python/overhead.py, which puts Python beside it.
#include <chrono>
#include <cstdlib>
#include <iostream>
#include <optional>

#include "vantage/error.h"
#include "vantage/mission.h"
#include "vantage/volume.h"

namespace {

double milliseconds_of_one(const vantage::MissionFile& file, int calls) {
  const vantage::Mission first = vantage::resolve_mission(file);
  vantage::RunOptions options;
  options.prepared.emplace(first.scene());
  options.scene_hash = vantage::scene_hash(first.scene());
  std::optional<vantage::Result> result = vantage::run_mission(first, options);
  const auto start = std::chrono::steady_clock::now();
  for (int i = 0; i < calls; ++i) {
    const vantage::Mission mission = vantage::resolve_mission(file, first.loaded);
    result = vantage::run_mission(mission, options);
  }
  const std::chrono::duration<double, std::milli> all = std::chrono::steady_clock::now() - start;
  return all.count() / calls;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    std::cerr << "usage: vantage_one_more MISSION CALLS\n";
    return 2;
  }
  try {
    std::cout << milliseconds_of_one(vantage::read_mission(argv[1]), std::atoi(argv[2])) << '\n';
  } catch (const vantage::Error& error) {
    std::cerr << error.what() << '\n';
    return 2;
  }
  return 0;
}
