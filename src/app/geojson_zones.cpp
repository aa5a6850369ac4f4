// RFC 7946; EUROCAE ED-269 (2020) and ED-318 (2024), whose schemas are at github.com/UASGeoZones.
#include <algorithm>
#include <cmath>
#include <initializer_list>
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

std::string member_place(const std::string& place, const std::string& key) {
  return (place.empty() ? "" : place + ".") + key;
}

std::string indexed_place(const std::string& place, const char* key, std::size_t index) {
  return member_place(place, key) + "[" + std::to_string(index) + "]";
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
  GeoJsonReader(const std::filesystem::path& file, const core::ProgressReporter& progress)
      : file_(file), progress_(progress) {}

  ZoneList read(const json& root);

 private:
  struct Heights {
    std::optional<ZoneHeight> lower, upper;
    bool are_given = false;
    std::optional<Error> fault;
  };

  void read_features(const json& features, const std::string& key);
  void read_feature(const json& feature, const std::string& place, std::size_t number);
  void read_geometry(const json& geometry, const std::string& place, const std::string& name, Heights heights);
  void read_point(const json& geometry, const std::string& place, const std::string& name, const Heights& heights);
  void read_line(const json& positions, const std::string& place, const std::string& name);
  void read_volume(const json& volume, const std::string& place, const std::string& name);
  bool read_fence(const json& feature, const std::string& place);
  void leave_others(const json& object, const std::string& place, const std::string& name,
                    std::initializer_list<std::string_view> read);
  bool may_hold_area(const json& value) const;
  ListedZone zone_of(const std::string& place, const std::string& name, const Heights& heights) const;
  /// One area that cannot be read does not keep the others from being read.
  template <typename Read>
  void guarded(const std::string& place, const std::string& name, const Read& read) {
    try {
      read();
    } catch (const Error& error) {
      leave_unread(zone_of(place, name, {}), error, result_);
    }
  }
  void add_polygon(const json& rings, const std::string& place, const std::string& name, const Heights& heights);
  void add_circle(const json& centre, const json& radius, bool may_be_feet, const std::string& place,
                  const std::string& name, const Heights& heights);
  void check_crs(const json& object, const std::string& place) const;

  Heights heights_of(const json& layer, const HeightKeys& keys, const std::string& place) const;
  std::optional<ZoneHeight> height(const json& layer, const char* key, const char* reference, const char* unit,
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
  const core::ProgressReporter& progress_;
  // Of the feature that is read.
  std::size_t feature_ = 0;
  std::vector<std::string> names_;
  const json* properties_ = nullptr;
  std::optional<bool> is_inclusion_;
  ZoneList result_;
};

/// Null where it has none of that name.
const json* find_member(const json* object, const char* key) {
  if (object == nullptr || !object->is_object()) return nullptr;
  const auto found = object->find(key);
  return found == object->end() || found->is_null() ? nullptr : &*found;
}

bool has_radius(const json* object) {
  const json* const radius = find_member(object, "radius");
  return radius != nullptr && number_in(*radius) != std::optional(0.0);
}

std::string word_in(const json* value) {
  return value != nullptr && value->is_string() ? io::clean_name(value->get_ref<const std::string&>()) : std::string();
}

bool is_word(std::string_view text, std::string_view word) {
  const auto small = [](char c) { return c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c; };
  const auto is_same = [&](char a, char b) { return small(a) == small(b); };
  return std::equal(text.begin(), text.end(), word.begin(), word.end(), is_same);
}

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
  const std::optional<double> number = number_in(value);
  if (!number) fail(place, what + " is not a number");
  return *number;
}

ZoneList GeoJsonReader::read(const json& root) {
  if (root.is_array()) {
    read_features(root, "");
    return std::move(result_);
  }
  check_crs(root, "");
  const std::string type = root.contains("type") ? type_of(root, "") : "FeatureCollection";
  const std::vector<std::string> lists = lists_of_features(root);
  if (lists.size() > (type == "FeatureCollection" ? 1U : 0U)) {
    fail("", "the file has zones in several places, as in " + in_quotes(lists.back()), "make several files of it");
  }
  if (type == "FeatureCollection") {
    const std::string key = lists.empty() ? "features" : lists.front();
    feature_ = static_cast<std::size_t>(-1);  // of none
    leave_others(root, "", "", {key});
    read_features(list(root, key.c_str(), ""), key);
  } else if (type == "Feature") {
    guarded("", "", [&] { read_feature(root, "", 0); });
  } else {
    guarded("", "", [&] { read_geometry(root, "", "", {}); });
  }
  return std::move(result_);
}

/// RFC 7946 has taken this member out, but older files have it: of a collection, a feature or a geometry.
void GeoJsonReader::check_crs(const json& object, const std::string& place) const {
  const json* const crs = find_member(&object, "crs");
  if (crs == nullptr) return;
  const std::string name = word_in(crs->is_string() ? crs : find_member(find_member(crs, "properties"), "name"));
  for (const char* known : {"CRS84", "CRS84h", "EPSG::4326", "EPSG:4326"}) {
    if (name.ends_with(known)) return;
  }
  fail(place.empty() ? "crs" : place + ".crs", "its positions are not in WGS 84",
       "convert the file to longitudes and latitudes (ogr2ogr -t_srs EPSG:4326)", ErrorCode::value_unsupported);
}

void GeoJsonReader::read_features(const json& features, const std::string& key) {
  for (std::size_t i = 0; i < features.size(); ++i) {
    const std::string place = indexed_place("", key.c_str(), i);
    feature_ = i;
    names_.clear();
    properties_ = nullptr;
    is_inclusion_.reset();
    guarded(place, "", [&] { read_feature(features[i], place, i); });
  }
}

void GeoJsonReader::read_feature(const json& feature, const std::string& place, std::size_t number) {
  if (!feature.is_object()) fail(place, "the feature is not an object");
  feature_ = number;
  FeatureNames names = names_of_feature(feature);
  const std::string name = std::move(names.first);
  names_ = std::move(names.all);
  properties_ = find_member(&feature, "properties");
  check_crs(feature, place);
  if (!read_fence(feature, place)) {
    ++result_.left_out[kDisabledArea];
    return;
  }
  leave_others(feature, place, name, {"geometry", "properties"});
  if (properties_ != nullptr) leave_others(*properties_, member_place(place, "properties"), name, {});
  const json& geometry = member(feature, "geometry", place);
  if (geometry.is_null() || (geometry.is_array() && geometry.empty())) {
    ++result_.left_out[kEmptyArea];
  } else if (geometry.is_array()) {
    for (std::size_t i = 0; i < geometry.size(); ++i) {
      const std::string volume = indexed_place(place, "geometry", i);
      guarded(volume, name, [&] { read_volume(geometry[i], volume, name); });
    }
  } else if (find_member(&geometry, "horizontalProjection") != nullptr) {
    read_volume(geometry, place, name);
  } else {
    read_geometry(geometry, place, name, {});
  }
}

/// What a dock of DJI says of a feature: whether it is to stay in. False where it does not count.
bool GeoJsonReader::read_fence(const json& feature, const std::string& place) {
  is_inclusion_.reset();
  const auto said = [&](const char* key) {
    const json* const value = find_member(&feature, key);
    return value != nullptr ? value : find_member(properties_, key);
  };
  const json* const type = said("geofence_type");
  if (type == nullptr) return true;
  const std::string word = word_in(type);
  if (!is_word(word, "nfz") && !is_word(word, "dfence")) {
    fail(place, "\"geofence_type\" is " + in_quotes(word), "write 'nfz' to stay out, 'dfence' to stay in",
         ErrorCode::value_unsupported);
  }
  is_inclusion_ = is_word(word, "dfence");
  const json* const enable = said("enable");
  if (enable != nullptr && !enable->is_boolean()) fail(place, "\"enable\" is not true or false");
  return enable == nullptr || enable->get<bool>();
}

/// Members that are not read, and may hold an area, are unread.
void GeoJsonReader::leave_others(const json& object, const std::string& place, const std::string& name,
                                 std::initializer_list<std::string_view> read) {
  for (const auto& [key, value] : object.items()) {
    if (std::find(read.begin(), read.end(), key) != read.end() || !may_hold_area(value)) continue;
    const std::string clean = io::clean_name(key);
    ListedZone zone = zone_of(member_place(place, clean), name.empty() ? clean : name, {});
    const Error fault(ErrorCode::value_unsupported,
                      "the member " + in_quotes(clean) + " may hold an area, and is not read",
                      file_.string() + ", " + zone.place, "write the area as a feature of its own, or take it out");
    leave_unread(std::move(zone), fault, result_);
  }
}

/// Whether there is a polygon in it, a ring of positions that is closed, or a place with a radius.
bool GeoJsonReader::may_hold_area(const json& value) const {
  constexpr std::size_t kFewest = 4;
  progress_.tick();
  if (!value.is_structured()) return false;
  const auto is_position = [](const json& one) {
    return one.is_array() && one.size() >= 2 && number_in(one[0]) && number_in(one[1]);
  };
  const bool is_line = value.is_array() && std::all_of(value.begin(), value.end(), is_position);
  if (is_line && value.size() >= kFewest && value.front() == value.back()) return true;
  const json* const coordinates = find_member(&value, "coordinates");
  const bool is_polygon = word_in(find_member(&value, "type")).ends_with("Polygon");
  if (is_polygon && coordinates != nullptr && !coordinates->empty()) return true;
  const bool has_place = coordinates != nullptr || find_member(&value, "center") || find_member(&value, "geometry");
  if (has_place && (has_radius(&value) || has_radius(find_member(&value, "extent")) ||
                    has_radius(find_member(&value, "properties")))) {
    return true;
  }
  return std::any_of(value.begin(), value.end(), [this](const json& part) { return may_hold_area(part); });
}

void GeoJsonReader::read_geometry(const json& geometry, const std::string& place, const std::string& name,
                                  Heights heights) {
  if (!geometry.is_object()) fail(place, "the geometry is not an object");
  check_crs(geometry, place);
  if (const auto layer = geometry.find("layer"); layer != geometry.end() && !layer->is_null()) {
    heights = heights_of(*layer, kLayerKeys, place);
  }
  const std::string type = type_of(geometry, place);
  leave_others(geometry, place, name, {type == "GeometryCollection" ? "geometries" : "coordinates"});
  const auto read_all = [&](const char* key, const auto& read) {
    const json& parts = list(geometry, key, place);
    if (parts.empty()) ++result_.left_out[kEmptyArea];
    for (std::size_t i = 0; i < parts.size(); ++i) {
      const std::string part = indexed_place(place, key, i);
      guarded(part, name, [&] { read(parts[i], part); });
    }
  };
  if (type == "GeometryCollection") {
    read_all("geometries", [&](const json& one, const std::string& part) { read_geometry(one, part, name, heights); });
  } else if (type == "Polygon") {
    add_polygon(list(geometry, "coordinates", place), place, name, heights);
  } else if (type == "MultiPolygon") {
    read_all("coordinates", [&](const json& one, const std::string& part) { add_polygon(one, part, name, heights); });
  } else if (type == "Point" || type == "MultiPoint") {
    read_point(geometry, place, name, heights);
  } else if (type == "LineString") {
    read_line(list(geometry, "coordinates", place), place, name);
  } else if (type == "MultiLineString") {
    read_all("coordinates", [&](const json& one, const std::string& part) { read_line(one, part, name); });
  } else {
    fail(place, "there is no geometry of the type " + in_quotes(type), "give areas: Polygon or MultiPolygon");
  }
}

/// A circle, if the file makes one of it.
void GeoJsonReader::read_point(const json& geometry, const std::string& place, const std::string& name,
                               const Heights& heights) {
  const json* const extent = find_member(&geometry, "extent");
  const json* const of = extent != nullptr ? extent : properties_;
  const auto may_be_extent = [](const json& member) { return has_radius(&member); };
  if (type_of(geometry, place) == "Point" && is_word(word_in(find_member(of, "subType")), "circle")) {
    add_circle(list(geometry, "coordinates", place), member(*of, "radius", place), false, place, name, heights);
  } else if (extent != nullptr) {
    fail(place, "\"extent\" is not a circle");
  } else if (has_radius(of) || has_radius(&geometry) || std::any_of(geometry.begin(), geometry.end(), may_be_extent)) {
    fail(place, "the point has a radius, and nothing says what it is for",
         "write \"subType\": \"Circle\" beside it, and the radius in metres");
  } else {
    ++result_.left_out["point"];
  }
}

void GeoJsonReader::read_line(const json& positions, const std::string& place, const std::string& name) {
  constexpr std::size_t kFewest = 4;
  const bool is_closed = positions.is_array() && positions.size() >= kFewest && positions.front() == positions.back();
  if (!is_closed) {
    ++result_.left_out["line"];
    return;
  }
  leave_closed_line(zone_of(place, name, {}), file_, result_);
}

void GeoJsonReader::read_volume(const json& volume, const std::string& place, const std::string& name) {
  if (!volume.is_object()) fail(place, "the volume is not an object");
  const Heights heights = heights_of(volume, kVolumeKeys, place);
  const json& projection = member(volume, "horizontalProjection", place);
  if (!projection.is_object()) fail(place, "\"horizontalProjection\" is not an object");
  const std::string type = type_of(projection, place);
  leave_others(volume, place, name, {"horizontalProjection"});
  leave_others(projection, place, name, {type == "Circle" ? "center" : "coordinates"});
  if (type == "Polygon") {
    add_polygon(list(projection, "coordinates", place), place, name, heights);
  } else if (type == "Circle") {
    // Readers differ on whether the unit of the heights is that of the radius too.
    const std::string unit = word_in(find_member(&volume, kVolumeKeys.unit));
    const bool may_be_feet = !is_word(unit, "m");
    add_circle(list(projection, "center", place), member(projection, "radius", place), may_be_feet, place, name,
               heights);
  } else {
    fail(place, "there is no projection of the type " + in_quotes(type), "give a Polygon or a Circle");
  }
}

double GeoJsonReader::unit_of(const json& layer, const char* key, const std::string& place) const {
  const std::string text = word_in(&member(layer, key, place));
  if (is_word(text, "m")) return 1;
  if (is_word(text, "ft")) return kFootM;
  fail(place, std::string("\"") + key + "\" is " + in_quotes(text), "give heights in 'm' or in 'ft'",
       ErrorCode::value_unsupported);
}

/// A height that is missing is no bound.
std::optional<ZoneHeight> GeoJsonReader::height(const json& layer, const char* key, const char* reference,
                                                const char* unit, const std::string& place) const {
  const json* const value = find_member(&layer, key);
  if (value == nullptr) return std::nullopt;
  ZoneHeight height;
  height.metres = number(*value, std::string("\"") + key + "\"", place) * unit_of(layer, unit, place);
  const std::string text = word_in(&member(layer, reference, place));
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
  Heights heights;
  heights.are_given = true;
  try {
    if (!layer.is_object()) fail(place, "\"layer\" is not an object");
    for (const auto& [key, value] : layer.items()) {
      for (const char* known : {keys.lower, keys.lower_reference, keys.upper, keys.upper_reference, keys.unit}) {
        if (key != known && is_word(key, known)) fail(place, "write " + in_quotes(known) + " for " + in_quotes(key));
      }
    }
    heights.lower = height(layer, keys.lower, keys.lower_reference, keys.unit, place);
    heights.upper = height(layer, keys.upper, keys.upper_reference, keys.unit, place);
  } catch (const Error& error) {
    heights.fault = error.with_fix(error.fix() + ", or write 'heights: any' beside 'file'");
  }
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
    progress_.tick();
    closed.corners.push_back(position(numbers, place));
    closed.z_m.push_back(numbers.size() > 2 ? number_in(numbers[2]).value_or(std::nan("")) : std::nan(""));
  }
  return opened_ring(closed, file_, place);
}

ListedZone GeoJsonReader::zone_of(const std::string& place, const std::string& name, const Heights& heights) const {
  ListedZone zone;
  zone.name = name.empty() ? std::to_string(feature_) : name;
  zone.names = names_;
  zone.place = place;
  zone.feature = feature_;
  zone.is_inclusion = is_inclusion_;
  zone.lower = heights.lower;
  zone.upper = heights.upper;
  zone.has_heights = heights.are_given;
  zone.heights_fault = heights.fault;
  return zone;
}

void GeoJsonReader::add_polygon(const json& rings, const std::string& place, const std::string& name,
                                const Heights& heights) {
  if (!rings.is_array()) fail(place, "a polygon is not an array of rings");
  const auto is_empty = [](const json& ring) { return ring.is_array() && ring.empty(); };
  if (std::all_of(rings.begin(), rings.end(), is_empty)) {
    ++result_.left_out[kEmptyArea];
    return;
  }
  ListedZone zone = zone_of(place, name, heights);
  for (std::size_t i = 0; i < rings.size(); ++i) {
    add_ring(ring(rings[i], place), i == 0, zone);
  }
  result_.zones.push_back(std::move(zone));
}

void GeoJsonReader::add_circle(const json& centre, const json& radius, bool may_be_feet, const std::string& place,
                               const std::string& name, const Heights& heights) {
  ListedZone zone = zone_of(place, name, heights);
  const double length = number(radius, "\"radius\"", place);
  if (!(length > 0)) fail(place, "the radius is not above 0", "correct it", ErrorCode::value_out_of_range);
  zone.circle = ListedCircle{position(centre, place), may_be_feet ? kFootM * length : length, length};
  result_.zones.push_back(std::move(zone));
}

}  // namespace

ZoneList geojson_zones(const json& root, const std::filesystem::path& file, const core::ProgressReporter& progress) {
  return GeoJsonReader(file, progress).read(root);
}

std::vector<std::string> lists_of_features(const json& root) {
  const auto has_geometry = [](const json& one) { return find_member(&one, "geometry") != nullptr; };
  std::vector<std::string> names;
  for (const auto& [key, value] : root.items()) {
    const bool is_list = value.is_array() && std::any_of(value.begin(), value.end(), has_geometry);
    if (is_list || key == "features") names.push_back(key);
  }
  return names;
}

std::optional<double> number_in(const json& value) {
  std::optional<double> number;
  if (value.is_number()) number = value.get<double>();
  if (value.is_string()) {
    const ParsedNumber parsed = parse_number(value.get_ref<const std::string&>());
    if (parsed.fault == NumberFault::none) number = parsed.value;
  }
  return number && std::isfinite(*number) ? number : std::nullopt;
}

}  // namespace vantage::internal::app
