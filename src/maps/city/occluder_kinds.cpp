#include <algorithm>
#include <array>

#include "maps/city/occluders.h"

namespace vantage::internal::city {
namespace {

template <std::size_t N>
bool is_one_of(std::string_view value, const std::array<std::string_view, N>& known) {
  return std::find(known.begin(), known.end(), value) != known.end();
}

bool says_yes(std::string_view value) { return !value.empty() && value != "no"; }

bool is_wall(const osm::Tags& tags) {
  static constexpr std::array<std::string_view, 6> barriers = {"wall",  "city_wall",  "fence",
                                                               "hedge", "wire_fence", "retaining_wall"};
  return is_one_of(tags.get("barrier"), barriers) || tags.get("historic") == "citywalls";
}

bool is_tower(const osm::Tags& tags) {
  static constexpr std::array<std::string_view, 10> towers = {
      "tower",     "communications_tower", "mast",         "chimney", "water_tower", "storage_tank", "silo",
      "gasometer", "lighthouse",           "cooling_tower"};
  return is_one_of(tags.get("man_made"), towers);
}

/// A way that a bridge carries. Tracks that are gone have no bridge to speak of.
bool is_carried(const osm::Tags& tags) {
  static constexpr std::array<std::string_view, 6> gone = {"razed",        "dismantled", "proposed",
                                                           "construction", "adjacent",   "platform"};
  const auto stands = [&](std::string_view key) { return says_yes(tags.get(key)) && !is_one_of(tags.get(key), gone); };
  return stands("highway") || stands("railway") || tags.get("bridge") == "aqueduct";
}

}  // namespace

std::optional<ObjectKind> kind_of(const osm::Tags& tags, Geometry geometry) {
  const bool line = geometry == Geometry::line, area = geometry == Geometry::area;
  const auto no_line = [&](ObjectKind kind) { return line ? std::nullopt : std::optional(kind); };
  const bool tower = !line && is_tower(tags);
  if (tower && !area) return ObjectKind::tower;
  // A point has no outline to build, but is told of.
  if (says_yes(tags.get("building:part"))) return no_line(ObjectKind::building_part);
  if (says_yes(tags.get("building"))) return no_line(ObjectKind::building);
  if (tower) return ObjectKind::tower;
  const std::string_view bridge = tags.get("bridge");
  if (line && says_yes(bridge) && is_carried(tags)) return ObjectKind::bridge;
  const bool drawn = tags.get("man_made") == "bridge" || (says_yes(bridge) && is_carried(tags));
  if (area && drawn) return ObjectKind::bridge;
  if ((line || (area && tags.get("area") == "yes")) && is_wall(tags)) return ObjectKind::wall;
  const std::string_view natural = tags.get("natural");
  if (natural == (line ? "tree_row" : "tree") && !area) return ObjectKind::tree;
  return std::nullopt;
}

bool wanted(const osm::Tags& tags) {
  return kind_of(tags, Geometry::area) || kind_of(tags, Geometry::line) || kind_of(tags, Geometry::point);
}

}  // namespace vantage::internal::city
