#include "app/pierced_advice.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "app/scene_caveats.h"
#include "maps/city/assembly.h"

namespace vantage::app {
namespace {

/// Kinds of CityRecord, and what scene.without calls them.
constexpr std::array<std::pair<std::string_view, const char*>, 4> kLeftOut = {
    {{"wall", "walls"}, {"tower", "towers"}, {"bridge", "bridges"}, {"tree", "trees"}}};

}  // namespace

std::optional<std::string> how_to_leave_out(const LoadedScene& loaded, std::uint32_t object,
                                            const std::string& target_object) {
  if (!loaded.city || object >= loaded.scene.objects.size()) return std::nullopt;
  const std::string& name = loaded.scene.objects[object];
  const auto record =
      std::find_if(loaded.city->records.begin(), loaded.city->records.end(),
                   [&](const CityRecord& one) { return one.fate != Fate::skipped && city::object_name(one) == name; });
  if (record == loaded.city->records.end()) return std::nullopt;
  const auto kind =
      std::find_if(kLeftOut.begin(), kLeftOut.end(), [&](const auto& entry) { return entry.first == record->kind; });
  if (kind == kLeftOut.end()) return std::nullopt;
  std::string what = "the map has a " + record->kind + " there";
  if (record->kind == "wall") {
    what = record->object == target_object ? "the target's own wall or fence stands on its outline"
                                           : "the map has a wall, fence or hedge there";
  }
  return what + ": leave out all of this kind with scene: {without: [" + kind->second +
         "]}, or give the vertices of a polygon beside it";
}

Error explained(const target::PiercedTarget& error, const LoadedScene& loaded, const std::string& target_object) {
  std::optional<std::string> advice = how_to_leave_out(loaded, error.object(), target_object);
  if (!advice) advice = on_its_side(loaded);
  if (!advice) return error;
  return {error.kind(), error.problem(), error.where(), *advice};
}

}  // namespace vantage::app
