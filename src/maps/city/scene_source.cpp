#include "vantage/scene_source.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <string>
#include <string_view>

namespace vantage {
namespace {

bool ends_with_any(const std::string& name, std::initializer_list<std::string_view> endings) {
  return std::any_of(endings.begin(), endings.end(), [&](std::string_view ending) { return name.ends_with(ending); });
}

}  // namespace

SceneSource::Kind source_kind(const std::filesystem::path& file) {
  std::string name = file.filename().string();
  std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return std::tolower(c); });
  if (ends_with_any(name, {".osm", ".osm.gz", ".osm.bz2", ".pbf"})) return SceneSource::Kind::map;
  if (ends_with_any(name, {".tif", ".tiff", ".hgt", ".hgt.zip", ".asc", ".vrt", ".img"})) {
    return SceneSource::Kind::raster;
  }
  return SceneSource::Kind::mesh;
}

std::vector<std::string> notes_of(const LoadedScene& loaded) {
  std::vector<std::string> notes = loaded.scene.notes;
  if (loaded.city) notes.insert(notes.end(), loaded.city->notes.begin(), loaded.city->notes.end());
  return notes;
}

LoadedScene load_scene(const SceneSource& source, const Progress& progress) {
  LoadedScene loaded;
  switch (source.kind) {
    case SceneSource::Kind::mesh:
      loaded.scene = read_scene(source.file, source.mesh, progress);
      break;
    case SceneSource::Kind::map: {
      City city = build_city(source.file, source.city, progress);
      loaded.scene = std::move(city.scene);
      loaded.city = std::move(city.report);
      break;
    }
    case SceneSource::Kind::raster: {
      RasterScene raster = scene_from_raster(source.file, source.raster, progress);
      loaded.scene = std::move(raster.scene);
      loaded.raster = raster.report;
      break;
    }
  }
  return loaded;
}

}  // namespace vantage
