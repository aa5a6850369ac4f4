// GeoJSON: RFC 7946.
#include <Eigen/Geometry>
#include <nlohmann/json.hpp>
#include <utility>

#include "core/text.h"
#include "geo/local_frame.h"
#include "io/georeference_text.h"
#include "vantage/fraction.h"

namespace vantage {
namespace {

using GeoJson = nlohmann::ordered_json;

/// Positions of one scene.
class Positions {
 public:
  explicit Positions(const std::optional<Georeference>& place) {
    if (place) frame_.emplace(internal::geo::LonLat{place->longitude_deg, place->latitude_deg});
  }

  GeoJson of(const Vec3& point) const {
    if (!frame_) return {point.x(), point.y(), point.z()};
    const internal::geo::LonLat position = frame_->to_lonlat(point.head<2>());
    return {position.longitude_deg, position.latitude_deg, point.z()};
  }

  /// Closed, as GeoJSON has it. `is_turned`: the other way round.
  GeoJson ring(const std::vector<Vec3>& corners, bool is_turned) const {
    GeoJson json = GeoJson::array();
    for (std::size_t i = 0; i <= corners.size(); ++i) {
      const std::size_t k = i % corners.size();
      json.push_back(of(corners[is_turned && k > 0 ? corners.size() - k : k]));
    }
    return json;
  }

 private:
  std::optional<internal::geo::LocalFrame> frame_;
};

/// Twice the area of a ring as seen from above, positive where it runs counter-clockwise.
double turn_from_above(const std::vector<Vec3>& ring) {
  double sum = 0;
  for (std::size_t i = 1; i + 1 < ring.size(); ++i) sum += (ring[i] - ring[0]).cross(ring[i + 1] - ring[0]).z();
  return sum;
}

GeoJson polygon_json(const SeenPolygon& polygon, const Positions& positions) {
  // RFC 7946 wants the outer ring counter-clockwise on the map. Of a wall it has no way round.
  const bool is_turned = turn_from_above(polygon.outer) < 0;
  GeoJson json = GeoJson::array();
  json.push_back(positions.ring(polygon.outer, is_turned));
  for (const auto& hole : polygon.holes) json.push_back(positions.ring(hole, is_turned));
  return json;
}

GeoJson geometry_json(const std::vector<SeenPolygon>& polygons, const Positions& positions) {
  if (polygons.empty()) return nullptr;
  if (polygons.size() == 1) {
    return {{"type", "Polygon"}, {"coordinates", polygon_json(polygons[0], positions)}};
  }
  GeoJson all = GeoJson::array();
  for (const SeenPolygon& polygon : polygons) all.push_back(polygon_json(polygon, positions));
  return {{"type", "MultiPolygon"}, {"coordinates", std::move(all)}};
}

std::string line_of(const GeoJson& json) {
  return internal::core::escaped_json(json.dump(-1, ' ', false, GeoJson::error_handler_t::replace));
}

}  // namespace

std::string SeenGeoJson::beginning() const {
  std::string text = "{\"type\": \"FeatureCollection\",\n\"coordinate_frame\": ";
  text += place_ ? "\"WGS 84, z of the scene\"" : "\"scene, metres\"";
  if (place_) text += ",\n\"georeference\": " + line_of(internal::io::georeference_json(*place_));
  return text + ",\n\"features\": [";
}

std::string SeenGeoJson::end() const { return count_ > 0 ? "\n]}\n" : "]}\n"; }

std::string SeenGeoJson::feature(const PointFraction& answer, const std::optional<std::string>& id) {
  GeoJson json;
  json["type"] = "Feature";
  if (id) json["id"] = *id;
  json["properties"] = {{"index", count_}, {"measure", name_of(measure_)}, {"fraction", answer.fraction}};
  json["geometry"] = geometry_json(answer.seen, Positions(place_));
  return std::string(count_++ > 0 ? ",\n" : "\n") + line_of(json);
}

}  // namespace vantage
