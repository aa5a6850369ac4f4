// What is set, as an object of JSON.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <utility>

#include "request/description.h"

namespace vantage::internal::request {

/// A visitor. Its keys are those of the mission file with their units: "min_edge_m". Settings of the machine, such as a
/// device, are left out. `number_as` makes JSON of a double; what is not given is null.
template <typename Json, typename NumberAs>
class JsonObject : Visitor {
 public:
  explicit JsonObject(NumberAs number_as) : number_as_(std::move(number_as)) {}

  template <typename Value, typename Choices>
  void choice(const Key& key, const Value& value, const Choices& choices) {
    add(key, Unit::none) = std::string(word_of(choices, value));
  }
  void number(const Key& key, double value, const Bounds& bounds, const Only& /*only*/) {
    add(key, bounds.unit) = number_as_(value);
  }
  void whole(const Key& key, int value, const Bounds& bounds) { add(key, bounds.unit) = number_as_(value); }
  void grid(const Key& key, const std::optional<std::array<int, 2>>& value, const Bounds& /*of_first*/,
            const Bounds& /*of_second*/) {
    add(key, Unit::none) = value ? Json{number_as_((*value)[0]), number_as_((*value)[1])} : Json();
  }
  template <typename Device>
  void device(const Key& /*key*/, const Device& /*value*/) {}

  const Json& json() const { return json_; }

 private:
  Json& add(const Key& key, Unit unit) { return json_[std::string(key.path).append(suffix_of(unit))]; }

  NumberAs number_as_;
  Json json_ = Json::object();
};

}  // namespace vantage::internal::request
