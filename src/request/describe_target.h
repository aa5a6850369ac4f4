// The section `target`, and entries of `targets`, of a mission file.
#pragma once

#include <array>
#include <string_view>

#include "request/description.h"

namespace vantage::internal::request {

struct TargetKeys {};

template <>
inline constexpr std::string_view kSection<TargetKeys> = "target";

inline constexpr std::array kTargetKeys = {
    Own{{.path = "name",
         .says = "for messages and reports",
         .without = "`target`; for `osm` the object's name in the map, with its id; for a `part` the object and the "
                    "part; for `file` the name in the file, or else the file's; for `volume` the file's"},
        Kind::text},
    Own{{"vertices", "3 to 64 points in order around a convex, planar polygon, in either direction"},
        Kind::points,
        Unit::metres},
    Own{{.path = "edges",
         .says = "the polygon's edges as pairs of vertex numbers, counted from 0; they must agree with the order of "
                 "`vertices`",
         .without = "from `vertices`"},
        Kind::points},
    Own{{"parts", "several convex polygons, each a list of points like `vertices`; all of them must be seen",
         "`offset` and `front` apply to each."},
        Kind::polygons,
        Unit::metres},
    Own{{"point", "a single point instead of a polygon, `[x, y, z]`"}, Kind::vector, Unit::metres},
    Own{{"outline",
         "3 or more points `[x, y]` in order around a simple polygon, which is [laid on the "
         "ground](#targets-from-maps-and-places), or points `[x, y, z]` in one plane, where it lies",
         "It need not be convex. Or a list of several such polygons, all of which must be seen."},
        Kind::points,
        Unit::metres},
    Own{{"holes", "polygons inside of the outline that are not of the target"}, Kind::points, Unit::metres},
    Own{{"osm",
         "an area of the scene's map, by its id, `way/123` or `relation/123`, or by its name "
         "([below](#targets-from-maps-and-places))",
         "With `part`, a building of the map."},
        Kind::text},
    Own{{"object", "with `part`, an object of the scene, by its name or its id ([names](#notes))"}, Kind::text},
    Own{{"at", "[latitude, longitude], with `part`: the highest object that lies there, but for the ground"},
        Kind::place},
    Own{{.path = "part",
         .says = "`roof` or `facade` of that object ([below](#roofs-and-facades))",
         .without = "none; `osm` is then an area on the ground"},
        Kind::word},
    Own{{.path = "facing",
         .says = "with `part`, only faces that look that way, within 45 degrees: `north`, `northeast`, `east`, ... or "
                 "degrees clockwise from north",
         .more = "North is y where the scene has no place on the earth.",
         .without = "all"},
        Kind::word_or_number},
    Own{{.path = "nearest",
         .says = "with `part`, only the face that is nearest to this point, `[x, y, z]`",
         .without = "all"},
        Kind::vector,
        Unit::metres},
    Own{{"center", "[latitude, longitude] of the centre of a rectangle on the ground, with `width` and `length`"},
        Kind::place},
    Own{{"file", "a [file](#targets-from-files) that has the target: GeoJSON, KML or KMZ"}, Kind::path},
    Own{{"feature", "the name, the id or the number of what counts of the file, where it has several areas"},
        Kind::text},
    Own{{"volume", "a closed mesh to fly through, for `tour` and `check` ([below](#volumes-to-fly-through))",
         "No other key but `name` stands beside it."},
        Kind::path},
    Own{{"width", "of the rectangle"}, Kind::number, Unit::metres},
    Own{{"length", "of the rectangle, along the heading"}, Kind::number, Unit::metres},
    Own{{.path = "heading", .says = "clockwise from north: where the rectangle's length points", .without = "0"},
        Kind::number,
        Unit::degrees},
    Own{{.path = "offset",
         .says = "moves the target this far along its normal, towards the front; a point only with `front`",
         .without = "0"},
        Kind::number,
        Unit::metres},
    Own{{.path = "front",
         .says = "a vector that points to the side from which the target must be visible",
         .more = "It may have any length, and must not be in the polygon's plane.",
         .without = "up; for a vertical polygon the side from which the vertices are counter-clockwise; for a point "
                    "all sides"},
        Kind::vector},
    Own{{.path = "sides",
         .says = "`front`, or `both`: a position must see the target from one side or the other",
         .more = "Not of a point.",
         .without = "`front`"},
        Kind::word},
};

template <typename Visit>
void describe(const TargetKeys& /*settings*/, Visit& visit) {
  visit.keys(kTargetKeys);
}

}  // namespace vantage::internal::request
