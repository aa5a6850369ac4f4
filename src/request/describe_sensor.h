// Maps of the section `sensor` of a mission file.
#pragma once

#include <array>
#include <string_view>
#include <type_traits>

#include "request/description.h"
#include "vantage/mission.h"
#include "vantage/sensor.h"

namespace vantage::internal::request {

inline constexpr std::array kPixelKinds = {
    Choice<PixelLimit::Kind>{PixelLimit::Kind::worst, "worst"},
    Choice<PixelLimit::Kind>{PixelLimit::Kind::perpendicular, "perpendicular"},
};
inline constexpr std::array kAircraftKinds = {
    Choice<VisualRange::Kind>{VisualRange::Kind::multirotor, "multirotor"},
    Choice<VisualRange::Kind>{VisualRange::Kind::fixed_wing, "fixed_wing"},
};

template <>
inline constexpr std::string_view kSection<PixelLimit> = "sensor.pixel";
template <>
inline constexpr std::string_view kSection<RadioLink> = "sensor.link";
template <>
inline constexpr std::string_view kSection<PilotSight> = "sensor.vlos";

template <typename Settings, typename Visit>
requires std::is_same_v<std::remove_const_t<Settings>, PixelLimit>
void describe(Settings& settings, Visit& visit) {
  auto& [size_m, kind] = settings;
  visit.number({.path = "size",
                .says = "how much of the target one pixel may cover",
                .is_required = true,
                .form = "write {size: 0.02}: metres of the target in one pixel"},
               size_m,
               {0, kLongest, Unit::metres, "give how much of the target a pixel may cover: 0.02", "",
                Bounds::Ends::without_least},
               Only{});
  visit.choice({.path = "kind",
                .says = "`worst`, which counts the slant of the view, or `perpendicular`, which does not",
                .form = "write worst, which counts the slant of the view, or perpendicular, which does not"},
               kind, kPixelKinds);
}

template <typename Settings, typename Visit>
requires std::is_same_v<std::remove_const_t<Settings>, RadioLink>
void describe(Settings& settings, Visit& visit) {
  auto& [frequency_ghz, clear] = settings;
  visit.number({.path = "frequency",
                .says = "of the radio waves",
                .is_required = true,
                .form = "write {frequency: 2.4, clear: 0.6}: GHz"},
               frequency_ghz,
               // Radio waves end there (ITU Radio Regulations, 1.5).
               {0, 3000, Unit::gigahertz, "give it in GHz: 2.4", "", Bounds::Ends::without_least}, Only{});
  visit.number({"clear", "the share of the first zone's radius that must be free"}, clear,
               {0, 1, Unit::none, "0.6 is usual, 1 is all of the first zone", "", Bounds::Ends::without_least}, Only{});
}

template <typename Settings, typename Visit>
requires std::is_same_v<std::remove_const_t<Settings>, PilotSight>
void describe(Settings& settings, Visit& visit) {
  auto& [range, eye_height_m] = settings;
  auto& [aircraft_size_m, kind, visibility_m] = range;
  constexpr std::string_view kForm =
      "write {aircraft_size: 0.35, kind: multirotor, visibility: 5000}: metres; multirotor also for a helicopter";
  visit.number(
      {.path = "aircraft_size", .says = "the largest dimension of the aircraft", .is_required = true, .form = kForm},
      aircraft_size_m,
      {0, kLongest, Unit::metres, "give the largest dimension in metres: wing span, or from rotor to rotor", "",
       Bounds::Ends::without_least},
      Only{});
  visit.choice(
      {.path = "kind", .says = "`multirotor` (also helicopters) or `fixed_wing`", .is_required = true, .form = kForm},
      kind, kAircraftKinds);
  visit.number(
      {.path = "visibility", .says = "the ground visibility", .is_required = true, .form = kForm}, visibility_m,
      {0, kLongest, Unit::metres, "give the ground visibility in metres: 5000", "", Bounds::Ends::without_least},
      Only{});
  visit.number({.path = "eye_height", .says = "of the pilot above the target", .is_none_at_zero = true}, eye_height_m,
               {0, kLongest, Unit::metres, "give metres, or leave it out", "", Bounds::Ends::without_least}, Only{});
}

}  // namespace vantage::internal::request
