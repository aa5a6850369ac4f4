// KML, GPX, GeoJSON and CSV: the flight as a line of points.
#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "common/input.h"
#include "flight/plans/plan_writer.h"
#include "flight/plans/point_details.h"
#include "vantage/error.h"

namespace vantage::internal::flight::plans {
namespace {

using nlohmann::json;

constexpr int kPlace = 11, kHeight = 6, kSmall = 3;

/// "11.5,48.1,520".
std::string kml_position(const LinePosition& at) {
  return decimal(at.longitude_deg, kPlace) + "," + decimal(at.latitude_deg, kPlace) + "," +
         decimal(at.height_m, kHeight);
}

std::string kml_position(const PlanWriter& writer, const Vec3& position) {
  const Eigen::Vector2d at = writer.lonlat(position);
  return kml_position({at.x(), at.y(), writer.height(position)});
}

std::string kml_lines(const PlanWriter& writer, const std::vector<OutPoint>& points) {
  const std::vector<std::vector<LinePosition>> lines = writer.lines(points);
  std::string text;
  for (const std::vector<LinePosition>& line : lines) {
    text += "<LineString><altitudeMode>absolute</altitudeMode><coordinates>\n";
    for (const LinePosition& position : line) text += kml_position(position) + "\n";
    text += "</coordinates></LineString>";
  }
  return lines.size() == 1 ? text : "<MultiGeometry>" + text + "</MultiGeometry>";
}

std::string kml_facet(const std::vector<std::string>& corners) {
  std::string text = "<Polygon><altitudeMode>absolute</altitudeMode><outerBoundaryIs><LinearRing><coordinates>";
  for (const std::string& corner : corners) text += corner + " ";
  return text + corners.front() + "</coordinates></LinearRing></outerBoundaryIs></Polygon>\n";
}

std::string kml_volume(const PlanWriter& writer, const NamedVolume& volume) {
  std::string text = "<Placemark><name>" + xml_text(volume.name) +
                     "</name><Style><LineStyle><width>0</width></LineStyle><PolyStyle><color>7f00a0ff</color>"
                     "</PolyStyle></Style><MultiGeometry>\n";
  for (const Triangle& triangle : volume.mesh.triangles) {
    std::vector<Vec3> ring;
    for (const std::uint32_t vertex : triangle) {
      if (vertex >= volume.mesh.vertices.size()) {
        throw Error(ErrorCode::index_out_of_range, "a vertex index is out of range", volume.name, "mend the mesh");
      }
      ring.push_back(volume.mesh.vertices[vertex]);
    }
    for (const io::GlobePolygon& part : io::cut_at_antimeridian({ring}, writer.on_globe())) {
      std::vector<std::string> corners;
      for (const io::GlobeCorner& corner : part.front()) {
        corners.push_back(
            kml_position({corner.at.place.longitude_deg, corner.at.place.latitude_deg, writer.height(corner.scene)}));
      }
      text += kml_facet(corners);
    }
  }
  return text + "</MultiGeometry></Placemark>\n";
}

/// The name of a point for people: what is seen there, and its number.
std::string title(const OutPoint& point, std::size_t index) {
  return std::to_string(index + 1) + (point.action.sees.empty() ? "" : " " + point.action.sees);
}

json json_or_null(const std::optional<double>& number) { return number ? json(*number) : json(); }

json properties_of(const OutPoint& point, std::size_t index) {
  const CameraAngles angles = camera_angles(point);
  return {{"name", printable(title(point, index))},
          {"point", index + 1},
          {"hold_s", point.hold_s},
          {"speed_m_s", std::isnan(point.speed_m_s) ? json() : json(point.speed_m_s)},
          {"yaw_deg", json_or_null(angles.yaw_deg)},
          {"gimbal_pitch_deg", json_or_null(angles.pitch_deg)},
          {"photo", point.action.photo},
          {"video", point.action.video},
          {"sees", printable(point.action.sees)}};
}

json position_of_json(const PlanWriter& writer, const Vec3& position) {
  const Eigen::Vector2d at = writer.lonlat(position);
  return {at.x(), at.y(), writer.height(position)};
}

/// Cut at the antimeridian, as RFC 7946 has it in section 3.1.9.
json line_json(const std::vector<std::vector<LinePosition>>& lines) {
  json all = json::array();
  for (const std::vector<LinePosition>& line : lines) {
    json& positions = all.emplace_back(json::array());
    for (const LinePosition& at : line) positions.push_back({at.longitude_deg, at.latitude_deg, at.height_m});
  }
  if (all.size() == 1) return {{"type", "LineString"}, {"coordinates", std::move(all[0])}};
  return {{"type", "MultiLineString"}, {"coordinates", std::move(all)}};
}

/// Whether a point is written: of circles only the ends of chords where something is done.
bool is_listed(const OutPoint& point) {
  const CameraAngles angles = camera_angles(point);
  return !point.is_of_circle || point.hold_s > 0 || point.action.photo || point.action.video || angles.yaw_deg ||
         angles.pitch_deg;
}

std::string gpx_extensions(const OutPoint& point) {
  std::string text;
  for (const auto& [name, value] : details_of(point)) {
    text.append("<vantage:").append(name).append(">").append(xml_text(value));
    text.append("</vantage:").append(name).append(">");
  }
  return text.empty() ? text : "<extensions>" + text + "</extensions>";
}

std::string kml_data(const char* name, const std::string& value) {
  return std::string("<Data name=\"") + name + "\"><value>" + xml_text(value) + "</value></Data>";
}

std::string field(const std::optional<double>& number, int decimals) {
  return "," + (number && !std::isnan(*number) ? decimal(*number, decimals) : std::string());
}

}  // namespace

std::string write_kml(const FlightOut& flight) {
  const PlanWriter writer(flight, PlanFormat::kml, {HeightDatum::sea_level});
  const std::vector<OutPoint> points = writer.points_to_cut();
  std::string text =
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<kml xmlns=\"http://www.opengis.net/kml/2.2\">\n<Document>\n<name>" +
      xml_text(flight.name) + "</name>\n";
  if (points.size() > 1) {  // a line has two positions
    text += "<Placemark><name>" + xml_text(flight.name) +
            "</name><Style><LineStyle><color>ff0000ff</color><width>3</width></LineStyle></Style>" +
            kml_lines(writer, points) + "</Placemark>\n";
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!is_listed(points[i])) continue;
    text += "<Placemark><name>" + xml_text(title(points[i], i)) + "</name><ExtendedData>" +
            kml_data("point", std::to_string(i + 1));
    for (const auto& [name, value] : details_of(points[i])) text += kml_data(name, value);
    text += "</ExtendedData><Point><altitudeMode>absolute</altitudeMode><coordinates>" +
            kml_position(writer, points[i].position) + "</coordinates></Point></Placemark>\n";
  }
  for (std::size_t i = 0; i < drawn_in_kml(flight); ++i) text += kml_volume(writer, flight.volumes[i]);
  return text + "</Document>\n</kml>\n";
}

std::string write_gpx(const FlightOut& flight) {
  const PlanWriter writer(flight, PlanFormat::gpx, {HeightDatum::sea_level});
  const std::vector<OutPoint> points = writer.points();
  std::string text =
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<gpx version=\"1.1\" creator=\"vantage\" "
      "xmlns=\"http://www.topografix.com/GPX/1/1\" xmlns:vantage=\"urn:x-vantage:flight\">\n<metadata><name>" +
      xml_text(flight.name) + "</name><desc>heights above mean sea level</desc></metadata>\n<rte><name>" +
      xml_text(flight.name) + "</name>\n";
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector2d at = writer.lonlat(points[i].position);
    const double longitude_deg = at.x() == 180 ? -180 : at.x();  // the format has no 180
    text += "<rtept lat=\"" + decimal(at.y(), kPlace) + "\" lon=\"" + decimal(longitude_deg, kPlace) + "\"><ele>" +
            decimal(writer.height(points[i].position), kHeight) + "</ele><name>" + xml_text(title(points[i], i)) +
            "</name>" + gpx_extensions(points[i]) + "</rtept>\n";
  }
  return text + "</rte>\n</gpx>\n";
}

std::string write_geojson(const FlightOut& flight) {
  const PlanWriter writer(flight, PlanFormat::geojson, {HeightDatum::ellipsoid});
  const std::vector<OutPoint> points = writer.points_to_cut();
  json features = json::array();
  features.push_back({{"type", "Feature"},
                      {"properties", {{"name", printable(flight.name)}, {"heights", "WGS 84 ellipsoid"}}},
                      {"geometry", line_json(writer.lines(points))}});
  if (points.size() == 1) features.clear();  // a line has two positions
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!is_listed(points[i])) continue;
    features.push_back(
        {{"type", "Feature"},
         {"properties", properties_of(points[i], i)},
         {"geometry", {{"type", "Point"}, {"coordinates", position_of_json(writer, points[i].position)}}}});
  }
  const json collection{{"type", "FeatureCollection"}, {"features", std::move(features)}};
  return collection.dump(1, ' ', false, json::error_handler_t::replace) + "\n";
}

std::string write_csv(const FlightOut& flight) {
  const PlanWriter writer(flight, PlanFormat::csv,
                          {HeightDatum::sea_level, HeightDatum::ellipsoid, HeightDatum::home, HeightDatum::scene_z});
  const bool is_of_scene = writer.heights() == HeightDatum::scene_z;
  const char* height = "height_amsl_m";
  if (writer.heights() == HeightDatum::ellipsoid) height = "height_ellipsoid_m";
  if (writer.heights() == HeightDatum::home) height = "height_home_m";
  std::string text = "name,";
  if (!is_of_scene) text += std::string("longitude_deg,latitude_deg,") + height + ",";
  text += "x_m,y_m,z_m,hold_s,speed_m_s,yaw_deg,gimbal_pitch_deg,photo,video,sees\n";
  const std::vector<OutPoint> points = writer.points();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const OutPoint& point = points[i];
    const CameraAngles angles = camera_angles(point);
    text += std::to_string(i + 1);
    if (!is_of_scene) {
      const Eigen::Vector2d at = writer.lonlat(point.position);
      text += field(at.x(), kPlace) + field(at.y(), kPlace) + field(writer.height(point.position), kHeight);
    }
    for (const double coordinate : point.position) text += field(coordinate, kHeight);
    text += std::string(",") + hold_text(point.hold_s) + field(point.speed_m_s, kSmall) +
            field(angles.yaw_deg, kSmall) + field(angles.pitch_deg, kSmall) + (point.action.photo ? ",1" : ",0") +
            (point.action.video ? ",1," : ",0,") + csv_field(printable(point.action.sees)) + "\n";
  }
  return text;
}

}  // namespace vantage::internal::flight::plans
