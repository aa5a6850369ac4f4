// RFC 7946; EUROCAE ED-269 (2020) and ED-318 (2024), whose schemas are at github.com/UASGeoZones.
#include <cmath>
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

constexpr double kFootM = 0.3048;

std::string indexed_place(const std::string& place, const char* key, std::size_t index) {
  return (place.empty() ? "" : place + ".") + key + "[" + std::to_string(index) + "]";
}

/// Which members of a volume say between which heights it lies.
struct HeightKeys {
  const char *lower, *lower_reference, *upper, *upper_reference, *unit;
};
constexpr HeightKeys kLayerKeys = {"lower", "lowerReference", "upper", "upperReference", "uom"};  // ED-318
constexpr HeightKeys kVolumeKeys = {"lowerLimit", "lowerVerticalReference", "upperLimit", "upperVerticalReference",
                                    "uomDimensions"};  // ED-269

class GeoJsonReader {
 public:
  explicit GeoJsonReader(const std::filesystem::path& file) : file_(file) {}

  ZoneList read(const json& root);

 private:
  struct Heights {
    std::optional<ZoneHeight> lower, upper;
    bool are_given = false;
  };

  void read_features(const json& root);
  void read_feature(const json& feature, const std::string& place, std::size_t number);
  void read_geometry(const json& geometry, const std::string& place, const std::string& name, Heights heights);
  void read_volume(const json& volume, const std::string& place, const std::string& name);
  void add_polygon(const json& rings, const std::string& place, const std::string& name, const Heights& heights);
  void add_circle(const json& centre, const json& radius, bool may_be_feet, const std::string& place,
                  const std::string& name, const Heights& heights);
  void check_crs(const json& root) const;

  Heights heights_of(const json& layer, const HeightKeys& keys, const std::string& place) const;
  std::optional<ZoneHeight> height(const json& layer, const char* key, const char* reference, double unit_m,
                                   const std::string& place) const;
  double unit_of(const json& layer, const char* key, const std::string& place) const;
  ListedRing ring(const json& positions, const std::string& place) const;
  Eigen::Vector2d position(const json& numbers, const std::string& place) const;
  double number(const json& value, const std::string& what, const std::string& place) const;
  std::string type_of(const json& object, const std::string& place) const;
  const json& member(const json& object, const char* key, const std::string& place) const;
  const json& list(const json& object, const char* key, const std::string& place) const;
  [[noreturn]] void fail(const std::string& place, const std::string& problem, const std::string& fix = "correct it",
                         ErrorCode code = ErrorCode::zone_file_syntax) const {
    fail_in_zones(code, file_, place, problem, fix);
  }

  const std::filesystem::path& file_;
  std::size_t feature_ = 0;  // that is read
  std::vector<std::string> names_;
  ZoneList result_;
};

/// What people call a feature.
struct FeatureNames {
  std::string first;             ///< its id, or else its name; empty where it has neither
  std::vector<std::string> all;  ///< names before ids
};

FeatureNames names_of_feature(const json& feature) {
  const auto properties = feature.find("properties");
  const auto text_in = [](const json& object, const char* key) {
    const auto found = object.is_object() ? object.find(key) : object.end();
    if (!object.is_object() || found == object.end()) return std::string();
    if (found->is_string()) return io::clean_name(found->get_ref<const std::string&>());
    return found->is_number() ? io::clean_name(found->dump()) : std::string();
  };
  FeatureNames names;
  std::vector<std::string> ids;
  for (const char* key : {"identifier", "id", "name", "title"}) {
    for (const json* object : {properties == feature.end() ? nullptr : &*properties, &feature}) {
      std::string text = object ? text_in(*object, key) : std::string();
      if (text.empty()) continue;
      if (names.first.empty()) names.first = text;
      const bool is_id = std::string_view(key) == "identifier" || std::string_view(key) == "id";
      (is_id ? ids : names.all).push_back(std::move(text));
    }
  }
  names.all.insert(names.all.end(), ids.begin(), ids.end());
  return names;
}

const json& GeoJsonReader::member(const json& object, const char* key, const std::string& place) const {
  const auto found = object.find(key);
  if (found == object.end()) fail(place, std::string("\"") + key + "\" is missing");
  return *found;
}

const json& GeoJsonReader::list(const json& object, const char* key, const std::string& place) const {
  const json& value = member(object, key, place);
  if (!value.is_array()) fail(place, std::string("\"") + key + "\" is not an array");
  return value;
}

std::string GeoJsonReader::type_of(const json& object, const std::string& place) const {
  const json& type = member(object, "type", place);
  if (!type.is_string()) fail(place, "\"type\" is not a text");
  return io::clean_name(type.get_ref<const std::string&>());
}

double GeoJsonReader::number(const json& value, const std::string& what, const std::string& place) const {
  const double number = value.is_number() ? value.get<double>() : std::nan("");
  if (!std::isfinite(number)) fail(place, what + " is not a number");
  return number;
}

ZoneList GeoJsonReader::read(const json& root) {
  check_crs(root);
  const std::string type = root.contains("type") ? type_of(root, "") : "FeatureCollection";
  if (type == "FeatureCollection") {
    read_features(root);
  } else if (type == "Feature") {
    read_feature(root, "", 0);
  } else {
    read_geometry(root, "", "", {});
  }
  return std::move(result_);
}

/// RFC 7946 has taken this member out, but older files have it.
void GeoJsonReader::check_crs(const json& root) const {
  const auto crs = root.find("crs");
  if (crs == root.end() || crs->is_null()) return;
  const std::string text = crs->dump(-1, ' ', true, json::error_handler_t::replace);
  for (const char* known : {"CRS84", "EPSG::4326", "EPSG:4326"}) {
    const std::size_t at = text.find(known), end = at + std::string_view(known).size();
    if (at != std::string::npos && !(end < text.size() && text[end] >= '0' && text[end] <= '9')) return;
  }
  fail("crs", "its positions are not in WGS 84",
       "convert the file to longitudes and latitudes (ogr2ogr -t_srs EPSG:4326)", ErrorCode::value_unsupported);
}

void GeoJsonReader::read_features(const json& root) {
  const json& features = list(root, "features", "");
  for (std::size_t i = 0; i < features.size(); ++i) {
    read_feature(features[i], indexed_place("", "features", i), i);
  }
}

void GeoJsonReader::read_feature(const json& feature, const std::string& place, std::size_t number) {
  if (!feature.is_object()) fail(place, "the feature is not an object");
  feature_ = number;
  FeatureNames names = names_of_feature(feature);
  const std::string name = std::move(names.first);
  names_ = std::move(names.all);
  const json& geometry = member(feature, "geometry", place);
  if (geometry.is_null()) {
    ++result_.left_out["feature without a geometry"];
  } else if (geometry.is_array()) {
    for (std::size_t i = 0; i < geometry.size(); ++i) {
      read_volume(geometry[i], indexed_place(place, "geometry", i), name);
    }
  } else {
    read_geometry(geometry, place, name, {});
  }
}

void GeoJsonReader::read_geometry(const json& geometry, const std::string& place, const std::string& name,
                                  Heights heights) {
  if (!geometry.is_object()) fail(place, "the geometry is not an object");
  if (const auto layer = geometry.find("layer"); layer != geometry.end() && !layer->is_null()) {
    heights = heights_of(*layer, kLayerKeys, place);
  }
  const std::string type = type_of(geometry, place);
  if (type == "GeometryCollection") {
    const json& parts = list(geometry, "geometries", place);
    for (std::size_t i = 0; i < parts.size(); ++i) {
      read_geometry(parts[i], indexed_place(place, "geometries", i), name, heights);
    }
  } else if (type == "Polygon") {
    add_polygon(list(geometry, "coordinates", place), place, name, heights);
  } else if (type == "MultiPolygon") {
    const json& polygons = list(geometry, "coordinates", place);
    for (std::size_t i = 0; i < polygons.size(); ++i) {
      add_polygon(polygons[i], indexed_place(place, "coordinates", i), name, heights);
    }
  } else if (type == "Point" && geometry.contains("extent")) {
    const json& extent = geometry["extent"];
    const bool is_circle = extent.is_object() && extent.contains("subType") && extent["subType"] == "Circle";
    if (!is_circle) fail(place, "\"extent\" is not a circle");
    add_circle(list(geometry, "coordinates", place), member(extent, "radius", place), false, place, name, heights);
  } else if (type == "Point" || type == "MultiPoint") {
    ++result_.left_out["point"];
  } else if (type == "LineString" || type == "MultiLineString") {
    ++result_.left_out["line"];
  } else {
    fail(place, "there is no geometry of the type " + in_quotes(type), "give areas: Polygon or MultiPolygon");
  }
}

void GeoJsonReader::read_volume(const json& volume, const std::string& place, const std::string& name) {
  if (!volume.is_object()) fail(place, "the volume is not an object");
  const Heights heights = heights_of(volume, kVolumeKeys, place);
  const json& projection = member(volume, "horizontalProjection", place);
  if (!projection.is_object()) fail(place, "\"horizontalProjection\" is not an object");
  const std::string type = type_of(projection, place);
  if (type == "Polygon") {
    add_polygon(list(projection, "coordinates", place), place, name, heights);
  } else if (type == "Circle") {
    // Readers differ on whether the unit of the heights is that of the radius too.
    const bool may_be_feet = unit_of(volume, kVolumeKeys.unit, place) != 1;
    add_circle(list(projection, "center", place), member(projection, "radius", place), may_be_feet, place, name,
               heights);
  } else {
    fail(place, "there is no projection of the type " + in_quotes(type), "give a Polygon or a Circle");
  }
}

double GeoJsonReader::unit_of(const json& layer, const char* key, const std::string& place) const {
  const json& unit = member(layer, key, place);
  const std::string text = unit.is_string() ? io::clean_name(unit.get_ref<const std::string&>()) : "";
  if (text == "m" || text == "M") return 1;
  if (text == "ft" || text == "FT") return kFootM;
  fail(place, std::string("\"") + key + "\" is " + in_quotes(text), "give heights in 'm' or in 'ft'",
       ErrorCode::value_unsupported);
}

/// A height that is missing is no bound.
std::optional<ZoneHeight> GeoJsonReader::height(const json& layer, const char* key, const char* reference,
                                                double unit_m, const std::string& place) const {
  const auto value = layer.find(key);
  if (value == layer.end() || value->is_null()) return std::nullopt;
  ZoneHeight height;
  height.metres = number(*value, std::string("\"") + key + "\"", place) * unit_m;
  const json& from = member(layer, reference, place);
  const std::string text = from.is_string() ? io::clean_name(from.get_ref<const std::string&>()) : "";
  if (text == "AMSL") {
    height.from = HeightReference::sea_level;
  } else if (text == "AGL") {
    height.from = HeightReference::ground;
  } else if (text == "WGS84") {
    height.from = HeightReference::ellipsoid;
  } else {
    fail(place, std::string("\"") + reference + "\" is " + in_quotes(text), "give 'AMSL', 'AGL' or 'WGS84'",
         ErrorCode::value_unsupported);
  }
  return height;
}

GeoJsonReader::Heights GeoJsonReader::heights_of(const json& layer, const HeightKeys& keys,
                                                 const std::string& place) const {
  if (!layer.is_object()) fail(place, "\"layer\" is not an object");
  Heights heights;
  heights.are_given = true;
  const double unit_m = unit_of(layer, keys.unit, place);
  heights.lower = height(layer, keys.lower, keys.lower_reference, unit_m, place);
  heights.upper = height(layer, keys.upper, keys.upper_reference, unit_m, place);
  return heights;
}

Eigen::Vector2d GeoJsonReader::position(const json& numbers, const std::string& place) const {
  if (!numbers.is_array() || numbers.size() < 2) fail(place, "a position is not an array of two numbers or more");
  return checked_position(number(numbers[0], "a longitude", place), number(numbers[1], "a latitude", place), file_,
                          place);
}

ListedRing GeoJsonReader::ring(const json& positions, const std::string& place) const {
  if (!positions.is_array()) fail(place, "a ring is not an array of positions");
  ListedRing closed;
  for (const json& numbers : positions) {
    closed.corners.push_back(position(numbers, place));
    const bool has_height = numbers.size() > 2 && numbers[2].is_number();
    closed.z_m.push_back(has_height ? number(numbers[2], "a height", place) : std::nan(""));
  }
  return opened_ring(closed, file_, place);
}

void GeoJsonReader::add_polygon(const json& rings, const std::string& place, const std::string& name,
                                const Heights& heights) {
  if (!rings.is_array() || rings.empty()) fail(place, "a polygon is not an array of rings");
  ListedZone zone;
  zone.name = name.empty() ? std::to_string(feature_) : name;
  zone.names = names_;
  zone.place = place;
  zone.feature = feature_;
  zone.lower = heights.lower;
  zone.upper = heights.upper;
  zone.has_heights = heights.are_given;
  for (std::size_t i = 0; i < rings.size(); ++i) {
    add_ring(ring(rings[i], place), i == 0, zone);
  }
  result_.zones.push_back(std::move(zone));
}

void GeoJsonReader::add_circle(const json& centre, const json& radius, bool may_be_feet, const std::string& place,
                               const std::string& name, const Heights& heights) {
  ListedZone zone;
  zone.name = name.empty() ? std::to_string(feature_) : name;
  zone.names = names_;
  zone.place = place;
  zone.feature = feature_;
  zone.lower = heights.lower;
  zone.upper = heights.upper;
  zone.has_heights = heights.are_given;
  const double length = number(radius, "\"radius\"", place);
  if (!(length > 0)) fail(place, "the radius is not above 0", "correct it", ErrorCode::value_out_of_range);
  zone.circle = ListedCircle{position(centre, place), may_be_feet ? kFootM * length : length, length};
  result_.zones.push_back(std::move(zone));
}

}  // namespace

ZoneList geojson_zones(const json& root, const std::filesystem::path& file) { return GeoJsonReader(file).read(root); }

}  // namespace vantage::internal::app
