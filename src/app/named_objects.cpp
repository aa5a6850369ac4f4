#include "app/named_objects.h"

#include <algorithm>
#include <array>
#include <string_view>

#include "common/input.h"
#include "common/json.h"
#include "vantage/error.h"

namespace vantage::internal::app {
namespace {

/// "areas of the map" of "area of the map".
std::string plural_of(const std::string& what) {
  const std::size_t noun = std::min(what.find(' '), what.size());
  return what.substr(0, noun) + "s" + what.substr(noun);
}

}  // namespace

std::vector<std::uint32_t> objects_named(const Scene& scene, const std::string& name) {
  std::vector<std::uint32_t> found;
  for (std::uint32_t i = 0; i < scene.objects.size(); ++i) {
    const SceneObject& object = scene.objects[i];
    if (object.name == name || object.source_id == name || display_name(object) == name) found.push_back(i);
  }
  return found;
}

std::string yaml_text(const std::string& text) {
  const auto is_plain = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '/' || c == '_';
  };
  const bool begins_with_letter = !text.empty() && (text[0] < '0' || text[0] > '9') && text[0] != '/';
  // What YAML, of one version or another, reads as no text at all, in any case.
  constexpr std::array<std::string_view, 9> kNoTexts = {"null", "true", "false", "yes", "no", "on", "off", "y", "n"};
  const bool is_word = begins_with_letter && std::none_of(kNoTexts.begin(), kNoTexts.end(), [&](std::string_view no) {
                         return is_same_name(text, std::string{no});
                       });
  return is_word && std::all_of(text.begin(), text.end(), is_plain) ? text : json_text(std::string_view{text});
}

bool uses_part_of_map(const Mission& mission) {
  const CityRegion& region = mission.as_written.scene.city.region;
  return region.center_deg || region.bbox_deg;
}

bool is_same_name(const std::string& a, const std::string& b) {
  const auto lower = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; };
  return a.size() == b.size() &&
         std::equal(a.begin(), a.end(), b.begin(), [&](char x, char y) { return lower(x) == lower(y); });
}

std::string id_of_name(const std::vector<NamedId>& known, const std::string& name, const std::string& what,
                       const std::string& where, bool is_part) {
  constexpr std::size_t kMost = 8;
  for (const bool as_written : {true, false}) {
    std::set<std::string> ids;
    for (const NamedId& one : known) {
      if (as_written ? one.name == name : is_same_name(one.name, name)) ids.insert(one.id);
    }
    if (ids.size() == 1) return *ids.begin();
    if (ids.empty()) continue;
    std::string list;
    std::size_t listed = 0;
    for (const std::string& id : ids) {
      if (listed++ == kMost) break;
      list += (list.empty() ? "" : ", ") + id;
    }
    if (ids.size() > kMost) list += ", ...";
    throw Error(ErrorCode::map_object_missing, "the name " + in_quotes(name) + " is that of several " + plural_of(what),
                where, "write the id of one of these " + std::to_string(ids.size()) + ": " + list);
  }
  std::set<std::string> names;
  for (const NamedId& one : known) names.insert(one.name);
  throw Error(ErrorCode::map_object_missing, "there is no " + what + " with the name " + in_quotes(name), where,
              advice_for_name(name, names, "write its id, 'way/123'") +
                  (is_part ? "; or use a larger part of the map: 'radius' or 'bbox' of the scene" : ""));
}

std::string advice_for_name(const std::string& word, const std::set<std::string>& names, const std::string& otherwise) {
  if (names.empty()) return otherwise;
  constexpr int kMost = 3;
  std::vector<std::string_view> left(names.begin(), names.end());
  std::string text;
  for (int i = 0; i < kMost && !left.empty(); ++i) {
    const std::string_view nearest = nearest_name(word, left);
    text += (text.empty() ? "" : ", ") + in_quotes(nearest);
    left.erase(std::find(left.begin(), left.end(), nearest));
  }
  return "the nearest of " + std::to_string(names.size()) + " names: " + text;
}

std::string advice_for_object(const Scene& scene, const std::string& name, const std::string& otherwise) {
  std::set<std::string> names;
  for (const SceneObject& object : scene.objects) {
    for (const std::string& known : {object.name, object.source_id}) {
      if (!known.empty()) names.insert(known);
    }
  }
  return advice_for_name(name, names, otherwise);
}

}  // namespace vantage::internal::app
