// How kinds of objects, causes, outcomes and devices are called in files.
#include "vantage/devices.h"
#include "vantage/input.h"
#include "vantage/scene.h"
#include "vantage/volume.h"

namespace vantage {

const char* name_of(ObjectKind kind) {
  switch (kind) {
    case ObjectKind::other:
      return "other";
    case ObjectKind::ground:
      return "ground";
    case ObjectKind::surface:
      return "surface";
    case ObjectKind::building:
      return "building";
    case ObjectKind::building_part:
      return "building part";
    case ObjectKind::wall:
      return "wall";
    case ObjectKind::tower:
      return "tower";
    case ObjectKind::bridge:
      return "bridge";
    case ObjectKind::tree:
      return "tree";
  }
  return "unknown";
}

std::string display_name(const SceneObject& object) {
  if (object.source_id.empty()) return printable(object.name);
  return printable(object.name.empty() ? object.source_id : object.source_id + " " + object.name);
}

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
    case CauseKind::sensor:
      return "sensor";
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

}  // namespace vantage
