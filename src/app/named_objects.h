// Objects of a scene by what people call them.
#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "vantage/scene.h"

namespace vantage::internal::app {

/// Indices of the objects whose name, source_id or display name it is.
std::vector<std::uint32_t> objects_named(const Scene& scene, const std::string& name);

/// "the nearest of 12 names: 'a', 'b', 'c'"; without names `otherwise`.
std::string advice_for_name(const std::string& word, const std::set<std::string>& names, const std::string& otherwise);

/// The same of the names and source_ids of all objects.
std::string advice_for_object(const Scene& scene, const std::string& name, const std::string& otherwise);

}  // namespace vantage::internal::app
