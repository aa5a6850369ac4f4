// The section `navigation` of a mission file, and the zones in it.
#pragma once

#include <array>
#include <string_view>

#include "request/description.h"

namespace vantage::internal::request {

struct NavigationKeys {};
struct ZoneKeys {};
struct NavigationMeshKeys {};

template <>
inline constexpr std::string_view kSection<NavigationKeys> = "navigation";
template <>
inline constexpr std::string_view kSection<ZoneKeys> = "a zone";
template <>
inline constexpr std::string_view kSection<NavigationMeshKeys> = "an entry of navigation.meshes";

inline constexpr std::array kNavigationKeys = {
    Own{{"altitude", "lowest and highest z, `[20, 120]`; or a map with `agl`, `z` or both"},
        Kind::numbers_or_map,
        Unit::metres},
    Own{{"altitude.agl", "lowest and highest height above the ground"}, Kind::numbers, Unit::metres},
    Own{{"altitude.z", "lowest and highest z"}, Kind::numbers, Unit::metres},
    Own{{.path = "ground",
         .says =
             "what heights above the ground are measured from, also of zones: the z of flat ground (m), the name of "
             "an object of the scene, which then is not an obstacle for `clearance`, or `all` for a scene that is "
             "terrain alone",
         .without = "what a map or a raster has as its ground"},
        Kind::text_or_number},
    Own{{"clearance", "> 0: how far the vehicle must stay from everything that is not ground"},
        Kind::number,
        Unit::metres},
    Own{{"keep_in", "[zones](#zones) to stay in", "The volume is cut to their union."}, Kind::maps, Unit::metres},
    Own{{.path = "boxes", .says = "the old name of `keep_in`", .is_old = true}, Kind::maps, Unit::metres},
    Own{{"keep_out", "[zones](#zones) to stay out of"}, Kind::maps, Unit::metres},
    Own{{"meshes", "closed meshes; the vehicle must stay inside all of them",
         "An entry is the path of a file, from the mission file, or `{mesh, up, scale}` as under `scene`."},
        Kind::list},
};

inline constexpr std::array kZoneKeys = {
    Own{{"min", "of a box along the axes, `[x, y, z]`"}, Kind::vector},
    Own{{"max", "of the box"}, Kind::vector},
    Own{{"polygon", "corners `[x, y]` of a simple polygon, in order"}, Kind::points},
    Own{{"holes", "polygons inside of `polygon` that are not of the zone"}, Kind::points},
    Own{{"file", "a [file](#files-of-zones), all of its zones"}, Kind::path},
    Own{{"z", "lowest and highest z"}, Kind::numbers, Unit::metres},
    Own{{"agl", "lowest and highest height above the ground"}, Kind::numbers, Unit::metres},
    Own{{"heights", "`any`: without bounds below and above"}, Kind::word},
    Own{{"skip", "`true`: what cannot be read of `file` is left out with a warning, instead of an error"}, Kind::flag},
};

inline constexpr std::array kNavigationMeshKeys = {
    Own{{.path = "mesh", .says = "its file", .is_required = true}, Kind::path},
    Own{{"up", "as `scene.up`"}, Kind::word},
    Own{{"scale", "as `scene.scale`"}, Kind::number, Unit::metres},
};

template <typename Visit>
void describe(const NavigationKeys& /*settings*/, Visit& visit) {
  visit.keys(kNavigationKeys);
}
template <typename Visit>
void describe(const ZoneKeys& /*settings*/, Visit& visit) {
  visit.keys(kZoneKeys);
}
template <typename Visit>
void describe(const NavigationMeshKeys& /*settings*/, Visit& visit) {
  visit.keys(kNavigationMeshKeys);
}

}  // namespace vantage::internal::request
