// Any file that a scene can be made of, and how.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "vantage/city.h"
#include "vantage/export.h"
#include "vantage/ground.h"
#include "vantage/progress.h"
#include "vantage/scene.h"
#include "vantage/tileset.h"

namespace vantage {

/// A file and what is to be made of it. Only the options of its kind count.
struct SceneSource {
  enum class Kind {
    mesh,    ///< read_scene: OBJ, PLY, STL, glTF, CityJSON
    map,     ///< build_city: OpenStreetMap
    raster,  ///< scene_from_raster: heights on a grid
    tileset  ///< read_tileset: 3D Tiles
  };
  Kind kind = Kind::mesh;
  std::filesystem::path file;
  std::string attribution = {};  ///< whom pictures have to name, where the file does not say it: see attribution_of
  SceneReadOptions mesh;
  CityOptions city;
  RasterOptions raster;
  TilesetOptions tileset;
  /// Of a tileset, instead of its `ground_m`: a raster of heights that becomes its ground (add_terrain). Empty: none.
  /// That of a map is in `city`.
  std::filesystem::path terrain = {};
  TerrainOptions terrain_options = {};
};

/// What is done about what cannot be built as the source has it, whatever its kind.
VANTAGE_API MissingPolicy missing_of(const SceneSource& source);
VANTAGE_API void set_missing(SceneSource& source, MissingPolicy policy);

/// The raster that is the ground of a map or a tileset; empty where there is none.
VANTAGE_API const std::filesystem::path& terrain_of(const SceneSource& source);

/// Told by the name: .osm, .pbf (also .osm.gz, .osm.bz2) are maps; .tif, .tiff, .hgt, .asc, .hgt.zip, .vrt and .img
/// are rasters; tileset.json and web addresses are tilesets; all else are meshes, but for JSON that begins as an answer
/// of Overpass does: a map. Case does not count. VRT and IMG are
/// no formats that scene_from_raster reads: they are told so that it says what to do.
VANTAGE_API SceneSource::Kind source_kind(const std::filesystem::path& file);

/// What missions looked up in a scene, kept for those to come: roofs and facades, outlines of the map, the ground.
/// Found when it is first needed; any number of threads may ask. A copy knows nothing yet.
class VANTAGE_API SceneLookups {
 public:
  SceneLookups();
  ~SceneLookups();
  SceneLookups(const SceneLookups&);
  SceneLookups& operator=(const SceneLookups&);

  struct Data;
  Data& data() const { return *data_; }  ///< for missions

 private:
  std::unique_ptr<Data> data_;
};

/// Not to be changed once a mission was resolved in it.
struct LoadedScene {
  Scene scene;
  std::optional<CityReport> city = {};        ///< of a map
  std::optional<RasterReport> raster = {};    ///< of a raster
  std::optional<TilesetReport> tileset = {};  ///< of a tileset
  SceneLookups lookups = {};
};

/// What is worth a sentence of the scene and its source.
VANTAGE_API std::vector<std::string> notes_of(const LoadedScene& loaded);

/// Throws as the function of its kind does; and Error(input), ErrorCode::scene_incomplete, for a ledger that is not
/// empty where the source says MissingPolicy::refuse.
VANTAGE_API LoadedScene load_scene(const SceneSource& source, const Progress& progress = {});

}  // namespace vantage
