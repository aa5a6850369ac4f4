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
    note_system(root, plan);
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
    if (!object.is_object()) source_.fail(ErrorCode::plan_syntax, place, "it is not an object", "correct it");
    const auto features = object.find("features");
    if (features != object.end() && features->is_array()) {
      for (std::size_t i = 0; i < features->size(); ++i) {
        add((*features)[i], within + (within.empty() ? "" : ".") + "features[" + std::to_string(i) + "]");
      }
      return;
    }
    std::string name;
    const auto properties = object.find("properties");
    if (properties != object.end() && properties->is_object()) {
      const auto found = properties->find("name");
      if (found != properties->end() && found->is_string()) name = printable(found->get<std::string>());
    }
    const auto geometry = object.find("geometry");
    const json& shape = geometry == object.end() ? object : *geometry;
    const auto type = shape.find("type");  // of null there is none
    if (!shape.is_object() || type == shape.end() || !type->is_string()) return;
    const json none = json::object();
    const json& details = properties != object.end() && properties->is_object() ? *properties : none;
    add_shape(shape, type->get<std::string>(), name, details, place);
  }

  /// RFC 7946 has WGS 84 alone; what was before it could name another system.
  void note_system(const json& root, FlightPlan& plan) const {
    const auto crs = root.find("crs");
    if (crs == root.end() || crs->is_null()) return;
    const std::string text = crs->dump(-1, ' ', true, json::error_handler_t::replace);
    if (text.find("CRS84") != std::string::npos || text.find("4326") != std::string::npos) return;
    plan.notes.push_back({WarningCode::plan_assumed, source_.name + ": its \"crs\" is not WGS 84, as which its " +
                                                         "positions are read: " + in_quotes(text.substr(0, 100))});
  }

  void add_shape(const json& shape, const std::string& kind, const std::string& name, const json& details,
                 const std::string& place) {
    const auto parts = shape.find("geometries");
    if (kind == "GeometryCollection" && parts != shape.end() && parts->is_array()) {
      for (std::size_t i = 0; i < parts->size(); ++i) {
        const json& part = (*parts)[i];
        const auto type = part.find("type");
        if (!part.is_object() || type == part.end() || !type->is_string()) continue;
        add_shape(part, type->get<std::string>(), name, details, place + ", geometry " + std::to_string(i + 1));
      }
    }
    if (kind == "Polygon" || kind == "MultiPolygon") {
      ++left_out_[kind];
      return;
    }
    const bool is_known = kind == "Point" || kind == "MultiPoint" || kind == "LineString" ||
                          kind == "MultiLineString" || kind == "GeometryCollection" || kind == "Feature" ||
                          kind == "FeatureCollection";
    if (!is_known) {
      source_.fail(ErrorCode::value_unsupported, place, "GeoJSON has no type " + in_quotes(kind),
                   "write \"LineString\" for what is flown");
    }
    const auto coordinates = shape.find("coordinates");
    if (coordinates == shape.end() || !coordinates->is_array()) return;
    const std::size_t lines = lines_.size();
    if (kind == "LineString") add_line(*coordinates, name, place);
    if (kind == "MultiLineString") {
      for (std::size_t i = 0; i < coordinates->size(); ++i) {
        add_line((*coordinates)[i], name, place + ", line " + std::to_string(i + 1));
      }
      join_at_antimeridian(lines_, lines);
    }
    if (kind == "MultiPoint") {
      for (const json& position : *coordinates) {
        add_position(position, place, points_.track);
        points_.numbers.push_back(0);
      }
    }
    if (kind != "Point") return;
    add_position(*coordinates, place, points_.track);
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
};

}  // namespace

FlightPlan read_geojson(const json& root, const PlanSource& source) { return GeojsonTracks(source).read(root); }

}  // namespace vantage::internal::flight::plans
