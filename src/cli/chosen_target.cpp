#include "cli/chosen_target.h"

#include <string_view>
#include <utility>

#include "common/input.h"
#include "vantage/error.h"

namespace vantage::cli {

std::vector<std::string> target_names(const Mission& mission) {
  if (volume_count(mission) == 1) return {mission.target.name};
  std::vector<std::string> names;
  for (const std::vector<Target>& view : mission.views) names.push_back(view.front().name);
  return names;
}

Mission of_target(const Mission& mission, const std::string& name) {
  const std::vector<std::string> names = target_names(mission);
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (names[i] == name) return one_volume(mission, i);
  }
  const std::vector<std::string_view> known(names.begin(), names.end());
  throw Error(ErrorCode::unknown_choice, "the mission has no target " + in_quotes(name), "command line, --target",
              "the nearest of " + std::to_string(names.size()) + " names is " + in_quotes(nearest_name(name, known)));
}

Mission of_volume(Mission mission, const std::string& name, const VolumeFile& volume) {
  if (!name.empty()) return of_target(mission, name);
  const std::size_t count = volume_count(mission);
  if (count == 1) return mission;
  const std::string stated = volume.volume.provenance ? volume.volume.provenance->mission_hash : "";
  for (std::size_t i = 0; i < count && !stated.empty(); ++i) {
    Mission one = one_volume(mission, i);
    if (mission_hash(one) == stated) return one;
  }
  throw Error(ErrorCode::missing_key, "nothing tells for which of " + std::to_string(count) + " targets the volume is",
              volume.file.string(), "name the target with --target");
}

}  // namespace vantage::cli
