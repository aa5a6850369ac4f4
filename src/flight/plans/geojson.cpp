// GeoJSON (RFC 7946): lines, or else points. The third number of a position is the height above the ellipsoid.
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/input.h"
#include "flight/plans/json_text.h"
#include "flight/plans/point_details.h"
#include "flight/plans/text_lines.h"

namespace vantage::internal::flight::plans {
namespace {

using nlohmann::json;

class GeojsonTracks {
 public:
  explicit GeojsonTracks(const PlanSource& source) : source_(source) {}

  FlightPlan read(const json& root) {
    FlightPlan plan;
    plan.format = PlanFormat::geojson;
    plan.file = source_.name;
    add(root, "");
    if (!crs_.empty()) {
      plan.notes.push_back({WarningCode::plan_assumed, source_.name + ": its \"crs\" is not WGS 84, as which its " +
                                                           "positions are read: " + in_quotes(crs_.substr(0, 100))});
    }
    if (!left_out_.empty()) {
      plan.notes.push_back(
          {WarningCode::plan_left_out, source_.name + " has more than is flown: " + counted(left_out_)});
    }
    take_details(std::move(points_), lines_, source_, plan);
    take_tracks(std::move(lines_), "line", "lines", source_, plan);
    check_plan(plan, source_);
    return plan;
  }

 private:
  /// Features, which may be nested, a feature, or a geometry; as deep as JSON is.
  void add(const json& object, const std::string& within) {
    const std::string place = within.empty() ? "the object" : within;
    const std::string kind = type_of(object, place);
    if (kind == "FeatureCollection") {
      refuse_others(object, place, "features");
      const json& features = list(object, "features", place);
      for (std::size_t i = 0; i < features.size(); ++i) {
        add(features[i], within + (within.empty() ? "" : ".") + "features[" + std::to_string(i) + "]");
      }
      return;
    }
    const auto properties = object.find("properties");
    const bool has_properties = properties != object.end() && !properties->empty();  // some write [] for none
    if (has_properties && !properties->is_object()) fail(place, "\"properties\" is not an object");
    const json none = json::object();
    const json& details = has_properties ? *properties : none;
    std::string name;
    const auto found = details.find("name");
    if (found != details.end() && found->is_string()) name = printable(found->get<std::string>());
    if (kind != "Feature") return add_shape(object, name, details, place);
    refuse_others(object, place, "geometry");
    const auto geometry = object.find("geometry");
    if (geometry == object.end()) fail(place, "\"geometry\" is missing");
    if (!geometry->is_null()) add_shape(*geometry, name, details, place);
  }

  [[noreturn]] void fail(const std::string& place, const std::string& problem) const {
    source_.fail(ErrorCode::plan_syntax, place, problem, "correct it");
  }

  std::string type_of(const json& object, const std::string& place) const {
    if (!object.is_object()) fail(place, "it is not an object");
    const auto type = object.find("type");
    if (type == object.end() || !type->is_string()) fail(place, "\"type\" is missing, or not a text");
    return type->get<std::string>();
  }

  const json& list(const json& object, const char* key, const std::string& place) const {
    const auto found = object.find(key);
    if (found == object.end() || !found->is_array())
      fail(place, std::string("\"") + key + "\" is missing, or not an array");
    return *found;
  }

  /// Members beside `read` are not flown: so none may hold positions, or be a misspelt one of GeoJSON.
  void refuse_others(const json& object, const std::string& place, std::string_view read) {
    note_system(object);
    for (const auto& [key, value] : object.items()) {
      if (key == read || key == "bbox") continue;
      const bool is_misspelt =
          !meant_name(key, {"type", "features", "geometry", "geometries", "coordinates", "properties"}).empty();
      if (!is_misspelt && !holds_positions(value, key == "properties")) continue;
      source_.fail(ErrorCode::value_unsupported, place,
                   "the member " + in_quotes(key) + " may hold what is flown, and is not read",
                   "write it as GeoJSON has it, or take it out");
    }
  }

  /// `is_data`: of properties, where numbers are no positions but in "coordinates".
  bool holds_positions(const json& value, bool is_data) const {
    source_.progress.tick();
    if (!value.is_structured()) return false;
    if (value.is_array() && !is_data && value.size() > 1 && value[0].is_number() && value[1].is_number()) return true;
    for (const auto& [key, part] : value.items()) {
      if (!is_data && (is_alike(key, "lat") || is_alike(key, "latitude"))) return true;
      if (key != "bbox" && holds_positions(part, is_data && !is_alike(key, "coordinates"))) return true;
    }
    return false;
  }

  /// RFC 7946 has WGS 84 alone; what was before it could name another system.
  void note_system(const json& object) {
    const auto crs = object.find("crs");
    if (crs == object.end() || crs->is_null() || !crs_.empty()) return;
    const std::string text = crs->dump(-1, ' ', true, json::error_handler_t::replace);
    if (text.find("CRS84") == std::string::npos && text.find("4326") == std::string::npos) crs_ = text;
  }

  void add_shape(const json& shape, const std::string& name, const json& details, const std::string& place) {
    const std::string kind = type_of(shape, place);
    const bool is_known = kind == "Point" || kind == "MultiPoint" || kind == "LineString" ||
                          kind == "MultiLineString" || kind == "Polygon" || kind == "MultiPolygon" ||
                          kind == "GeometryCollection";
    if (!is_known) {
      source_.fail(ErrorCode::value_unsupported, place, "GeoJSON has no geometry of the type " + in_quotes(kind),
                   "write \"LineString\" for what is flown");
    }
    refuse_others(shape, place, kind == "GeometryCollection" ? "geometries" : "coordinates");
    if (kind == "GeometryCollection") {
      const json& parts = list(shape, "geometries", place);
      for (std::size_t i = 0; i < parts.size(); ++i) {
        add_shape(parts[i], name, details, place + ", geometry " + std::to_string(i + 1));
      }
      return;
    }
    if (kind == "Polygon" || kind == "MultiPolygon") {
      ++left_out_[kind];
      return;
    }
    const json& coordinates = list(shape, "coordinates", place);
    const std::size_t lines = lines_.size();
    if (kind == "LineString") add_line(coordinates, name, place);
    if (kind == "MultiLineString") {
      for (std::size_t i = 0; i < coordinates.size(); ++i) {
        add_line(coordinates[i], name, place + ", line " + std::to_string(i + 1));
      }
      join_at_antimeridian(lines_, lines);
    }
    if (kind == "MultiPoint") {
      for (const json& position : coordinates) {
        add_position(position, place, points_.track);
        points_.numbers.push_back(0);
      }
    }
    if (kind != "Point") return;
    add_position(coordinates, place, points_.track);
    points_.numbers.push_back(0);
    for (const auto& [key, value] : details.items()) {
      PlanItem& item = points_.track.items.back();
      if (value.is_number()) set_detail(key, value.get<double>(), item, &points_.numbers.back());
      if (value.is_string()) set_detail(key, value.get_ref<const std::string&>(), item, &points_.numbers.back());
    }
  }

  void add_line(const json& positions, const std::string& name, const std::string& place) {
    if (!positions.is_array()) source_.fail(ErrorCode::plan_syntax, place, "a line is not an array", "correct it");
    PlanTrack track;
    track.name = name;
    track.place = place;
    for (std::size_t i = 0; i < positions.size(); ++i) {
      add_position(positions[i], place + ", position " + std::to_string(i + 1), track);
    }
    if (!track.items.empty()) lines_.push_back(std::move(track));
  }

  void add_position(const json& numbers, const std::string& place, PlanTrack& track) {
    source_.progress.tick();
    const std::string where = source_.place(place);
    const auto is_number = [&](std::size_t i) { return numbers[i].is_number(); };
    const bool is_good = numbers.is_array() && numbers.size() >= 2 && is_number(0) && is_number(1) &&
                         (numbers.size() < 3 || is_number(2));
    if (!is_good) {
      PlanSource::fail_at(ErrorCode::plan_syntax, where, "a position is not [longitude, latitude, height]",
                          "give two or three numbers");
    }
    PlanItem& item = new_item(track, total_, place, source_);
    item.position.horizontal = checked_lonlat(numbers[0].get<double>(), numbers[1].get<double>(), where);
    item.position.datum = HeightDatum::ellipsoid;
    if (numbers.size() > 2) item.position.height_m = numbers[2].get<double>();
  }

  const PlanSource& source_;
  std::vector<PlanTrack> lines_;
  DetailPoints points_;
  std::map<std::string, std::size_t> left_out_;
  std::size_t total_ = 0;
  std::string crs_;  ///< the first one that is not WGS 84
};

}  // namespace

FlightPlan read_geojson(const json& root, const PlanSource& source) { return GeojsonTracks(source).read(root); }

}  // namespace vantage::internal::flight::plans
