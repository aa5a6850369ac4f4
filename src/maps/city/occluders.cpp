#include "maps/city/occluders.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <numbers>
#include <string>

#include "core/format.h"
#include "maps/city/tree.h"

namespace vantage::internal::city {
namespace {

constexpr double kMostHeight = 1500;  // metres: twice what stands, as for buildings
constexpr double kMostRotor = 400;    // metres
constexpr double kMostWidth = 200;    // metres: of a wall, a bridge or a tank
constexpr double kLeastSize = 0.05;   // metres: nothing is thinner or lower than that
constexpr double kMostTree = 150;     // metres
constexpr double kMostCrown = 60;     // metres
constexpr double kLeastTower = 0.2;   // metres: a thinner one would be dropped as a sliver
constexpr int kTowerSides = 16;
constexpr double kMetreGirth = 20;  // circumference=* beyond that is in centimetres

/// The first of the keys that holds a length, be it but roughly, and no more than `most` of it; what holds none is
/// remarked on.
std::optional<double> tagged_length(const osm::Tags& tags, std::initializer_list<std::string_view> keys, double most,
                                    std::vector<TagRemark>& remarks) {
  for (const std::string_view key : keys) {
    const std::string_view value = tags.get(key);
    if (value.empty()) continue;
    const bool plain = parse_length_m(value).has_value();
    const std::optional<double> length = any_length_m(value);
    const bool usable = length && *length > 0;
    const double taken = usable ? std::clamp(*length, kLeastSize, most) : 0;
    if (plain && usable && *length <= most) return taken;
    const TagFault fault = !length          ? TagFault::no_value
                           : *length <= 0   ? TagFault::negative
                           : *length > most ? TagFault::too_large
                                            : TagFault::rough;
    remarks.push_back({fault, std::string(key), std::string(value),
                       usable ? core::format("taken as {:.6g} m", taken) : "taken as untagged"});
    remarks.back().unsure = key.ends_with("height") || key == "height:hub" || fault == TagFault::too_large;
    if (usable) return taken;
  }
  return std::nullopt;
}

std::optional<double> tagged_height(const osm::Tags& tags, double most, std::vector<TagRemark>& remarks) {
  return tagged_length(tags, {"height", "est_height", "building:height"}, most, remarks);
}

/// `min_height`, of several the lowest, so that nothing hides less than it may.
std::optional<double> tagged_bottom(const osm::Tags& tags, std::vector<TagRemark>& remarks) {
  const std::string_view value = tags.get("min_height");
  if (value.empty() || value == "0") return std::nullopt;
  const std::optional<double> bottom = parse_lowest_length_m(value);
  if (bottom && *bottom > 0 && *bottom <= kMostHeight) return bottom;
  remarks.push_back({TagFault::no_value, "min_height", std::string(value), "taken as untagged"});
  return std::nullopt;
}

OccluderDefaults::Size size_of(const std::map<std::string, OccluderDefaults::Size, std::less<>>& sizes,
                               std::initializer_list<std::string_view> names) {
  for (const std::string_view name : names) {
    const auto found = sizes.find(name);
    if (found != sizes.end()) return found->second;
  }
  return {2, 0.25};
}

std::vector<Shape> extruded(const std::vector<Footprint>& footprints, const BuildingForm& form) {
  std::vector<Shape> shapes;
  for (const Footprint& footprint : footprints) shapes.push_back({footprint, form, std::nullopt});
  return shapes;
}

/// The line in pieces of equal length, none longer than `piece_m`; whole when that is 0.
std::vector<std::vector<Vec2>> pieces_of(const std::vector<Vec2>& line, double piece_m) {
  double length = 0;
  for (std::size_t i = 0; i + 1 < line.size(); ++i) length += (line[i + 1] - line[i]).norm();
  if (piece_m <= 0 || !(length > piece_m)) return {line};
  const double step = length / std::ceil(length / piece_m);
  std::vector<std::vector<Vec2>> pieces = {{line[0]}};
  double left = step;
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    Vec2 from = line[i];
    double rest = (line[i + 1] - from).norm();
    while (rest > left + kGrid) {
      const Vec2 cut = from + (line[i + 1] - from) * (left / rest);
      pieces.back().push_back(cut);
      pieces.push_back({cut});
      rest -= left;
      from = cut;
      left = step;
    }
    pieces.back().push_back(line[i + 1]);
    left -= rest;
  }
  return pieces;
}

// ---- walls ----

BuildingForm bridge_form(const osm::Tags& tags, const OccluderDefaults& defaults, std::vector<TagRemark>& remarks);

OccluderDefaults::Size wall_size(const osm::Tags& tags, const OccluderDefaults& defaults,
                                 std::vector<TagRemark>& remarks) {
  const std::string_view barrier = tags.get("barrier");
  const std::string_view kind = barrier == "wire_fence"               ? "fence"
                                : tags.get("historic") == "citywalls" ? "city_wall"
                                                                      : barrier;
  OccluderDefaults::Size size = size_of(defaults.walls, {tags.get("wall"), kind, "wall"});
  size.height_m = tagged_height(tags, kMostHeight, remarks).value_or(size.height_m);
  size.width_m = tagged_length(tags, {"width", "est_width"}, kMostWidth, remarks).value_or(size.width_m);
  return size;
}

BuildingForm upright(const osm::Tags& tags, double height_m, std::vector<TagRemark>& remarks) {
  BuildingForm form;
  form.top_m = height_m;
  const std::optional<double> bottom = tagged_bottom(tags, remarks);
  if (bottom && *bottom < height_m) {
    form.bottom_m = *bottom;
  } else if (bottom) {
    remarks.push_back({TagFault::bottom_too_high, "min_height", std::string(tags.get("min_height")),
                       "taken as standing on the ground"});
  }
  return form;
}

/// On a bridge from the ground to above its deck.
BuildingForm wall_form(const osm::Tags& tags, double height_m, const OccluderDefaults& defaults,
                       std::vector<TagRemark>& remarks) {
  std::vector<TagRemark> unheard;
  return upright(tags, is_on_bridge(tags) ? bridge_form(tags, defaults, unheard).top_m : height_m, remarks);
}

std::vector<Shape> walls_along(const osm::Tags& tags, const std::vector<Vec2>& points, double piece_m,
                               const OccluderDefaults& defaults, std::vector<TagRemark>& remarks) {
  const OccluderDefaults::Size size = wall_size(tags, defaults, remarks);
  const BuildingForm form = wall_form(tags, size.height_m, defaults, remarks);
  std::vector<Shape> shapes;
  const std::vector<std::vector<Vec2>> pieces = pieces_of(points, piece_m);
  for (const std::vector<Vec2>& piece : pieces) {
    const bool closed = pieces.size() == 1 && points.size() > 3 && points.front() == points.back();
    for (Shape& shape : extruded(widen(piece, closed, size.width_m), form)) shapes.push_back(std::move(shape));
  }
  return shapes;
}

// ---- towers ----

OccluderDefaults::Size tower_size(const osm::Tags& tags, const OccluderDefaults& defaults) {
  return size_of(defaults.towers, {tags.get("tower:type"), tags.get("man_made"), "tower"});
}

/// As a building without a storey height: its roof, its min_height, and a height of its own when it has none.
BuildingForm tower_form(const osm::Tags& tags, const OccluderDefaults& defaults, std::vector<TagRemark>& remarks) {
  BuildingDefaults building;
  building.levels = tower_size(tags, defaults).height_m / building.level_m;
  building.levels_of.clear();
  return read_form(tags, nullptr, building, remarks);
}

/// A regular prism's outline, its corners on the circle.
std::vector<Footprint> column(const Vec2& middle, double diameter_m) {
  Ring ring;
  for (int k = 0; k < kTowerSides; ++k) {
    const double angle = 2 * std::numbers::pi * k / kTowerSides;
    ring.push_back(middle + diameter_m / 2 * Vec2(std::cos(angle), std::sin(angle)));
  }
  Repairs repairs;
  return clean({{ring, {}}}, repairs);
}

// ---- bridges ----

/// From the lowest that its underside may be to the highest that its top may be, and up to its height where that is
/// said.
BuildingForm deck_form(const osm::Tags& tags, const OccluderDefaults& defaults, std::vector<TagRemark>& remarks) {
  BuildingForm form;
  const std::string_view layer = tags.get("layer");
  const std::optional<double> layers = parse_levels(layer);
  constexpr double kMostLayers = 10;
  if (!layer.empty() && (!layers || std::abs(*layers) > kMostLayers)) {
    remarks.push_back({TagFault::no_value, "layer", std::string(layer), "taken as untagged", true});
  } else if (layers && *layers < 0) {
    remarks.push_back({TagFault::below_ground, "layer", std::string(layer), "taken as 0"});
  }
  const bool valid = layers && *layers != 0 && std::abs(*layers) <= kMostLayers;
  double highest = defaults.layer_m * (valid ? std::max(*layers, 0.0) : 1);
  form.bottom_m = valid ? std::min(highest, defaults.layer_m * parse_lowest_levels(layer).value_or(0)) : highest;
  const std::string_view clear = tags.get("min_height");
  const auto clearance = clear == "0" ? std::nullopt : tagged_length(tags, {"min_height"}, kMostHeight, remarks);
  if (clearance) {
    highest = *clearance;
    form.bottom_m = std::min(highest, parse_lowest_length_m(clear).value_or(0));
  }
  form.top_m = highest + defaults.deck_m;
  const auto height = tagged_height(tags, kMostHeight, remarks);
  if (height && (*height > form.top_m || *height - defaults.deck_m < form.bottom_m)) {
    form.top_m = std::max(form.top_m, *height);
    form.bottom_m = std::min(form.bottom_m, *height - defaults.deck_m);
    const char* const key = tags.has("height") ? "height" : tags.has("est_height") ? "est_height" : "building:height";
    remarks.push_back({TagFault::rough, "height", std::string(tags.get(key)), "held from the deck up to it", true});
  }
  form.bottom_m = std::max(form.bottom_m, 0.0);
  return form;
}

/// With the wall that is drawn as one with it.
BuildingForm bridge_form(const osm::Tags& tags, const OccluderDefaults& defaults, std::vector<TagRemark>& remarks) {
  BuildingForm form = deck_form(tags, defaults, remarks);
  if (is_wall(tags)) form.top_m += wall_size(tags, defaults, remarks).height_m;
  return form;
}

double deck_width(const osm::Tags& tags, const OccluderDefaults& defaults, std::vector<TagRemark>& remarks) {
  if (const auto width = tagged_length(tags, {"width", "est_width"}, kMostWidth, remarks)) return *width;
  const auto count = [&](std::string_view key, double most) {
    const std::optional<double> number = parse_levels(tags.get(key));
    return number && *number >= 1 && *number <= most ? *number : 0;
  };
  const double lanes = count("lanes", 20);
  double width = 0;
  for (const std::string_view key : {"highway", "aeroway", "waterway"}) {
    if (!tags.has(key)) continue;
    const auto found = defaults.ways.find(tags.get(key));
    const double usual = found == defaults.ways.end() ? defaults.other_way_m : found->second;
    width = std::max(width, key == "highway" && lanes > 0 ? defaults.lane_m * lanes : usual);
  }
  return width > 0 ? width : defaults.track_m * std::max(1.0, count("tracks", 20));
}

// ---- trees ----

Tree tree_of(const osm::Tags& tags, const OccluderDefaults& defaults, std::vector<TagRemark>& remarks) {
  Tree tree;
  const double height = tagged_height(tags, kMostTree, remarks).value_or(defaults.tree_m);
  const BuildingForm form = upright(tags, height, remarks);
  tree.bottom_m = form.bottom_m;
  tree.top_m = form.top_m;
  const double own = tree.top_m - tree.bottom_m;
  tree.crown_m = tagged_length(tags, {"diameter_crown", "crown_diameter"}, kMostCrown, remarks)
                     .value_or(defaults.crown_share * own);
  std::optional<double> girth = tagged_length(tags, {"circumference"}, 100 * kMetreGirth, remarks);
  if (girth && *girth > kMetreGirth) *girth /= 100;
  tree.trunk_m = girth ? *girth / std::numbers::pi : defaults.trunk_share * own;
  tree.trunk_m = std::min(std::max(tree.trunk_m, kLeastSize / 5), tree.crown_m / 2);
  tree.crown_base_share = std::clamp(defaults.crown_base_share, 0.05, 0.9);
  tree.needles = tags.get("leaf_type") == "needleleaved" || tags.get("type") == "conifer";
  return tree;
}

// ---- stand-ins ----

constexpr double kThinLine = 1;   // metres: width of a line that says none
constexpr double kMostPipe = 20;  // metres: diameter=* beyond that is in millimetres

/// As high as its height or its hub; where it says only how many levels it has, as a building with them.
BuildingForm stand_in_form(const osm::Tags& tags, const BuildingDefaults& buildings, std::vector<TagRemark>& remarks) {
  const std::optional<double> said = tagged_height(tags, kMostHeight, remarks);
  const auto hub = tagged_length(tags, {"height:hub"}, kMostHeight, remarks);
  double height = said.value_or(0);
  if (!said && says_levels(tags)) {
    const BuildingForm form = read_form(tags, nullptr, buildings, remarks);
    if (!hub) return form;
    height = form.top_m;
  }
  // A hub says how high the axis is; the rotor goes on above it.
  const auto rotor = tagged_length(tags, {"rotor:diameter"}, kMostRotor, remarks);
  if (hub) height = std::max(height, *hub + (rotor ? *rotor / 2 : column_radius_m(tags, *hub / (1 - kRotorShare))));
  return upright(tags, std::max(height, kLeastSize), remarks);
}

/// The diameter of a point's column: as the tags say it, or else by its kind and its height.
double column_width(const osm::Tags& tags, double height_m, std::vector<TagRemark>& remarks) {
  if (const auto rotor = tagged_length(tags, {"rotor:diameter"}, kMostRotor, remarks)) return *rotor;
  const auto said = tagged_length(tags, {"diameter", "width"}, kMostWidth, remarks);
  return said ? *said : 2 * column_radius_m(tags, height_m);
}

std::vector<Shape> trees_along(const osm::Tags& tags, const std::vector<Vec2>& points, const OccluderDefaults& defaults,
                               std::vector<TagRemark>& remarks) {
  Tree tree = tree_of(tags, defaults, remarks);
  std::vector<Shape> shapes;
  const auto plant = [&](const Vec2& foot) {
    tree.foot = foot;
    shapes.push_back({{}, {}, tree});
  };
  const std::vector<std::vector<Vec2>> pieces = pieces_of(points, defaults.tree_spacing_m);
  for (const std::vector<Vec2>& piece : pieces) plant(piece.front());
  if (points.front() != points.back()) plant(points.back());
  return shapes;
}

}  // namespace

void PlanBounds::extend(const Vec2& point) {
  min = min.cwiseMin(point);
  max = max.cwiseMax(point);
}

void PlanBounds::extend(const Footprint& footprint) {
  for (const Vec2& corner : footprint.outer) extend(corner);
}

bool PlanBounds::meets(const PlanBounds& other) const {
  return (min.array() <= other.max.array()).all() && (other.min.array() <= max.array()).all();
}

PlanBounds bounds_of(const std::vector<Shape>& shapes) {
  PlanBounds bounds;
  for (const Shape& shape : shapes) {
    bounds.extend(shape.footprint);
    if (!shape.tree) continue;
    const Vec2 crown = Vec2::Constant(shape.tree->crown_m / 2);
    bounds.extend(shape.tree->foot - crown);
    bounds.extend(shape.tree->foot + crown);
  }
  return bounds;
}

std::vector<Shape> shapes_of_line(const osm::Tags& tags, const std::vector<Vec2>& points, double piece_m,
                                  const OccluderDefaults& defaults, const BuildingDefaults& buildings,
                                  std::vector<TagRemark>& remarks) {
  const std::optional<ObjectKind> kind = kind_of(tags, Geometry::line);
  const bool finite = std::all_of(points.begin(), points.end(), [](const Vec2& p) { return p.allFinite(); });
  std::vector<Shape> shapes;
  if (finite && points.size() >= 2) {
    if (kind == ObjectKind::wall) shapes = walls_along(tags, points, piece_m, defaults, remarks);
    if (kind == ObjectKind::tree || (kind == ObjectKind::wall && tags.get("natural") == "tree_row")) {
      const std::vector<Shape> trees = trees_along(tags, points, defaults, remarks);
      shapes.insert(shapes.end(), trees.begin(), trees.end());
    }
    if (kind == ObjectKind::bridge) {
      const bool closed = points.size() > 3 && points.front() == points.back();
      shapes =
          extruded(widen(points, closed, deck_width(tags, defaults, remarks)), bridge_form(tags, defaults, remarks));
    }
    if (kind == ObjectKind::stand_in) {
      std::optional<double> width = tagged_length(tags, {"width", "est_width"}, kMostWidth, remarks);
      if (!width) width = tagged_length(tags, {"diameter"}, 1000 * kMostPipe, remarks);
      if (width && *width > kMostPipe && !tags.has("width") && !tags.has("est_width")) *width /= 1000;
      const bool closed = points.size() > 3 && points.front() == points.back();
      shapes = extruded(widen(points, closed, width.value_or(kThinLine)), stand_in_form(tags, buildings, remarks));
    }
  }
  if (shapes.empty() && kind)
    remarks.push_back({TagFault::too_small, "", "", std::string(name_of(*kind)).append(" along a line")});
  return shapes;
}

std::vector<Shape> shapes_of_point(const osm::Tags& tags, const Vec2& point, const OccluderDefaults& defaults,
                                   const BuildingDefaults& buildings, std::vector<TagRemark>& remarks) {
  const std::optional<ObjectKind> kind = kind_of(tags, Geometry::point);
  if (kind == ObjectKind::tree) {
    Tree tree = tree_of(tags, defaults, remarks);
    tree.foot = point;
    return {{{}, {}, tree}};
  }
  if (kind == ObjectKind::tower) {
    const double diameter =
        tagged_length(tags, {"diameter", "width"}, kMostWidth, remarks).value_or(tower_size(tags, defaults).width_m);
    return extruded(column(point, std::max(diameter, kLeastTower)), tower_form(tags, defaults, remarks));
  }
  if (!kind) return {};
  const bool is_stand_in = kind == ObjectKind::stand_in;
  const BuildingForm form =
      is_stand_in ? stand_in_form(tags, buildings, remarks) : read_form(tags, nullptr, buildings, remarks);
  // What stands in is round what it stands in for: its sides on the circle.
  const double width = column_width(tags, form.top_m, remarks) / std::cos(std::numbers::pi / kTowerSides);
  return extruded(column(point, std::max(width, kLeastTower)), form);
}

std::vector<Shape> shapes_of_area(const osm::Tags& tags, const std::vector<Footprint>& area,
                                  const OccluderDefaults& defaults, const BuildingDefaults& buildings,
                                  std::vector<TagRemark>& remarks) {
  const std::optional<ObjectKind> kind = kind_of(tags, Geometry::area);
  if (kind == ObjectKind::tower) return extruded(area, tower_form(tags, defaults, remarks));
  if (kind == ObjectKind::bridge) return extruded(area, bridge_form(tags, defaults, remarks));
  if (kind == ObjectKind::stand_in) return extruded(area, stand_in_form(tags, buildings, remarks));
  if (kind == ObjectKind::wall) {
    return extruded(area, wall_form(tags, wall_size(tags, defaults, remarks).height_m, defaults, remarks));
  }
  return {};
}

CitySolid make_solid(const Shape& shape, double ground_m) {
  if (shape.tree) return {tree_mesh(*shape.tree, ground_m), ""};
  return make_solid(shape.footprint, shape.form, ground_m);
}

}  // namespace vantage::internal::city
