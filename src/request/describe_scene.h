// The section `scene` of a mission file.
#pragma once

#include <array>
#include <string_view>

#include "request/description.h"

namespace vantage::internal::request {

struct SceneKeys {};

template <>
inline constexpr std::string_view kSection<SceneKeys> = "scene";

inline constexpr std::array kSceneKeys = {
    Own{{"mesh",
         "the mesh that may hide the target: OBJ, PLY, STL, glTF, GLB or [CityJSON](scene.md#cityjson), also "
         "compressed with gzip",
         "The path starts from the mission file."},
        Kind::path},
    Own{{"osm", "instead of `mesh`, an OpenStreetMap file", "The scene is built from it ([below](#scenes-from-maps))."},
        Kind::path},
    Own{{"raster", "instead of `mesh`, a raster of surface heights", "It is the scene."}, Kind::path},
    Own{{"tiles", "instead of `mesh`, the `tileset.json` of a tileset of [3D Tiles](tilesets.md)",
         "Its features become the objects of the scene."},
        Kind::path},
    Own{{.path = "detail",
         .says = "for a tileset, the largest geometric error of a tile that is not refined",
         .without = "1"},
        Kind::number,
        Unit::metres},
    Own{{.path = "ground",
         .says = "for a tileset, the z of a plane that is its ground",
         .without = "none but what the tileset has"},
        Kind::number,
        Unit::metres},
    Own{{.path = "up",
         .says = "the axis of the mesh file that points up, `y` or `z`",
         .more = "A point (x, y, z) of a y-up file is (x, -z, y) in the scene frame. glTF is y up by its "
                 "specification and does not need `up`.",
         .without = "`z`"},
        Kind::word},
    Own{{.path = "scale", .says = "metres in one unit of the mesh file, > 0", .without = "1"},
        Kind::number,
        Unit::metres},
    Own{{.path = "lod", .says = "for CityJSON, the level of detail", .without = "the highest"}, Kind::text},
    Own{{.path = "crs",
         .says =
             "for a mesh, a raster, a tileset or the `terrain` of a map, the coordinate reference system of its "
             "coordinates, such as `EPSG:28992`, whatever the file says; or, for a mesh or a tileset, `none`: they are "
             "metres of no known place",
         .without = "what the file says"},
        Kind::text},
    Own{{.path = "origin",
         .says = "[latitude, longitude]: for a mesh, CityJSON or a raster, the scene's origin",
         .without = "the file's origin, or its middle"},
        Kind::place},
    Own{{.path = "sea_level",
         .says =
             "the z of mean sea level in the scene frame, for [files of zones](#files-of-zones) and for `terrain` of "
             "a tileset with heights above it",
         .without = "0 where the heights of the scene have a known zero (terrain, a raster, a reference system with "
                    "heights), else unknown"},
        Kind::number,
        Unit::metres},
    Own{{.path = "attribution",
         .says = "whom pictures and pages have to name, as `\"© OpenStreetMap contributors\"`",
         .without = "what the scene's file says, which a scene made from OpenStreetMap by vantage does"},
        Kind::text},
    Own{{.path = "center",
         .says = "[latitude, longitude]: for a map, a raster or a tileset, the centre of the part that is used; it is "
                 "the scene's origin",
         .without = "all of the file"},
        Kind::place},
    Own{{"radius", "of the part that is used round `center`"}, Kind::number, Unit::metres},
    Own{{.path = "bbox",
         .says = "degrees: the part that is used as a box, `[west, south, east, north]`",
         .without = "all of the file"},
        Kind::numbers},
    Own{{.path = "terrain",
         .says =
             "for a map or a [tileset](tilesets.md#ground), the heights of the ground: GeoTIFF, `.hgt` or `.hgt.zip`",
         .without = "for a map a plane at z = 0"},
        Kind::path},
    Own{{.path = "error",
         .says = "for a map or a tileset with terrain, or a raster: how far the triangles may lie above it, [at its "
                 "posts](terrain.md#terrain-as-triangles)",
         .without = "0.5; for a raster 0.25"},
        Kind::number,
        Unit::metres},
    Own{{.path = "z_unit",
         .says =
             "for a raster and for `terrain`, what its heights are in, whatever the file says: `m`, `ft` or `us-ft`",
         .without = "what the file says, else metres; a raster whose eastings are in feet must say it"},
        Kind::word},
    Own{{.path = "void",
         .says = "for a raster and for `terrain`, the height of [posts that have none](terrain.md#voids)",
         .without = "of the rim of a void, or of its neighbours"},
        Kind::number,
        Unit::metres},
    Own{{.path = "partial",
         .says = "for a map, `true`: an answer of Overpass that says that it is [not complete](scene.md#maps) is read "
                 "as far "
                 "as it goes",
         .without = "such an answer is refused"},
        Kind::flag},
    Own{{.path = "without",
         .says = "for a map, what is left out: a list of `walls`, `towers`, `bridges`, `trees`, and of "
                 "[stand-ins](scene.md#the-ledger) `woods`, `stadiums`, `masts`, `turbines`, `cranes`, `tanks`, "
                 "`monuments`, `others`; and `lines` overhead, for clearance",
         .without = "nothing"},
        Kind::list},
    Own{{.path = "missing",
         .says = "what is done about what the file says stands there and that cannot be built as it stands: `block`, "
                 "`warn` or `refuse`",
         .more =
             "With `block` a [stand-in](scene.md#the-ledger) holds its place, where it has one. With `warn` nothing "
             "does: volumes may claim too much behind it. `refuse` makes it an error.",
         .without = "`block`"},
        Kind::word},
    Own{{.path = "defaults",
         .says = "for a map, the values that are assumed where it has none: `{level: 3.2, levels.house: 2}`",
         .without = "those of [the table](scene.md#defaults)"},
        Kind::map},
    Own{{"frame", "for a map, what its [tiles](python-areas.md#tiles) have in common, as a plan of tiles says it",
         "With it the part of the map is built and prepared so that volumes in it are those of the whole map."},
        Kind::map},
    Own{{.path = "frame.origin", .says = "[latitude, longitude]", .is_required = true}, Kind::place},
    Own{{.path = "frame.ground", .says = "metres: `[west, south, east, north]`", .is_required = true}, Kind::numbers},
    Own{{.path = "frame.reach", .says = "how far tiles see beyond their border", .is_required = true},
        Kind::number,
        Unit::metres},
};

template <typename Visit>
void describe(const SceneKeys& /*settings*/, Visit& visit) {
  visit.keys(kSceneKeys);
}

}  // namespace vantage::internal::request
