// glTF 2.0, binary container: y up, one primitive and one material per kind of cause. Positions are single precision,
// as glTF demands, but relative to a node whose translation is written in full: UTM-sized coordinates survive.
#include <array>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "io/georeference_text.h"
#include "io/glb_container.h"
#include "io/glb_material.h"
#include "io/kind_colours.h"
#include "io/volume_statement.h"
#include "io/writers.h"
#include "vantage/version.h"

namespace vantage::internal::io {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kTriangles = 4;  // glTF 2.0, mesh.primitive.mode

/// From the numbers that pictures and screens use (sRGB, 0 to 255) to the linear ones that glTF asks for.
double linear(int colour) {
  const double c = colour / 255.0;
  return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
}

}  // namespace

Json cause_material(CauseKind kind) {
  const KindColour of_kind = colour_of(kind);
  const std::array<double, 4> colour{linear(of_kind.red), linear(of_kind.green), linear(of_kind.blue), of_kind.opacity};
  return {{"name", name_of(kind)},
          {"pbrMetallicRoughness", {{"baseColorFactor", colour}, {"metallicFactor", 0.0}, {"roughnessFactor", 0.9}}},
          {"alphaMode", "BLEND"},
          {"doubleSided", true}};
}

const std::string& credit_of(const Volume& volume) {
  const bool is_placed = volume.attribution.empty() && volume.georeference;
  return is_placed ? volume.georeference->attribution : volume.attribution;
}

namespace {

/// The document and its one buffer.
struct Gltf {
  Json json;
  std::string buffer;

  /// Appends to the buffer what `from` marks the beginning of, as a view.
  std::size_t add_view(std::size_t from, int target) {
    json["bufferViews"].push_back(
        {{"buffer", 0}, {"byteOffset", from}, {"byteLength", buffer.size() - from}, {"target", target}});
    return json["bufferViews"].size() - 1;
  }

  std::size_t add_accessor(Json accessor) {
    json["accessors"].push_back(std::move(accessor));
    return json["accessors"].size() - 1;
  }
};

std::size_t add_positions(Gltf& gltf, const StoredMesh& stored) {
  std::array<float, 3> low, high;
  low.fill(std::numeric_limits<float>::infinity());
  high.fill(-std::numeric_limits<float>::infinity());
  for (const Vec3& vertex : stored.mesh.vertices) {
    const Vec3 local = to_y_up(vertex - stored.origin);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto coordinate = static_cast<float>(local[static_cast<Eigen::Index>(axis)]);
      low[axis] = std::min(low[axis], coordinate);
      high[axis] = std::max(high[axis], coordinate);
      append_little_endian(gltf.buffer, coordinate);
    }
  }
  // As doubles, so that the text reads back as exactly these floats; the specification demands that.
  const auto exact = [](const std::array<float, 3>& v) { return std::array<double, 3>{v[0], v[1], v[2]}; };
  return gltf.add_accessor({{"bufferView", gltf.add_view(0, kArrayBuffer)},
                            {"componentType", kFloat},
                            {"count", stored.mesh.vertices.size()},
                            {"type", "VEC3"},
                            {"min", exact(low)},
                            {"max", exact(high)}});
}

/// Adds the facets of one kind of cause; nothing when there are none.
void add_primitive(Gltf& gltf, const Volume& volume, const StoredMesh& stored, CauseKind kind, std::size_t positions,
                   Json& primitives) {
  const std::size_t from = gltf.buffer.size();
  for (std::size_t t = 0; t < stored.mesh.triangles.size(); ++t) {
    if (volume.causes[stored.cause_of[t]].kind != kind) continue;
    for (const std::uint32_t index : stored.mesh.triangles[t]) append_little_endian(gltf.buffer, index);
  }
  const std::size_t count = (gltf.buffer.size() - from) / sizeof(std::uint32_t);
  if (count == 0) return;
  const std::size_t indices = gltf.add_accessor({{"bufferView", gltf.add_view(from, kElementArrayBuffer)},
                                                 {"componentType", kUnsignedInt},
                                                 {"count", count},
                                                 {"type", "SCALAR"}});
  gltf.json["materials"].push_back(cause_material(kind));
  primitives.push_back({{"attributes", {{"POSITION", positions}}},
                        {"indices", indices},
                        {"material", gltf.json["materials"].size() - 1},
                        {"mode", kTriangles}});
}

/// The mesh with its facets by kind of cause, as the primitives have them.
Mesh in_file_order(const Volume& volume, const StoredMesh& stored) {
  Mesh mesh{stored.mesh.vertices, {}};
  for (const CauseKind kind : kKinds) {
    for (std::size_t t = 0; t < stored.mesh.triangles.size(); ++t) {
      if (volume.causes[stored.cause_of[t]].kind == kind) mesh.triangles.push_back(stored.mesh.triangles[t]);
    }
  }
  return mesh;
}

Gltf make_gltf(const Volume& volume, const StoredMesh& stored) {
  Gltf gltf;
  gltf.json["asset"] = {{"version", "2.0"}, {"generator", "vantage " VANTAGE_VERSION}};
  if (const std::string& credit = credit_of(volume); !credit.empty()) gltf.json["asset"]["copyright"] = credit;
  gltf.json["asset"]["extras"]["vantage"]["rounding_m"] = stored.rounding_m;
  if (auto statement = statement_json(volume, in_file_order(volume, stored))) {
    gltf.json["asset"]["extras"]["vantage"]["volume"] = std::move(*statement);
  }
  gltf.json["scene"] = 0;
  if (stored.mesh.empty()) {  // the specification allows no empty array, so there is no node either
    gltf.json["scenes"] = Json::array({{{"name", std::string("no volume: ") + name_of(volume.outcome)}}});
    return gltf;
  }
  const Vec3 translation = to_y_up(stored.origin);
  gltf.json["scenes"] = Json::array({{{"nodes", {0}}}});
  if (volume.georeference) {
    gltf.json["scenes"][0]["extras"]["vantage"]["georeference"] = io::georeference_json(*volume.georeference);
  }
  gltf.json["nodes"] = Json::array({{{"name", "visibility volume"},
                                     {"mesh", 0},
                                     {"translation", {translation.x(), translation.y(), translation.z()}}}});
  Json primitives = Json::array();
  const std::size_t positions = add_positions(gltf, stored);
  for (const CauseKind kind : kKinds) add_primitive(gltf, volume, stored, kind, positions, primitives);
  gltf.json["meshes"] = Json::array({{{"name", "visibility volume"}, {"primitives", std::move(primitives)}}});
  gltf.json["buffers"] = Json::array({{{"byteLength", gltf.buffer.size()}}});
  return gltf;
}

}  // namespace

void write_glb(const Volume& volume, const StoredMesh& stored, AtomicFile& file) {
  const Gltf gltf = make_gltf(volume, stored);
  write_glb_container(gltf.json.dump(-1, ' ', false, Json::error_handler_t::replace), gltf.buffer, file);
}

}  // namespace vantage::internal::io
