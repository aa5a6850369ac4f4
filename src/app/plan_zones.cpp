// Fences of ground stations: https://docs.qgroundcontrol.com/master/en/qgc-dev-guide/file_formats/plan.html,
// "GeoFence", and https://mavlink.io/en/file_formats/. Latitudes come first.
#include <algorithm>
#include <iterator>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "app/json_zones.h"
#include "common/input.h"
#include "io/mesh_builder.h"

namespace vantage::internal::app {
namespace {

using nlohmann::json;

class PlanReader {
 public:
  explicit PlanReader(const std::filesystem::path& file) : file_(file) { result_.has_no_heights = true; }

  ZoneList read(const json& fence) {
    if (!fence.is_object()) fail("geoFence", "\"geoFence\" is not an object");
    if (fence.contains("polygon")) {
      fail("geoFence", "the plan is of an old version of QGroundControl",
           "save it anew with QGroundControl 3.3 or later", ErrorCode::value_unsupported);
    }
    read_list(fence, "polygons", "polygon", [this](const json& entry, ListedZone& zone) { polygon(entry, zone); });
    read_list(fence, "circles", "circle", [this](const json& entry, ListedZone& zone) { circle(entry, zone); });
    for (const auto& [key, value] : fence.items()) {
      constexpr std::string_view kKnown[] = {"polygons", "circles", "breachReturn", "version"};
      if (value.is_null() || std::find(std::begin(kKnown), std::end(kKnown), key) != std::end(kKnown)) continue;
      leave_unknown(io::clean_name(key));
    }
    return std::move(result_);
  }

 private:
  /// It may be a list of fences.
  void leave_unknown(const std::string& key) {
    ListedZone zone;
    zone.name = key;
    zone.names = {key};
    zone.place = "geoFence." + key;
    zone.feature = static_cast<std::size_t>(-1);  // of none
    const Error fault(ErrorCode::zone_file_syntax, "a fence has no such member", file_.string() + ", " + zone.place,
                      "write \"polygons\" or \"circles\"");
    leave_unread(std::move(zone), fault, result_);
  }

  template <typename Read>
  void read_list(const json& fence, const char* key, const char* one, const Read& read) {
    const auto list = fence.find(key);
    if (list == fence.end()) return;
    if (!list->is_array()) fail(std::string("geoFence.") + key, "it is not an array");
    for (std::size_t i = 0; i < list->size(); ++i) {
      ListedZone zone;
      zone.name = std::string(one) + " " + std::to_string(i);
      zone.feature = result_.zones.size();
      zone.names = {zone.name};
      zone.place = std::string("geoFence.") + key + "[" + std::to_string(i) + "]";
      try {
        const json& entry = (*list)[i];
        if (!entry.is_object()) fail(zone.place, "the fence is not an object");
        const auto inclusion = entry.find("inclusion");
        if (inclusion == entry.end() || !inclusion->is_boolean()) {
          fail(zone.place, "\"inclusion\" is not true or false");
        }
        zone.is_inclusion = inclusion->get<bool>();
        read(entry, zone);
        if (zone.outer.empty() && !zone.circle) {
          ++result_.left_out[kEmptyArea];
        } else {
          result_.zones.push_back(std::move(zone));
        }
      } catch (const Error& error) {
        leave_unread(std::move(zone), error, result_);
      }
    }
  }

  void polygon(const json& entry, ListedZone& zone) const {
    const auto positions = entry.find("polygon");
    if (positions == entry.end() || !positions->is_array())
      fail(zone.place, "\"polygon\" is not an array of positions");
    Zone::Ring ring;
    for (const json& numbers : *positions) {
      const Eigen::Vector2d p = position(numbers, zone.place);
      if (ring.empty() || ring.back() != p) ring.push_back(p);
    }
    while (ring.size() > 1 && ring.front() == ring.back()) ring.pop_back();
    zone.outer = std::move(ring);
  }

  void circle(const json& entry, ListedZone& zone) const {
    const auto circle = entry.find("circle");
    if (circle == entry.end() || !circle->is_object() || !circle->contains("center") || !circle->contains("radius")) {
      fail(zone.place, "\"circle\" has no \"center\" and \"radius\"");
    }
    const double radius = number((*circle)["radius"], zone.place);
    if (!(radius > 0)) fail(zone.place, "the radius is not above 0", "correct it", ErrorCode::value_out_of_range);
    zone.circle = ListedCircle{position((*circle)["center"], zone.place), radius, radius};
  }

  Eigen::Vector2d position(const json& numbers, const std::string& place) const {
    if (!numbers.is_array() || numbers.size() < 2) fail(place, "a position is not an array of two numbers");
    return checked_position(number(numbers[1], place), number(numbers[0], place), file_, place);
  }

  double number(const json& value, const std::string& place) const {
    const std::optional<double> number = number_in(value);
    if (!number) fail(place, "a value is not a number");
    return *number;
  }

  [[noreturn]] void fail(const std::string& place, const std::string& problem, const std::string& fix = "correct it",
                         ErrorCode code = ErrorCode::zone_file_syntax) const {
    fail_in_zones(code, file_, place, problem, fix);
  }

  const std::filesystem::path& file_;
  ZoneList result_;
};

/// Rows of 12 fields: number, current, frame, command, four parameters, latitude, longitude, height, autocontinue.
class WaypointReader {
 public:
  WaypointReader(const std::filesystem::path& file, const core::ProgressReporter& progress)
      : file_(file), progress_(progress) {
    result_.has_no_heights = true;
  }

  ZoneList read(std::string_view text);

 private:
  // https://mavlink.io/en/messages/common.html, MAV_CMD
  enum Command { return_point = 5000, corner_in = 5001, corner_out = 5002, circle_in = 5003, circle_out = 5004 };
  static constexpr int kLastFence = 5099;  // rally points begin behind it
  struct Row {
    std::size_t line = 0;
    int command = 0;
    double parameter = 0;  ///< how many corners the polygon has, or the radius
    double longitude = 0, latitude = 0;
  };

  void read_row(std::string_view line, std::size_t number);
  void add_corner(const Row& row);
  void add_circle(const Row& row);
  void end_polygon();
  ListedZone fence(const char* kind, std::size_t number, const Row& row) const;
  [[noreturn]] void fail(const Row& row, const std::string& problem, const std::string& fix = "correct it") const {
    fail_in_zones(ErrorCode::zone_file_syntax, file_, "line " + std::to_string(row.line), problem, fix);
  }

  const std::filesystem::path& file_;
  const core::ProgressReporter& progress_;
  std::vector<Row> corners_;  // of the polygon that is open
  std::size_t polygons_ = 0, circles_ = 0;
  ZoneList result_;
};

std::vector<std::string_view> fields_of(std::string_view line) {
  constexpr std::string_view kBlanks = " \t\r";
  std::vector<std::string_view> fields;
  for (std::size_t at = line.find_first_not_of(kBlanks); at != std::string_view::npos;) {
    const std::size_t end = std::min(line.find_first_of(kBlanks, at), line.size());
    fields.push_back(line.substr(at, end - at));
    at = line.find_first_not_of(kBlanks, end);
  }
  return fields;
}

ZoneList WaypointReader::read(std::string_view text) {
  std::size_t number = 0;
  while (!text.empty()) {
    progress_.tick();
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    if (++number == 1) continue;
    try {
      read_row(line, number);
    } catch (const Error& error) {
      ListedZone zone;
      zone.name = zone.place = "line " + std::to_string(number);
      zone.feature = result_.zones.size();
      leave_unread(std::move(zone), error, result_);
      corners_.clear();
    }
  }
  end_polygon();
  return std::move(result_);
}

void WaypointReader::read_row(std::string_view line, std::size_t number) {
  constexpr std::size_t kFewest = 11;
  const std::vector<std::string_view> fields = fields_of(line);
  if (fields.empty()) return;
  Row row;
  row.line = number;
  const auto value = [&](std::size_t field) {
    const ParsedNumber parsed = parse_number(fields[field]);
    if (parsed.fault != NumberFault::none) fail(row, "not a number: " + in_quotes(fields[field]));
    return parsed.value;
  };
  if (fields.size() < kFewest) fail(row, "the row has " + std::to_string(fields.size()) + " fields, and not 12");
  row.command = static_cast<int>(std::clamp(value(3), 0.0, 1e6));
  row.parameter = value(4);
  row.latitude = value(8);
  row.longitude = value(9);
  const bool is_corner = row.command == corner_in || row.command == corner_out;
  if (!corners_.empty() && (!is_corner || row.command != corners_.front().command)) end_polygon();
  if (is_corner) return add_corner(row);
  if (row.command == circle_in || row.command == circle_out) return add_circle(row);
  if (row.command > circle_out && row.command <= kLastFence) {
    fail(row, "the command " + std::to_string(row.command) + " is none of a fence that is known");
  }
  const bool is_home = value(0) == 0 && row.command < return_point;
  if (!is_home) ++result_.left_out[row.command == return_point ? "return point" : "waypoint"];
}

ListedZone WaypointReader::fence(const char* kind, std::size_t number, const Row& row) const {
  ListedZone zone;
  zone.name = std::string(kind) + " " + std::to_string(number);
  zone.names = {zone.name};
  zone.place = "line " + std::to_string(row.line);
  zone.feature = result_.zones.size();
  zone.is_inclusion = row.command == corner_in || row.command == circle_in;
  return zone;
}

void WaypointReader::add_corner(const Row& row) {
  corners_.push_back(row);
  if (static_cast<double>(corners_.size()) >= corners_.front().parameter) end_polygon();
}

void WaypointReader::end_polygon() {
  const std::vector<Row> corners = std::exchange(corners_, {});
  if (corners.empty()) return;
  ListedZone zone = fence("polygon", polygons_++, corners.front());
  try {
    const auto count = static_cast<double>(corners.size());
    for (const Row& row : corners) {
      if (row.parameter != count || count < 3) {
        fail(row,
             "the polygon has " + std::to_string(corners.size()) + " corners, and the row says " +
                 shortest(row.parameter),
             "give each of its corners, 3 or more, their number");
      }
      const Eigen::Vector2d p = checked_position(row.longitude, row.latitude, file_, zone.place);
      if (zone.outer.empty() || zone.outer.back() != p) zone.outer.push_back(p);
    }
    while (zone.outer.size() > 1 && zone.outer.front() == zone.outer.back()) zone.outer.pop_back();
    result_.zones.push_back(std::move(zone));
  } catch (const Error& error) {
    leave_unread(std::move(zone), error, result_);
  }
}

void WaypointReader::add_circle(const Row& row) {
  ListedZone zone = fence("circle", circles_++, row);
  try {
    if (!(row.parameter > 0)) fail(row, "the radius is not above 0");
    const Eigen::Vector2d centre = checked_position(row.longitude, row.latitude, file_, zone.place);
    zone.circle = ListedCircle{centre, row.parameter, row.parameter};
    result_.zones.push_back(std::move(zone));
  } catch (const Error& error) {
    leave_unread(std::move(zone), error, result_);
  }
}

}  // namespace

ZoneList waypoint_zones(std::string_view text, const std::filesystem::path& file,
                        const core::ProgressReporter& progress) {
  return WaypointReader(file, progress).read(text);
}

ZoneList plan_zones(const json& root, const std::filesystem::path& file) {
  return PlanReader(file).read(root["geoFence"]);
}

}  // namespace vantage::internal::app
