// Zones of JSON files that are parsed.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "app/zone_file.h"

namespace vantage::internal::app {

/// GeoJSON (RFC 7946): areas in features, collections and geometries. ED-318 adds `layer`, the heights of a geometry,
/// and `extent`, which makes a circle of a point; docks of DJI do that with properties of the feature, say with
/// `geofence_type` what it is for, and with `enable` whether it counts. In ED-269 the geometry of a feature is a list
/// of volumes, or one, each with heights and a `horizontalProjection`; the list of features has different names.
ZoneList geojson_zones(const nlohmann::json& root, const std::filesystem::path& file,
                       const core::ProgressReporter& progress);

/// The geofence of a plan of QGroundControl: polygons and circles, without heights.
ZoneList plan_zones(const nlohmann::json& root, const std::filesystem::path& file);

/// The same of ArduPilot, in a list of waypoints ("QGC WPL"), as Mission Planner saves it.
ZoneList waypoint_zones(std::string_view text, const std::filesystem::path& file,
                        const core::ProgressReporter& progress);

/// The members of a GeoJSON that are lists of features. InterUSS calls its one "UASZoneList".
std::vector<std::string> lists_of_features(const nlohmann::json& root);

/// A number, also one that is written as text; nothing for another value, or one that is not finite.
std::optional<double> number_in(const nlohmann::json& value);

}  // namespace vantage::internal::app
