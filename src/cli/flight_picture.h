// Pictures of flights: in the scene, and below it the profile with what is seen.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "vantage/flight.h"
#include "vantage/flight_check.h"
#include "vantage/geometry.h"
#include "vantage/mission.h"
#include "vantage/progress.h"

namespace vantage::cli {

struct FlightPicture {
  const Mission* mission = nullptr;
  const Flight* flight = nullptr;
  const FlightCheck* check = nullptr;     ///< of the flight: where which target is seen
  std::vector<const Mesh*> volumes = {};  ///< from where targets are seen, drawn together
  std::string title, subtitle;
};

/// Draws and writes a PNG.
void write_flight_picture(const FlightPicture& picture, const std::filesystem::path& file, const Progress& progress);

}  // namespace vantage::cli
