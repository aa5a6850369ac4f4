#include "flight/plans/plan_source.h"

#include <cmath>
#include <initializer_list>
#include <utility>

#include "common/input.h"
#include "core/text.h"

namespace vantage::internal::flight::plans {
namespace {

// No vehicle flies so high or stays so long: larger numbers are in another unit, or garbage.
constexpr double kHighestM = 100e3, kLongestS = 1e7, kFastest = 1e4, kWidestM = 100e3, kMostTurns = 1e4;

bool is_within(double value, double most) { return std::abs(value) <= most; }  // not-a-number is not

void check_height(const PlanPosition& position, const std::string& where) {
  if (std::isnan(position.height_m) || is_within(position.height_m, kHighestM)) return;
  PlanSource::fail_at(ErrorCode::value_out_of_range, where,
                      "a height of " + shortest(position.height_m) + " m is not one that can be flown at",
                      "give metres");
}

void check_number(bool holds, const PlanItem& item, const char* what) {
  if (holds) return;
  PlanSource::fail_at(ErrorCode::value_out_of_range, item.place, std::string(what) + " is not one that can be flown",
                      "correct it: metres, seconds, degrees");
}

void check_item(const PlanItem& item) {
  check_height(item.position, item.place);
  check_number(item.hold_s >= 0 && is_within(item.hold_s, kLongestS), item, "the time to stay");
  check_number(std::isnan(item.speed_m_s) || (item.speed_m_s > 0 && is_within(item.speed_m_s, kFastest)), item,
               "the speed");
  check_number(is_within(item.acceptance_radius_m, kWidestM), item, "the radius of acceptance");
  check_number(is_within(item.loiter_radius_m, kWidestM), item, "the radius of the circle");
  check_number(item.turns >= 0 && is_within(item.turns, kMostTurns), item, "the number of turns");
  check_number(item.cut_m >= 0 && is_within(item.cut_m, kWidestM), item, "the distance of the turn");
  for (const auto& angle : {item.yaw_deg, item.gimbal_yaw_deg, item.gimbal_pitch_deg}) {
    check_number(!angle || is_within(*angle, 1e4), item, "an angle");
  }
  if (item.look_at) check_height(*item.look_at, item.place);
}

}  // namespace

Eigen::Vector2d checked_lonlat(double longitude_deg, double latitude_deg, const std::string& where) {
  const auto is_place = [](double longitude, double latitude) {
    return std::abs(latitude) <= 90 && std::abs(longitude) <= 180;  // not-a-number is none
  };
  if (is_place(longitude_deg, latitude_deg)) return {longitude_deg, latitude_deg};
  PlanSource::fail_at(
      ErrorCode::not_on_earth, where,
      "longitude " + shortest(longitude_deg) + ", latitude " + shortest(latitude_deg) + " is not a place on the earth",
      is_place(latitude_deg, longitude_deg) ? "longitude and latitude seem to be swapped"
                                            : "give WGS 84 positions in degrees, in the order of the format");
}

std::string counted(const std::map<std::string, std::size_t>& counts) {
  std::string text;
  for (const auto& [what, count] : counts) {
    text.append(text.empty() ? "" : ", ").append(std::to_string(count)).append(" ").append(what);
  }
  return text;
}

namespace {

void note_joined(std::size_t count, const char* one, const char* many, const std::string& names,
                 const PlanSource& source, FlightPlan& plan) {
  if (count < 2) return;
  plan.notes.push_back({WarningCode::plan_joined, source.name + " has " + core::count_text(count, one, many) +
                                                      ", flown one after the other" + names});
}

std::string names_of(const std::vector<PlanTrack>& tracks) {
  std::string names;
  constexpr std::size_t kMostNamed = 10;
  for (std::size_t i = 0; i < tracks.size() && i < kMostNamed; ++i) {
    const PlanTrack& track = tracks[i];
    names.append(names.empty() ? "" : ", ").append(track.name.empty() ? std::to_string(i + 1) : in_quotes(track.name));
  }
  return tracks.size() > kMostNamed ? names + ", ..." : names;
}

/// All of that name, or else the one of that number.
std::vector<PlanTrack> chosen(std::vector<PlanTrack> tracks, const char* one, const PlanSource& source) {
  std::vector<PlanTrack> named;
  for (PlanTrack& track : tracks) {
    if (track.name == source.track) named.push_back(std::move(track));
  }
  if (!named.empty()) return named;
  const ParsedNumber number = parse_number(source.track);
  const bool is_index = number.fault == NumberFault::none && number.value >= 1 &&
                        number.value <= static_cast<double>(tracks.size()) && number.value == std::floor(number.value);
  if (!is_index) {
    source.fail(ErrorCode::unknown_choice, "", "there is no " + std::string(one) + " " + in_quotes(source.track),
                tracks.empty() ? "the file has none" : "choose among " + names_of(tracks) + ", or a number from 1");
  }
  named.push_back(std::move(tracks[static_cast<std::size_t>(number.value) - 1]));
  return named;
}

}  // namespace

void take_tracks(std::vector<PlanTrack> tracks, const char* one, const char* many, const PlanSource& source,
                 FlightPlan& plan) {
  if (!source.track.empty()) tracks = chosen(std::move(tracks), one, source);
  std::size_t segments = 0;
  for (PlanTrack& track : tracks) {
    plan.items.insert(plan.items.end(), std::make_move_iterator(track.items.begin()),
                      std::make_move_iterator(track.items.end()));
    segments += track.segments;
  }
  note_joined(tracks.size(), one, many, ": " + names_of(tracks), source, plan);
  if (segments > tracks.size()) note_joined(segments, "segment", "segments", "", source, plan);
}

void join_at_antimeridian(std::vector<PlanTrack>& tracks, std::size_t first) {
  constexpr double kAntimeridian = 180, kSameDeg = 1e-9, kSameM = 1e-4;
  const auto meets = [](const PlanPosition& a, const PlanPosition& b) {
    const bool is_cut = std::abs(a.horizontal.x()) == kAntimeridian && b.horizontal.x() == -a.horizontal.x() &&
                        std::abs(a.horizontal.y() - b.horizontal.y()) <= kSameDeg;
    const bool is_level = std::isnan(a.height_m) ? std::isnan(b.height_m) : std::abs(a.height_m - b.height_m) <= kSameM;
    return is_cut && is_level;
  };
  if (first >= tracks.size()) return;
  std::size_t last = first;  // of those that are joined
  for (std::size_t i = first + 1; i < tracks.size(); ++i) {
    std::vector<PlanItem>&items = tracks[i].items, &before = tracks[last].items;
    if (!items.empty() && !before.empty() && meets(before.back().position, items.front().position)) {
      before.insert(before.end(), std::make_move_iterator(items.begin() + 1), std::make_move_iterator(items.end()));
    } else if (++last != i) {
      tracks[last] = std::move(tracks[i]);
    }
  }
  tracks.resize(last + 1);
}

PlanItem& new_item(PlanTrack& track, std::size_t& total, const std::string& place, const PlanSource& source) {
  check_count(++total, source);
  PlanItem& item = track.items.emplace_back();
  item.place = source.place(place);
  return item;
}

void NotJudged::name(const std::string& place, const std::string& why) {
  if (!places_.insert(place).second) return;
  constexpr std::size_t kMostNamed = 20;
  const std::size_t more = places_.size() > kMostNamed ? places_.size() - kMostNamed : 0;
  if (more > 1) texts_.pop_back();
  texts_.push_back(more > 0 ? file_ + ": and " + core::count_text(more, "item", "items") + " more"
                            : place + ": " + why);
}

void check_count(std::size_t items, const PlanSource& source) {
  if (items <= kMostPlanItems) return;
  source.fail(ErrorCode::value_out_of_range, "", "the plan has more than " + std::to_string(kMostPlanItems) + " items",
              "take a part of it");
}

void check_plan(const FlightPlan& plan, const PlanSource& source) {
  check_count(plan.items.size(), source);
  bool has_position = false;
  for (const PlanItem& item : plan.items) {
    check_item(item);
    has_position = has_position || item.position.horizontal.allFinite();
  }
  if (!has_position) {
    source.fail(ErrorCode::plan_empty, "", "the plan holds no positions", "give a plan with waypoints, or a track");
  }
  if (plan.home) check_height(*plan.home, source.place("home"));
}

}  // namespace vantage::internal::flight::plans
