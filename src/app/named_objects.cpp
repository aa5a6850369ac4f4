#include "app/named_objects.h"

#include <algorithm>
#include <string_view>

#include "vantage/input.h"

namespace vantage::internal::app {

std::vector<std::uint32_t> objects_named(const Scene& scene, const std::string& name) {
  std::vector<std::uint32_t> found;
  for (std::uint32_t i = 0; i < scene.objects.size(); ++i) {
    const SceneObject& object = scene.objects[i];
    if (object.name == name || object.source_id == name || display_name(object) == name) found.push_back(i);
  }
  return found;
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
