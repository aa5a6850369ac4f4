#include "app/components/maps.h"
#include "app/components/missing.h"

namespace vantage::internal::app {

LoadedScene load_map(const SceneSource& source, const Progress&) {
  throw_missing("maps", "maps", source.file.string());
}

LoadedScene load_raster(const SceneSource& source, const Progress&) {
  throw_missing("maps", "rasters", source.file.string());
}

void put_on_ground(Mission& mission, const geo::LocalFrame*, const Progress&) {
  throw_missing("maps", "targets on the ground", mission.as_written.places.target);
}

ZoneList parse_kml_zones(std::string_view, const std::filesystem::path& file, const core::ProgressReporter&) {
  throw_missing("maps", "KML files", file.string());
}

}  // namespace vantage::internal::app
