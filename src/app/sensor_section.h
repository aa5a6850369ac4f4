// The section 'sensor' of a mission file.
#pragma once

#include <optional>
#include <string>

#include "app/value_reader.h"
#include "app/yaml_tree.h"
#include "vantage/mission.h"

namespace vantage::internal::app {

struct SensorSection {
  Sensor sensor;  ///< with a sun_time, without the direction to the sun
  std::optional<CameraSource> camera;
  std::optional<SunTime> sun_time;
  std::optional<PilotSight> vlos;
};

/// Throws Error(input) with the place for what docs/mission-file.md does not allow.
SensorSection parse_sensor_section(const YamlNode& node, const ValueReader& reader);

/// The section's text, which reads back as the same; "sensor:" and lines below it.
std::string sensor_section_text(const MissionFile& mission);

/// The moment that an ISO 8601 text with a zone names; nothing for any other text.
std::optional<SunTime> parse_time(const std::string& text);

}  // namespace vantage::internal::app
