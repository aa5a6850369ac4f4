#include "app/pierced_advice.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "app/named_objects.h"
#include "app/scene_warnings.h"
#include "common/input.h"
#include "common/ledger.h"
#include "core/format.h"
#include "geo/on_globe.h"

namespace vantage::internal::app {
namespace {

/// What scene.without calls them.
constexpr std::array<std::pair<ObjectKind, const char*>, 4> kLeftOut = {{{ObjectKind::wall, "walls"},
                                                                         {ObjectKind::tower, "towers"},
                                                                         {ObjectKind::bridge, "bridges"},
                                                                         {ObjectKind::tree, "trees"}}};

}  // namespace

std::optional<std::string> how_to_leave_out_stand_in(const LoadedScene& loaded, std::uint32_t object) {
  const std::vector<LedgerEntry>& ledger = loaded.scene.ledger;
  const auto entry =
      std::find_if(ledger.begin(), ledger.end(), [&](const auto& one) { return one.stand_in == object; });
  if (entry == ledger.end() || loaded.scene.objects.at(object).kind != ObjectKind::stand_in) return std::nullopt;
  return "a stand-in is there: " + ledger_text(*entry) + "; leave it out with scene: {" +
         (entry->without.empty() ? "missing: warn}, which leaves out all stand-ins"
                                 : "without: [" + entry->without + "]}, or all stand-ins with missing: warn");
}

std::optional<std::string> how_to_leave_out(const LoadedScene& loaded, std::uint32_t object,
                                            const std::string& target_object) {
  if (auto advice = how_to_leave_out_stand_in(loaded, object)) return advice;
  if (!loaded.city || object >= loaded.scene.objects.size()) return std::nullopt;
  const SceneObject& found = loaded.scene.objects[object];
  const auto kind =
      std::find_if(kLeftOut.begin(), kLeftOut.end(), [&](const auto& entry) { return entry.first == found.kind; });
  if (kind == kLeftOut.end()) return std::nullopt;
  std::string what = std::string("the map has a ") + name_of(found.kind) + " there";
  if (found.kind == ObjectKind::wall) {
    const bool is_its_own =
        !target_object.empty() && (found.source_id == target_object || is_same_name(found.name, target_object));
    what = is_its_own ? "the target's own wall or fence stands on its outline"
                      : "the map has a wall, fence or hedge there";
  }
  return what + ": leave out all of this kind with scene: {without: [" + kind->second +
         "]}, or give the vertices of a polygon beside it";
}

std::string how_to_take_roof(const LoadedScene& loaded, std::uint32_t object, const Vec3& at) {
  // The name as it is: cut short, or with a bracket outside of quotes, the mission would not find it.
  const SceneObject& found = loaded.scene.objects[object];
  const std::string& name = found.source_id.empty() ? found.name : found.source_id;
  std::string target = "object: " + yaml_text(name);
  if (const auto& place = loaded.scene.georeference) {
    const geo::LonLat position = geo::OnGlobe(*place).to_geodetic(at).place;
    target = core::format("at: [{:.6f}, {:.6f}]", position.latitude_deg, position.longitude_deg);
  } else if (name.empty() || loaded.scene.objects.size() == 1 || objects_named(loaded.scene, name).size() > 1) {
    return "for its roof give the vertices of that: no name tells it from other objects";
  }
  return "for its roof write 'target: {" + target + ", part: roof}'";
}

Error explained(const Error& error, const LoadedScene& loaded, const std::string& target_object) {
  std::optional<std::string> advice;
  if (error.object()) advice = how_to_leave_out(loaded, *error.object(), target_object);
  if (const auto side = on_its_side(loaded); side && !advice) advice = side->text;
  return advice ? error.with_fix(*advice) : error;
}

}  // namespace vantage::internal::app
