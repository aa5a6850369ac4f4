// What missions need of the component `maps`: maps.cpp, or without_maps.cpp in builds without it.
#pragma once

#include <filesystem>
#include <string_view>

#include "app/zone_file.h"
#include "geo/local_frame.h"
#include "vantage/mission.h"

namespace vantage::internal::app {

/// A scene of a map or a raster. Throws what build_city and scene_from_raster throw.
LoadedScene load_map(const SceneSource& source, const Progress& progress);
LoadedScene load_raster(const SceneSource& source, const Progress& progress);

/// Lays the target that `mission.as_written.ground_target` describes on the ground of the scene, in `frame`:
/// that of the scene, which only outlines can do without.
void put_on_ground(Mission& mission, const geo::LocalFrame* frame, const Progress& progress);

/// parse_zones of a text in XML. `file` is for messages.
ZoneList parse_kml_zones(std::string_view text, const std::filesystem::path& file,
                         const core::ProgressReporter& progress);

}  // namespace vantage::internal::app
