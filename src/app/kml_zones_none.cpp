// For builds without Expat.
#include "app/kml_zones.h"

namespace vantage::internal::app {

ZoneList parse_kml_zones(std::string_view, const std::filesystem::path& file, const core::ProgressReporter&) {
  throw Error(ErrorCode::component_missing, "this build of vantage reads no KML files", file.string(),
              "give GeoJSON, or build vantage with VANTAGE_COMPONENTS=vantage");
}

}  // namespace vantage::internal::app
