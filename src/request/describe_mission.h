// The outermost keys of a mission file, and the small sections `exact` and `links`.
#pragma once

#include <array>
#include <string_view>
#include <type_traits>

#include "request/describe_sensor.h"
#include "request/description.h"
#include "vantage/volume.h"

namespace vantage::internal::request {

struct MissionKeys {};
struct LinkKeys {};

template <>
inline constexpr std::string_view kSection<MissionKeys> = "the mission";
template <>
inline constexpr std::string_view kSection<ExactOptions> = "exact";
template <>
inline constexpr std::string_view kSection<LinkKeys> = "an entry of links";

inline constexpr std::array kMissionKeys = {
    Own{{.path = "scene", .says = "what may hide the target", .is_required = true}, Kind::map},
    Own{{.path = "crs",
         .says = "the coordinate reference system of the target, boxes and zones "
                 "([below](#coordinates-on-the-earth))",
         .without = "the scene frame"},
        Kind::text},
    Own{{"target", "what must be seen"}, Kind::map},
    Own{{"targets", "instead of `target`, a list of targets, each with the same keys ([below](#several-targets))"},
        Kind::maps},
    Own{{.path = "combine",
         .says = "what the volumes of several targets become: `all`, `any` or `each`",
         .without = "`all`"},
        Kind::word},
    Own{{"sensor", "what the sensor can do"}, Kind::map},
    Own{{"navigation", "where the vehicle may fly"}, Kind::map},
    Own{{.path = "method",
         .says = "how the volume is computed: `exact`, or `spheres` for the method of the paper "
                 "([spheres.md](spheres.md)), which may over-claim",
         .more = "`vantage compute --method` overrides it. `vantage query` is always exact.",
         .without = "`exact`"},
        Kind::word},
    Own{{"exact", "options of `method: exact`"}, Kind::map},
    Own{{"spheres", "options of `method: spheres`"}, Kind::map},
    Own{{"tour", "a flight that sees the targets"}, Kind::map},
    Own{{"links",
         "a list of what the vehicle of a flight must stay in sight of, as a pilot, or in reach of, as an "
         "antenna",
         "`vantage check` [judges them](flight.md#links)."},
        Kind::maps},
    Own{{.path = "work_limit",
         .says = "how much [work](#the-work-limit) the boolean operations may be, > 0",
         .without = "1.0e+7"},
        Kind::number},
};

inline constexpr std::array kLinkKeys = {
    Own{{.path = "name", .says = "no two the same", .without = "`link 1`, `link 2`, ..."}, Kind::text},
    Own{{"point", "where it is: `[x, y, z]`, as `crs` says; or `at`"}, Kind::vector, Unit::metres},
    Own{{"at", "[latitude, longitude] of a place on the ground"}, Kind::place},
    Own{{.path = "height", .says = "above `at`", .without = "0"}, Kind::number, Unit::metres},
    Own{{.path = "max_range", .says = "from there to the vehicle, > 0", .without = "no limit"},
        Kind::number,
        Unit::metres},
};
inline constexpr std::array kLinkRadioKeys = {
    Own{{.path = "frequency",
         .says = "of a radio link, as in `sensor.link`",
         .without = "none: the line of sight alone must be free"},
        Kind::number,
        Unit::gigahertz},
    Own{{.path = "clear", .says = "as in `sensor.link`", .without = "0.6"}, Kind::number},
};

template <typename Visit>
void describe(const MissionKeys& /*settings*/, Visit& visit) {
  visit.keys(kMissionKeys);
}

template <typename Settings, typename Visit>
requires std::is_same_v<std::remove_const_t<Settings>, ExactOptions>
void describe(Settings& settings, Visit& visit) {
  auto& [tolerance_m, threads, work_limit] = settings;
  static_cast<void>(threads), static_cast<void>(work_limit);  // of a run; of the mission
  visit.number({"tolerance", "the facets that approximate the range sphere may be this far inside it",
                "Planar parts are exact to rounding, and nothing is ever outside."},
               tolerance_m, {0, kLongest, Unit::metres, "write a positive number", "", Bounds::Ends::without_least},
               Only{});
}

template <typename Visit>
void describe(const LinkKeys& /*settings*/, Visit& visit) {
  visit.keys(kLinkKeys);
  visit.template instead<PilotSight>({"vlos", "instead of `max_range`, as `sensor.vlos`"});
  visit.keys(kLinkRadioKeys);
}

}  // namespace vantage::internal::request
