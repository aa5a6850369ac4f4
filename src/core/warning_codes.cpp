// The names of the warnings.
#include <array>
#include <cstddef>

#include "vantage/warning.h"

namespace vantage {
namespace {

constexpr std::array kCodes = {WarningCode::range_beyond_data,  WarningCode::range_beyond_scene,
                               WarningCode::scene_on_its_side,  WarningCode::target_in_degrees,
                               WarningCode::target_underground, WarningCode::target_from_below,
                               WarningCode::volume_below_scene, WarningCode::ground_extended};

}  // namespace

std::span<const WarningCode> warning_codes() { return kCodes; }

const char* name_of(WarningCode code) {
  switch (code) {
    case WarningCode::range_beyond_data:
      return "range-beyond-data";
    case WarningCode::range_beyond_scene:
      return "range-beyond-scene";
    case WarningCode::scene_on_its_side:
      return "scene-on-its-side";
    case WarningCode::target_in_degrees:
      return "target-in-degrees";
    case WarningCode::target_underground:
      return "target-underground";
    case WarningCode::target_from_below:
      return "target-from-below";
    case WarningCode::volume_below_scene:
      return "volume-below-scene";
    case WarningCode::ground_extended:
      return "ground-extended";
  }
  return "unknown";
}

}  // namespace vantage
