// Small tilesets of 3D Tiles, made by code.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "vantage/geometry.h"

namespace vantage::testing {

/// A GLB of boxes. Each box is one metre wide in x and z, stands on y = 0 at `corner`, and is `height` high (y is up).
struct TileBox {
  Vec3 corner = Vec3::Zero();
  double height = 1;
  int feature = 0;  ///< as _BATCHID, or _FEATURE_ID_0
};
/// `ids`: the attribute of the features; empty for none. `extra`: members of the glTF; "more": texts that become buffer
/// views from 3 on; "featureIds": the sets of EXT_mesh_features.
std::string box_glb(const std::vector<TileBox>& boxes, const std::string& ids = "", nlohmann::json extra = {});

/// The tables may be empty.
std::string b3dm(const std::string& glb, const nlohmann::json& features = {{"BATCH_LENGTH", 0}},
                 const nlohmann::json& batch = {}, const std::string& batch_binary = "");
std::string i3dm(const std::string& glb_or_uri, const nlohmann::json& features, const std::string& binary,
                 const nlohmann::json& batch = {}, bool embedded = true);
/// A cloud of points.
std::string pnts(const nlohmann::json& features, const std::string& binary);
std::string cmpt(const std::vector<std::string>& parts);
/// With one byte of availability for tiles, contents and child subtrees each, or constants.
std::string subtree(const nlohmann::json& json, const std::string& binary = "");

/// A tileset.json with this root.
nlohmann::json tileset_json(nlohmann::json root, double error = 100, const std::string& version = "1.1");
/// A tile about the origin: a box of `half` metres.
nlohmann::json tile_json(double error, const std::string& uri = "", double half = 100);

/// The 16 numbers of the frame that touches the earth at a place: x east, y north, z up.
nlohmann::json transform_at(double latitude_deg, double longitude_deg);

}  // namespace vantage::testing
