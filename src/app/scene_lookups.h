// What is found out about a scene once, for all missions in it.
#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <typeindex>
#include <utility>

#include "vantage/scene_source.h"

namespace vantage {

/// One value of each type.
struct SceneLookups::Data {
  std::recursive_mutex mutex;  // making one value may take another one
  std::map<std::type_index, std::shared_ptr<const void>> values;
};

namespace internal::app {

/// The scene's value of a type; `make()` returns it as a std::shared_ptr<const T> where it is asked for the first time.
/// Who asks meanwhile waits. Where `make` throws there is no value yet.
template <typename T, typename Make>
const T& looked_up(const LoadedScene& loaded, const Make& make) {
  SceneLookups::Data& data = loaded.lookups.data();
  const std::lock_guard lock(data.mutex);
  std::shared_ptr<const void>& value = data.values[typeid(T)];
  if (!value) {
    std::shared_ptr<const T> made = make();
    value = std::move(made);
  }
  return *static_cast<const T*>(value.get());
}

}  // namespace internal::app
}  // namespace vantage
