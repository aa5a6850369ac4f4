#include "io/feature_identity.h"

#include <algorithm>
#include <array>
#include <initializer_list>
#include <span>

namespace vantage::internal::io {
namespace {

// In the order in which they are preferred. "gml_id" and "bldg:address": PLATEAU; "identificatie": 3DBAG; "EGID" and
// "UUID": swisstopo.
constexpr std::array<std::string_view, 12> kIds = {"gml_id",   "gml:id", "gmlid", "_gml_id", "identificatie", "uuid",
                                                   "globalid", "bag_id", "egid",  "osm_id",  "cityobjectid",  "guid"};
constexpr std::array<std::string_view, 6> kNumbers = {"id", "feature_id", "featureid", "objectid", "fid", "batchid"};
constexpr std::array<std::string_view, 6> kNames = {"gml:name", "name", "bldg:name", "label", "title", "gml_name"};
constexpr std::array<std::string_view, 5> kAddresses = {"bldg:address", "address", "addr:full", "adresse", "adres"};
constexpr std::array<std::string_view, 6> kKinds = {"feature_type", "featuretype",   "class",
                                                    "type",         "citygml_class", "objecttype"};

std::string lower(std::string_view text) {
  std::string result(text);
  std::transform(result.begin(), result.end(), result.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return result;
}

std::string first_of(std::span<const std::string_view> wanted, const std::vector<std::string>& names) {
  for (const std::string_view one : wanted) {
    const auto found = std::find_if(names.begin(), names.end(), [&](const auto& name) { return lower(name) == one; });
    if (found != names.end()) return *found;
  }
  return {};
}

}  // namespace

ObjectKind kind_of_feature(const std::string& type) {
  const std::string text = lower(type);
  const auto says = [&](std::initializer_list<std::string_view> words) {
    return std::any_of(words.begin(), words.end(),
                       [&](std::string_view word) { return text == word || text.ends_with(":" + std::string(word)); });
  };
  if (says({"building"})) return ObjectKind::building;
  if (says({"buildingpart"})) return ObjectKind::building_part;
  if (says({"bridge", "bridgepart"})) return ObjectKind::bridge;
  if (says({"solitaryvegetationobject", "tree"})) return ObjectKind::tree;
  if (says({"relieffeature", "tinrelief", "terrain", "ground"})) return ObjectKind::ground;
  return ObjectKind::other;
}

IdentityProperties identity_properties(const std::vector<std::string>& names) {
  return {first_of(kIds, names), first_of(kNumbers, names), first_of(kNames, names), first_of(kAddresses, names),
          first_of(kKinds, names)};
}

SceneObject identity_of(const IdentityValues& values, std::string_view tile, std::uint64_t feature) {
  SceneObject object;
  object.name = values.name.empty() ? values.address : values.name;
  object.kind = kind_of_feature(values.kind);
  const std::string number = values.number.empty() ? std::to_string(feature) : values.number;
  object.source_id = values.id.empty() ? std::string(tile) + "#" + number : values.id;
  return object;
}

}  // namespace vantage::internal::io
