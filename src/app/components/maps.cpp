#include "app/components/maps.h"

#include <utility>

namespace vantage::internal::app {

LoadedScene load_map(const SceneSource& source, const Progress& progress) {
  LoadedScene loaded;
  City city = build_city(source.file, source.city, progress);
  loaded.scene = std::move(city.scene);
  loaded.city = std::move(city.report);
  return loaded;
}

LoadedScene load_raster(const SceneSource& source, const Progress& progress) {
  LoadedScene loaded;
  RasterScene raster = scene_from_raster(source.file, source.raster, progress);
  loaded.scene = std::move(raster.scene);
  loaded.raster = raster.report;
  return loaded;
}

}  // namespace vantage::internal::app
