#include "io/cityjson_document.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <cmath>
#include <unordered_map>
#include <utility>

#include "common/input.h"
#include "io/object_text.h"

namespace vantage::internal::io::cityjson {
namespace {

struct PositionHash {
  std::size_t operator()(const std::array<double, 3>& position) const {
    std::uint64_t hash = 0;
    for (const double coordinate : position) {
      hash = (hash ^ std::bit_cast<std::uint64_t>(coordinate)) * 0x9e3779b97f4a7c15u;
      hash ^= hash >> 32;
    }
    return hash;
  }
};

std::string key_text(const char* key) { return std::string("\"").append(key).append("\""); }

/// Letters in lower case, the rest left out: what a misspelt key has in common with the right one.
std::string letters(std::string_view key) {
  std::string result;
  for (const char c : key) {
    if (std::isalpha(static_cast<unsigned char>(c))) {
      result += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    }
  }
  return result;
}

void check_version(const Json& root, const Trail& trail) {
  const auto type = root.find("type");
  if (type == root.end() || !type->is_string()) trail.fail("\"type\" is missing", "give a CityJSON file");
  if (*type == "CityJSONFeature") {
    trail.fail("it begins with a feature; the line of type CityJSON, with the transform, is missing",
               "put the metadata line of the sequence before it");
  }
  if (*type != "CityJSON") {
    trail.fail("its type is " + shown_word(type->get<std::string>()), "give a CityJSON file");
  }
  const auto version = root.find("version");
  if (version == root.end() || !version->is_string()) trail.fail("\"version\" is missing");
  const auto text = version->get<std::string>();
  for (const std::string_view known : {"1.0", "1.1", "2.0"}) {
    if (text == known || (text.starts_with(known) && text[known.size()] == '.')) return;
  }
  trail.fail_as(ErrorCode::mesh_unsupported,
                "its version " + shown_word(text) + " cannot be read; 1.0, 1.1 and 2.0 can",
                "convert the file, for instance with 'cjio upgrade'");
}

void read_transform(const Json& root, Header& header, const Trail& trail) {
  const auto transform = root.find("transform");
  if (transform == root.end()) {
    if (root["version"].get<std::string>().starts_with("1.0")) return;  // later versions are always quantised
    trail.fail("\"transform\" is missing");
  }
  if (!transform->is_object()) trail.fail("\"transform\" is not an object");
  const auto vector = [&](const char* key) -> Vec3 {
    const Json& array = required(*transform, key, Json::value_t::array, trail);
    return Vec3(numbers(array, 3, key_text(key).c_str(), trail).data());
  };
  header.scale = vector("scale");
  header.translate = vector("translate");
  header.has_transform = true;
  if ((header.scale.array() == 0).any()) trail.fail("a \"scale\" of the transform is 0");
}

std::vector<Vec3> positions(const Json& array, const char* what, const Trail& trail) {
  std::vector<Vec3> result;
  result.reserve(array.size());
  for (const Json& vertex : array) {
    // Spelt out: there are many, and the name is only needed when one is wrong.
    const bool is_triple = vertex.is_array() && vertex.size() == 3 && vertex[0].is_number() && vertex[1].is_number() &&
                           vertex[2].is_number();
    if (!is_triple) {
      trail.fail(std::string(what)
                     .append(" ")
                     .append(std::to_string(result.size()))
                     .append(" (counted from 0) is not an array of three numbers"));
    }
    result.emplace_back(vertex[0].get<double>(), vertex[1].get<double>(), vertex[2].get<double>());
  }
  return result;
}

void read_templates(const Json& root, Header& header, const Trail& trail) {
  header.templates = Json::array();
  const auto templates = root.find("geometry-templates");
  if (templates == root.end()) return;
  if (!templates->is_object()) trail.fail("\"geometry-templates\" is not an object");
  header.templates = required(*templates, "templates", Json::value_t::array, trail);
  const Json& vertices = required(*templates, "vertices-templates", Json::value_t::array, trail);
  header.template_vertices = Vertices(positions(vertices, "template vertex", trail));
}

}  // namespace

Vertices::Vertices(std::vector<Vec3> positions) : positions_(std::move(positions)), known_(positions_.size()) {
  std::unordered_map<std::array<double, 3>, std::uint32_t, PositionHash> first_at(positions_.size());
  same_as_.reserve(positions_.size());
  for (const Vec3& p : positions_) {
    // Adding zero makes -0 the same as 0.
    const std::array<double, 3> key = {p.x() + 0.0, p.y() + 0.0, p.z() + 0.0};
    same_as_.push_back(first_at.try_emplace(key, static_cast<std::uint32_t>(same_as_.size())).first->second);
  }
}

std::uint32_t Vertices::use(std::size_t index, const Eigen::Affine3d& placement, MeshBuilder& builder) {
  const std::uint32_t first = same_as_[index];
  Known& known = known_[first];
  if (known.instance != instance_) known = {instance_, builder.add_vertex(placement * positions_[first], 0)};
  return known.vertex;
}

Header read_header(const Json& root, const Trail& trail) {
  if (!root.is_object()) trail.fail("its JSON is not an object");
  check_version(root, trail);
  Header header;
  read_transform(root, header, trail);
  read_templates(root, header, trail);
  const auto metadata = root.find("metadata");
  if (metadata == root.end()) return header;
  if (!metadata->is_object()) trail.fail("\"metadata\" is not an object");
  const auto crs = metadata->find("referenceSystem");
  if (crs == metadata->end()) return header;
  if (!crs->is_string()) trail.fail("\"referenceSystem\" is not a text");
  header.crs = crs->get<std::string>();
  return header;
}

Vertices read_vertices(const Json& root, const Header& header, const Trail& trail) {
  std::vector<Vec3> vertices = positions(required(root, "vertices", Json::value_t::array, trail), "vertex", trail);
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    if (header.has_transform) vertices[i] = vertices[i].cwiseProduct(header.scale) + header.translate;
    if (!vertices[i].allFinite()) {
      trail.fail_as(ErrorCode::coordinate_not_finite,
                    "vertex " + std::to_string(i) + " (counted from 0) is not finite");
    }
  }
  return Vertices(std::move(vertices));
}

const Json& required(const Json& object, const char* key, Json::value_t type, const Trail& trail) {
  const auto found = object.find(key);
  if (found == object.end()) {
    std::string problem = key_text(key) + " is missing";
    for (const auto& [other, value] : object.items()) {
      if (letters(other) == letters(key)) problem += "; there is " + shown_word(other);
    }
    trail.fail(std::move(problem));
  }
  if (found->type() != type) {
    trail.fail(key_text(key) + (type == Json::value_t::array ? " is not an array" : " is not an object"));
  }
  return *found;
}

std::size_t index_below(const Json& value, std::size_t count, const char* what, const Trail& trail) {
  if (value.is_array()) trail.fail("its boundaries are nested deeper than its type has levels");
  if (!value.is_number_integer()) {
    trail.fail(std::string("the number of a ").append(what).append(" is not a whole number"));
  }
  if (value.is_number_unsigned() && value.get<std::uint64_t>() < count) return value.get<std::uint64_t>();
  trail.fail("it refers to " + std::string(what) + " " + value.dump() + ", but there are only " +
             std::to_string(count) + " (counted from 0)");
}

std::vector<double> numbers(const Json& array, std::size_t count, const char* what, const Trail& trail) {
  std::vector<double> result;
  if (array.is_array() && array.size() == count) {
    for (const Json& value : array) {
      if (value.is_number() && std::isfinite(value.get<double>())) result.push_back(value.get<double>());
    }
  }
  if (result.size() != count)
    trail.fail(std::string(what) + " is not an array of " + std::to_string(count) + " numbers");
  return result;
}

std::string_view text_in(const Json& object, const char* key) {
  const auto found = object.is_object() ? object.find(key) : object.end();
  return found != object.end() && found->is_string() ? found->get_ref<const std::string&>() : std::string_view();
}

ObjectKind kind_of(std::string_view type) {
  constexpr std::array<std::pair<std::string_view, ObjectKind>, 6> kKinds = {
      {{"Building", ObjectKind::building},
       {"BuildingPart", ObjectKind::building_part},
       {"Bridge", ObjectKind::bridge},
       {"BridgePart", ObjectKind::bridge},
       {"BridgeConstructiveElement", ObjectKind::bridge},
       {"SolitaryVegetationObject", ObjectKind::tree}}};
  const auto* const found =
      std::find_if(kKinds.begin(), kKinds.end(), [&](const auto& entry) { return entry.first == type; });
  return found == kKinds.end() ? ObjectKind::other : found->second;
}

bool is_flat(std::string_view type) {
  constexpr std::array<std::string_view, 7> kFlat = {"Road",    "Railway",   "TransportSquare", "Waterway",
                                                     "LandUse", "WaterBody", "TINRelief"};
  return std::find(kFlat.begin(), kFlat.end(), type) != kFlat.end();
}

std::optional<double> height_of(const Json& object) {
  const auto attributes = object.find("attributes");
  if (attributes == object.end() || !attributes->is_object()) return std::nullopt;
  const auto height = attributes->find("measuredHeight");
  if (height == attributes->end()) return std::nullopt;
  double metres = height->is_number() ? height->get<double>() : 0;
  if (height->is_string()) metres = parse_length(height->get_ref<const std::string&>()).value;
  return metres > 0 && metres < core::kMaxCoordinate ? std::optional(metres) : std::nullopt;
}

Box extent_of(const Json& object) {
  const auto extent = object.find("geographicalExtent");
  if (extent == object.end() || !extent->is_array() || extent->size() != 6) return {};
  std::array<double, 6> n{};
  for (std::size_t i = 0; i < 6; ++i) {
    if (!(*extent)[i].is_number()) return {};
    n[i] = (*extent)[i].get<double>();
  }
  const Box box{Vec3(n[0], n[1], n[2]), Vec3(n[3], n[4], n[5])};
  const bool has_width = box.min.x() < box.max.x() && box.min.y() < box.max.y() && box.min.z() <= box.max.z();
  return has_width && box.min.allFinite() && box.max.allFinite() ? box : Box{};
}

SceneObject identity_of(const std::string& id, const Json& object) {
  SceneObject identity{"", id, ObjectKind::other};
  identity.kind = kind_of(text_in(object, "type"));
  const auto attributes = object.find("attributes");
  if (attributes == object.end() || !attributes->is_object()) return identity;
  if (text_in(*attributes, "name") != id) identity.name = text_in(*attributes, "name");
  return identity;
}

Box box_of_points(const Json& geometries, const Vertices& vertices) {
  Box box;
  for (const Json& geometry : geometries) {
    const auto boundaries = geometry.find("boundaries");
    if (boundaries == geometry.end()) continue;
    std::vector<const Json*> waiting = {&*boundaries};
    while (!waiting.empty()) {
      const Json& next = *waiting.back();
      waiting.pop_back();
      if (next.is_array()) {
        for (const Json& one : next) waiting.push_back(&one);
      } else if (next.is_number_unsigned() && next.get<std::uint64_t>() < vertices.size()) {
        box.extend(vertices.position(next.get<std::size_t>()));
      }
    }
  }
  return box;
}

}  // namespace vantage::internal::io::cityjson
