// Simple 3D Buildings: tags -> heights and a roof. https://wiki.openstreetmap.org/wiki/Simple_3D_Buildings
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "maps/osm/extract.h"
#include "vantage/city.h"

namespace vantage::internal::city {

enum class RoofShape {
  flat,
  gabled,
  hipped,
  half_hipped,
  pyramidal,
  skillion,
  gambrel,
  mansard,
  dome,
  onion,
  cone,
  round,
  saltbox
};
constexpr int kRoofShapes = 13;

/// As the scheme spells it: "half-hipped".
std::string_view text(RoofShape shape);

/// One solid over a footprint. Heights are metres above the ground of the building it belongs to.
struct BuildingForm {
  double bottom_m = 0;  ///< min_height: 0 stands on the ground
  double top_m = 0;     ///< of the roof's highest point; > bottom_m
  double roof_m = 0;    ///< of this the roof's part, 0 <= roof_m <= top_m - bottom_m
  RoofShape roof = RoofShape::flat;
  std::optional<double> roof_direction_deg;  ///< compass: where the roof's main face falls to; across the ridge
  bool roof_across = false;                  ///< roof:orientation=across: the ridge runs along the shorter side
  bool is_box = false;  ///< the roof is of another shape, which a box as high as its top holds; `roof` gives its height

  /// The pitch of a roof whose height the tags leave open: it follows from the outline's width (`settled`), and
  /// `roof_m` is 0 until then.
  struct Pitch {
    double angle_deg = 0;
    bool on_top = false;    ///< the roof comes on top of `top_m`; else `top_m` stays, and the walls give way
    double most_share = 1;  ///< of the height above the bottom that the roof may take

    bool operator==(const Pitch&) const = default;
  };
  std::optional<Pitch> pitch;
  bool is_guessed = false;  ///< no tag says how high it is, or how many levels it has: the default of its kind
  /// > 0: stands on posts. The bottom is this far below the eaves, `bottom_m` only a lower limit (`settled`).
  double deck_m = 0;

  bool operator==(const BuildingForm&) const = default;
};

/// What holds both: as high as the higher one, and a box where its roof does not hold the other.
BuildingForm joined(const BuildingForm& a, const BuildingForm& b);

/// What is wrong with a tag.
enum class TagFault {
  no_value,         ///< no length, number, angle or word that the key may have
  negative,         ///< below zero, or zero where that is as wrong
  zero,             ///< a height of zero
  too_large,        ///< more than anything that is built
  unknown_roof,     ///< a roof that is not known, or that cannot be
  no_direction,     ///< a skillion roof that does not say where it falls
  below_ground,     ///< a layer below the ground
  bottom_too_high,  ///< the bottom is not below the top
  no_height,        ///< nothing is left between bottom and top
  too_small,        ///< nothing is left to build
  rough,            ///< no plain number, but holds one: the largest is taken
};

struct TagRemark {
  TagFault fault;
  std::string key, value;  ///< "height", "concrete"; empty for a thing as a whole
  std::string outcome;     ///< "taken as untagged"

  /// Whether it makes a height uncertain, so that the ledger has to tell of it.
  bool unsure = false;

  CityRemark for_people() const {
    return key.empty() ? CityRemark{outcome, outcome}
                       : CityRemark{key + "=" + value + ": " + outcome, key + ": " + outcome};
  }
};

/// "48.5", "48.5 m", "48,5m", "160 ft", "160'", "5'11\"", "0.2 km", "5;5.5" (the largest counts: what hides more);
/// nothing for what is not a length. Metres; may be negative.
std::optional<double> parse_length_m(std::string_view text);
/// The same of a bottom, of which the lowest counts.
std::optional<double> parse_lowest_length_m(std::string_view text);
/// "3", "2.5", "2;3" (the largest); nothing for what is not a number of levels.
std::optional<double> parse_levels(std::string_view text);
std::optional<double> parse_lowest_levels(std::string_view text);
/// parse_length_m, or else the largest length that the text holds: "13-22", "~22", "22 m (approx)", "1'000" (which may
/// be thousands), "10 storeys" of `level_m` each. Nothing where it holds no number.
std::optional<double> any_length_m(std::string_view text, double level_m);
/// With storeys of the default height.
std::optional<double> any_length_m(std::string_view text);
/// The largest number of levels that a text holds which is not plainly one; "G+5" are 6.
std::optional<double> roughly_levels(std::string_view text);
/// "45", "45°", "45 deg", "40;45" (the largest); nothing else.
std::optional<double> parse_angle_deg(std::string_view text);
/// Degrees clockwise from north: "45", "45°", "NE", "north"; nothing else.
std::optional<double> parse_direction_deg(std::string_view text);
/// A roof:shape, its synonyms included (the table is in roof_names.cpp); nothing for what is none.
std::optional<RoofShape> parse_roof_shape(std::string_view text);

/// Heights and roof of a building or a part. `outline`: the tags of the building that a part lies in, for what the part
/// does not say itself (nothing is inherited but building, the kind that default levels go by). Never fails: nonsense
/// is remarked on and taken as untagged. Heights are taken from, in this order:
///   top     height, building:height, est_height; else building:levels (or the default of the kind) and the roof
///   bottom  min_height; else, unless the height is rough or one of several, building:min_level; else, likewise, for
///           building=roof, carport and the like and for wall=no, the thickness of a deck below the eaves; else the
///           ground
///   roof    roof:height, roof:levels, roof:angle, the default pitch
/// A min_height above the height is left out (the object then reaches down to the ground, most often inside what it
/// stands on); one within 1 cm of the height makes a deck. building:levels not above building:min_level are taken as
/// counted from there.
BuildingForm read_form(const osm::Tags& tags, const osm::Tags* outline, const BuildingDefaults& defaults,
                       std::vector<TagRemark>& remarks);

}  // namespace vantage::internal::city
