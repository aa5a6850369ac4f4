#include "tiles/tables.h"

#include <array>
#include <cmath>
#include <cstring>
#include <utility>

#include "common/input.h"
#include "io/json_text.h"

namespace vantage::internal::tiles {
namespace {

template <class T>
double value_at(const char* data) {
  T value;
  std::memcpy(&value, data, sizeof value);
  return static_cast<double>(value);
}

struct Component {
  std::string_view name;
  std::size_t size;
  double (*load)(const char*);
};
constexpr std::array<Component, 8> kComponents = {{{"BYTE", 1, value_at<std::int8_t>},
                                                   {"UNSIGNED_BYTE", 1, value_at<std::uint8_t>},
                                                   {"SHORT", 2, value_at<std::int16_t>},
                                                   {"UNSIGNED_SHORT", 2, value_at<std::uint16_t>},
                                                   {"INT", 4, value_at<std::int32_t>},
                                                   {"UNSIGNED_INT", 4, value_at<std::uint32_t>},
                                                   {"FLOAT", 4, value_at<float>},
                                                   {"DOUBLE", 8, value_at<double>}}};

/// Element `index`, of `components` numbers, of a property whose values begin at "byteOffset".
const char* element(const Json& property, std::string_view binary, std::uint64_t index, std::size_t bytes) {
  const auto offset = property.find("byteOffset");
  const double start = offset != property.end() && offset->is_number() ? offset->get<double>() : -1;
  if (!(start >= 0 && start <= static_cast<double>(binary.size())) || start != std::floor(start)) {
    throw std::string("a \"byteOffset\" goes beyond the end of its table");
  }
  const std::uint64_t room = binary.size() - static_cast<std::uint64_t>(start);
  if (bytes == 0 || index >= room / bytes) throw std::string("a property goes beyond the end of its table");
  return binary.data() + static_cast<std::uint64_t>(start) + index * bytes;
}

const Component& component_named(const std::string& name) {
  for (const Component& component : kComponents) {
    if (component.name == name) return component;
  }
  throw std::string("a property has an unknown \"componentType\"");
}

std::string type_named(const Json& property, const char* otherwise) {
  const auto type = property.find("componentType");
  return type != property.end() && type->is_string() ? type->get<std::string>() : otherwise;
}

}  // namespace

Table::Table(std::string_view json, std::string_view binary, const core::ProgressReporter& progress,
             const core::ReadLimits& limits)
    : json_(Json::object()), binary_(binary) {
  is_empty_ = json.find_first_not_of(std::string_view(" \t\r\n\0", 5)) == std::string_view::npos;
  if (is_empty_) return;
  try {
    json_ = io::parse_json(json.substr(0, json.find('\0')), progress, limits);
  } catch (const io::JsonProblem& problem) {
    throw "a table: " + problem.text;
  }
  if (!json_.is_object()) throw std::string("a table is not an object");
}

std::optional<std::vector<double>> Table::global(const char* name, std::size_t count) const {
  const auto found = json_.find(name);
  if (found == json_.end()) return std::nullopt;
  std::vector<double> values;
  if (found->is_object()) {
    const Component& component = component_named(type_named(*found, "FLOAT"));
    const char* const data = element(*found, binary_, 0, component.size * count);
    for (std::size_t i = 0; i < count; ++i) values.push_back(component.load(data + i * component.size));
  } else if (found->is_array()) {
    for (const Json& value : *found) values.push_back(value.is_number() ? value.get<double>() : NAN);
  }
  bool is_finite = values.size() == count;
  for (const double value : values) is_finite = is_finite && std::isfinite(value);
  if (!is_finite) throw std::string("\"") + name + "\" does not hold " + std::to_string(count) + " numbers";
  return values;
}

std::uint64_t Table::whole(const char* name) const {
  const auto found = json_.find(name);
  if (found == json_.end()) throw std::string("\"") + name + "\" is missing";
  const double value = found->is_number()   ? found->get<double>()
                       : found->is_object() ? value_at<std::uint32_t>(element(*found, binary_, 0, 4))
                                            : -1;
  if (!(value >= 0 && value < 4294967296.0) || value != std::floor(value)) {
    throw std::string("\"") + name + "\" is not a whole number";
  }
  return static_cast<std::uint64_t>(value);
}

std::optional<std::vector<double>> Table::per_instance(const char* name, std::size_t components, std::size_t count,
                                                       const char* type) const {
  const auto found = json_.find(name);
  if (found == json_.end()) return std::nullopt;
  if (!found->is_object()) throw std::string("\"") + name + "\" is not an object";
  const Component& component = component_named(type_named(*found, type));
  const std::size_t bytes = component.size * components;
  if (count == 0) return std::vector<double>();
  element(*found, binary_, count - 1, bytes);  // all are there
  const char* const data = element(*found, binary_, 0, bytes);
  std::vector<double> values(components * count);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = component.load(data + i * component.size);
  return values;
}

std::string property_text(const Json& values, std::string_view binary, std::uint64_t index) {
  if (values.is_array()) {
    if (index >= values.size()) return {};
    const Json& value = values[index];
    if (value.is_string()) return value.get<std::string>();
    return value.is_number() ? value.dump() : "";
  }
  const auto type = values.find("type");
  if (type == values.end() || *type != "SCALAR") return {};
  const Component& component = component_named(type_named(values, ""));
  return shortest(component.load(element(values, binary, index, component.size)));
}

std::vector<std::uint32_t> whole_numbers(const Json& values, const std::string& name, std::uint64_t count,
                                         std::string_view binary) {
  std::vector<std::uint32_t> numbers;
  if (values.is_array()) {
    if (values.size() != count) {
      throw "\"" + name + "\" has " + std::to_string(values.size()) + " values instead of " + std::to_string(count);
    }
    for (const Json& value : values) {
      if (!value.is_number_unsigned() || value.get<std::uint64_t>() > 0xffffffffU) {
        throw "\"" + name + "\" holds something other than whole numbers";
      }
      numbers.push_back(value.get<std::uint32_t>());
    }
    return numbers;
  }
  if (!values.is_object()) throw "\"" + name + "\" is neither an array nor an object";
  const std::string type = type_named(values, "UNSIGNED_SHORT");
  if (!type.starts_with("UNSIGNED_")) throw "\"" + name + "\" is of a \"componentType\" other than whole numbers";
  const Component& component = component_named(type);
  if (count == 0) return numbers;
  element(values, binary, count - 1, component.size);  // all are there
  const char* const data = element(values, binary, 0, component.size);
  numbers.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    numbers[i] = static_cast<std::uint32_t>(component.load(data + i * component.size));
  }
  return numbers;
}

/// A garbled table says less of who hides something. It must not take away what hides.
BatchTable::BatchTable(std::string_view json, std::string_view binary, std::string tile,
                       const core::ProgressReporter& progress, const core::ReadLimits& limits)
    : table_({}, {}, progress, limits), binary_(binary), tile_(std::move(tile)) {
  try {
    table_ = Table(json, binary, progress, limits);
  } catch (const std::string& problem) {
    unreadable_.add("the batch table: " + problem);
  }
  std::vector<std::string> names;
  for (const auto& [name, value] : table_.json().items()) {
    if (value.is_array() || value.is_object()) names.push_back(name);
  }
  known_ = io::identity_properties(names);
  read_hierarchy(progress);
}

void BatchTable::read_hierarchy(const core::ProgressReporter& progress) {
  const auto extensions = table_.json().find("extensions");
  if (extensions == table_.json().end() || !extensions->is_object()) return;
  const auto described = extensions->find("3DTILES_batch_table_hierarchy");
  if (described == extensions->end()) return;
  try {
    hierarchy_.emplace(*described, binary_, progress, unreadable_);
  } catch (const std::string& problem) {
    unreadable_.add("the hierarchy of the batch table: " + problem);
  }
}

SceneObject BatchTable::identity(std::uint64_t feature) {
  constexpr std::size_t kMostInherited = std::size_t{64} << 20;  // a tile of a million features has 40 of names
  io::IdentityValues own{value(known_.id, feature), value(known_.number, feature), value(known_.name, feature),
                         value(known_.address, feature), value(known_.kind, feature)};
  if (!hierarchy_) return io::identity_of(own, tile_, feature);
  if (feature >= hierarchy_->size()) {
    unreadable_.add("feature " + std::to_string(feature) + " is no instance of the hierarchy, which has " +
                    std::to_string(hierarchy_->size()));
    return io::identity_of(own, tile_, feature);
  }
  const Hierarchy::Known known = hierarchy_->known(feature);
  inherited_bytes_ += known.bytes();
  if (inherited_bytes_ > kMostInherited) {
    unreadable_.add("the names of the hierarchy have more than 64 MiB together");
    return io::identity_of(own, tile_, feature);
  }
  const bool has_label = !own.name.empty() || !own.address.empty();
  if (own.id.empty() && own.number.empty()) {
    own.id = known.values.id;
    own.number = known.values.number;
  }
  if (!has_label) {
    own.name = known.values.name;
    own.address = known.values.address;
  }
  SceneObject object = io::identity_of(own, tile_, has_label ? feature : known.instance);
  if (object.kind == ObjectKind::other) object.kind = known.kind;
  return object;
}

std::string BatchTable::value(const std::string& property, std::uint64_t feature) {
  if (property.empty()) return {};
  try {
    return property_text(table_.json()[property], binary_, feature);
  } catch (const std::string& problem) {
    unreadable_.add("the property \"" + property + "\" of the batch table: " + problem);
    return {};
  }
}

}  // namespace vantage::internal::tiles
