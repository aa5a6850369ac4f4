// The section `sensor` of a mission file.
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
inline constexpr std::string_view kSection<Sensor> = "sensor";
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

inline constexpr std::array kCameraKeys = {
    Own{{.path = "camera",
         .says = "the whole target, all parts, must be in one picture of it",
         .more = "Either a model, or numbers: where width and height give two focal lengths in pixels, the smaller one "
                 "counts."},
        Kind::map},
    Own{{"camera.model", "a name that `vantage cameras` lists"}, Kind::text},
    Own{{"camera.width", "pixels of the whole picture"}, Kind::whole},
    Own{{"camera.height", "pixels of the whole picture"}, Kind::whole},
    Own{{"camera.focal_length", "of the lens itself; not beside `fov`"}, Kind::number, Unit::millimetres},
    Own{{"camera.sensor_width", "of the part of the sensor that makes the picture; not beside `fov`"},
        Kind::number,
        Unit::millimetres},
    Own{{"fov", "the angles of view, horizontal and vertical, with or without a `camera` that gives the pixels"},
        Kind::numbers,
        Unit::degrees},
    Own{{.path = "mount", .says = "`gimbal`, or a map of angles of a camera that does not turn", .without = "`gimbal`"},
        Kind::word_or_map},
    Own{{.path = "mount.yaw", .says = "clockwise from north, or `any`: the vehicle can turn", .is_required = true},
        Kind::word_or_number,
        Unit::degrees},
    Own{{.path = "mount.pitch", .says = "0 is level, -90 straight down", .is_required = true},
        Kind::number,
        Unit::degrees},
    Own{{.path = "mount.roll", .says = "a positive one lowers the right edge of the picture", .without = "0"},
        Kind::number,
        Unit::degrees},
    Own{{.path = "gimbal", .says = "instead of `mount`: the ways that the camera may look"}, Kind::map},
    Own{{.path = "gimbal.yaw", .says = "as of `mount`", .without = "`any`"}, Kind::word_or_number, Unit::degrees},
    Own{{.path = "gimbal.pitch",
         .says = "the lowest and the highest",
         .without =
             "what the gimbal of the [model](camera.md#cameras-that-vantage-knows) reaches; [-90, 90] where that "
             "is not known"},
        Kind::numbers,
        Unit::degrees},
    Own{{.path = "gimbal.roll", .says = "as of `mount`", .without = "0"}, Kind::number, Unit::degrees},
};
inline constexpr std::array kPixelKeys = {
    Own{{"dori",
         "instead of `pixel`, a level of EN 62676-4: `detection`, `observation`, `recognition` or "
         "`identification`: 25, 62, 125 or 250 pixels per metre, `perpendicular`"},
        Kind::word},
};
inline constexpr std::array kSunKeys = {
    Own{{"sun", "no point of the target may be seen too near to the sun"}, Kind::map},
    Own{{.path = "sun.exclude", .says = "> 0, at most 90: not nearer than this", .is_required = true},
        Kind::number,
        Unit::degrees},
    Own{{"sun.time", "ISO 8601 with a zone: `2026-06-21T16:00Z`",
         "It needs a scene that says where on the earth it lies."},
        Kind::text},
    Own{{"sun.azimuth", "instead of the time: clockwise from north"}, Kind::number, Unit::degrees},
    Own{{"sun.elevation", "with the azimuth: above the horizon, 0 to 90"}, Kind::number, Unit::degrees},
};
inline constexpr std::array kShareKeys = {
    Own{{.path = "visible",
         .says = "the part of the target's area that must be seen, > 0 and at most 1",
         .more = "All other limits hold for all of the target: it must be in range, in the picture and looked at from "
                 "the front as a whole ([how](camera.md#most-of-a-long-facade)). Not for a point, not with `method: "
                 "spheres`.",
         .without = "1"},
        Kind::number},
    Own{{.path = "cells",
         .says = "into how many pieces of the same area the target is cut for `visible`, 1 to 1024",
         .more = "A piece counts where it is seen whole. With more of them the volume is larger, up to what is right, "
                 "and takes longer. `vantage query` and `vantage verify` count exactly what is seen, without cells.",
         .without = "16"},
        Kind::whole},
};

template <typename Settings, typename Visit>
requires std::is_same_v<std::remove_const_t<Settings>, Sensor>
void describe(Settings& settings, Visit& visit) {
  auto& [max_range_m, min_range_m, incidence_deg, camera, mount, pixel, sun, link, visible] = settings;
  visit.number({.path = "max_range",
                .says = "from the viewpoint to every point of the target",
                .without = "none; required without `vlos`, `pixel` and `dori`",
                .is_none_at_infinity = true},
               max_range_m,
               {0, kLongest, Unit::metres, "give the farthest distance at which the target can be seen", "",
                Bounds::Ends::without_least},
               Only{});
  visit.template instead<PilotSight>(
      {.path = "vlos",
       .says = "instead of `max_range`, how far a pilot on the ground may be from the aircraft",
       .more = "The target is a point, the pilot's eyes; with `eye_height` the place where the pilot stands. [How the "
               "range follows](camera.md#the-sight-of-a-pilot)."});
  visit.number({.path = "min_range",
                .says = "to every point of the target, less than the range",
                .without = "none",
                .is_none_at_zero = true},
               min_range_m, {0, kLongest, Unit::metres, "give metres", "", Bounds::Ends::without_least}, Only{});
  visit.number({"incidence", "largest angle between the target's normal and the line to the viewpoint"}, incidence_deg,
               {0, 90, Unit::degrees, "it is measured from the target's normal: 60 leaves out the last 30 degrees", "",
                Bounds::Ends::neither},
               Only{});
  visit.keys(kCameraKeys, camera, mount);
  visit.map({"pixel", "how much of the target one pixel may cover", "Needs the camera's pixels."}, pixel);
  visit.keys(kPixelKeys, pixel);
  visit.keys(kSunKeys, sun);
  visit.map({"link", "a radio link between the target, a point where an antenna is, and the vehicle",
             "Nothing of the scene may enter the first Fresnel zone about the straight way between them. Not with "
             "`method: spheres`. [What that means](camera.md#the-zone-of-a-radio-link)."},
            link);
  visit.keys(kShareKeys, visible);
}

}  // namespace vantage::internal::request
