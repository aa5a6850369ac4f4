// KML 2.2 (OGC 07-147r2): the polygons of all placemarks. XML is read with Expat, as maps are.
#include <expat.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <exception>
#include <iterator>
#include <map>
#include <memory>
#include <new>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "app/kml_zones.h"
#include "common/input.h"
#include "io/mesh_builder.h"

namespace vantage::internal::app {
namespace {

/// A polygon of a placemark, with what its altitudes say.
struct DrawnPolygon {
  ListedZone zone;
  double low_m = INFINITY, high_m = -INFINITY;
  double offset_m = 0;  ///< altitudeOffset of Google, in all of its altitudes
  bool is_absolute = false, has_all_altitudes = true;
  std::optional<Error> fault;

  bool is_level() const { return has_all_altitudes && low_m == high_m; }
};

/// Whether its corners lie on one line in plan, as far as positions are exact: 0.1 mm.
bool is_upright(const Zone::Ring& ring) {
  constexpr double kExactDeg = 1e-9;
  if (ring.size() < 3) return true;
  const Eigen::Vector2d& first = ring.front();
  const auto nearer = [&](const auto& a, const auto& b) { return (a - first).norm() < (b - first).norm(); };
  const Eigen::Vector2d along = *std::max_element(ring.begin(), ring.end(), nearer) - first;
  return std::all_of(ring.begin(), ring.end(), [&](const Eigen::Vector2d& p) {
    const Eigen::Vector2d to = p - first;
    return std::abs(along.x() * to.y() - along.y() * to.x()) <= kExactDeg * along.norm();
  });
}

using Corner = std::pair<double, double>;
using CornerSet = std::set<Corner>;
using SideSet = std::set<std::pair<Corner, Corner>>;

/// The sides of its rings, in no direction.
SideSet sides_of(const ListedZone& zone) {
  SideSet sides;
  const auto add = [&](const Zone::Ring& ring) {
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Eigen::Vector2d &a = ring[i], &b = ring[(i + 1) % ring.size()];
      sides.insert(std::minmax(Corner(a.x(), a.y()), Corner(b.x(), b.y())));
    }
  };
  add(zone.outer);
  for (const Zone::Ring& hole : zone.holes) add(hole);
  return sides;
}

CornerSet corners_of(const SideSet& sides) {
  CornerSet corners;
  for (const auto& [a, b] : sides) corners.insert({a, b});
  return corners;
}

/// Between which heights faces lie, as far as they say it.
struct FaceHeights {
  double low_m = INFINITY, high_m = -INFINITY;
  bool are_known = true, reach_ground = false;

  void add(const FaceHeights& more) {
    low_m = std::min(low_m, more.low_m);
    high_m = std::max(high_m, more.high_m);
    are_known = are_known && more.are_known;
    reach_ground = reach_ground || more.reach_ground;
  }
};

FaceHeights heights_of(const DrawnPolygon& face) {
  return {face.low_m, face.high_m, face.is_absolute && face.has_all_altitudes, face.zone.has_heights};
}

/// One zone of a floor, a ceiling and walls, which say how high it is if floor and ceiling are level.
ListedZone joined_solid(const std::vector<DrawnPolygon>& levels, FaceHeights heights) {
  for (const DrawnPolygon& level : levels) heights.add(heights_of(level));
  const auto is_end = [&](const DrawnPolygon& level) {
    return level.is_level() && (level.low_m == heights.low_m || level.low_m == heights.high_m);
  };
  const bool are_known = heights.are_known && std::all_of(levels.begin(), levels.end(), is_end);
  ListedZone zone = levels.front().zone;
  zone.is_solid = true;
  zone.has_heights = are_known && heights.low_m < heights.high_m;
  zone.lower = zone.upper = std::nullopt;
  if (!zone.has_heights) {
    zone.unused_heights = ": its floor and its ceiling are not level above the sea";
    return zone;
  }
  if (!heights.reach_ground) zone.lower = ZoneHeight{heights.low_m, HeightReference::sea_level};
  zone.upper = ZoneHeight{heights.high_m, HeightReference::sea_level};
  return zone;
}

/// The zones of a placemark: walls go to the polygons above or below which all their corners lie. Those that are of no
/// solid stay as they are.
std::vector<ListedZone> joined_solids(std::vector<DrawnPolygon> drawn, const core::ProgressReporter& progress) {
  struct Solid {
    CornerSet corners;
    std::vector<DrawnPolygon> levels;
    std::optional<FaceHeights> walls;
  };
  struct Walls {
    FaceHeights heights;
    bool are_of_solid = false;
  };
  std::vector<Solid> solids;
  std::map<SideSet, std::size_t> solid_of;
  std::map<Corner, std::vector<std::size_t>> solids_at;
  const auto first_wall = std::stable_partition(drawn.begin(), drawn.end(),
                                                [](const DrawnPolygon& one) { return !is_upright(one.zone.outer); });
  for (auto level = drawn.begin(); level != first_wall; ++level) {
    progress.tick();
    const auto [found, is_new] = solid_of.try_emplace(sides_of(level->zone), solids.size());
    if (is_new) {
      solids.push_back({corners_of(found->first), {}, {}});
      for (const Corner& corner : solids.back().corners) solids_at[corner].push_back(found->second);
    }
    solids[found->second].levels.push_back(std::move(*level));
  }
  std::map<CornerSet, Walls> walls_on;  // by their corners in plan
  std::vector<const Walls*> walls_of;   // of each wall, those on the same corners
  for (auto wall = first_wall; wall != drawn.end(); ++wall) {
    progress.tick();
    Walls& walls = walls_on[corners_of(sides_of(wall->zone))];
    walls.heights.add(heights_of(*wall));
    walls_of.push_back(&walls);
  }
  for (auto& [feet, walls] : walls_on) {
    // Many solids may meet at one of the corners. At the one with the fewest, little is looked through in all.
    const auto has_fewer = [&](const Corner& a, const Corner& b) { return solids_at[a].size() < solids_at[b].size(); };
    for (const std::size_t index : solids_at[*std::min_element(feet.begin(), feet.end(), has_fewer)]) {
      progress.tick();
      Solid& solid = solids[index];
      const auto is_corner = [&](const Corner& foot) { return solid.corners.contains(foot); };
      if (!std::all_of(feet.begin(), feet.end(), is_corner)) continue;
      walls.are_of_solid = true;
      if (!solid.walls) solid.walls.emplace();
      solid.walls->add(walls.heights);
    }
  }
  std::vector<ListedZone> zones;
  for (auto wall = first_wall; wall != drawn.end(); ++wall) {
    if (!walls_of[static_cast<std::size_t>(wall - first_wall)]->are_of_solid) zones.push_back(std::move(wall->zone));
  }
  for (Solid& solid : solids) {
    if (solid.walls) zones.push_back(joined_solid(solid.levels, *solid.walls));
    if (!solid.walls) {
      for (DrawnPolygon& level : solid.levels) zones.push_back(std::move(level.zone));
    }
  }
  return zones;
}

template <std::size_t N>
bool is_any(std::string_view name, const std::string_view (&names)[N]) {
  return std::find(std::begin(names), std::end(names), name) != std::end(names);
}

constexpr std::string_view kOfPolygon[] = {"outerBoundaryIs", "innerBoundaryIs", "LinearRing",
                                           "coordinates",     "extrude",         "tessellate",
                                           "altitudeMode",    "altitudeOffset",  "drawOrder"};
/// Of those that have elements themselves: geometries, and what is known to be none.
constexpr std::string_view kOfPlacemark[] = {
    "MultiGeometry", "Point",  "LineString", "LinearRing", "Polygon",      "Model",          "Track",
    "MultiTrack",    "author", "link",       "Camera",     "LookAt",       "TimeSpan",       "TimeStamp",
    "Style",         "Region", "StyleMap",   "Metadata",   "ExtendedData", "AddressDetails", "description"};

class KmlReader {
 public:
  KmlReader(const std::filesystem::path& file, const core::ProgressReporter& progress)
      : file_(file), progress_(progress), parser_(XML_ParserCreate(nullptr)) {
    if (!parser_) throw std::bad_alloc();
    XML_SetUserData(parser_.get(), this);
    XML_SetElementHandler(parser_.get(), on_start, on_end);
    XML_SetCharacterDataHandler(parser_.get(), on_text);
    XML_SetStartDoctypeDeclHandler(parser_.get(), on_doctype);
  }

  ZoneList read(std::string_view text);

 private:
  struct FreeParser {
    void operator()(XML_Parser parser) const { XML_ParserFree(parser); }
  };

  // Errors may not pass through Expat, which is C: they wait until it is left.
  template <typename Action>
  static void guarded(void* reader, const Action& action) {
    KmlReader& self = *static_cast<KmlReader*>(reader);
    if (self.error_) return;
    try {
      action(self);
    } catch (...) {
      self.error_ = std::current_exception();
      XML_StopParser(self.parser_.get(), XML_FALSE);
    }
  }
  static void on_start(void* reader, const char* name, const char**) {
    guarded(reader,
            [&](KmlReader& self) { self.start(local_name(name), std::string_view(name).starts_with("wpml:")); });
  }
  static void on_end(void* reader, const char* name) {
    guarded(reader, [&](KmlReader& self) { self.end(local_name(name)); });
  }
  static void on_text(void* reader, const char* text, int length) {
    guarded(reader, [&](KmlReader& self) { self.text_.append(text, static_cast<std::size_t>(length)); });
  }
  static void on_doctype(void* reader, const char*, const char*, const char*, int) {
    guarded(reader, [](KmlReader& self) { self.fail("a KML file has no DOCTYPE", "take it out"); });
  }
  /// "kml:Polygon" is "Polygon".
  static std::string local_name(std::string_view name) { return std::string(name.substr(name.rfind(':') + 1)); }

  void start(const std::string& name, bool is_of_dji);
  void end(const std::string& name);
  void end_in_polygon(const std::string& name);
  void end_boundary();
  void end_positions(const std::string& name);
  void end_line();
  void end_polygon();
  void end_placemark();
  void leave_unknown(const std::string& problem);
  ListedRing positions() const;
  bool is_in(const char* name) const { return !open_.empty() && open_.back() == name; }
  std::string place() const { return "line " + std::to_string(XML_GetCurrentLineNumber(parser_.get())); }
  [[noreturn]] void fail(const std::string& problem, const std::string& fix = "correct it",
                         ErrorCode code = ErrorCode::zone_file_syntax) const {
    fail_in_zones(code, file_, place(), problem, fix);
  }

  const std::filesystem::path& file_;
  const core::ProgressReporter& progress_;
  std::unique_ptr<XML_ParserStruct, FreeParser> parser_;
  std::exception_ptr error_;
  std::vector<std::string> open_;
  std::string text_, name_, altitude_mode_, extrude_;
  std::optional<DrawnPolygon> polygon_;  // that is open
  std::optional<ListedRing> ring_;       // of the boundary that is open, as far as it has coordinates
  double ring_offset_m_ = 0;
  bool is_known_ = true;             // the part of a placemark that is open
  std::vector<DrawnPolygon> drawn_;  // of the placemark that is open
  std::size_t placemarks_ = 0, polygons_ = 0;
  ZoneList result_;
};

ZoneList KmlReader::read(std::string_view text) {
  const XML_Status status = XML_Parse(parser_.get(), text.data(), static_cast<int>(text.size()), XML_TRUE);
  if (error_) std::rethrow_exception(error_);
  if (status != XML_STATUS_OK) {
    fail(std::string("the XML is broken: ") + XML_ErrorString(XML_GetErrorCode(parser_.get())), "save the file anew");
  }
  end_placemark();
  return std::move(result_);
}

/// What may be an area, and is none of KML.
void KmlReader::leave_unknown(const std::string& problem) {
  ListedZone zone;
  if (!name_.empty()) zone.names = {name_};
  zone.name = name_.empty() ? place() : name_;
  zone.place = place();
  zone.feature = placemarks_ > 0 ? placemarks_ - 1 : 0;
  const Error fault(ErrorCode::value_unsupported, problem, file_.string() + ", " + zone.place, "draw it as a polygon");
  leave_unread(std::move(zone), fault, result_);
}

void KmlReader::start(const std::string& name, bool is_of_dji) {
  constexpr std::size_t kDeepest = 100;
  if (open_.empty() && name != "kml") {
    fail("not a file of zones: XML about <" + io::clean_name(name) + ">", "give KML");
  }
  if (open_.size() >= kDeepest) fail("elements are nested deeper than 100 levels");
  if (!open_.empty() && open_.back() == "coordinates") fail("there is an element among coordinates");
  const bool is_of_placemark = is_in("Placemark") || is_in("MultiGeometry");
  if (is_of_placemark) is_known_ = is_of_dji || is_any(name, kOfPlacemark);
  if (!is_of_placemark && !is_known_) {  // an element of a placemark that holds others
    is_known_ = true;                    // it is told once
    leave_unknown("KML has no <" + io::clean_name(open_.back()) + "> in a placemark");
  }
  if (polygon_ && !polygon_->fault && !is_of_dji && !is_any(name, kOfPolygon)) {
    polygon_->fault = Error(ErrorCode::zone_file_syntax, "KML has no <" + io::clean_name(name) + "> in a polygon",
                            file_.string() + ", " + place(), "correct it, or take it out");
  }
  if (is_any(name, {"LinearRing", "outerBoundaryIs", "innerBoundaryIs"})) ring_.reset();
  if (name == "LinearRing") ring_offset_m_ = 0;
  open_.push_back(name);
  text_.clear();
  if (name == "Placemark") {
    end_placemark();
    name_.clear();
    ++placemarks_;
  }
  if (name == "Polygon") {
    if (polygon_) fail("a polygon is inside of another one");
    ListedZone& zone = polygon_.emplace().zone;
    if (!name_.empty()) zone.names = {name_};
    zone.name = name_.empty() ? std::to_string(polygons_) : name_;
    zone.place = place();
    zone.feature = placemarks_ > 0 ? placemarks_ - 1 : 0;
    ++polygons_;
    altitude_mode_.clear();
    extrude_.clear();
  }
}

void KmlReader::end(const std::string& name) {
  progress_.tick();
  open_.pop_back();
  if (name == "name" && is_in("Placemark")) name_ = io::clean_name(text_);
  if (is_in("Placemark") || is_in("MultiGeometry")) is_known_ = true;
  if (polygon_) {
    try {
      end_in_polygon(name);
    } catch (const Error& error) {
      if (error.kind() != ErrorKind::input) throw;
      if (!polygon_->fault) polygon_->fault = error;
    }
  }
  if (name == "Polygon") end_polygon();
  if (name == "Placemark") end_placemark();
  if (name == "Point") ++result_.left_out["point"];
  if (!polygon_ && is_any(name, {"coordinates", "Coordinates"})) end_positions(name);
  if (name == "Track") ++result_.left_out["line"];
  if (name == "GroundOverlay") ++result_.left_out["image"];
  if (name == "Model" || name == "NetworkLink") {
    ListedZone zone;
    if (is_in("Placemark") && !name_.empty()) zone.names = {name_};
    zone.name = zone.place = place();
    zone.feature = static_cast<std::size_t>(-1);  // of none
    const bool is_link = name == "NetworkLink";
    const Error fault(ErrorCode::value_unsupported,
                      is_link ? "a link to another file is not followed" : "a model of another file is not read",
                      file_.string() + ", " + zone.place,
                      is_link ? "name that file in the mission, too" : "draw it as a polygon");
    leave_unread(std::move(zone), fault, result_);
  }
  text_.clear();
}

void KmlReader::end_positions(const std::string& name) {
  const bool is_read = name == "coordinates";
  if (is_read && (is_in("LineString") || is_in("LinearRing"))) return end_line();
  if ((is_read && (is_in("Point") || is_in("LatLonQuad"))) || io::clean_name(text_).empty()) return;
  leave_unknown("<" + name + "> is in no geometry of KML");
}

void KmlReader::end_line() {
  constexpr std::size_t kFewest = 4;
  Zone::Ring line;
  try {
    line = positions().corners;
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::input) throw;  // else it is a line, whatever is wrong with it
  }
  if (line.size() < kFewest || line.front() != line.back()) {
    ++result_.left_out["line"];
    return;
  }
  ListedZone zone;
  if (!name_.empty()) zone.names = {name_};
  zone.name = name_.empty() ? place() : name_;
  zone.place = place();
  leave_closed_line(std::move(zone), file_, result_);
}

void KmlReader::end_in_polygon(const std::string& name) {
  const auto refuse_second = [&](bool differs) {
    if (differs) fail("<" + name + "> is given twice");
  };
  if (is_any(name, {"altitudeMode", "extrude"}) && is_in("Polygon")) {
    std::string& kept = name == "extrude" ? extrude_ : altitude_mode_;
    const std::string text = io::clean_name(text_);
    refuse_second(!kept.empty() && kept != text);
    kept = text;
  }
  if (name == "altitudeOffset") {
    const std::string text = io::clean_name(text_);
    const ParsedNumber offset = parse_number(text);
    if (offset.fault != NumberFault::none) fail("an altitudeOffset is not a number: " + in_quotes(text));
    double& kept = is_in("LinearRing") ? ring_offset_m_ : polygon_->offset_m;
    refuse_second(kept != 0 && kept != offset.value);
    kept = offset.value;
  }
  if (name == "coordinates") {
    if (!is_in("LinearRing")) fail("coordinates of a polygon are in no ring");
    if (ring_) fail("a ring has coordinates twice");
    ring_ = positions();
  }
  if (name == "LinearRing") end_boundary();
  if ((name == "outerBoundaryIs" || name == "innerBoundaryIs") && !ring_) {
    fail("a boundary of a polygon has no coordinates");
  }
}

void KmlReader::end_boundary() {
  const bool is_outer = is_in("outerBoundaryIs");
  if (!is_outer && !is_in("innerBoundaryIs")) fail("a ring of a polygon is neither its outer nor an inner boundary");
  if (is_outer && !polygon_->zone.outer.empty()) fail("a polygon has two outer boundaries");
  if (!ring_ || ring_->corners.empty()) return;
  ListedRing corners = *ring_;
  for (double& altitude_m : corners.z_m) {
    altitude_m += ring_offset_m_;
    polygon_->has_all_altitudes = polygon_->has_all_altitudes && !std::isnan(altitude_m);
    polygon_->low_m = std::fmin(polygon_->low_m, altitude_m);
    polygon_->high_m = std::fmax(polygon_->high_m, altitude_m);
  }
  add_ring(opened_ring(corners, file_, place()), is_outer, polygon_->zone);
}

/// A polygon at one height above the sea, extruded to the ground, is a zone below that height. At other heights it is a
/// surface, and says nothing of the space about it. `relativeToGround` lifts the corners from the ground under them,
/// and the surface between them does not follow the ground: to keep out of what is so far above the ground would be too
/// little over a valley, and to stay in it too much over a hill. So these heights are not used either.
void KmlReader::end_polygon() {
  DrawnPolygon polygon = std::move(*polygon_);
  polygon_.reset();
  ListedZone& zone = polygon.zone;
  if (polygon.fault) {
    leave_unread(std::move(zone), *polygon.fault, result_);
    return;
  }
  if (zone.outer.empty() && !zone.holes.empty()) {
    const Error fault(ErrorCode::zone_file_syntax, "the polygon has no outer boundary",
                      file_.string() + ", " + zone.place, "correct it");
    leave_unread(std::move(zone), fault, result_);
    return;
  }
  if (zone.outer.empty()) {
    ++result_.left_out[kEmptyArea];
    return;
  }
  polygon.low_m += polygon.offset_m;
  polygon.high_m += polygon.offset_m;
  for (double& z_m : zone.corner_z_m) z_m += polygon.offset_m;
  const bool is_above_ground = altitude_mode_ == "relativeToGround", has_altitude = polygon.low_m < INFINITY;
  polygon.is_absolute = altitude_mode_ == "absolute";
  if (polygon.is_absolute && (extrude_ == "1" || extrude_ == "true") && polygon.is_level()) {
    zone.has_heights = true;
    zone.upper = ZoneHeight{polygon.low_m, HeightReference::sea_level};
  } else if (is_above_ground && has_altitude) {
    zone.unused_heights = ": altitudes that are relativeToGround are those of its corners alone";
  }
  if (polygon.is_absolute) zone.corners_from = HeightReference::sea_level;
  if (is_above_ground) zone.corners_from = HeightReference::ground;
  if (!polygon.is_absolute && !is_above_ground) zone.corner_z_m.clear();  // clamped to the ground
  drawn_.push_back(std::move(polygon));
}

void KmlReader::end_placemark() {
  for (ListedZone& zone : joined_solids(std::exchange(drawn_, {}), progress_)) result_.zones.push_back(std::move(zone));
}

/// "longitude,latitude[,altitude]", with blanks between them and none within.
ListedRing KmlReader::positions() const {
  constexpr std::string_view kBlanks = " \t\r\n";
  ListedRing positions;
  std::string_view rest = text_;
  for (;;) {
    const std::size_t begin = rest.find_first_not_of(kBlanks);
    if (begin == std::string_view::npos) return positions;
    rest.remove_prefix(begin);
    progress_.tick();
    const std::string_view tuple = rest.substr(0, rest.find_first_of(kBlanks));
    rest.remove_prefix(tuple.size());
    double numbers[3] = {0, 0, 0};
    const char *at = tuple.data(), *const end = tuple.data() + tuple.size();
    int count = 0;
    for (; count < 3; ++count) {
      const auto [next, fault] = std::from_chars(at, end, numbers[count]);
      if (fault != std::errc() || !std::isfinite(numbers[count])) {
        at = nullptr;
        break;
      }
      at = next;
      if (at == end || *at != ',') {
        ++count;
        break;
      }
      if (count < 2) ++at;
    }
    if (at != end || count < 2) {
      fail("a position is not longitude,latitude,altitude: " + in_quotes(io::clean_name(tuple.substr(0, 60))),
           "write numbers with commas between them and no blanks");
    }
    positions.corners.push_back(checked_position(numbers[0], numbers[1], file_, place()));
    positions.z_m.push_back(count == 3 ? numbers[2] : std::nan(""));
  }
}

}  // namespace

ZoneList parse_kml_zones(std::string_view text, const std::filesystem::path& file,
                         const core::ProgressReporter& progress) {
  return KmlReader(file, progress).read(text);
}

}  // namespace vantage::internal::app
