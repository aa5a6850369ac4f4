#include "support/tile_files.h"

#include <cmath>
#include <numbers>

#include "support/mesh_reading.h"

namespace vantage::testing {
namespace {

using nlohmann::json;

std::string padded(std::string bytes, std::size_t to, char with) {
  while (bytes.size() % to != 0) bytes += with;
  return bytes;
}

std::string glb_of(const json& gltf, const std::string& binary) {
  const std::string text = padded(gltf.dump(), 4, ' '), buffer = padded(binary, 4, '\0');
  return "glTF" + bytes_of(2u) + bytes_of(static_cast<std::uint32_t>(28 + text.size() + buffer.size())) +
         bytes_of(static_cast<std::uint32_t>(text.size())) + "JSON" + text +
         bytes_of(static_cast<std::uint32_t>(buffer.size())) + std::string("BIN\0", 4) + buffer;
}

std::string table_text(const json& table) { return table.empty() ? "" : padded(table.dump(), 8, ' '); }

std::string size_of_text(const std::string& text) { return bytes_of(static_cast<std::uint32_t>(text.size())); }

std::string tile_of(const std::string& magic, const std::string& tables_and_rest, const std::string& sizes) {
  const std::size_t length = 12 + sizes.size() + tables_and_rest.size();
  return magic + bytes_of(1u) + bytes_of(static_cast<std::uint32_t>(length)) + sizes + tables_and_rest;
}

}  // namespace

std::string box_glb(const std::vector<TileBox>& boxes, const std::string& ids, json extra) {
  constexpr int kFaces[12][3] = {{0, 1, 2}, {1, 3, 2}, {4, 6, 5}, {5, 6, 7}, {0, 4, 1}, {1, 4, 5},
                                 {2, 3, 6}, {3, 7, 6}, {0, 2, 4}, {2, 6, 4}, {1, 5, 3}, {3, 5, 7}};
  std::string positions, features, indices;
  for (std::size_t b = 0; b < boxes.size(); ++b) {
    for (int i = 0; i < 8; ++i) {
      const Vec3 at = boxes[b].corner + Vec3((i & 1) != 0, (i & 4) != 0 ? boxes[b].height : 0, (i & 2) != 0);
      for (int k = 0; k < 3; ++k) positions += bytes_of(static_cast<float>(at[k]));
      features += bytes_of(static_cast<float>(boxes[b].feature));
    }
    for (const auto& face : kFaces) {
      for (const int corner : face) indices += bytes_of(static_cast<std::uint32_t>(8 * b + corner));
    }
  }
  json gltf = extra.is_object() ? std::move(extra) : json::object();
  gltf["asset"] = {{"version", "2.0"}};
  gltf["scenes"] = {{{"nodes", {0}}}};
  gltf["scene"] = 0;
  if (!gltf.contains("nodes")) gltf["nodes"] = {{{"mesh", 0}, {"name", "house"}}};
  json primitive = {{"attributes", {{"POSITION", 0}}}, {"indices", 1}};
  if (!ids.empty()) primitive["attributes"][ids] = 2;
  if (ids == "_FEATURE_ID_0") {
    primitive["extensions"]["EXT_mesh_features"]["featureIds"] = {{{"attribute", 0}, {"propertyTable", 0}}};
  }
  if (gltf.contains("featureIds")) {
    primitive["extensions"]["EXT_mesh_features"]["featureIds"] = gltf["featureIds"];
    gltf.erase("featureIds");
  }
  gltf["meshes"] = {{{"primitives", {primitive}}}};
  const std::size_t vertices = 8 * boxes.size();
  gltf["accessors"] = {{{"bufferView", 0}, {"componentType", 5126}, {"count", vertices}, {"type", "VEC3"}},
                       {{"bufferView", 1}, {"componentType", 5125}, {"count", 36 * boxes.size()}, {"type", "SCALAR"}},
                       {{"bufferView", 2}, {"componentType", 5126}, {"count", vertices}, {"type", "SCALAR"}}};
  std::string binary;
  const auto view = [&](const std::string& bytes) {
    const json result = {{"buffer", 0}, {"byteOffset", binary.size()}, {"byteLength", bytes.size()}};
    binary += padded(bytes, 4, '\0');
    return result;
  };
  gltf["bufferViews"] = {view(positions), view(indices), view(features)};
  if (gltf.contains("more")) {  // further buffer views, as texts
    for (const json& bytes : gltf["more"]) gltf["bufferViews"].push_back(view(bytes.get<std::string>()));
    gltf.erase("more");
  }
  gltf["buffers"] = {{{"byteLength", binary.size()}}};
  return glb_of(gltf, binary);
}

std::string b3dm(const std::string& glb, const json& features, const json& batch, const std::string& batch_binary) {
  const std::string feature_text = table_text(features), batch_text = table_text(batch);
  return tile_of("b3dm", feature_text + batch_text + batch_binary + glb,
                 size_of_text(feature_text) + bytes_of(0u) + size_of_text(batch_text) + size_of_text(batch_binary));
}

std::string i3dm(const std::string& glb_or_uri, const json& features, const std::string& binary, const json& batch,
                 bool embedded) {
  const std::string feature_text = table_text(features), batch_text = table_text(batch);
  return tile_of("i3dm", feature_text + binary + batch_text + glb_or_uri,
                 size_of_text(feature_text) + size_of_text(binary) + size_of_text(batch_text) + bytes_of(0u) +
                     bytes_of(embedded ? 1u : 0u));
}

std::string pnts(const json& features, const std::string& binary) {
  const std::string feature_text = table_text(features);
  return tile_of("pnts", feature_text + binary,
                 size_of_text(feature_text) + size_of_text(binary) + bytes_of(0u) + bytes_of(0u));
}

std::string cmpt(const std::vector<std::string>& parts) {
  std::string inside;
  for (const std::string& part : parts) inside += part;
  return "cmpt" + bytes_of(1u) + bytes_of(static_cast<std::uint32_t>(16 + inside.size())) +
         bytes_of(static_cast<std::uint32_t>(parts.size())) + inside;
}

std::string subtree(const json& described, const std::string& binary) {
  const std::string text = padded(described.dump(), 8, ' ');
  return "subt" + bytes_of(1u) + bytes_of(std::uint64_t{text.size()}) + bytes_of(std::uint64_t{binary.size()}) + text +
         binary;
}

json tileset_json(json root, double error, const std::string& version) {
  return {{"asset", {{"version", version}}}, {"geometricError", error}, {"root", std::move(root)}};
}

json tile_json(double error, const std::string& uri, double half) {
  json tile = {{"geometricError", error}, {"boundingVolume", {{"box", {0, 0, 0, half, 0, 0, 0, half, 0, 0, 0, half}}}}};
  if (!uri.empty()) tile["content"] = {{"uri", uri}};
  return tile;
}

json transform_at(double latitude_deg, double longitude_deg) {
  const double a = 6378137.0, f = 1 / 298.257223563, e2 = f * (2 - f);
  const double phi = latitude_deg * std::numbers::pi / 180, lambda = longitude_deg * std::numbers::pi / 180;
  const double n = a / std::sqrt(1 - e2 * std::sin(phi) * std::sin(phi));
  return {-std::sin(lambda),
          std::cos(lambda),
          0,
          0,
          -std::sin(phi) * std::cos(lambda),
          -std::sin(phi) * std::sin(lambda),
          std::cos(phi),
          0,
          std::cos(phi) * std::cos(lambda),
          std::cos(phi) * std::sin(lambda),
          std::sin(phi),
          0,
          n * std::cos(phi) * std::cos(lambda),
          n * std::cos(phi) * std::sin(lambda),
          n * (1 - e2) * std::sin(phi),
          1};
}

}  // namespace vantage::testing
