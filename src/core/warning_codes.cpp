// The names of the warnings.
#include <array>
#include <cstddef>

#include "vantage/error.h"

namespace vantage {
namespace {

struct WarningRow {
  WarningCode code;
  const char* name;
};

constexpr std::array kWarningRows = {
    WarningRow{WarningCode::range_beyond_data, "range-beyond-data"},
    WarningRow{WarningCode::range_beyond_scene, "range-beyond-scene"},
    WarningRow{WarningCode::scene_on_its_side, "scene-on-its-side"},
    WarningRow{WarningCode::target_in_degrees, "target-in-degrees"},
    WarningRow{WarningCode::target_underground, "target-underground"},
    WarningRow{WarningCode::target_inside, "target-inside"},
    WarningRow{WarningCode::target_from_below, "target-from-below"},
    WarningRow{WarningCode::target_covered, "target-covered"},
    WarningRow{WarningCode::volume_below_scene, "volume-below-scene"},
    WarningRow{WarningCode::pixel_in_metres, "pixel-in-metres"},
    WarningRow{WarningCode::ground_extended, "ground-extended"},
    WarningRow{WarningCode::zones_left_out, "zones-left-out"},
    WarningRow{WarningCode::clearance_from_all, "clearance-from-all"},
    WarningRow{WarningCode::above_surface, "above-surface"},
    WarningRow{WarningCode::faces_together, "faces-together"},
    WarningRow{WarningCode::plan_left_out, "plan-left-out"},
    WarningRow{WarningCode::plan_joined, "plan-joined"},
    WarningRow{WarningCode::plan_assumed, "plan-assumed"},
    WarningRow{WarningCode::plan_beyond_zones, "plan-beyond-zones"},
    WarningRow{WarningCode::volume_small, "volume-small"},
    WarningRow{WarningCode::scene_incomplete, "scene-incomplete"},
    WarningRow{WarningCode::volume_changed, "volume-changed"},
    WarningRow{WarningCode::volume_of_other_scene, "volume-of-other-scene"},
    WarningRow{WarningCode::volume_of_other_mission, "volume-of-other-mission"},
    WarningRow{WarningCode::volume_moved, "volume-moved"},
    WarningRow{WarningCode::heights_differ, "heights-differ"},
    WarningRow{WarningCode::rounding_overstated, "rounding-overstated"},
};

constexpr bool are_warnings_in_order() {
  for (std::size_t i = 0; i < kWarningRows.size(); ++i) {
    if (static_cast<std::size_t>(kWarningRows[i].code) != i) return false;
  }
  return kWarningRows.back().code == WarningCode::rounding_overstated;
}
static_assert(are_warnings_in_order(), "one row for each code, in the order of their declaration");

constexpr std::array<WarningCode, kWarningRows.size()> codes_of_warnings() {
  std::array<WarningCode, kWarningRows.size()> codes{};
  for (std::size_t i = 0; i < kWarningRows.size(); ++i) codes[i] = kWarningRows[i].code;
  return codes;
}
constexpr std::array kWarningCodes = codes_of_warnings();

}  // namespace

std::span<const WarningCode> warning_codes() { return kWarningCodes; }

const char* name_of(WarningCode code) { return kWarningRows.at(static_cast<std::size_t>(code)).name; }

}  // namespace vantage
