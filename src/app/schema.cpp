#include "app/schema.h"

#include <algorithm>
#include <stdexcept>

#include "common/input.h"
#include "request/sections.h"
#include "vantage/error.h"

namespace vantage::internal::app {
namespace {

using request::KeyList;

/// All of them.
const std::vector<KeyList>& lists() {
  static const std::vector<KeyList> kLists = [] {
    std::vector<KeyList> all;
    request::each_section([&]<typename Settings>(const Settings& /*settings*/) {
      const std::vector<KeyList> section = request::key_lists<Settings>();
      all.insert(all.end(), section.begin(), section.end());
    });
    return all;
  }();
  return kLists;
}

std::string joined(const std::vector<std::string_view>& words) {
  std::string text;
  for (const std::string_view word : words) text += (text.empty() ? "" : ", ") + std::string(word);
  return text;
}

/// The list, other than `known`, that has `key`; null when none does.
const KeyList* owner_of(std::string_view key, const KeyList& known) {
  for (const KeyList& candidate : lists()) {
    if (candidate.name == known.name) continue;
    if (std::find(candidate.keys.begin(), candidate.keys.end(), key) != candidate.keys.end()) return &candidate;
  }
  return nullptr;
}

[[noreturn]] void fail_unknown(const YamlEntry& entry, const KeyList& list, const std::string& file) {
  const std::string_view nearest = nearest_name(entry.key, list.keys);
  const std::string known = " (keys of " + list.name + ": " + joined(list.keys) + ")";
  // Where most letters differ, no key is meant.
  const bool is_like_one = 2 * edit_distance(entry.key, nearest) <= static_cast<int>(entry.key.size());
  std::string fix = (is_like_one ? "did you mean '" + std::string(nearest) + "'?" : "take one of its keys") + known;
  // What {max_range: 1,000} holds.
  if (!entry.key.empty() && entry.key.find_first_not_of("0123456789") == std::string::npos)
    fix = "write numbers without a comma: 1000" + known;
  // A key that is right elsewhere is more likely misplaced than misspelt, unless it is one slip from a key of this
  // place.
  if (const KeyList* owner = owner_of(entry.key, list); owner && edit_distance(entry.key, nearest) > 1) {
    fix = "'" + entry.key + "' belongs to " + owner->name + "; the nearest key here is '" + std::string(nearest) + "'" +
          known;
  }
  throw Error(ErrorCode::unknown_key, "unknown key " + in_quotes(entry.key) + " in " + list.name,
              place_in(file, entry.place), fix);
}

}  // namespace

const YamlNode* find(const YamlNode& map, std::string_view key) {
  for (const YamlEntry& entry : map.entries) {
    if (entry.key == key) return &entry.value;
  }
  return nullptr;
}

void check_keys(const YamlNode& node, std::string_view map, const std::string& file) {
  const auto is_named = [&](const KeyList& list) { return list.name == map; };
  const auto found = std::find_if(lists().begin(), lists().end(), is_named);
  if (found == lists().end()) throw std::logic_error("there is no map " + std::string(map));
  check_keys(node, *found, file);
}

void check_keys(const YamlNode& node, const KeyList& known, const std::string& file) {
  if (node.kind != YamlNode::Kind::map) {
    std::string fix = "write its keys, indented, as 'key: value': " + joined(known.keys);
    if (known.name == "sensor.camera") fix = "for a camera by name write {model: NAME}; else " + fix;
    fail_at(ErrorCode::wrong_type, node, file, known.name + " must be a mapping of keys, not " + describe(node), fix);
  }
  for (const YamlEntry& entry : node.entries) {
    const auto is_one_of = [&](const std::vector<std::string_view>& keys) {
      return std::find(keys.begin(), keys.end(), entry.key) != keys.end();
    };
    if (!is_one_of(known.keys) && !is_one_of(known.old_keys)) fail_unknown(entry, known, file);
  }
}

void fail_at(ErrorCode code, const YamlNode& node, const std::string& file, const std::string& problem,
             const std::string& fix) {
  throw Error(code, problem, place_in(file, node.place), fix);
}

std::string describe(const YamlNode& node) {
  switch (node.kind) {
    case YamlNode::Kind::null:
      return "nothing";
    case YamlNode::Kind::sequence:
      return "a list of " + std::to_string(node.items.size());
    case YamlNode::Kind::map:
      return "a mapping";
    case YamlNode::Kind::scalar:
      break;
  }
  return (node.is_quoted ? "the text " : "") + in_quotes(node.text);
}

}  // namespace vantage::internal::app
