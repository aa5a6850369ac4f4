// What is set, as an object of JSON, and read from one.
#pragma once

#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "request/description.h"
#include "vantage/error.h"

namespace vantage::internal::request {

inline std::string name_in_json(const Key& key, Unit unit) { return std::string(key.path).append(suffix_of(unit)); }

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
    const bool is_none = (key.is_none_at_zero && value == 0) || (key.is_none_at_infinity && std::isinf(value));
    if (!is_none) add(key, bounds.unit) = number_as_(value);
  }
  void number(const Key& key, const std::optional<double>& value, const Bounds& bounds, const Only& /*only*/) {
    if (value) add(key, bounds.unit) = number_as_(*value);
  }
  void whole(const Key& key, int value, const Bounds& bounds) { add(key, bounds.unit) = number_as_(value); }
  void grid(const Key& key, const std::optional<std::array<int, 2>>& value, const Bounds& /*of_first*/,
            const Bounds& /*of_second*/) {
    add(key, Unit::none) = value ? Json{number_as_((*value)[0]), number_as_((*value)[1])} : Json();
  }
  template <typename Device>
  void device(const Key& /*key*/, const Device& /*value*/) {}

  template <typename Settings>
  void map(const Key& key, const std::optional<Settings>& value) {
    if (!value) return;
    JsonObject inner(number_as_);
    describe(*value, inner);
    add(key, Unit::none) = inner.json_;
  }
  template <typename Settings>
  void instead(const Key& /*key*/) {}
  const Json& json() const { return json_; }

 protected:
  NumberAs number_as_;
  Json json_ = Json::object();

 private:
  Json& add(const Key& key, Unit unit) { return json_[name_in_json(key, unit)]; }
};

/// A visitor that reads what JsonObject wrote with numbers as numbers. Throws what `Json` throws for what is missing or
/// of another type, and Error(input) for what is out of its range.
template <typename Json>
class JsonReader : Visitor {
 public:
  JsonReader(const Json& json, std::string_view section) : json_(json), section_(section) {}

  template <typename Value, typename Choices>
  void choice(const Key& key, Value& value, const Choices& choices) const {
    const std::string word = json_.at(name_in_json(key, Unit::none)).template get<std::string>();
    for (const auto& [one, its_word] : choices) {
      if (word != its_word) continue;
      value = one;
      return;
    }
    throw Error(ErrorCode::unknown_choice, "'" + word + "' is not known", name_of(key), std::string(key.form));
  }
  void number(const Key& key, double& value, const Bounds& bounds, const Only& /*only*/) const {
    const std::string name = name_in_json(key, bounds.unit);
    if ((key.is_none_at_zero || key.is_none_at_infinity) && !json_.contains(name)) return;
    value = json_.at(name).template get<double>();
    check_within(bounds, value, name_of(key));
  }
  void number(const Key& key, std::optional<double>& value, const Bounds& bounds, const Only& only) const {
    if (json_.contains(name_in_json(key, bounds.unit))) number(key, value.emplace(), bounds, only);
  }
  template <typename Settings>
  void map(const Key& key, std::optional<Settings>& value) const {
    const std::string name = name_in_json(key, Unit::none);
    if (!json_.contains(name)) return;
    JsonReader inner(json_.at(name), name_of(key));
    describe(value.emplace(), inner);
  }
  template <typename Settings>
  void instead(const Key& /*key*/) const {}

 protected:
  std::string name_of(const Key& key) const { return section_ + "." + std::string(key.path); }

  const Json& json_;
  std::string section_;
};

}  // namespace vantage::internal::request
