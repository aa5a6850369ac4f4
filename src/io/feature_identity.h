// Which properties of features in tiles of 3D Tiles say who the features are. Each maker of tilesets has other names.
#pragma once

#include <cstdint>
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

/// ObjectKind::other for what it does not know.
ObjectKind kind_of_feature(const std::string& type);

/// Names and ids of features that are garbled: taken as missing.
struct UnreadableProperties {
  std::uint64_t count = 0;
  std::string first = {};  ///< what is wrong with the first

  void add(const std::string& problem) {
    if (count++ == 0) first = problem;
  }
  void add(const UnreadableProperties& more) {
    if (count == 0) first = more.first;
    count += more.count;
  }
};

}  // namespace vantage::internal::io
