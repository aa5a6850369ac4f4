#include "core/names.h"

namespace vantage::core {

const char* name_of(CauseKind kind) {
  switch (kind) {
    case CauseKind::scene:
      return "scene";
    case CauseKind::range:
      return "range";
    case CauseKind::target_plane:
      return "target_plane";
    case CauseKind::navigation:
      return "navigation";
  }
  return "unknown";
}

const char* name_of(Outcome outcome) {
  switch (outcome) {
    case Outcome::computed:
      return "computed";
    case Outcome::out_of_range:
      return "out_of_range";
    case Outcome::blocked_at_once:
      return "blocked_at_once";
    case Outcome::outside_limits:
      return "outside_limits";
    case Outcome::no_common_view:
      return "no_common_view";
  }
  return "unknown";
}

const char* name_of(DeviceKind kind) {
  switch (kind) {
    case DeviceKind::cpu:
      return "cpu";
    case DeviceKind::opengl_software:
      return "opengl_software";
    case DeviceKind::opengl_hardware:
      return "opengl_hardware";
  }
  return "unknown";
}

}  // namespace vantage::core
