#include <algorithm>
#include <array>

#include "maps/city/occluders.h"
#include "maps/osm/meaning.h"

namespace vantage::internal::city {
namespace {

template <std::size_t N>
bool is_one_of(std::string_view value, const std::array<std::string_view, N>& known) {
  return std::find(known.begin(), known.end(), value) != known.end();
}

bool says_yes(std::string_view value) { return !value.empty() && value != "no" && value != "false"; }

/// Not what says how high its hub is: a tower would be as high as a tower, without the rotor.
bool is_tower(const osm::Tags& tags) {
  static constexpr std::array<std::string_view, 10> towers = {
      "tower",     "communications_tower", "mast",         "chimney", "water_tower", "storage_tank", "silo",
      "gasometer", "lighthouse",           "cooling_tower"};
  return is_one_of(tags.get("man_made"), towers) && any_length_m(tags.get("height:hub")).value_or(0) <= 0;
}

constexpr std::array<std::string_view, 7> kGone = {"demolished", "razed",     "removed",   "proposed",
                                                   "planned",    "destroyed", "dismantled"};

/// "razed:building": what is gone of it; nothing for other keys.
std::optional<std::string_view> gone_key(std::string_view key) {
  const std::size_t colon = key.find(':');
  if (colon == std::string::npos || !is_one_of(key.substr(0, colon), kGone)) return std::nullopt;
  return key.substr(colon + 1);
}

/// What a bridge carries: nothing where no tag says it, or all that they say is gone.
enum class Carried { nothing, gone, something };
Carried carried(const osm::Tags& tags) {
  static constexpr std::array<std::string_view, 6> ways = {"highway", "railway",  "waterway",
                                                           "aeroway", "man_made", "public_transport"};
  Carried result = tags.get("bridge") == "aqueduct" ? Carried::something : Carried::nothing;
  for (const auto& [key, value] : tags.all) {
    if (!says_yes(value)) continue;
    const bool is_way = is_one_of(key, ways);
    if (is_way && !is_one_of(value, kGone)) return Carried::something;
    const auto past = gone_key(key);
    if (result == Carried::nothing && (is_way || (past && is_one_of(*past, ways)))) result = Carried::gone;
  }
  return result;
}

/// Whether a tag says how high an object is.
bool says_its_height(const osm::Tags& tags) {
  static constexpr std::array<std::string_view, 4> keys = {"height", "est_height", "building:height", "height:hub"};
  return says_levels(tags) || std::any_of(keys.begin(), keys.end(), [&](std::string_view key) {
           return any_length_m(tags.get(key)).value_or(0) > 0;
         });
}

/// Whether a key says what a thing is.
bool names_a_kind(std::string_view key) {
  static constexpr std::array<std::string_view, 30> kinds = {
      "building",         "building:part", "man_made",         "power",        "aerialway",
      "historic",         "tourism",       "leisure",          "natural",      "landuse",
      "barrier",          "amenity",       "generator:source", "memorial",     "bridge",
      "advertising",      "aeroway",       "attraction",       "military",     "railway",
      "public_transport", "tower:type",    "seamark:type",     "artwork_type", "shop",
      "office",           "craft",         "healthcare",       "club",         "roller_coaster"};
  return is_one_of(key, kinds);
}

/// Whether a key may say what a thing is: all but those that say something about it, or about what was there.
bool may_name_a_kind(std::string_view key) {
  static constexpr std::array<std::string_view, 34> about = {
      "name", "source",   "note",  "fixme",     "FIXME",   "description", "wikidata", "wikipedia", "image",
      "url",  "website",  "ref",   "start",     "end",     "date",        "height",   "est",       "min",
      "max",  "levels",   "level", "layer",     "width",   "length",      "material", "colour",    "old",
      "alt",  "operator", "owner", "architect", "created", "check",       "type"};
  if (names_a_kind(key)) return true;
  if (key.find(':') != std::string_view::npos) return false;  // "addr:street", "roof:shape"
  return !is_one_of(key.substr(0, key.find('_')), about) && !is_one_of(key, kGone);
}

/// Not in the open, or not there.
bool stands_nowhere(const osm::Tags& tags) {
  static constexpr std::array<std::string_view, 3> below = {"underground", "indoor", "underwater"};
  if (says_yes(tags.get("indoor")) || says_yes(tags.get("tunnel")) || is_one_of(tags.get("location"), below))
    return true;
  const auto sinks = [&](std::string_view key) { return parse_levels(tags.get(key)).value_or(0) < 0; };
  // The layer of what covers the ground only says how it is to be drawn.
  const bool is_ground = says_yes(tags.get("landuse")) || says_yes(tags.get("natural"));
  if ((sinks("layer") && !is_ground) || sinks("level")) return true;
  // "demolished:building=yes" may be of what stood there before something else, "destroyed=1945" too.
  bool is_gone = false, is_something = false;
  for (const auto& [name, value] : tags.all) {
    const std::string_view key = name;
    const bool is_over = is_one_of(value, kGone);
    if ((key == "status" || key == "state") && is_over) return true;
    if (is_one_of(key, kGone) && value == "yes") return true;
    if (is_over && names_a_kind(key)) is_gone = true;
    if (!is_over && may_name_a_kind(key)) is_something |= says_yes(value);
    const auto past = gone_key(key);
    is_gone |= past && says_yes(value) && names_a_kind(*past);
  }
  return is_gone && !is_something;
}

/// What a tag says of a thing.
enum class Word { nothing, no_blocker, blocker };

/// No blockers are street furniture, ways, and forms of the ground, whatever height they have.
Word word_of(std::string_view key, std::string_view value) {
  static constexpr std::array<std::string_view, 12> keys = {
      "highway",    "waterway",     "entrance",        "door",     "kerb",     "emergency",
      "playground", "traffic_sign", "traffic_calming", "crossing", "boundary", "place"};
  // What stands none the less, and what is said of anything.
  static constexpr std::array<std::string_view, 5> standing = {"dam", "weir", "lock_gate", "sluice_gate", "elevator"};
  static constexpr std::array<std::string_view, 4> empty = {"yes", "attraction", "viewpoint", "platform"};
  static constexpr std::array<std::string_view, 20> amenities = {
      "bench",         "waste_basket",    "waste_disposal", "recycling",       "post_box",         "telephone", "clock",
      "parking_meter", "vending_machine", "drinking_water", "bicycle_parking", "charging_station", "atm",       "bbq",
      "lounger",       "table",           "letter_box",     "parcel_locker",   "watering_place",   "grit_bin"};
  static constexpr std::array<std::string_view, 8> made = {"flagpole",     "surveillance", "street_cabinet", "manhole",
                                                           "survey_point", "water_tap",    "planter",        "cutline"};
  static constexpr std::array<std::string_view, 16> grounds = {
      "peak",  "hill",      "volcano",       "cliff",    "valley", "ridge", "arete", "saddle",
      "water", "coastline", "cave_entrance", "sinkhole", "spring", "gorge", "bay",   "earth_bank"};
  static constexpr std::array<std::string_view, 2> waters = {"basin", "reservoir"};
  static constexpr std::array<std::string_view, 8> barriers = {"bollard", "kerb",  "gate",     "lift_gate",
                                                               "chain",   "block", "handrail", "cycle_barrier"};
  static constexpr std::array<std::string_view, 4> signs = {"board", "sign", "flag", "poster_box"};
  if (!says_yes(value)) return Word::nothing;
  if (is_one_of(key, keys)) {
    if (is_one_of(value, standing)) return Word::blocker;
    return key == "emergency" && value == "yes" ? Word::nothing : Word::no_blocker;
  }
  if ((key == "amenity" && is_one_of(value, amenities)) || (key == "man_made" && is_one_of(value, made)) ||
      (key == "natural" && is_one_of(value, grounds)) || (key == "landuse" && is_one_of(value, waters)) ||
      (key == "barrier" && is_one_of(value, barriers)) || (key == "advertising" && is_one_of(value, signs)) ||
      (key == "tourism" && value == "information") || (key == "leisure" && value == "picnic_table")) {
    return Word::no_blocker;
  }
  const bool is_blocker = (names_a_kind(key) && !is_one_of(value, empty)) || (key == "support" && value == "tower");
  return is_blocker ? Word::blocker : Word::nothing;
}

/// Nothing else than what is no blocker: a city gate with barrier=gate is one.
bool is_no_blocker(const osm::Tags& tags) {
  const auto says = [&](Word word) {
    return std::any_of(tags.all.begin(), tags.all.end(),
                       [&](const auto& tag) { return word_of(tag.first, tag.second) == word; });
  };
  return says(Word::no_blocker) && !says(Word::blocker);
}

/// Cables hide next to nothing; a pipe may hide much.
bool is_cable(const osm::Tags& tags) {
  return overhead_height_m(tags) && !(tags.get("man_made") == "pipeline" && says_its_height(tags));
}

struct StandInKind {
  std::string_view key, value;  ///< an empty value stands for any
  std::string_view name;        ///< of the switch
  bool is_high = false;         ///< it is told of though nothing says how high it is

  bool has(const osm::Tags& tags) const { return value.empty() ? says_yes(tags.get(key)) : tags.get(key) == value; }
};

constexpr std::array kStandInKinds = {StandInKind{"natural", "wood", "woods", true},
                                      StandInKind{"natural", "scrub", "woods", true},
                                      StandInKind{"natural", "tree_group", "woods", true},
                                      StandInKind{"natural", "tree", "woods", true},
                                      StandInKind{"landuse", "forest", "woods", true},
                                      StandInKind{"landuse", "orchard", "woods", true},
                                      StandInKind{"leisure", "stadium", "stadiums", true},
                                      StandInKind{"leisure", "sports_hall", "stadiums", true},
                                      StandInKind{"leisure", "sports_centre", "stadiums"},
                                      StandInKind{"generator:source", "wind", "turbines", true},
                                      StandInKind{"man_made", "windmill", "turbines", true},
                                      StandInKind{"man_made", "wind_turbine", "turbines", true},
                                      StandInKind{"man_made", "crane", "cranes", true},
                                      StandInKind{"man_made", "tank", "tanks", true},
                                      StandInKind{"man_made", "bunker_silo", "tanks", true},
                                      StandInKind{"man_made", "antenna", "masts", true},
                                      StandInKind{"man_made", "utility_pole", "masts"},
                                      StandInKind{"power", "tower", "masts", true},
                                      StandInKind{"power", "portal", "masts", true},
                                      StandInKind{"power", "", "masts"},
                                      StandInKind{"aerialway", "pylon", "masts", true},
                                      StandInKind{"aerialway", "station", "masts", true},
                                      StandInKind{"aerialway", "", "masts"},
                                      StandInKind{"historic", "castle", "monuments", true},
                                      StandInKind{"historic", "city_gate", "monuments", true},
                                      StandInKind{"historic", "monument", "monuments", true},
                                      StandInKind{"historic", "ruins", "monuments", true},
                                      StandInKind{"historic", "tower", "monuments", true},
                                      StandInKind{"historic", "", "monuments"},
                                      StandInKind{"man_made", "obelisk", "monuments", true},
                                      StandInKind{"tourism", "artwork", "monuments"},
                                      StandInKind{"memorial", "", "monuments"}};

bool stands_high(const osm::Tags& tags) {
  return std::any_of(kStandInKinds.begin(), kStandInKinds.end(),
                     [&](const StandInKind& kind) { return kind.is_high && kind.has(tags); });
}

bool is_stand_in(const osm::Tags& tags) {
  return (says_its_height(tags) || stands_high(tags)) && !stands_nowhere(tags) && !is_no_blocker(tags);
}

}  // namespace

bool is_wall(const osm::Tags& tags) {
  static constexpr std::array<std::string_view, 6> barriers = {"wall",  "city_wall",  "fence",
                                                               "hedge", "wire_fence", "retaining_wall"};
  return is_one_of(tags.get("barrier"), barriers) || tags.get("historic") == "citywalls";
}

std::optional<ObjectKind> kind_of(const osm::Tags& tags, Geometry geometry) {
  const bool line = geometry == Geometry::line, area = geometry == Geometry::area;
  const auto no_line = [&](ObjectKind kind) { return line ? std::nullopt : std::optional(kind); };
  const bool tower = !line && is_tower(tags);
  if (tower && !area) return ObjectKind::tower;
  // A point has no outline to build, but is told of.
  if (says_yes(tags.get("building:part"))) return no_line(ObjectKind::building_part);
  if (says_yes(tags.get("building"))) return no_line(ObjectKind::building);
  if (tower) return ObjectKind::tower;
  const bool is_bridge = says_yes(tags.get("bridge")) && (line || area);
  if (is_bridge && carried(tags) == Carried::something) return ObjectKind::bridge;
  if (area && tags.get("man_made") == "bridge") return ObjectKind::bridge;
  // An area that nothing else makes one is the barrier's own.
  const auto is_whole = [&] { return area && (tags.get("area") == "yes" || !osm::means_area(tags)); };
  if (is_wall(tags) && (line || is_whole())) return ObjectKind::wall;
  const std::string_view natural = tags.get("natural");
  if (natural == (line ? "tree_row" : "tree") && !area) return ObjectKind::tree;
  if (line && is_cable(tags)) return std::nullopt;
  if (is_stand_in(tags)) return ObjectKind::stand_in;
  return is_bridge && carried(tags) == Carried::nothing ? std::optional(ObjectKind::bridge) : std::nullopt;
}

bool says_levels(const osm::Tags& tags) {
  return std::max(roughly_levels(tags.get("building:levels")).value_or(0),
                  roughly_levels(tags.get("building:part:levels")).value_or(0)) > 0;
}

bool is_on_bridge(const osm::Tags& tags) { return says_yes(tags.get("bridge")) && carried(tags) != Carried::gone; }

std::optional<ObjectKind> kind_besides(const osm::Tags& tags) {
  osm::Tags others = tags;
  std::erase_if(others.all, [](const auto& tag) { return tag.first == "building" || tag.first == "building:part"; });
  if (others.all.size() == tags.all.size()) return std::nullopt;
  const bool has_hub = any_length_m(tags.get("height:hub")).value_or(0) > 0;
  if (is_tower(tags) ? says_its_height(tags) : !has_hub) return std::nullopt;
  return kind_of(others, Geometry::area);
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
  const auto kind =
      std::find_if(kStandInKinds.begin(), kStandInKinds.end(), [&](const StandInKind& one) { return one.has(tags); });
  const std::string_view name = kind == kStandInKinds.end() ? "others" : kind->name;
  const auto all = occluder_switches();
  return *std::find_if(all.begin(), all.end(), [&](const OccluderSwitch& one) { return name == one.name; });
}

bool lacks_height(const osm::Tags& tags, Geometry geometry) {
  return kind_of(tags, geometry) == ObjectKind::stand_in && !says_its_height(tags);
}

double column_radius_m(const osm::Tags& tags, double height_m) {
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
