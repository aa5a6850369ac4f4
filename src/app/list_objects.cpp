#include <algorithm>
#include <limits>
#include <string>
#include <string_view>
#include <unordered_map>

#include "app/named_objects.h"
#include "common/input.h"
#include "common/objects.h"
#include "vantage/error.h"

namespace vantage {
namespace {

std::string in_lower_case(std::string_view text) {
  std::string lower(text);
  for (char& c : lower) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return lower;
}

/// How many bytes the character at a place of a text in UTF-8 has.
std::size_t character_bytes(std::string_view text, std::size_t at) {
  std::size_t end = at + 1;
  while (end < text.size() && (static_cast<unsigned char>(text[end]) & 0xC0) == 0x80) ++end;
  return end - at;
}

/// '*' stands for any text, '?' for a character. Goes back to the last '*' only: linear in practice, never exponential.
bool is_matched(std::string_view pattern, std::string_view text) {
  std::size_t p = 0, t = 0, star = std::string_view::npos, after = 0;
  while (t < text.size()) {
    if (p < pattern.size() && pattern[p] == '?') {
      ++p;
      t += character_bytes(text, t);
    } else if (p < pattern.size() && pattern[p] != '*' && pattern[p] == text[t]) {
      ++p;
      ++t;
    } else if (p < pattern.size() && pattern[p] == '*') {
      star = p++;
      after = t;
    } else if (star != std::string_view::npos) {
      p = star + 1;
      after += character_bytes(text, after);
      t = after;
    } else {
      return false;
    }
  }
  while (p < pattern.size() && pattern[p] == '*') ++p;
  return p == pattern.size();
}

class Pattern {
 public:
  explicit Pattern(const std::string& pattern)
      : text_(in_lower_case(pattern)), is_glob_(pattern.find_first_of("*?") != std::string::npos) {}

  bool takes(const SceneObject& object) const {
    return takes(object.name) || takes(object.source_id) || takes(display_name(object));
  }

 private:
  bool takes(const std::string& name) const {
    const std::string lower = in_lower_case(name);
    return is_glob_ ? is_matched(text_, lower) : lower.find(text_) != std::string::npos;
  }

  std::string text_;
  bool is_glob_;
};

/// Nothing of an object that has no name to write, of a tree, which has neither a roof nor a facade, and of a stand-in,
/// which is no target.
std::string mission_of(const LoadedScene& loaded, const SceneObject& object) {
  const std::string& known_as = object.source_id.empty() ? object.name : object.source_id;
  if (known_as.empty() || object.kind == ObjectKind::tree || object.kind == ObjectKind::stand_in) return "";
  if (object.kind == ObjectKind::ground || object.kind == ObjectKind::surface) {
    return "navigation: {ground: " + internal::app::yaml_text(known_as) + "}";
  }
  const bool is_of_map = loaded.city && !object.source_id.empty();
  const char* const part = object.kind == ObjectKind::wall ? ", part: facade}" : ", part: roof}";
  return std::string("target: {") + (is_of_map ? "osm: " : "object: ") + internal::app::yaml_text(known_as) + part;
}

}  // namespace

std::vector<ListedObject> list_objects(const LoadedScene& loaded, const std::string& text) {
  const Scene& scene = loaded.scene;
  if (scene.object_of.empty()) return {};  // a scene may have no objects
  std::vector<ListedObject> all(scene.objects.size());
  for (std::uint32_t i = 0; i < all.size(); ++i) {
    all[i].index = i;
    all[i].object = scene.objects[i];
    all[i].min_z_m = std::numeric_limits<double>::infinity();
    all[i].max_z_m = -all[i].min_z_m;
  }
  for (std::size_t i = 0; i < scene.mesh.triangles.size(); ++i) {
    ListedObject& one = all.at(scene.object_of.at(i));
    ++one.triangles;
    for (const std::uint32_t vertex : scene.mesh.triangles[i]) {
      one.min_z_m = std::min(one.min_z_m, scene.mesh.vertices.at(vertex).z());
      one.max_z_m = std::max(one.max_z_m, scene.mesh.vertices.at(vertex).z());
    }
  }
  std::unordered_map<std::string, const CityRecord*> record_of;
  if (loaded.city) {
    for (const CityRecord& record : loaded.city->records) record_of[record.object.source_id] = &record;
  }
  const Pattern pattern(text);
  std::vector<ListedObject> listed;
  for (ListedObject& one : all) {
    if (one.triangles == 0 || !pattern.takes(one.object)) continue;
    one.height_m = one.max_z_m - one.min_z_m;
    const auto record = one.object.source_id.empty() ? record_of.end() : record_of.find(one.object.source_id);
    if (record != record_of.end()) {
      one.height_m = one.max_z_m - record->second->ground_m;
      one.footprint_m2 = record->second->footprint_m2;
    }
    one.mission = mission_of(loaded, one.object);
    listed.push_back(std::move(one));
  }
  if (!listed.empty()) return listed;
  throw Error(ErrorCode::object_missing, "no object of the scene has a name like " + in_quotes(text), "",
              internal::app::advice_for_object(scene, text, "the objects of this scene have no names"));
}

}  // namespace vantage
