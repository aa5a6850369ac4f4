#include <algorithm>
#include <charconv>

#include "maps/osm/extract.h"

namespace vantage::internal::osm {

std::string text(ObjectId id) {
  const char* const type = id.type == ObjectType::node ? "node/" : id.type == ObjectType::way ? "way/" : "relation/";
  return type + std::to_string(id.id);
}

std::optional<ObjectId> parse_object_id(std::string_view text) {
  for (const ObjectType type : {ObjectType::node, ObjectType::way, ObjectType::relation}) {
    const std::string prefix = osm::text(ObjectId{type, 0});  // "way/0"
    const std::string_view long_form = std::string_view{prefix}.substr(0, prefix.size() - 1);
    std::string_view number;
    if (text.starts_with(long_form)) {
      number = text.substr(long_form.size());
    } else if (text.starts_with(long_form.front())) {
      number = text.substr(1);
    } else {
      continue;
    }
    ObjectId id{type, 0};
    const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), id.id);
    if (error == std::errc() && end == number.data() + number.size() && !number.empty()) return id;
  }
  return std::nullopt;
}

std::string_view Tags::get(std::string_view key) const {
  const auto found = std::find_if(all.begin(), all.end(), [key](const auto& tag) { return tag.first == key; });
  return found == all.end() ? std::string_view() : std::string_view{found->second};
}

bool Tags::has(std::string_view key) const {
  return std::any_of(all.begin(), all.end(), [key](const auto& tag) { return tag.first == key; });
}

}  // namespace vantage::internal::osm
