// What is out of its range is told of its key.
#pragma once

#include <array>
#include <limits>
#include <optional>
#include <string>

#include "request/description.h"
#include "vantage/error.h"
#include "vantage/tour.h"

namespace vantage::internal::request {

/// A visitor that throws Error(input) at the first number that its key does not take, whatever the other settings are.
class Checker : Visitor {
 public:
  explicit Checker(std::string_view section) : section_(section) {}

  template <typename Value, typename Choices>
  void choice(const Key& /*key*/, const Value& /*value*/, const Choices& /*choices*/) {}
  void number(const Key& key, double value, const Bounds& bounds, const Only& /*only*/) const {
    if (key.is_none_at_zero && value == 0) return;
    if (!key.is_none_at_infinity || value != std::numeric_limits<double>::infinity()) {
      check_within(bounds, value, name_of(key));
    }
  }
  void number(const Key& key, const std::optional<double>& value, const Bounds& bounds, const Only& /*only*/) const {
    if (value) check_within(bounds, *value, name_of(key));
  }
  template <typename Settings>
  void map(const Key& key, const std::optional<Settings>& value) const {
    if (!value) return;
    Checker inner(name_of(key));
    describe(*value, inner);
  }
  template <typename Settings>
  void instead(const Key& /*key*/) const {}
  void pair(const Key& key, double low, const Bounds& of_low, double high, const Bounds& of_high,
            const Only& /*only*/) const {
    check_within(of_low, low, name_of(key) + "[0]");
    check_within(of_high, high, name_of(key) + "[1]");
  }
  void whole(const Key& key, int value, const Bounds& bounds) const { check_within(bounds, value, name_of(key)); }
  void flag(const Key& /*key*/, bool /*value*/) {}
  void grid(const Key& key, const std::optional<std::array<int, 2>>& value, const Bounds& of_first,
            const Bounds& of_second) const {
    if (!value) return;
    check_within(of_first, (*value)[0], name_of(key) + "[0]");
    check_within(of_second, (*value)[1], name_of(key) + "[1]");
  }
  template <typename Device>
  void device(const Key& /*key*/, const Device& /*value*/) {}
  void home(const Key& key, const std::optional<TourHome>& value) const {
    if (!value || !value->position || value->position->allFinite()) return;
    throw Error(ErrorCode::coordinate_not_finite, name_of(key) + " is not finite", name_of(key), "give finite numbers");
  }

 private:
  std::string name_of(const Key& key) const { return section_ + "." + std::string(key.path); }

  std::string section_;
};

}  // namespace vantage::internal::request
