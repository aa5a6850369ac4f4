// What is read from certificates, value by value.
#include <cmath>

#include "flight/judge/judged_proofs.h"

namespace vantage::internal::flight::judge {

const Json& list_of(const Json& json, std::optional<std::size_t> count) {
  demand(json.is_array(), "there is no list where one should be");
  demand(!count || json.size() == *count, "a list is too long or too short");
  return json;
}

BigInteger whole_of(const Json& json, int bits) {
  constexpr double kLargest = 1e15;
  demand(json.is_number(), "there is no number where one should be");
  const auto value = json.get<double>();  // integers up to 1e15 are exact
  demand(std::abs(value) <= kLargest, "a number is too large, or none");
  demand(fraction_bits(value) <= bits, "a number is too fine");
  return BigInteger::scaled(value, bits);
}

std::size_t index_of(const Json& json, std::size_t end) {
  demand(json.is_number_integer(), "there is no whole number where one should be");
  demand(json.is_number_unsigned() && json.get<std::uint64_t>() < end, "an index is out of range");
  return json.get<std::size_t>();
}

void demand_keys(const Json& json, std::span<const char* const> keys, const char* problem) {
  demand(json.is_object() && json.size() == keys.size(), problem);
  for (const char* key : keys) demand(json.contains(key), problem);
}

}  // namespace vantage::internal::flight::judge
