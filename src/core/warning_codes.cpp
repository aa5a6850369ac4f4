// The names of the warnings.
#include <array>
#include <cstddef>

#include "vantage/warning.h"

namespace vantage {
namespace {

struct Row {
  WarningCode code;
  const char* name;
};

constexpr std::array kRows = {
    Row{WarningCode::range_beyond_data, "range-beyond-data"},
    Row{WarningCode::range_beyond_scene, "range-beyond-scene"},
    Row{WarningCode::scene_on_its_side, "scene-on-its-side"},
    Row{WarningCode::target_in_degrees, "target-in-degrees"},
    Row{WarningCode::target_underground, "target-underground"},
    Row{WarningCode::target_from_below, "target-from-below"},
    Row{WarningCode::volume_below_scene, "volume-below-scene"},
    Row{WarningCode::ground_extended, "ground-extended"},
    Row{WarningCode::volume_changed, "volume-changed"},
    Row{WarningCode::volume_of_other_scene, "volume-of-other-scene"},
    Row{WarningCode::volume_of_other_mission, "volume-of-other-mission"},
    Row{WarningCode::volume_moved, "volume-moved"},
    Row{WarningCode::heights_differ, "heights-differ"},
    Row{WarningCode::rounding_overstated, "rounding-overstated"},
};

constexpr bool are_in_order() {
  for (std::size_t i = 0; i < kRows.size(); ++i) {
    if (static_cast<std::size_t>(kRows[i].code) != i) return false;
  }
  return kRows.back().code == WarningCode::rounding_overstated;
}
static_assert(are_in_order(), "one row for each code, in the order of their declaration");

constexpr std::array<WarningCode, kRows.size()> codes_of_rows() {
  std::array<WarningCode, kRows.size()> codes{};
  for (std::size_t i = 0; i < kRows.size(); ++i) codes[i] = kRows[i].code;
  return codes;
}
constexpr std::array kCodes = codes_of_rows();

}  // namespace

std::span<const WarningCode> warning_codes() { return kCodes; }

const char* name_of(WarningCode code) { return kRows.at(static_cast<std::size_t>(code)).name; }

}  // namespace vantage
