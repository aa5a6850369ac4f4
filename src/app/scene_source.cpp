#include "vantage/scene_source.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <fstream>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include "app/providers/maps.h"
#include "app/scene_lookups.h"
#include "app/scene_warnings.h"
#include "io/object_text.h"

namespace vantage {
namespace {

bool ends_with_any(const std::string& name, std::initializer_list<std::string_view> endings) {
  return std::any_of(endings.begin(), endings.end(), [&](std::string_view ending) { return name.ends_with(ending); });
}

/// Whether a JSON file begins as an answer of Overpass does, whose objects are "elements".
bool is_json_of_map(const std::filesystem::path& file) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) return false;  // a pipe would wait for ever
  std::string begin(4096, '\0');
  std::ifstream stream(file, std::ios::binary);
  stream.read(begin.data(), static_cast<std::streamsize>(begin.size()));
  begin.resize(static_cast<std::size_t>(stream.gcount()));
  return begin.find("\"elements\"") != std::string::npos && begin.find("\"CityJSON\"") == std::string::npos;
}

/// As its kind is loaded.
LoadedScene loaded_scene(const SceneSource& source, const Progress& progress) {
  LoadedScene loaded;
  switch (source.kind) {
    case SceneSource::Kind::map: {
      const auto& maps = internal::app::map_provider("maps", source.file.string());
      City city = maps.build_city(source.file, source.city, progress);
      loaded.scene = std::move(city.scene);
      loaded.city = std::move(city.report);
      break;
    }
    case SceneSource::Kind::raster: {
      const auto& maps = internal::app::map_provider("rasters", source.file.string());
      RasterScene raster = maps.scene_from_raster(source.file, source.raster, progress);
      loaded.scene = std::move(raster.scene);
      loaded.raster = raster.report;
      break;
    }
    case SceneSource::Kind::tileset: {
      TilesetScene tiles = read_tileset(source.file, source.tileset, progress);
      loaded.scene = std::move(tiles.scene);
      loaded.tileset = std::move(tiles.report);
      if (source.terrain.empty()) break;
      TerrainOptions options = source.terrain_options;
      options.missing = source.tileset.missing;
      internal::app::map_provider("rasters", source.terrain.string())
          .add_terrain(loaded.scene, source.terrain, options, progress);
      loaded.tileset->triangles = loaded.scene.mesh.triangles.size();
      loaded.tileset->objects = loaded.scene.objects.size();
      break;
    }
    case SceneSource::Kind::mesh:
      loaded.scene = read_scene(source.file, source.mesh, progress);
      break;
  }
  return loaded;
}

}  // namespace

SceneSource::Kind source_kind(const std::filesystem::path& file) {
  if (is_web_address(file)) return SceneSource::Kind::tileset;
  std::string name = file.filename().string();
  std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return std::tolower(c); });
  if (ends_with_any(name, {".osm", ".osm.gz", ".osm.bz2", ".pbf"})) return SceneSource::Kind::map;
  if (ends_with_any(name, {".tif", ".tiff", ".hgt", ".hgt.zip", ".asc", ".vrt", ".img"})) {
    return SceneSource::Kind::raster;
  }
  if (name == "tileset.json") return SceneSource::Kind::tileset;
  return name.ends_with(".json") && is_json_of_map(file) ? SceneSource::Kind::map : SceneSource::Kind::mesh;
}

MissingPolicy missing_of(const SceneSource& source) {
  switch (source.kind) {
    case SceneSource::Kind::map:
      return source.city.missing;
    case SceneSource::Kind::raster:
      return source.raster.missing;
    case SceneSource::Kind::tileset:
      return source.tileset.missing;
    case SceneSource::Kind::mesh:
      break;
  }
  return source.mesh.missing;
}

void set_missing(SceneSource& source, MissingPolicy policy) {
  source.mesh.missing = source.city.missing = source.raster.missing = source.tileset.missing = policy;
}

const std::filesystem::path& terrain_of(const SceneSource& source) {
  return source.kind == SceneSource::Kind::tileset ? source.terrain : source.city.terrain;
}

SceneLookups::SceneLookups() : data_(std::make_unique<Data>()) {}
SceneLookups::~SceneLookups() = default;
// What was looked up refers to the scene of the other one.
SceneLookups::SceneLookups(const SceneLookups&) : SceneLookups() {}
SceneLookups& SceneLookups::operator=(const SceneLookups&) {
  data_ = std::make_unique<Data>();
  return *this;
}

std::vector<std::string> notes_of(const LoadedScene& loaded) {
  std::vector<std::string> notes = loaded.scene.notes;
  if (loaded.city) notes.insert(notes.end(), loaded.city->notes.begin(), loaded.city->notes.end());
  if (const auto side = internal::app::on_its_side(loaded)) notes.push_back(side->text);
  return notes;
}

LoadedScene load_scene(const SceneSource& source, const Progress& progress) {
  LoadedScene loaded = loaded_scene(source, progress);
  if (missing_of(source) == MissingPolicy::refuse) {
    internal::io::refuse_incomplete(loaded.scene.ledger, source.file.string());
  }
  if (source.attribution.empty()) return loaded;
  loaded.scene.attribution = source.attribution;
  if (auto& place = loaded.scene.georeference) place->attribution = attribution_of(loaded.scene);  // for files
  return loaded;
}

}  // namespace vantage
