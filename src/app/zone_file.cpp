#include "app/zone_file.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "app/json_zones.h"
#include "app/kml_zones.h"
#include "common/input.h"
#include "io/json_text.h"
#include "io/mesh_builder.h"
#include "io/zip.h"

namespace vantage::internal::app {
namespace {

constexpr const char* kZoneFileAdvice =
    "give GeoJSON, ED-269, ED-318, KML, KMZ, a .plan of QGroundControl, or .waypoints with a fence";

std::string_view without_mark(std::string_view text) {
  constexpr std::string_view kMark = "\xEF\xBB\xBF";
  return text.substr(text.substr(0, kMark.size()) == kMark ? kMark.size() : 0);
}

nlohmann::json json_of_zones(std::string_view text, const std::filesystem::path& file,
                             const core::ProgressReporter& progress) {
  core::ReadLimits limits;
  try {
    return io::parse_json(text, progress, limits);
  } catch (const io::JsonProblem& problem) {
    std::string place;
    if (problem.line > 0) {
      place = "line " + std::to_string(problem.line) + ", column " + std::to_string(problem.column);
    }
    fail_in_zones(ErrorCode::zone_file_syntax, file, place, "not a file of zones: " + problem.text, kZoneFileAdvice);
  }
}

/// Of a KMZ file: "doc.kml", or else the first one. The others are unread.
ZoneList archive_zones(std::string_view text, const std::filesystem::path& file,
                       const core::ProgressReporter& progress) {
  constexpr const char* kFirst = "doc.kml";
  std::string kml;
  std::vector<std::string> others, archives;
  try {
    kml = io::unzipped(text, kFirst, ".kml", kMostZoneBytes);
    others = io::names_in_zip(text, ".kml");
    archives = io::names_in_zip(text, ".kmz");
  } catch (const io::ZipProblem& problem) {
    const bool is_too_large = problem.kind == io::ZipProblem::Kind::too_large;
    fail_in_zones(is_too_large ? ErrorCode::file_too_large : ErrorCode::zone_file_syntax, file, "",
                  "the file is a zip archive, as KMZ is, and " + problem.text,
                  "give a KMZ file, or the .kml that is in it");
  }
  if (io::is_zip(kml)) {
    fail_in_zones(ErrorCode::zone_file_syntax, file, "", "the file is a zip archive in a zip archive", "unpack it");
  }
  ZoneList list = parse_zones(kml, file, progress);
  const auto first = std::find(others.begin(), others.end(), kFirst);
  others.erase(first == others.end() ? others.begin() : first);
  others.insert(others.end(), archives.begin(), archives.end());
  for (const std::string& other : others) {
    ListedZone zone;
    zone.name = zone.place = io::clean_name(other);
    zone.feature = static_cast<std::size_t>(-1);  // of none
    const Error fault(ErrorCode::value_unsupported, "the archive holds several KML files, and one is read",
                      file.string() + ", " + zone.place, "unpack it, and name each file in the mission");
    leave_unread(std::move(zone), fault, list);
  }
  return list;
}

}  // namespace

ZoneList parse_zones(std::string_view text, const std::filesystem::path& file, const core::ProgressReporter& progress) {
  text = without_mark(text);
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  const char begin = first == std::string_view::npos ? '\0' : text[first];
  const bool is_utf16 = text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF");
  if (begin == '<' || is_utf16) return parse_kml_zones(text, file, progress);
  if (io::is_zip(text)) return archive_zones(text, file, progress);
  if (text.starts_with("QGC WPL")) return waypoint_zones(text, file, progress);
  if (begin != '{' && begin != '[') {
    fail_in_zones(ErrorCode::zone_file_syntax, file, "",
                  "not a file of zones: it is neither JSON nor XML, and no list of waypoints", kZoneFileAdvice);
  }
  const nlohmann::json root = json_of_zones(text, file, progress);
  if (!root.contains("geoFence")) return geojson_zones(root, file, progress);
  if (root.contains("type") || !lists_of_features(root).empty()) {
    fail_in_zones(ErrorCode::zone_file_syntax, file, "", "the file is a plan with a fence and GeoJSON in one",
                  "make two files of it");
  }
  return plan_zones(root, file);
}

void leave_unread(ListedZone zone, const Error& fault, ZoneList& list) {
  if (fault.kind() != ErrorKind::input || list.unread.size() >= Navigation::kMostZones) throw fault;
  list.unread.push_back({std::move(zone), fault});
}

void leave_closed_line(ListedZone zone, const std::filesystem::path& file, ZoneList& list) {
  zone.is_inclusion = false;
  zone.feature = static_cast<std::size_t>(-1);  // of none
  const Error fault(ErrorCode::value_unsupported, "the line is closed, and may be meant as an area",
                    file.string() + ", " + zone.place, "write it as a polygon");
  leave_unread(std::move(zone), fault, list);
}

void fail_in_zones(ErrorCode code, const std::filesystem::path& file, const std::string& place,
                   const std::string& problem, const std::string& fix) {
  throw Error(code, problem, place.empty() ? file.string() : file.string() + ", " + place, fix);
}

Eigen::Vector2d checked_position(double longitude_deg, double latitude_deg, const std::filesystem::path& file,
                                 const std::string& place) {
  // Written so that not-a-number is refused too. A longitude may go on beyond the antimeridian.
  if (std::abs(latitude_deg) <= 90 && std::abs(longitude_deg) <= 540) return {longitude_deg, latitude_deg};
  fail_in_zones(
      ErrorCode::not_on_earth, file, place,
      "longitude " + shortest(longitude_deg) + ", latitude " + shortest(latitude_deg) + " is not a place on the earth",
      "give WGS 84 positions in degrees, in the order of the format");
}

ListedRing opened_ring(const ListedRing& closed, const std::filesystem::path& file, const std::string& place) {
  const Zone::Ring& corners = closed.corners;
  if (corners.size() < 4 || corners.front() != corners.back()) {
    fail_in_zones(ErrorCode::zone_file_syntax, file, place,
                  corners.size() < 4 ? "the ring has " + std::to_string(corners.size()) + " positions, 4 are the least"
                                     : "the ring is not closed",
                  "end each ring with its first position");
  }
  ListedRing ring;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    if (!ring.corners.empty() && ring.corners.back() == corners[i]) continue;
    ring.corners.push_back(corners[i]);
    ring.z_m.push_back(closed.z_m[i]);
  }
  if (ring.corners.size() > 1) {
    ring.corners.pop_back();
    ring.z_m.pop_back();
  }
  return ring;
}

void add_ring(ListedRing ring, bool is_outer, ListedZone& zone) {
  // Holes may stand before the outer ring, whose heights come first.
  const auto at = is_outer ? zone.corner_z_m.begin() : zone.corner_z_m.end();
  zone.corner_z_m.insert(at, ring.z_m.begin(), ring.z_m.end());
  if (is_outer) {
    zone.outer = std::move(ring.corners);
  } else {
    zone.holes.push_back(std::move(ring.corners));
  }
}

}  // namespace vantage::internal::app
