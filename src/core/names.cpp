// How kinds of objects, causes, outcomes, limits and devices are called in files.
#include <algorithm>
#include <string_view>

#include "common/input.h"
#include "vantage/devices.h"
#include "vantage/each_limit.h"
#include "vantage/scene.h"
#include "vantage/volume.h"

namespace vantage {
namespace {

template <typename Limits>
bool has_any(const Limits& limits) {
  bool found = false;
  each_limit(limits, [&](auto /*limit*/, const auto& /*value*/) { found = true; });
  return found;
}

}  // namespace

bool Navigation::empty() const { return !has_any(*this); }

bool Sensor::limits_view() const { return has_any(*this); }

std::string_view name_of(Limit limit) {
  switch (limit) {
    case Limit::altitude:
      return "altitude";
    case Limit::keep_in:
      return "keep_in";
    case Limit::keep_out:
      return "keep_out";
    case Limit::meshes:
      return "meshes";
    case Limit::above_ground:
      return "agl";
    case Limit::clearance:
      return "clearance";
    case Limit::min_range:
      return "min_range";
    case Limit::incidence:
      return "incidence";
    case Limit::frame:
      return "frame";
    case Limit::pixel:
      return "pixel";
    case Limit::sun:
      return "sun";
  }
  return "unknown";
}

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
    case ObjectKind::stand_in:
      return "stand-in";
  }
  return "unknown";
}

const char* name_of(MissingPolicy policy) {
  switch (policy) {
    case MissingPolicy::block:
      return "block";
    case MissingPolicy::warn:
      return "warn";
    case MissingPolicy::refuse:
      return "refuse";
  }
  return "unknown";
}

std::string attribution_of(const Scene& scene) {
  const auto is_of_map = [](const SceneObject& object) {
    const std::string_view id = object.source_id;
    const std::size_t slash = id.find('/');
    const std::string_view kind = id.substr(0, slash);
    if (slash == std::string_view::npos || (kind != "way" && kind != "relation" && kind != "node")) return false;
    return slash + 1 < id.size() && id.find_first_not_of("0123456789", slash + 1) == std::string_view::npos;
  };
  std::string known = scene.georeference ? scene.georeference->attribution : "";
  if (known.empty() && std::any_of(scene.objects.begin(), scene.objects.end(), is_of_map)) known = kOpenStreetMapCredit;
  const std::string& given = scene.attribution;
  if (given.empty() || known.find(given) != std::string::npos) return known;
  return known.empty() || given.find(known) != std::string::npos ? given : given + ", " + known;
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
