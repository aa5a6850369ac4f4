#include "app/schema.h"

#include <algorithm>
#include <array>
#include <utility>

#include "common/input.h"
#include "request/describe_sensor.h"
#include "request/describe_spheres.h"
#include "request/describe_tour.h"
#include "vantage/error.h"

namespace vantage::internal::app {
namespace {

using request::KeyList;

const std::array<std::pair<Section, KeyList>, 15>& table() {
  static const std::array<std::pair<Section, KeyList>, 15> kTable = {{
      {Section::mission,
       {"the mission",
        {"scene", "crs", "target", "targets", "combine", "sensor", "navigation", "method", "exact", "spheres", "tour",
         "links", "work_limit"}}},
      {Section::scene,
       {"scene",
        {"mesh", "osm", "raster", "up", "scale", "lod", "crs", "origin", "sea_level", "attribution", "center", "radius",
         "bbox", "terrain", "error", "without", "defaults", "frame"}}},
      {Section::target, {"target", {"name",   "vertices", "edges",  "parts",   "point",   "outline", "holes", "osm",
                                    "object", "at",       "part",   "facing",  "nearest", "center",  "file",  "feature",
                                    "volume", "width",    "length", "heading", "offset",  "front",   "sides"}}},
      {Section::sensor,
       {"sensor",
        {"max_range", "min_range", "incidence", "camera", "fov", "mount", "gimbal", "pixel", "dori", "sun", "vlos",
         "link", "visible", "cells"}}},
      {Section::camera, {"sensor.camera", {"model", "width", "height", "focal_length", "sensor_width"}}},
      {Section::mount, {"sensor.mount", {"yaw", "pitch", "roll"}}},
      {Section::gimbal, {"sensor.gimbal", {"yaw", "pitch", "roll"}}},
      {Section::sun, {"sensor.sun", {"time", "azimuth", "elevation", "exclude"}}},
      {Section::navigation,
       {"navigation", {"altitude", "ground", "clearance", "keep_in", "boxes", "keep_out", "meshes"}}},
      {Section::altitude, {"navigation.altitude", {"agl", "z"}}},
      {Section::zone, {"a zone", {"min", "max", "polygon", "holes", "file", "z", "agl", "heights"}}},
      {Section::mesh, {"an entry of navigation.meshes", {"mesh", "up", "scale"}}},
      {Section::exact, {"exact", {"tolerance"}}},
      {Section::frame, {"scene.frame", {"origin", "ground", "reach"}}},
      {Section::flight_link,
       {"an entry of links", {"name", "point", "at", "height", "max_range", "vlos", "frequency", "clear"}}},
  }};
  return kTable;
}

const KeyList& list_of(Section section) { return table()[static_cast<std::size_t>(section)].second; }

/// All of them.
const std::vector<const KeyList*>& lists() {
  static const std::array kDescribed = {request::key_lists<PixelLimit>(), request::key_lists<PilotSight>(),
                                        request::key_lists<RadioLink>(), request::key_lists<SpheresOptions>(),
                                        request::key_lists<TourSettings>()};
  static const std::vector<const KeyList*> kLists = [] {
    std::vector<const KeyList*> all;
    for (const auto& [section, list] : table()) all.push_back(&list);
    for (const std::vector<KeyList>& section : kDescribed) {
      for (const KeyList& list : section) all.push_back(&list);
    }
    return all;
  }();
  return kLists;
}

std::string joined(const std::vector<std::string_view>& words) {
  std::string text;
  for (const std::string_view word : words) text += (text.empty() ? "" : ", ") + std::string(word);
  return text;
}

/// The list, other than `known`, that has `key`; null when none does.
const KeyList* owner_of(std::string_view key, const KeyList& known) {
  for (const KeyList* candidate : lists()) {
    if (candidate->name == known.name) continue;
    if (std::find(candidate->keys.begin(), candidate->keys.end(), key) != candidate->keys.end()) return candidate;
  }
  return nullptr;
}

[[noreturn]] void fail_unknown(const YamlEntry& entry, const KeyList& list, const std::string& file) {
  const std::string_view nearest = nearest_name(entry.key, list.keys);
  const std::string known = " (keys of " + list.name + ": " + joined(list.keys) + ")";
  std::string fix = "did you mean '" + std::string(nearest) + "'?" + known;
  // What {max_range: 1,000} holds.
  if (!entry.key.empty() && entry.key.find_first_not_of("0123456789") == std::string::npos)
    fix = "write numbers without a comma: 1000" + known;
  // A key that is right elsewhere is more likely misplaced than misspelt, unless it is one slip from a key of this
  // place.
  if (const KeyList* owner = owner_of(entry.key, list); owner && edit_distance(entry.key, nearest) > 1) {
    fix = "'" + entry.key + "' belongs to " + owner->name + "; the nearest key here is '" + std::string(nearest) + "'" +
          known;
  }
  throw Error(ErrorCode::unknown_key, "unknown key " + in_quotes(entry.key) + " in " + list.name,
              place_in(file, entry.place), fix);
}

}  // namespace

std::string_view section_name(Section section) { return list_of(section).name; }

const std::vector<std::string_view>& known_keys(Section section) { return list_of(section).keys; }

const YamlNode* find(const YamlNode& map, std::string_view key) {
  for (const YamlEntry& entry : map.entries) {
    if (entry.key == key) return &entry.value;
  }
  return nullptr;
}

void check_keys(const YamlNode& node, Section section, const std::string& file) {
  check_keys(node, list_of(section), file);
}

void check_keys(const YamlNode& node, const KeyList& known, const std::string& file) {
  if (node.kind != YamlNode::Kind::map) {
    std::string fix = "write its keys, indented, as 'key: value': " + joined(known.keys);
    if (&known == &list_of(Section::camera)) fix = "for a camera by name write {model: NAME}; else " + fix;
    fail_at(ErrorCode::wrong_type, node, file, known.name + " must be a mapping of keys, not " + describe(node), fix);
  }
  for (const YamlEntry& entry : node.entries) {
    if (std::find(known.keys.begin(), known.keys.end(), entry.key) == known.keys.end()) {
      fail_unknown(entry, known, file);
    }
  }
}

void fail_at(ErrorCode code, const YamlNode& node, const std::string& file, const std::string& problem,
             const std::string& fix) {
  throw Error(code, problem, place_in(file, node.place), fix);
}

std::string describe(const YamlNode& node) {
  switch (node.kind) {
    case YamlNode::Kind::null:
      return "nothing";
    case YamlNode::Kind::sequence:
      return "a list of " + std::to_string(node.items.size());
    case YamlNode::Kind::map:
      return "a mapping";
    case YamlNode::Kind::scalar:
      break;
  }
  return (node.is_quoted ? "the text " : "") + in_quotes(node.text);
}

}  // namespace vantage::internal::app
