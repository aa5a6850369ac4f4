#include "maps/city/building_form.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <utility>

#include "core/format.h"

namespace vantage::internal::city {
namespace {

constexpr double kHighest = 1500;    // metres: twice what stands; beyond it a unit or a digit is wrong
constexpr double kThinnest = 0.01;   // metres: a thinner solid is none, next to what rounding does to a large outline
constexpr double kMostLevels = 300;  // likewise
constexpr double kSteepest = 85;     // degrees; a steeper roof is a wall
constexpr double kSteep = 60;        // degrees: of roofs whose angle cannot be read
constexpr double kRoundPitch = 45;   // of domes and onions: as high as half their width
constexpr double kRoofShare = 1.0 / 3;
constexpr double kRounding = 1e-6;  // metres: 9 - 7.9 is 1.1

class FormReader {
 public:
  FormReader(const osm::Tags& tags, const osm::Tags* outline, const BuildingDefaults& defaults,
             std::vector<TagRemark>& remarks)
      : tags_(tags), defaults_(defaults), remarks_(remarks), kind_(kind_of(tags, outline)) {
    // By its own tags alone: what stands under a roof is no roof.
    const std::string own = kind_of(tags, nullptr);
    on_posts_ = own == "roof" || own == "carport" || own == "canopy" || tags.get("wall") == "no";
  }

  BuildingForm read() {
    read_roof();
    is_rough_ = false;
    const std::optional<double> height = first_height();
    const bool is_rough_height = height && is_rough_;
    for (const std::string_view key : {"building:levels", "building:part:levels"}) {
      if (!levels_) levels_ = sized(key, parse_levels, roughly_levels, kMostLevels, "");
    }
    is_rough_ = is_rough_height || (!height && is_rough_);
    // What the tags say of the height and cannot be understood matters where nothing else of them says it.
    if (!height && !levels_) {
      for (const std::size_t i : unheard_) remarks_[i].unsure = true;
    }
    form_.is_guessed = !height && !(levels_ && (*levels_ > 0 || roof_m_));
    read_bottom(height);
    if (height) {
      form_.top_m = *height;
      mend_bottom();
    } else {
      stack_levels();
    }
    fit_roof();
    // Many lie underground, but not all: to leave one out that does not would let a volume claim too much.
    if (parse_levels(tags_.get("layer")).value_or(0) < 0) {
      remark(TagFault::below_ground, "layer", tags_.get("layer"), "its layer is not used");
    }
    if (on_posts_ && !bottom_tagged_ && !is_rough_) form_.deck_m = defaults_.roof_deck_m;
    return form_;
  }

 private:
  /// The kind of building that defaults go by; empty for building=yes.
  static std::string kind_of(const osm::Tags& tags, const osm::Tags* outline) {
    const auto says = [](std::string_view value) { return !value.empty() && value != "yes" && value != "no"; };
    for (const std::string_view key : {"building:part", "building"}) {
      if (says(tags.get(key))) return std::string(tags.get(key));
    }
    if (outline != nullptr && says(outline->get("building"))) return std::string(outline->get("building"));
    return "";
  }

  void remark(TagFault fault, std::string_view key, std::string_view value, std::string_view outcome) {
    remarks_.push_back({fault, std::string(key), std::string(value), std::string(outcome)});
  }

  /// What the tags say of a roof cannot be built: a box hides as much as any roof.
  void make_box(std::string_view key, std::string_view value) {
    remark(TagFault::unknown_roof, key, value, "built as a box as high as its top");
    remarks_.back().unsure = true;
    form_.is_box = true;
  }

  /// A height or a number of levels; of several, or where it is not plainly written, the largest number counts.
  template <typename Parse, typename Roughly>
  std::optional<double> sized(std::string_view key, const Parse& parse, const Roughly& roughly, double most,
                              std::string_view unit) {
    const std::string_view value = tags_.get(key);
    if (value.empty()) return std::nullopt;
    const bool is_plain = parse(value).has_value();
    is_rough_ = !is_plain || value.find(';') != std::string_view::npos;
    if (!is_plain) {
      const std::optional<double> rough = roughly(value);
      if (rough && *rough > 0 && *rough <= most) {
        remark(TagFault::rough, key, value, "taken as " + core::format("{:.6g}", *rough) + std::string(unit));
        remarks_.back().unsure = true;
        return rough;
      }
    }
    const std::size_t before = remarks_.size();
    const std::optional<double> plain = number({key}, parse, most);
    for (std::size_t i = before; i < remarks_.size(); ++i) {
      remarks_[i].unsure = remarks_[i].fault == TagFault::too_large;
      unheard_.push_back(i);
    }
    return plain;
  }

  /// The first of the keys that has a value from 0 to `most`; others are remarked on.
  template <typename Parse>
  std::optional<double> number(std::initializer_list<std::string_view> keys, const Parse& parse, double most) {
    for (const std::string_view key : keys) {
      const std::string_view value = tags_.get(key);
      if (value.empty()) continue;
      const std::optional<double> result = parse(value);
      if (result && *result >= 0 && *result <= most) return result;
      const TagFault fault = !result ? TagFault::no_value : *result < 0 ? TagFault::negative : TagFault::too_large;
      remark(fault, key, value, "taken as untagged");
    }
    return std::nullopt;
  }

  std::optional<double> first_height() {
    for (const std::string_view key : {"height", "building:height", "est_height"}) {
      const auto roughly = [&](std::string_view value) { return any_length_m(value, defaults_.level_m); };
      if (roughly(tags_.get(key)).value_or(0) > kHighest) {
        remark(TagFault::too_large, key, tags_.get(key), core::format("taken as {:.6g} m", kHighest));
        remarks_.back().unsure = is_rough_ = true;
        return kHighest;
      }
      const std::optional<double> height = sized(key, parse_length_m, roughly, kHighest, " m");
      if (height && *height >= kThinnest) return height;
      if (height) remark(TagFault::zero, key, tags_.get(key), "taken as untagged");
    }
    return std::nullopt;
  }

  void read_roof() {
    const std::string_view value = tags_.get(tags_.has("roof:shape") ? "roof:shape" : "building:roof:shape");
    if (!value.empty()) {
      const std::optional<RoofShape> shape = parse_roof_shape(value);
      if (!shape) make_box("roof:shape", value);
      form_.roof = shape.value_or(RoofShape::gabled);
    }
    read_roof_height();
    if (form_.roof == RoofShape::flat) return;
    const std::string_view direction =
        tags_.get(tags_.has("roof:direction") ? "roof:direction" : "roof:slope:direction");
    form_.roof_direction_deg = parse_direction_deg(direction);
    if (!direction.empty() && !form_.roof_direction_deg) make_box("roof:direction", direction);
    if (form_.roof == RoofShape::skillion && direction.empty()) {
      remark(TagFault::no_direction, "roof:shape", value, "built as a box as high as its top");
      form_.is_box = true;
    }
    const std::string_view orientation = tags_.get("roof:orientation");
    form_.roof_across = orientation == "across";
    if (!orientation.empty() && orientation != "across" && orientation != "along") {
      make_box("roof:orientation", orientation);
    }
  }

  void read_roof_height() {
    const auto roughly = [&](std::string_view value) { return any_length_m(value, defaults_.roof_level_m); };
    std::optional<double> levels;
    const std::size_t before = remarks_.size();
    std::string_view rough;
    for (const std::string_view key : {"roof:height", "building:roof:height"}) {
      if (!roof_m_) roof_m_ = sized(key, parse_length_m, roughly, kHighest, " m");
      if (std::exchange(is_rough_, false)) rough = key;
    }
    for (const std::string_view key : {"roof:levels", "building:roof:levels"}) {
      if (!roof_m_ && !levels) levels = sized(key, parse_levels, roughly_levels, kMostLevels, "");
      if (std::exchange(is_rough_, false)) rough = key;
    }
    unheard_.clear();
    for (std::size_t i = before; i < remarks_.size(); ++i) remarks_[i].unsure = true;
    // Too high a roof has too low eaves.
    form_.is_box |= remarks_.size() > before;
    if (!rough.empty() && remarks_.size() == before) make_box(rough, tags_.get(rough));  // "2;15"
    if (roof_m_ && *roof_m_ == 0) form_.roof = RoofShape::flat;
    if (!roof_m_ && levels && *levels > 0) roof_m_ = *levels * defaults_.roof_level_m;
    if (roof_m_ || form_.roof == RoofShape::flat) return;
    const bool round = form_.roof == RoofShape::dome || form_.roof == RoofShape::onion;
    form_.pitch = {round ? kRoundPitch : defaults_.roof_pitch_deg, false, kRoofShare};
    const std::string_view angle = tags_.get("roof:angle");
    if (angle.empty()) return;
    const std::optional<double> degrees = parse_angle_deg(angle);
    const bool is_angle = degrees && *degrees > 0 && *degrees <= kSteepest;
    const double any = roughly_levels(angle).value_or(0);  // "~70"
    form_.pitch = {is_angle ? *degrees : any > kSteep && any <= kSteepest ? any : kSteep, false, 1};
    if (!is_angle || angle.find(';') != std::string_view::npos) make_box("roof:angle", angle);
  }

  void read_bottom(const std::optional<double>& height) {
    if (const auto bottom = number({"min_height"}, parse_lowest_length_m, kHighest)) {
      form_.bottom_m = *bottom;
      bottom_key_ = "min_height";
    } else if (const auto level = number({"building:min_level"}, parse_lowest_levels, kMostLevels)) {
      // A building that says both its height and its levels says how high a level is.
      const bool own = height && levels_ && *levels_ > *level && *height > roof_m_.value_or(0);
      if (height && is_rough_) return;  // so is the height of a level
      min_level_ = *level;
      form_.bottom_m = *level * (own ? (*height - roof_m_.value_or(0)) / *levels_ : defaults_.level_m);
      bottom_key_ = "building:min_level";
    }
    bottom_tagged_ = form_.bottom_m > 0;
  }

  /// The height is tagged: the bottom has to lie below it.
  void mend_bottom() {
    if (form_.bottom_m <= form_.top_m - kThinnest) return;
    const bool equal = std::abs(form_.bottom_m - form_.top_m) < kThinnest && !is_rough_;
    form_.bottom_m = equal ? std::max(0.0, form_.top_m - defaults_.roof_deck_m) : 0;
    remark(TagFault::bottom_too_high, bottom_key_, tags_.get(bottom_key_),
           equal ? "taken as a deck below the height" : "taken as standing on the ground");
  }

  /// No height is tagged: walls of so many levels, and the roof on top.
  void stack_levels() {
    double levels = levels_ ? *levels_ : default_levels();
    if (levels_ && *levels_ <= min_level_ && min_level_ > 0) {
      remark(TagFault::bottom_too_high, "building:levels", tags_.get("building:levels"),
             "taken as counted from building:min_level");
      levels += min_level_;
    }
    const double roof = roof_m_.value_or(0);
    double walls = levels * defaults_.level_m;
    if (walls + roof < kThinnest || (walls < kThinnest && form_.pitch)) {
      remark(TagFault::zero, "building:levels", tags_.get("building:levels"), "taken as untagged");
      walls = std::max(default_levels(), 1.0) * defaults_.level_m;
    }
    if (form_.bottom_m > 0 && (walls < form_.bottom_m || walls + roof < form_.bottom_m + kThinnest)) {
      walls = form_.bottom_m + (roof >= kThinnest ? 0 : defaults_.level_m);
      remark(TagFault::no_height, bottom_key_, tags_.get(bottom_key_),
             roof >= kThinnest ? "the roof stands on it" : "taken as one level high");
    }
    form_.top_m = walls + roof;
    if (form_.pitch) form_.pitch->on_top = true;
  }

  double default_levels() const {
    const bool generic = kind_.empty() && on_posts_;
    const auto found = defaults_.levels_of.find(generic ? "roof" : kind_);
    return found == defaults_.levels_of.end() ? defaults_.levels : found->second;
  }

  void fit_roof() {
    if (form_.roof == RoofShape::flat || !roof_m_) return;
    const double most = form_.top_m - form_.bottom_m;
    if (*roof_m_ > most + kRounding) {
      const std::string_view key = tags_.has("roof:height") ? "roof:height" : "roof:levels";
      make_box(key, tags_.get(key));
    }
    form_.roof_m = *roof_m_ > most - kRounding ? most : *roof_m_;
  }

  const osm::Tags& tags_;
  const BuildingDefaults& defaults_;
  std::vector<TagRemark>& remarks_;
  std::string kind_;
  bool on_posts_ = false, bottom_tagged_ = false;
  bool is_rough_ = false;  ///< what was read last is no single plain number; at last: what makes the top
  std::optional<double> levels_, roof_m_;  // the latter when the tags say it
  double min_level_ = 0;
  std::string_view bottom_key_;
  std::vector<std::size_t> unheard_;  // remarks on heights and levels that could not be understood
  BuildingForm form_;
};

/// The height up to which a form is whole, under any roof and over any outline.
double eaves_m(const BuildingForm& form) {
  if (form.roof == RoofShape::flat || (form.pitch && form.pitch->on_top)) return form.top_m;
  return form.top_m - (form.pitch ? form.pitch->most_share * (form.top_m - form.bottom_m) : form.roof_m);
}

bool rises_above_top(const BuildingForm& form) {
  return form.roof != RoofShape::flat && form.pitch && form.pitch->on_top;
}

}  // namespace

BuildingForm joined(const BuildingForm& a, const BuildingForm& b) {
  const BuildingForm &high = b.top_m > a.top_m ? b : a, &low = b.top_m > a.top_m ? a : b;
  BuildingForm result = high;
  result.bottom_m = std::min(a.bottom_m, b.bottom_m);
  if (low.deck_m != high.deck_m || low.top_m != high.top_m) result.deck_m = 0;
  BuildingForm raised = low;
  raised.top_m = high.top_m;
  raised.bottom_m = high.bottom_m;
  raised.deck_m = high.deck_m;
  raised.is_guessed = high.is_guessed;
  if (raised == high || (!rises_above_top(low) && low.top_m <= eaves_m(high))) return result;
  if (rises_above_top(low)) {
    // A skillion rises most, over all of the width.
    const bool both = rises_above_top(high);
    result.roof = both ? RoofShape::skillion : low.roof;
    result.roof_m = 0;
    result.roof_direction_deg = low.roof_direction_deg;
    result.roof_across = low.roof_across || (both && high.roof_across);
    result.pitch = low.pitch;
    if (both) result.pitch->angle_deg = std::max(low.pitch->angle_deg, high.pitch->angle_deg);
    if (both) result.pitch->most_share = std::max(low.pitch->most_share, high.pitch->most_share);
  }
  result.is_box = true;
  return result;
}

BuildingForm read_form(const osm::Tags& tags, const osm::Tags* outline, const BuildingDefaults& defaults,
                       std::vector<TagRemark>& remarks) {
  return FormReader(tags, outline, defaults, remarks).read();
}

}  // namespace vantage::internal::city
