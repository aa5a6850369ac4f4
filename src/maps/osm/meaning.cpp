#include "maps/osm/meaning.h"

#include <algorithm>
#include <array>
#include <iterator>

namespace vantage::internal::osm {
namespace {

using Tag = std::pair<std::string, std::string>;

template <std::size_t N>
bool contains(const std::array<std::string_view, N>& list, std::string_view text) {
  return std::find(list.begin(), list.end(), text) != list.end();
}

// Keys whose closed ways are areas, but for the values that are lines by nature.
constexpr std::array<std::string_view, 17> kAreaKeys = {
    "building", "building:part", "leisure", "landuse",          "natural",  "amenity", "place", "man_made", "tourism",
    "historic", "shop",          "office",  "public_transport", "military", "water",   "power", "aeroway"};
constexpr std::array<std::string_view, 7> kLinearNatural = {"tree_row", "coastline", "cliff",     "ridge",
                                                            "arete",    "valley",    "earth_bank"};
constexpr std::array<std::string_view, 6> kLinearManMade = {"embankment", "dyke",       "cutline",
                                                            "pipeline",   "breakwater", "groyne"};
constexpr std::array<std::string_view, 4> kLinearPower = {"line", "minor_line", "cable", "portal"};
constexpr std::array<std::string_view, 2> kLinearAeroway = {"runway", "taxiway"};
constexpr std::array<std::string_view, 6> kLineKeys = {"barrier",  "highway",   "railway",
                                                       "waterway", "aerialway", "tree_row"};

/// A feature whose key is used for areas, but which is drawn as a line.
bool is_linear(std::string_view key, std::string_view value) {
  if (key == "natural") return contains(kLinearNatural, value);
  if (key == "man_made") return contains(kLinearManMade, value);
  if (key == "power") return contains(kLinearPower, value);
  if (key == "aeroway") return contains(kLinearAeroway, value);
  return (key == "historic" && (value == "citywalls" || value == "railway")) ||
         (key == "roller_coaster" && value == "track");
}

/// A feature whose key is used for lines, but which is drawn as an area.
bool is_areal(std::string_view key, std::string_view value) {
  return (key == "waterway" && (value == "riverbank" || value == "dock")) || (key == "aerialway" && value == "station");
}

// Those that libosmium leaves out of account in old-style multipolygons; the last two are of its own test data.
constexpr std::array<std::string_view, 6> kSilentKeys = {"type", "created_by", "source",
                                                         "note", "test:id",    "test:section"};

constexpr std::array<std::string_view, 5> kHeightKeys = {"height", "building:height", "est_height", "building:levels",
                                                         "building:part:levels"};
constexpr std::array<std::string_view, 7> kRoofKeys = {
    "roof:height",          "roof:levels",          "roof:angle",         "roof:shape",
    "building:roof:height", "building:roof:levels", "building:roof:shape"};

bool is_silent(const Tag& tag) { return contains(kSilentKeys, tag.first); }

bool has_tag(const Tags& tags, const Tag& wanted) {
  return std::find(tags.all.begin(), tags.all.end(), wanted) != tags.all.end();
}

}  // namespace

bool means_building(const Tags& tags) {
  return std::any_of(tags.all.begin(), tags.all.end(), [](const Tag& tag) {
    return (tag.first == "building" || tag.first == "building:part") && tag.second != "no";
  });
}

bool means_area(const Tags& tags) {
  if (means_building(tags)) return true;
  const std::string_view area = tags.get("area");
  if (area == "no") return false;
  if (area == "yes") return true;
  return std::any_of(tags.all.begin(), tags.all.end(), [](const Tag& tag) {
    if (tag.second == "no") return false;
    return tag.first.starts_with("area:") || (contains(kAreaKeys, tag.first) && !is_linear(tag.first, tag.second)) ||
           is_areal(tag.first, tag.second);
  });
}

bool means_line(const Tags& tags) {
  if (!means_area(tags)) return true;
  return tags.get("area") != "yes" && is_linear(tags);
}

bool has_line_round(const Tags& tags) {
  const bool is_wall = tags.has("barrier") || tags.get("historic") == "citywalls";
  return tags.get("area") != "yes" && (tags.get("natural") == "tree_row" || (is_wall && means_area(tags)));
}

bool is_linear(const Tags& tags) {
  return std::any_of(tags.all.begin(), tags.all.end(), [](const Tag& tag) {
    if (tag.second == "no" || is_areal(tag.first, tag.second)) return false;
    return contains(kLineKeys, tag.first) || is_linear(tag.first, tag.second);
  });
}

bool says_nothing(const Tags& tags) { return std::all_of(tags.all.begin(), tags.all.end(), is_silent); }

bool repeats(const Tags& way, const Tags& area) {
  return std::all_of(way.all.begin(), way.all.end(), [&area](const Tag& tag) {
    if (is_silent(tag) || has_tag(area, tag)) return true;
    return (tag.first == "building" || tag.first == "building:part") && tag.second == "yes" && area.has(tag.first);
  });
}

bool says_the_same(const Tags& a, const Tags& b) {
  const auto in = [](const Tags& tags) {
    return [&tags](const Tag& tag) { return is_silent(tag) || has_tag(tags, tag); };
  };
  return std::all_of(a.all.begin(), a.all.end(), in(b)) && std::all_of(b.all.begin(), b.all.end(), in(a));
}

Tags common_tags(const std::vector<Tags>& all) {
  if (all.empty()) return {};
  Tags common = all.front();
  for (const Tags& tags : all) {
    std::erase_if(common.all, [&tags](const Tag& tag) { return !has_tag(tags, tag); });
  }
  return common;
}

bool says_height(const Tags& tags) {
  return std::any_of(tags.all.begin(), tags.all.end(), [](const Tag& tag) { return contains(kHeightKeys, tag.first); });
}

bool is_of_another(const Tags& piece, const Tags& area) {
  if (means_building(piece) && means_building(area)) return false;
  return (means_area(piece) || is_linear(piece)) &&
         std::none_of(piece.all.begin(), piece.all.end(),
                      [&area](const Tag& tag) { return !is_silent(tag) && has_tag(area, tag); });
}

Tags with_heights(const Tags& tags, const Tags& heights) {
  Tags all = heights;
  const bool is_said = says_height(heights);
  for (const Tag& tag : tags.all) {
    if (!heights.has(tag.first) && !(is_said && contains(kHeightKeys, tag.first))) all.all.push_back(tag);
  }
  return all;
}

void add_heights(Area& area, const Tags& others, bool of_it) {
  Tags heights;
  std::copy_if(others.all.begin(), others.all.end(), std::back_inserter(heights.all),
               [](const Tag& tag) { return contains(kHeightKeys, tag.first) || contains(kRoofKeys, tag.first); });
  const auto is_known = [&area](const Tag& tag) { return has_tag(area.tags, tag); };
  if (std::all_of(heights.all.begin(), heights.all.end(), is_known)) return;
  if (of_it && !says_height(area.tags) && says_height(heights)) {
    area.tags = with_heights(area.tags, heights);
  } else {
    area.heights.push_back(std::move(heights));
  }
}

}  // namespace vantage::internal::osm
