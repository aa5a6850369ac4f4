#include "support/tag_oracle.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <regex>
#include <sstream>

namespace vantage::testing {
namespace {

using Parse = std::function<std::optional<double>(const std::string&)>;

// The defaults of docs/scene.md.
constexpr double kLevel = 3, kLevels = 3, kRoofLevel = 2.5, kRoofDeck = 0.5, kRoofShare = 1.0 / 3;
constexpr double kThin = 0.01, kHighest = 1500, kMostLevels = 300;

double default_levels(const std::string& kind) {
  static const std::map<std::string, double> levels = {{"house", 2},     {"detached", 2},   {"semidetached_house", 2},
                                                       {"terrace", 2},   {"bungalow", 1},   {"farm", 2},
                                                       {"garage", 1},    {"garages", 1},    {"carport", 1},
                                                       {"shed", 1},      {"hut", 1},        {"cabin", 1},
                                                       {"kiosk", 1},     {"roof", 1},       {"greenhouse", 1},
                                                       {"service", 1},   {"retail", 2},     {"static_caravan", 1},
                                                       {"warehouse", 2}, {"industrial", 2}, {"cathedral", 8},
                                                       {"church", 4}};
  const auto found = levels.find(kind);
  return found == levels.end() ? kLevels : found->second;
}

double decimal(std::string digits) {
  std::replace(digits.begin(), digits.end(), ',', '.');
  return std::strtod(digits.c_str(), nullptr);
}

std::optional<double> one_number(const std::string& text) {
  static const std::regex form(R"(\s*([+-]?(?:\d+[.,]?\d*|[.,]\d+))\s*)");
  std::smatch match;
  return std::regex_match(text, match, form) ? std::optional(decimal(match[1])) : std::nullopt;
}

std::optional<double> one_length(const std::string& text) {
  static const std::regex form(R"(\s*([+-]?(?:\d+[.,]?\d*|[.,]\d+))\s*([a-z]*\.?|'|")\s*)", std::regex::icase);
  static const std::regex feet_and_inches(R"(\s*(-?\d+)\s*'\s*(\d+(?:[.,]\d+)?)\s*("|'')?\s*)");
  static const std::map<std::string, double> units = {
      {"", 1},          {"m", 1},         {"m.", 1},      {"meter", 1},     {"meters", 1},  {"metre", 1},
      {"metres", 1},    {"mm", 0.001},    {"cm", 0.01},   {"km", 1000},     {"ft", 0.3048}, {"ft.", 0.3048},
      {"feet", 0.3048}, {"foot", 0.3048}, {"in", 0.0254}, {"inch", 0.0254}, {"'", 0.3048},  {"\"", 0.0254}};
  std::smatch match;
  if (std::regex_match(text, match, feet_and_inches) && decimal(match[2]) < 12) {
    const double feet = decimal(match[1]);
    return feet * 0.3048 + (match[1].str().front() == '-' ? -1 : 1) * decimal(match[2]) * 0.0254;
  }
  if (!std::regex_match(text, match, form)) return std::nullopt;
  std::string unit = match[2];
  std::transform(unit.begin(), unit.end(), unit.begin(), [](unsigned char c) { return std::tolower(c); });
  const auto known = units.find(unit);
  return known == units.end() ? std::nullopt : std::optional(decimal(match[1]) * known->second);
}

/// Or the smallest.
std::optional<double> largest(const std::string& list, const Parse& parse, bool is_least = false) {
  std::optional<double> most;
  std::istringstream stream(list);
  for (std::string one; std::getline(stream, one, ';');) {
    if (one.find_first_not_of(" \t") == std::string::npos) continue;
    const std::optional<double> value = parse(one);
    if (!value) return std::nullopt;
    most = is_least ? std::min(most.value_or(*value), *value) : std::max(most.value_or(*value), *value);
  }
  return most;
}

/// One building's tags under the scheme.
class Tagged {
 public:
  Tagged(const TagMap& tags, const TagMap* outline) : tags_(tags) {
    for (const std::string& said :
         {tag(tags, "building:part"), tag(tags, "building"), outline ? tag(*outline, "building") : std::string()}) {
      if (kind_.empty() && said != "yes" && said != "no") kind_ = said;
    }
    const bool is_canopy = kind_ == "roof" || kind_ == "carport" || kind_ == "canopy";
    on_posts_ = is_canopy || tag(tags, "wall") == "no";
    if (kind_.empty() && on_posts_) kind_ = "roof";
    height_ = first({"height", "building:height", "est_height"}, length_of, kThin, kHighest);
    levels_ = first({"building:levels", "building:part:levels"}, number_of, 0, kMostLevels);
    roof_ = first({"roof:height", "building:roof:height"}, length_of, 0, kHighest);
    const bool is_flat = roof_ && *roof_ == 0;
    const auto roof_levels = first({"roof:levels", "building:roof:levels"}, number_of, 0, kMostLevels);
    if (!roof_ && roof_levels && *roof_levels > 0) roof_ = *roof_levels * kRoofLevel;
    const std::string shape = tag(tags, tags.contains("roof:shape") ? "roof:shape" : "building:roof:shape");
    shaped_ = !shape.empty() && shape != "flat" && !is_flat;
  }

  ExpectedHeights heights() {
    double bottom = read_bottom();
    bool bottom_is_said = bottom > 0;
    ExpectedHeights result;
    if (height_) {
      result.top = {*height_, *height_};
      if (bottom > *height_ - kThin) {
        because("min_height not below height");
        const bool is_deck = std::abs(bottom - *height_) < kThin;
        bottom = is_deck ? std::max(0.0, *height_ - kRoofDeck) : 0;
        bottom_is_said = true;
      }
    } else {
      result.top = stacked(bottom);
    }
    result.bottom = {bottom, bottom};
    if (on_posts_ && !bottom_is_said) result.bottom = below_the_deck(result.top);
    result.stands = result.bottom.most == 0;
    result.because = because_;
    return result;
  }

 private:
  void because(const std::string& reason) { because_ += (because_.empty() ? "" : ", ") + reason; }

  std::optional<double> first(std::initializer_list<const char*> keys, const Parse& parse, double least, double most) {
    for (const char* const key : keys) {
      const std::string value = tag(tags_, key);
      if (value.empty()) continue;
      const std::optional<double> result = parse(value);
      if (result && *result >= least && *result <= most) return result;
      because("nonsense taken as untagged");
    }
    return std::nullopt;
  }

  double read_bottom() {
    const auto lowest_length = [](const std::string& list) { return largest(list, one_length, true); };
    const auto lowest_number = [](const std::string& list) { return largest(list, one_number, true); };
    if (const auto bottom = first({"min_height"}, lowest_length, 0, kHighest)) return *bottom;
    const auto level = first({"building:min_level"}, lowest_number, 0, kMostLevels);
    if (!level) return 0;
    min_level_ = *level;
    const double body = height_.value_or(0) - roof_.value_or(0);
    const bool says_level = levels_ && *levels_ > min_level_ && body > 0;
    return *level * (says_level ? body / *levels_ : kLevel);
  }

  /// The top of walls of so many levels, and of a roof on them.
  ExpectedHeights::Range stacked(double bottom) {
    const double roof = roof_.value_or(0);
    double levels = levels_.value_or(default_levels(kind_));
    if (levels_ && min_level_ > 0 && levels <= min_level_) {
      because("levels counted from min_level");
      levels += min_level_;
    }
    double walls = levels * kLevel;
    const bool open_roof = shaped_ && !roof_;
    if (walls + roof < kThin || (walls < kThin && open_roof)) {
      because("no levels and no height");
      walls = kLevel * std::max(1.0, default_levels(kind_));
    }
    if (bottom > 0 && (walls < bottom || walls + roof < bottom + kThin)) {
      because("min_height above the levels");
      walls = bottom + (roof >= kThin ? 0 : kLevel);
    }
    if (!open_roof) return {walls + roof, walls + roof};
    because("roof without a height");
    if (!tag(tags_, "roof:angle").empty()) return {walls, walls + kHighest};
    return {walls, walls + (walls - bottom) * kRoofShare / (1 - kRoofShare)};
  }

  /// A deck under the eaves, which a roof without a height leaves open.
  ExpectedHeights::Range below_the_deck(const ExpectedHeights::Range& top) {
    because("stands on posts");
    const double flat = std::max(0.0, top.most - kRoofDeck);
    if (!shaped_) return {flat, flat};
    if (!roof_) return {0, flat};
    const double body = std::max(0.0, top.least - std::min(*roof_, top.least) - kRoofDeck);
    return {body, flat};  // a shape that is none is built flat
  }

  const TagMap& tags_;
  std::string kind_, because_;
  bool on_posts_ = false, shaped_ = false;
  std::optional<double> height_, levels_, roof_;
  double min_level_ = 0;
};

}  // namespace

std::optional<double> length_of(const std::string& list) { return largest(list, one_length); }
std::optional<double> number_of(const std::string& list) { return largest(list, one_number); }

ExpectedHeights expected_heights(const TagMap& tags, const TagMap* outline) { return Tagged(tags, outline).heights(); }

}  // namespace vantage::testing
