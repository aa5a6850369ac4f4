// The keys of a mission file, and the errors about them.
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

#include "app/yaml_tree.h"
#include "request/key_lists.h"
#include "vantage/error.h"

namespace vantage::internal::app {

/// The value of `key` in `map`, or null.
const YamlNode* find(const YamlNode& map, std::string_view key);

/// Throws Error(input) unless `node` is a map with known keys only. For an unknown key the error names the nearest
/// known one, or the section that it belongs to. `map`: its name, "sensor.mount"; another one is a defect.
void check_keys(const YamlNode& node, std::string_view map, const std::string& file);
/// The same of a map of a described section.
void check_keys(const YamlNode& node, const request::KeyList& known, const std::string& file);

/// Throws Error(input) at `node`.
[[noreturn]] void fail_at(ErrorCode code, const YamlNode& node, const std::string& file, const std::string& problem,
                          const std::string& fix);

/// What a node is, for messages: "a list", "the text 'abc'", "nothing".
std::string describe(const YamlNode& node);

}  // namespace vantage::internal::app
