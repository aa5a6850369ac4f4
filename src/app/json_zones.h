// Zones of JSON files that are parsed.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>

#include "app/zone_file.h"

namespace vantage::internal::app {

/// GeoJSON (RFC 7946): areas in features, collections and geometries. ED-318 adds `layer`, the heights of a geometry,
/// and `extent`, which makes a circle of a point. In ED-269 the geometry of a feature is a list of volumes, each with
/// heights and a `horizontalProjection`.
ZoneList geojson_zones(const nlohmann::json& root, const std::filesystem::path& file);

/// The geofence of a plan of QGroundControl: polygons and circles, without heights.
ZoneList plan_zones(const nlohmann::json& root, const std::filesystem::path& file);

}  // namespace vantage::internal::app
