#include "io/tile_content.h"

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <unordered_map>
#include <utility>

#include "common/input.h"
#include "io/glb_container.h"
#include "io/glb_material.h"
#include "io/writers.h"
#include "vantage/version.h"

namespace vantage::internal::io {
namespace {

using TileJson = nlohmann::ordered_json;

constexpr int kTilePoints = 0, kTileTriangles = 4;  // glTF 2.0, mesh.primitive.mode
constexpr std::size_t kTableAlignment = 8;          // EXT_structural_metadata, of every buffer view
constexpr std::uint64_t kMostFeatures = std::uint64_t{1} << std::numeric_limits<float>::digits;  // exact as floats
constexpr std::array<double, 4> kTargetColour = {0.6, 0.02, 0.02, 1};                            // red, linear

/// The document and its one buffer.
struct TileGltf {
  TileJson json;
  std::string buffer;

  /// `target`: 0 for what is no vertex data.
  std::size_t add_view(std::string_view bytes, int target = 0) {
    buffer.resize((buffer.size() + kTableAlignment - 1) / kTableAlignment * kTableAlignment, '\0');
    TileJson view = {{"buffer", 0}, {"byteOffset", buffer.size()}, {"byteLength", bytes.size()}};
    if (target != 0) view["target"] = target;
    buffer += bytes;
    json["bufferViews"].push_back(std::move(view));
    return json["bufferViews"].size() - 1;
  }

  std::size_t add_accessor(std::size_t view, int component, const char* type, std::size_t count) {
    json["accessors"].push_back({{"bufferView", view}, {"componentType", component}, {"count", count}, {"type", type}});
    return json["accessors"].size() - 1;
  }
};

/// Vertices of a mesh, and what they belong to.
struct TileVertices {
  std::vector<Vec3> places;
  std::vector<std::size_t> features;
};

/// The attributes of a primitive.
TileJson add_vertices(TileGltf& gltf, const TileVertices& vertices) {
  std::string positions, ids;
  std::array<float, 3> low, high;
  low.fill(std::numeric_limits<float>::infinity());
  high.fill(-std::numeric_limits<float>::infinity());
  for (const Vec3& place : vertices.places) {
    const Vec3 turned = to_y_up(place);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto coordinate = static_cast<float>(turned[static_cast<Eigen::Index>(axis)]);
      low[axis] = std::min(low[axis], coordinate);
      high[axis] = std::max(high[axis], coordinate);
      append_little_endian(positions, coordinate);
    }
  }
  for (const std::size_t feature : vertices.features) append_little_endian(ids, static_cast<float>(feature));
  const std::size_t count = vertices.places.size();
  const std::size_t position = gltf.add_accessor(gltf.add_view(positions, kArrayBuffer), kFloat, "VEC3", count);
  // As doubles, so that the text reads back as exactly these floats; the specification demands that.
  const auto exact = [](const std::array<float, 3>& v) { return std::array<double, 3>{v[0], v[1], v[2]}; };
  gltf.json["accessors"][position]["min"] = exact(low);
  gltf.json["accessors"][position]["max"] = exact(high);
  const std::size_t id = gltf.add_accessor(gltf.add_view(ids, kArrayBuffer), kFloat, "SCALAR", count);
  return {{"POSITION", position}, {"_FEATURE_ID_0", id}};
}

/// `features`: how many of them the primitive has.
TileJson tile_primitive(const TileJson& attributes, std::size_t material, int mode, std::size_t features) {
  const TileJson ids = {{{"featureCount", features}, {"attribute", 0}, {"label", "cause"}, {"propertyTable", 0}}};
  return {{"attributes", attributes},
          {"material", material},
          {"mode", mode},
          {"extensions", {{"EXT_mesh_features", {{"featureIds", ids}}}}}};
}

std::size_t add_indices(TileGltf& gltf, const std::vector<std::uint32_t>& indices) {
  std::string bytes;
  for (const std::uint32_t index : indices) append_little_endian(bytes, index);
  return gltf.add_accessor(gltf.add_view(bytes, kElementArrayBuffer), kUnsignedInt, "SCALAR", indices.size());
}

/// The facets of one kind of cause.
struct TileFacets {
  std::vector<std::uint32_t> corners;
  std::vector<bool> has_cause;  // of Volume::causes
};

/// One primitive for each kind of cause that has facets, in the order of CauseKind; they share their vertices.
TileJson volume_primitives(TileGltf& gltf, const Volume& volume, const StoredMesh& stored) {
  TileVertices vertices;
  std::unordered_map<std::uint64_t, std::uint32_t> known;  // by cause and vertex of the mesh
  std::map<CauseKind, TileFacets> by_kind;
  for (std::size_t t = 0; t < stored.mesh.triangles.size(); ++t) {
    const std::uint32_t cause = stored.cause_of[t];
    TileFacets& facets = by_kind[volume.causes[cause].kind];
    facets.has_cause.resize(volume.causes.size());
    facets.has_cause[cause] = true;
    for (const std::uint32_t corner : stored.mesh.triangles[t]) {
      const auto next = static_cast<std::uint32_t>(vertices.places.size());
      const auto [place, is_new] = known.try_emplace(std::uint64_t{cause} << 32 | corner, next);
      if (is_new) {
        vertices.places.push_back(stored.mesh.vertices[corner] - stored.origin);
        vertices.features.push_back(cause);
      }
      facets.corners.push_back(place->second);
    }
  }
  check_count(vertices.places.size(), std::numeric_limits<std::uint32_t>::max() - 1, "vertices", "GLB");
  const TileJson attributes = add_vertices(gltf, vertices);
  TileJson primitives = TileJson::array();
  for (const auto& [kind, facets] : by_kind) {
    gltf.json["materials"].push_back(cause_material(kind));
    const auto features = std::count(facets.has_cause.begin(), facets.has_cause.end(), true);
    TileJson primitive = tile_primitive(attributes, gltf.json["materials"].size() - 1, kTileTriangles,
                                        static_cast<std::size_t>(features));
    primitive["indices"] = add_indices(gltf, facets.corners);
    primitives.push_back(std::move(primitive));
  }
  return primitives;
}

/// A target's polygons as fans, or a point; its feature is `feature`.
TileJson target_primitive(TileGltf& gltf, const TileTarget& target, std::size_t feature, std::size_t material) {
  TileVertices vertices;
  std::vector<std::uint32_t> indices;
  for (const std::vector<Vec3>& part : target.parts) {
    const auto first = static_cast<std::uint32_t>(vertices.places.size());
    for (std::uint32_t i = 2; i < part.size(); ++i) {
      for (const std::uint32_t corner : {0U, i - 1, i}) indices.push_back(first + corner);
    }
    for (const Vec3& place : part) vertices.places.push_back(place);
  }
  vertices.features.assign(vertices.places.size(), feature);
  TileJson primitive =
      tile_primitive(add_vertices(gltf, vertices), material, indices.empty() ? kTilePoints : kTileTriangles, 1);
  if (!indices.empty()) primitive["indices"] = add_indices(gltf, indices);
  return primitive;
}

void add_targets(TileGltf& gltf, const std::vector<TileTarget>& targets, std::size_t first_feature) {
  if (targets.empty()) return;
  gltf.json["materials"].push_back(
      {{"name", "target"},
       {"pbrMetallicRoughness", {{"baseColorFactor", kTargetColour}, {"metallicFactor", 0.0}}},
       {"doubleSided", true}});
  TileJson primitives = TileJson::array();
  for (std::size_t i = 0; i < targets.size(); ++i) {
    primitives.push_back(target_primitive(gltf, targets[i], first_feature + i, gltf.json["materials"].size() - 1));
  }
  gltf.json["meshes"].push_back({{"name", "target"}, {"primitives", std::move(primitives)}});
  gltf.json["nodes"].push_back({{"name", "target"}, {"mesh", gltf.json["meshes"].size() - 1}});
  gltf.json["scenes"][0]["nodes"].push_back(gltf.json["nodes"].size() - 1);
}

/// A column of texts. A view holds a byte at least, also where all texts are empty.
TileJson add_texts(TileGltf& gltf, const std::vector<TileFeature>& features, std::string TileFeature::*text) {
  std::string values, offsets;
  append_little_endian(offsets, std::uint32_t{0});
  for (const TileFeature& feature : features) {
    values += feature.*text;
    check_count(values.size(), std::numeric_limits<std::uint32_t>::max(), "bytes of names", "GLB");
    append_little_endian(offsets, static_cast<std::uint32_t>(values.size()));
  }
  if (values.empty()) values.push_back('\0');
  const std::size_t value_view = gltf.add_view(values);
  return {{"values", value_view}, {"stringOffsets", gltf.add_view(offsets)}, {"stringOffsetType", "UINT32"}};
}

/// EXT_structural_metadata: the schema, and the table that feature ids are rows of.
void add_table(TileGltf& gltf, const std::vector<TileFeature>& features) {
  std::string areas;
  for (const TileFeature& feature : features) append_little_endian(areas, feature.area_m2);
  const TileJson properties = {
      {"kind",
       {{"name", "kind of cause"},
        {"description", "what bounds the view there: scene, range, target_plane, navigation, sensor; or target"},
        {"type", "STRING"},
        {"required", true}}},
      {"name",
       {{"name", "name"},
        {"description", "of the object of the scene that hides the target, of the limit, or of the target"},
        {"type", "STRING"},
        {"required", true}}},
      {"area_m2",
       {{"name", "area"},
        {"description", "of all facets of the cause, or of the target, in square metres"},
        {"type", "SCALAR"},
        {"componentType", "FLOAT64"},
        {"required", true}}}};
  const TileJson schema = {
      {"id", "vantage_volume"},
      {"classes",
       {{"cause", {{"name", "cause"}, {"description", "what bounds the volume"}, {"properties", properties}}}}}};
  TileJson columns;
  columns["kind"] = add_texts(gltf, features, &TileFeature::kind);
  columns["name"] = add_texts(gltf, features, &TileFeature::name);
  columns["area_m2"] = {{"values", gltf.add_view(areas)}};
  const TileJson table = {
      {"name", "causes"}, {"class", "cause"}, {"count", features.size()}, {"properties", std::move(columns)}};
  gltf.json["extensions"]["EXT_structural_metadata"] = {{"schema", schema},
                                                        {"propertyTables", TileJson::array({table})}};
}

std::vector<TileFeature> tile_features(const Volume& volume, const std::vector<TileTarget>& targets) {
  std::vector<TileFeature> features;
  for (const Cause& cause : volume.causes) {
    features.push_back({name_of(cause.kind), printable(cause.name), cause.area_m2});
  }
  for (const TileTarget& target : targets) features.push_back(target.feature);
  check_count(features.size(), kMostFeatures, "causes", "3D Tiles");
  return features;
}

}  // namespace

void write_tile_content(const Volume& volume, const StoredMesh& stored, const std::vector<TileTarget>& targets,
                        AtomicFile& file) {
  const std::vector<TileFeature> features = tile_features(volume, targets);
  TileGltf gltf;
  gltf.json["asset"] = {{"version", "2.0"}, {"generator", "vantage " VANTAGE_VERSION}};
  if (const std::string& credit = credit_of(volume); !credit.empty()) gltf.json["asset"]["copyright"] = credit;
  gltf.json["asset"]["extras"]["vantage"]["rounding_m"] = stored.rounding_m;
  gltf.json["extensionsUsed"] = {"EXT_mesh_features", "EXT_structural_metadata"};
  gltf.json["scene"] = 0;
  gltf.json["scenes"] = TileJson::array({{{"nodes", {0}}}});
  gltf.json["nodes"] = TileJson::array({{{"name", "visibility volume"}, {"mesh", 0}}});
  TileJson primitives = volume_primitives(gltf, volume, stored);
  gltf.json["meshes"] = TileJson::array({{{"name", "visibility volume"}, {"primitives", std::move(primitives)}}});
  add_targets(gltf, targets, volume.causes.size());
  add_table(gltf, features);
  gltf.json["buffers"] = TileJson::array({{{"byteLength", gltf.buffer.size()}}});
  write_glb_container(gltf.json.dump(-1, ' ', false, TileJson::error_handler_t::replace), gltf.buffer, file);
}

}  // namespace vantage::internal::io
