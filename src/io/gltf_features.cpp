#include "io/gltf_features.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

#include "common/input.h"

namespace vantage::internal::io::gltf {
namespace {

constexpr const char* kMetadata = "EXT_structural_metadata";

template <class T>
std::string number_at(const char* data) {
  T value;
  std::memcpy(&value, data, sizeof value);
  if constexpr (std::is_floating_point_v<T>) return std::isfinite(value) ? shortest(value) : "";
  return std::to_string(value);
}

struct NumberType {
  std::string_view name;
  std::uint64_t size;
  std::string (*text)(const char*);
};
constexpr std::array<NumberType, 10> kNumberTypes = {{{"INT8", 1, number_at<std::int8_t>},
                                                      {"UINT8", 1, number_at<std::uint8_t>},
                                                      {"INT16", 2, number_at<std::int16_t>},
                                                      {"UINT16", 2, number_at<std::uint16_t>},
                                                      {"INT32", 4, number_at<std::int32_t>},
                                                      {"UINT32", 4, number_at<std::uint32_t>},
                                                      {"INT64", 8, number_at<std::int64_t>},
                                                      {"UINT64", 8, number_at<std::uint64_t>},
                                                      {"FLOAT32", 4, number_at<float>},
                                                      {"FLOAT64", 8, number_at<double>}}};

std::uint64_t whole_at(const char* data, std::uint64_t size) {
  std::uint64_t value = 0;
  std::memcpy(&value, data, size);
  return value;
}

}  // namespace

std::optional<std::uint64_t> FeatureIds::of(std::uint64_t element) const {
  std::uint64_t id = element;
  if (values) {
    if (element >= values->count()) return std::nullopt;
    const double number = values->number(element, 0);
    if (!(number >= 0 && number < 9e15)) return std::nullopt;
    id = static_cast<std::uint64_t>(std::llround(number));
  }
  if (null_id && id == *null_id) return std::nullopt;
  return id;
}

const Json* Features::member(const Json& object, const char* key) const {
  const auto found = object.find(key);
  if (found == object.end()) return nullptr;
  if (!found->is_object()) document_.fail(std::string("\"") + key + "\" is not an object");
  return &*found;
}

const Features::Table* Features::table(std::uint64_t index) {
  if (const auto known = tables_.find(index); known != tables_.end()) return &known->second;
  const Json* const metadata = document_.extension(document_.root(), kMetadata);
  if (!metadata) return nullptr;
  const Json& all = document_.array(*metadata, "propertyTables");
  if (index >= all.size()) document_.fail("there is no property table number " + std::to_string(index));
  const Json& described = all[index];
  if (!described.is_object()) document_.fail("a property table is not an object");
  Table table;
  table.count = document_.required_whole(described, "count");
  table.properties = member(described, "properties");
  const Json* const schema = member(*metadata, "schema");
  const Json* const classes = schema ? member(*schema, "classes") : nullptr;
  const Json* const own = classes ? member(*classes, document_.text(described, "class").c_str()) : nullptr;
  table.classes = own ? member(*own, "properties") : nullptr;
  if (table.properties && table.classes) {
    std::vector<std::string> names;
    for (const auto& [name, value] : table.properties->items()) {
      if (value.is_object() && table.classes->contains(name)) names.push_back(name);
    }
    table.known = identity_properties(names);
  }
  return &(tables_[index] = table);
}

/// Null where there is none, or a garbled one.
const Features::Table* Features::table_or_nothing(std::uint64_t index) {
  if (index == FeatureIds::kNoTable) return nullptr;
  try {
    return table(index);
  } catch (const Error& error) {
    if (error.code() != ErrorCode::mesh_syntax) throw;
    unreadable_.add(error.problem());
    return nullptr;
  }
}

/// Of several sets of features the first whose table says who these are, or else the first.
std::optional<FeatureIds> Features::best_of(const Json& sets,
                                            const std::function<Accessor(const std::string&)>& attribute) {
  std::optional<FeatureIds> best;
  for (const Json& set : sets) {
    if (!set.is_object()) document_.fail("a set of feature ids is not an object");
    if (set.contains("texture")) continue;  // that is seen from its image alone, and no image is read
    FeatureIds ids;
    ids.table = document_.whole(set, "propertyTable").value_or(FeatureIds::kNoTable);
    ids.null_id = document_.whole(set, "nullFeatureId");
    if (const auto number = document_.whole(set, "attribute")) {
      ids.values = attribute("_FEATURE_ID_" + std::to_string(*number));
    }
    const Table* const known = table_or_nothing(ids.table);
    if (!known) ids.table = FeatureIds::kNoTable;
    const bool says_who = known && (!known->known.id.empty() || !known->known.name.empty());
    if (says_who) return ids;
    if (!best) best = ids;
  }
  return best;
}

std::optional<FeatureIds> Features::of_primitive(const Json& primitive,
                                                 const std::map<std::string, Accessor>& attributes) {
  const auto accessor = [&](const std::string& name) {
    if (const auto known = attributes.find(name); known != attributes.end()) return known->second;
    const Json* const named = member(primitive, "attributes");
    return document_.accessor(document_.required_whole(named ? *named : primitive, name.c_str()));
  };
  if (const Json* const features = document_.extension(primitive, "EXT_mesh_features")) {
    const Json& sets = document_.array(*features, "featureIds");
    const auto is_by_texture = [](const Json& set) { return set.is_object() && set.contains("texture"); };
    if (std::any_of(sets.begin(), sets.end(), is_by_texture)) ++by_texture_;
    return best_of(sets, accessor);
  }
  const Json* const named = member(primitive, "attributes");
  if (!batch_ || !named || !named->contains("_BATCHID")) return std::nullopt;
  FeatureIds ids;
  ids.table = FeatureIds::kBatchTable;
  ids.values = accessor("_BATCHID");
  return ids;
}

std::optional<FeatureIds> Features::of_node(const Json& node) {
  const Json* const features = document_.extension(node, "EXT_instance_features");
  const Json* const instances = document_.extension(node, "EXT_mesh_gpu_instancing");
  if (!features || !instances) return std::nullopt;
  return best_of(document_.array(*features, "featureIds"), [&](const std::string& name) {
    const Json* const named = member(*instances, "attributes");
    return document_.accessor(document_.required_whole(named ? *named : *instances, name.c_str()));
  });
}

SceneObject Features::identity(std::uint64_t index, std::uint64_t id) {
  if (index == FeatureIds::kBatchTable) return batch_(id);
  const Table* const known = index == FeatureIds::kNoTable ? nullptr : table(index);
  if (!known || id >= known->count) return identity_of({}, tile_, id);
  const IdentityProperties& names = known->known;
  const auto text = [&](const std::string& name) { return value_or_nothing(*known, name, id); };
  return identity_of({text(names.id), text(names.number), text(names.name), text(names.address), text(names.kind)},
                     tile_, id);
}

/// A garbled table says less of who hides something. It must not take away what hides.
std::string Features::value_or_nothing(const Table& from, const std::string& name, std::uint64_t row) {
  try {
    return value(from, name, row);
  } catch (const Error& error) {
    if (error.code() != ErrorCode::mesh_syntax) throw;
    unreadable_.add(error.problem());
    return {};
  }
}

/// As text; empty for what is neither a text nor a number.
std::string Features::value(const Table& from, const std::string& name, std::uint64_t row) {
  if (name.empty()) return {};
  const Json& property = (*from.properties)[name];
  const Json& kind = (*from.classes)[name];
  if (!kind.is_object() || kind.value("array", Json(false)) == Json(true)) return {};
  const std::string type = document_.text(kind, "type");
  if (type == "STRING") return text_value(property, row, from.count);
  if (type != "SCALAR") return {};
  const std::string component = document_.text(kind, "componentType");
  for (const NumberType& number : kNumberTypes) {
    if (number.name != component) continue;
    const std::string_view bytes = document_.view(document_.required_whole(property, "values"));
    if (row >= bytes.size() / number.size) document_.fail("the property \"" + name + "\" has too few values");
    return number.text(bytes.data() + row * number.size);
  }
  return {};
}

std::string Features::text_value(const Json& property, std::uint64_t row, std::uint64_t count) {
  const std::string type = document_.text(property, "stringOffsetType");
  const std::uint64_t size = type == "UINT8" ? 1 : type == "UINT16" ? 2 : type == "UINT64" ? 8 : 4;
  const std::string_view bytes = document_.view(document_.required_whole(property, "values"));
  const std::string_view offsets = document_.view(document_.required_whole(property, "stringOffsets"));
  if (count >= offsets.size() / size) document_.fail("a property of texts has too few offsets");
  const std::uint64_t first = whole_at(offsets.data() + row * size, size);
  const std::uint64_t last = whole_at(offsets.data() + (row + 1) * size, size);
  if (first > last || last > bytes.size()) document_.fail("an offset of a property of texts goes beyond its values");
  return std::string(bytes.substr(first, last - first));
}

}  // namespace vantage::internal::io::gltf
