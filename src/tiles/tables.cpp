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

BatchTable::BatchTable(std::string_view json, std::string_view binary, std::string tile,
                       const core::ProgressReporter& progress, const core::ReadLimits& limits)
    : binary_(binary), tile_(std::move(tile)) {
  table_.emplace(json, binary, progress, limits);
  std::vector<std::string> names;
  for (const auto& [name, value] : table_->json().items()) {
    if (value.is_array() || value.is_object()) names.push_back(name);
  }
  known_ = io::identity_properties(names);
}

SceneObject BatchTable::identity(std::uint64_t feature) const {
  return io::identity_of({value(known_.id, feature), value(known_.number, feature), value(known_.name, feature),
                          value(known_.address, feature), value(known_.kind, feature)},
                         tile_, feature);
}

/// As text; empty for what is neither a text nor a number.
std::string BatchTable::value(const std::string& property, std::uint64_t feature) const {
  if (property.empty()) return {};
  const Json& values = table_->json()[property];
  if (values.is_array()) {
    if (feature >= values.size()) return {};
    const Json& value = values[feature];
    if (value.is_string()) return value.get<std::string>();
    return value.is_number() ? value.dump() : "";
  }
  const auto type = values.find("type");
  if (type == values.end() || *type != "SCALAR") return {};
  try {
    const Component& component = component_named(type_named(values, ""));
    return shortest(component.load(element(values, binary_, feature, component.size)));
  } catch (const std::string&) {
    return {};  // a name less
  }
}

}  // namespace vantage::internal::tiles
