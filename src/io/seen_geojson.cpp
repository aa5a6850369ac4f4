// GeoJSON: RFC 7946.
#include <Eigen/Geometry>
#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "core/text.h"
#include "geo/on_globe.h"
#include "io/antimeridian.h"
#include "io/georeference_text.h"
#include "vantage/fraction.h"

namespace vantage {
namespace {

using GeoJson = nlohmann::ordered_json;

/// Positions of one scene.
class Positions {
 public:
  explicit Positions(const std::optional<Georeference>& place) {
    if (place) globe_.emplace(*place);
  }

  /// The coordinates of a polygon, and of more where it is cut at the antimeridian.
  std::vector<GeoJson> polygons(const std::vector<std::vector<Vec3>>& rings) const {
    std::vector<GeoJson> polygons;
    if (!globe_) {
      GeoJson& json = polygons.emplace_back(GeoJson::array());
      for (const std::vector<Vec3>& ring : rings) {
        json.push_back(closed<Vec3>(ring, [](const Vec3& at) { return GeoJson{at.x(), at.y(), at.z()}; }));
      }
      return polygons;
    }
    const auto place = [this](const Vec3& point) { return globe_->to_geodetic(point); };
    for (const internal::io::GlobePolygon& part : internal::io::cut_at_antimeridian(rings, place)) {
      GeoJson& json = polygons.emplace_back(GeoJson::array());
      for (const internal::io::GlobeRing& ring : part) {
        json.push_back(closed<internal::io::GlobeCorner>(ring, [](const internal::io::GlobeCorner& corner) {
          return GeoJson{corner.at.place.longitude_deg, corner.at.place.latitude_deg, corner.scene.z()};
        }));
      }
    }
    return polygons;
  }

 private:
  /// As GeoJSON has it: the first position is repeated.
  template <class Corner, class Position>
  static GeoJson closed(const std::vector<Corner>& ring, const Position& position) {
    GeoJson json = GeoJson::array();
    for (const Corner& corner : ring) json.push_back(position(corner));
    if (!ring.empty()) json.push_back(json[0]);
    return json;
  }

  std::optional<internal::geo::OnGlobe> globe_;
};

/// Twice the area of a ring as seen from above, positive where it runs counter-clockwise.
double turn_from_above(const std::vector<Vec3>& ring) {
  double sum = 0;
  for (std::size_t i = 1; i + 1 < ring.size(); ++i) sum += (ring[i] - ring[0]).cross(ring[i + 1] - ring[0]).z();
  return sum;
}

/// The other way round, from the same corner on.
std::vector<Vec3> turned(const std::vector<Vec3>& ring) {
  std::vector<Vec3> result = ring;
  if (!result.empty()) std::reverse(result.begin() + 1, result.end());
  return result;
}

GeoJson geometry_json(const std::vector<SeenPolygon>& polygons, const Positions& positions) {
  GeoJson all = GeoJson::array();
  for (const SeenPolygon& polygon : polygons) {
    std::vector<std::vector<Vec3>> rings{polygon.outer};
    rings.insert(rings.end(), polygon.holes.begin(), polygon.holes.end());
    // RFC 7946 wants the outer ring counter-clockwise on the map. Of a wall it has no way round.
    if (turn_from_above(polygon.outer) < 0) {
      for (std::vector<Vec3>& ring : rings) ring = turned(ring);
    }
    for (GeoJson& part : positions.polygons(rings)) all.push_back(std::move(part));
  }
  if (all.empty()) return nullptr;
  if (all.size() == 1) return {{"type", "Polygon"}, {"coordinates", std::move(all[0])}};
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
