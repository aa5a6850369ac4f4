// Which properties of features in tiles of 3D Tiles say who the features are. Each maker of tilesets has other names.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "vantage/scene.h"

namespace vantage::internal::io {

/// Names of properties; empty where there is none.
struct IdentityProperties {
  std::string id;       ///< unique among all tilesets: "gml_id", "identificatie"
  std::string number;   ///< unique in its tile, as far as is known: "id"
  std::string name;     ///< "name"
  std::string address;  ///< "bldg:address"
  std::string kind;     ///< "feature_type"
};

IdentityProperties identity_properties(const std::vector<std::string>& names);

/// The values of these properties; empty where there is none.
struct IdentityValues {
  std::string id, number, name, address, kind;
};

/// `tile`: what the tile is called, `feature`: the feature's number in it. The source id is the one that is unique, or
/// "TILE#NUMBER". The name is the name, or else the address.
SceneObject identity_of(const IdentityValues& values, std::string_view tile, std::uint64_t feature);

}  // namespace vantage::internal::io
