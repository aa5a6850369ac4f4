// Objects of scenes by their names.
#pragma once

#include <string>
#include <vector>

#include "vantage/scene.h"

namespace vantage {

/// What outputs call them.
inline std::vector<std::string> names_of(const std::vector<SceneObject>& objects) {
  std::vector<std::string> names;
  for (const SceneObject& object : objects) names.push_back(display_name(object));
  return names;
}

/// Objects of which no more than the name is known.
inline std::vector<SceneObject> named(const std::vector<std::string>& names) {
  std::vector<SceneObject> objects;
  for (const std::string& name : names) objects.push_back({name});
  return objects;
}

}  // namespace vantage
