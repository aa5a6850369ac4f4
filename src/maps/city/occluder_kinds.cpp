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

/// Whether a tag says how high an object is.
bool says_its_height(const osm::Tags& tags) {
  static constexpr std::array<std::string_view, 4> keys = {"height", "est_height", "building:height", "height:hub"};
  return std::any_of(keys.begin(), keys.end(), [&](std::string_view key) {
    const std::string_view value = tags.get(key);
    if (value.empty()) return false;
    const auto plain = parse_length_m(value);
    return (plain ? plain : roughly_length_m(value, 1)).value_or(0) > 0;
  });
}

/// Whether a key says what a thing is.
bool names_a_kind(std::string_view key) {
  static constexpr std::array<std::string_view, 16> kinds = {
      "building", "building:part", "man_made", "power",   "aerialway", "historic",         "tourism",  "leisure",
      "natural",  "landuse",       "barrier",  "amenity", "bridge",    "generator:source", "memorial", "advertising"};
  return is_one_of(key, kinds);
}

/// Not in the open, or not there.
bool stands_nowhere(const osm::Tags& tags) {
  static constexpr std::array<std::string_view, 3> below = {"underground", "indoor", "underwater"};
  static constexpr std::array<std::string_view, 6> gone = {"demolished", "razed",   "removed",
                                                           "proposed",   "planned", "destroyed"};
  if (says_yes(tags.get("indoor")) || says_yes(tags.get("tunnel")) || is_one_of(tags.get("location"), below))
    return true;
  const auto sinks = [&](std::string_view key) { return parse_levels(tags.get(key)).value_or(0) < 0; };
  if (sinks("layer") || sinks("level")) return true;
  // "demolished:building=yes" may be of what stood there before something else.
  bool is_gone = false, is_something = false;
  for (const auto& [name, value] : tags.all) {
    const std::string_view key = name;
    const bool says_what = names_a_kind(key);
    if ((says_what || key == "status" || key == "state") && is_one_of(value, gone)) return true;
    is_something |= says_what && says_yes(value);
    const std::size_t colon = key.find(':');
    if (!is_one_of(key.substr(0, colon), gone) || !says_yes(value)) continue;
    if (colon == std::string::npos) return true;
    is_gone |= names_a_kind(key.substr(colon + 1));
  }
  return is_gone && !is_something;
}

/// Street furniture, ways, and forms of the ground, whatever height they have.
bool is_no_blocker(const osm::Tags& tags) {
  static constexpr std::array<std::string_view, 10> keys = {
      "highway",    "waterway",     "entrance",        "door",    "kerb", "emergency",
      "playground", "traffic_sign", "traffic_calming", "crossing"};
  static constexpr std::array<std::string_view, 2> places = {"boundary", "place"};
  const auto is_said = [&](std::string_view key) { return says_yes(tags.get(key)); };
  const bool is_something =
      std::any_of(tags.all.begin(), tags.all.end(), [](const auto& tag) { return names_a_kind(tag.first); });
  static constexpr std::array<std::string_view, 20> amenities = {
      "bench",         "waste_basket",    "waste_disposal", "recycling",       "post_box",         "telephone", "clock",
      "parking_meter", "vending_machine", "drinking_water", "bicycle_parking", "charging_station", "atm",       "bbq",
      "lounger",       "table",           "letter_box",     "parcel_locker",   "watering_place",   "grit_bin"};
  static constexpr std::array<std::string_view, 8> made = {"flagpole",     "surveillance", "street_cabinet", "manhole",
                                                           "survey_point", "water_tap",    "planter",        "cutline"};
  static constexpr std::array<std::string_view, 16> grounds = {
      "peak",  "hill",      "volcano",       "cliff",    "valley", "ridge", "arete", "saddle",
      "water", "coastline", "cave_entrance", "sinkhole", "spring", "gorge", "bay",   "earth_bank"};
  static constexpr std::array<std::string_view, 8> barriers = {"bollard", "kerb",  "gate",     "lift_gate",
                                                               "chain",   "block", "handrail", "cycle_barrier"};
  static constexpr std::array<std::string_view, 4> signs = {"board", "sign", "flag", "poster_box"};
  return std::any_of(keys.begin(), keys.end(), is_said) ||
         (!is_something && std::any_of(places.begin(), places.end(), is_said)) ||
         is_one_of(tags.get("amenity"), amenities) || is_one_of(tags.get("man_made"), made) ||
         is_one_of(tags.get("natural"), grounds) || is_one_of(tags.get("barrier"), barriers) ||
         is_one_of(tags.get("advertising"), signs) || tags.get("tourism") == "information" ||
         tags.get("leisure") == "picnic_table";
}

bool is_stand_in(const osm::Tags& tags) {
  return says_its_height(tags) && !stands_nowhere(tags) && !is_no_blocker(tags);
}

struct StandInKind {
  std::string_view key, value;  ///< an empty value stands for any
  std::string_view name;        ///< of the switch
};

constexpr std::array kStandInKinds = {StandInKind{"natural", "wood", "woods"},
                                      StandInKind{"natural", "scrub", "woods"},
                                      StandInKind{"natural", "tree_group", "woods"},
                                      StandInKind{"landuse", "forest", "woods"},
                                      StandInKind{"landuse", "orchard", "woods"},
                                      StandInKind{"leisure", "stadium", "stadiums"},
                                      StandInKind{"leisure", "sports_hall", "stadiums"},
                                      StandInKind{"leisure", "sports_centre", "stadiums"},
                                      StandInKind{"generator:source", "wind", "turbines"},
                                      StandInKind{"man_made", "windmill", "turbines"},
                                      StandInKind{"man_made", "wind_turbine", "turbines"},
                                      StandInKind{"man_made", "crane", "cranes"},
                                      StandInKind{"man_made", "tank", "tanks"},
                                      StandInKind{"man_made", "bunker_silo", "tanks"},
                                      StandInKind{"man_made", "antenna", "masts"},
                                      StandInKind{"man_made", "utility_pole", "masts"},
                                      StandInKind{"power", "", "masts"},
                                      StandInKind{"aerialway", "", "masts"},
                                      StandInKind{"historic", "", "monuments"},
                                      StandInKind{"man_made", "obelisk", "monuments"},
                                      StandInKind{"tourism", "artwork", "monuments"},
                                      StandInKind{"memorial", "", "monuments"}};

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
  if (line && overhead_height_m(tags)) return std::nullopt;  // it hides next to nothing
  return is_stand_in(tags) ? std::optional(ObjectKind::stand_in) : std::nullopt;
}

std::optional<double> overhead_height_m(const osm::Tags& tags) {
  static constexpr std::array<std::string_view, 10> cables = {"cable_car", "gondola", "chair_lift", "mixed_lift",
                                                              "drag_lift", "t-bar",   "j-bar",      "platter",
                                                              "zip_line",  "goods"};
  if (stands_nowhere(tags)) return std::nullopt;
  if (tags.get("power") == "line") return 60;
  if (tags.get("power") == "minor_line") return 20;
  if (is_one_of(tags.get("aerialway"), cables)) return 40;
  const std::string_view location = tags.get("location");
  if (tags.get("man_made") == "pipeline" && (location == "overhead" || location == "overground")) return 10;
  return std::nullopt;
}

const OccluderSwitch& stand_in_switch(const osm::Tags& tags) {
  const auto fits = [&](const StandInKind& kind) {
    const std::string_view value = tags.get(kind.key);
    return kind.value.empty() ? says_yes(value) : value == kind.value;
  };
  const auto kind = std::find_if(kStandInKinds.begin(), kStandInKinds.end(), fits);
  const std::string_view name = kind == kStandInKinds.end() ? "others" : kind->name;
  const auto all = occluder_switches();
  return *std::find_if(all.begin(), all.end(), [&](const OccluderSwitch& one) { return name == one.name; });
}

double column_radius_m(const osm::Tags& tags, double height_m) {
  constexpr double kRotorShare = 0.4;  // of a turbine's height, where no tag says its rotor
  const std::string_view name = stand_in_switch(tags).name;
  if (name == "turbines") return std::max(3.0, kRotorShare * height_m);
  if (name == "masts") return tags.get("power") == "tower" ? 4 : 1;
  if (name == "stadiums" || name == "woods") return 20;
  if (name == "tanks" || says_yes(tags.get("building")) || says_yes(tags.get("building:part"))) return 10;
  return 3;
}

bool wanted(const osm::Tags& tags) {
  return kind_of(tags, Geometry::area) || kind_of(tags, Geometry::line) || kind_of(tags, Geometry::point) ||
         overhead_height_m(tags);
}

}  // namespace vantage::internal::city
