// Plans of ground stations, written by hand.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "common/input.h"
#include "vantage/flight.h"

namespace vantage::testing::plan_texts {

/// A SimpleItem of QGroundControl. Parameters as JSON: "[0, 0, 0, null, 48, 11, 50]".
inline std::string simple(int command, int frame, const std::string& parameters, int id = 0,
                          const std::string& more = "") {
  return "{\"type\": \"SimpleItem\", \"autoContinue\": true, \"command\": " + std::to_string(command) +
         ", \"frame\": " + std::to_string(frame) + ", \"doJumpId\": " + std::to_string(id) + more +
         ", \"params\": " + parameters + "}";
}

inline std::string waypoint(double latitude, double longitude, double height, int frame = 3, int id = 0) {
  return simple(16, frame,
                "[0, 0, 0, null, " + shortest(latitude) + ", " + shortest(longitude) + ", " + shortest(height) + "]",
                id);
}

inline std::string joined(const std::vector<std::string>& texts, const std::string& between) {
  std::string all;
  for (const std::string& text : texts) all += (all.empty() ? "" : between) + text;
  return all;
}

/// vehicle: MAV_TYPE, 2 for a multirotor and 1 for a fixed wing.
inline std::string plan(const std::vector<std::string>& items, int vehicle = 2,
                        const std::string& home = "[48, 11, 500]") {
  return "{\"fileType\": \"Plan\", \"version\": 1, \"groundStation\": \"QGroundControl\", \"mission\": {\"version\": "
         "2, "
         "\"firmwareType\": 12, \"vehicleType\": " +
         std::to_string(vehicle) + ", \"cruiseSpeed\": 15, \"hoverSpeed\": 5, \"plannedHomePosition\": " + home +
         ", \"items\": [" + joined(items, ",\n") + "]}}";
}

/// A placemark with a line, and a document of placemarks.
inline std::string kml_line(const std::string& coordinates, const std::string& mode = "absolute",
                            const std::string& name = "flight") {
  return "<Placemark><name>" + name + "</name><LineString><altitudeMode>" + mode + "</altitudeMode><coordinates>" +
         coordinates + "</coordinates></LineString></Placemark>";
}
inline std::string kml(const std::string& placemarks) {
  return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<kml xmlns=\"http://www.opengis.net/kml/2.2\" "
         "xmlns:gx=\"http://www.google.com/kml/ext/2.2\"><Document>\n" +
         placemarks + "\n</Document></kml>\n";
}

/// A waypoint of DJI's waylines, with more elements in it.
inline std::string wayline_point(double longitude, double latitude, double height, const std::string& more = "") {
  return "<Placemark><Point><coordinates>" + shortest(longitude) + "," + shortest(latitude) +
         "</coordinates></Point><wpml:executeHeight>" + shortest(height) + "</wpml:executeHeight>" + more +
         "</Placemark>\n";
}

/// A plan of DJI; it stays at the end, if `config` says nothing else.
inline std::string waylines(const std::string& folders, const std::string& config = "") {
  const bool ends = config.find("finishAction") != std::string::npos;
  return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<kml xmlns=\"http://www.opengis.net/kml/2.2\" "
         "xmlns:wpml=\"http://www.dji.com/wpmz/1.0.2\"><Document><wpml:missionConfig>" +
         config + (ends ? "" : "<wpml:finishAction>noAction</wpml:finishAction>") + "</wpml:missionConfig>\n" +
         folders + "</Document></kml>\n";
}
inline std::string wayline(const std::string& points, const std::string& mode = "relativeToStartPoint",
                           int number = 0) {
  return "<Folder><wpml:executeHeightMode>" + mode + "</wpml:executeHeightMode><wpml:waylineId>" +
         std::to_string(number) + "</wpml:waylineId><wpml:autoFlightSpeed>8</wpml:autoFlightSpeed>" + points +
         "</Folder>\n";
}

inline std::string gpx(const std::string& content) {
  return "<?xml version=\"1.0\"?>\n<gpx version=\"1.1\" creator=\"t\" xmlns=\"http://www.topografix.com/GPX/1/1\">\n" +
         content + "</gpx>\n";
}

/// A text of UTF-8 in UTF-16.
inline std::string in_utf16(const std::string& utf8, bool is_big, bool has_mark) {
  std::string bytes;
  const auto add = [&](unsigned unit) {
    const char high = static_cast<char>(unit >> 8), low = static_cast<char>(unit & 0xFF);
    bytes += is_big ? high : low;
    bytes += is_big ? low : high;
  };
  if (has_mark) add(0xFEFF);
  for (std::size_t i = 0; i < utf8.size();) {
    const auto first = static_cast<unsigned char>(utf8[i]);
    const std::size_t length = first < 0x80 ? 1 : first < 0xE0 ? 2 : first < 0xF0 ? 3 : 4;
    unsigned code = length == 1 ? first : first & (0x7Fu >> length);
    for (std::size_t k = 1; k < length; ++k) code = code << 6 | (static_cast<unsigned char>(utf8[i + k]) & 0x3Fu);
    i += length;
    if (code < 0x10000) {
      add(code);
    } else {
      add(0xD800 + ((code - 0x10000) >> 10));
      add(0xDC00 + ((code - 0x10000) & 0x3FF));
    }
  }
  return bytes;
}

/// What is read of such a text.
inline FlightPlan parsed_plan(const std::string& text, const std::string& track = "") {
  ReadPlanOptions options;
  options.track = track;
  return parse_flight_plan(text, "/data/flight.plan", options);
}

inline bool has_note(const std::vector<Warning>& notes, WarningCode code) {
  return std::any_of(notes.begin(), notes.end(), [&](const Warning& note) { return note.code == code; });
}

}  // namespace vantage::testing::plan_texts
