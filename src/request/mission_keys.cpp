#include "vantage/mission_keys.h"

#include <array>
#include <optional>
#include <utility>

#include "common/input.h"
#include "request/description.h"
#include "request/sections.h"

namespace vantage {
namespace {

using internal::request::Bounds;
using internal::request::Key;
using internal::request::Only;
using internal::request::Own;
using Kind = MissionKey::Kind;

/// As lists of keys name a section that messages name otherwise.
std::string listed_name(std::string_view section) {
  for (const auto& [name, listed] : {std::pair{"the mission", ""},
                                     {"a zone", "navigation.keep_in[]"},
                                     {"an entry of navigation.meshes", "navigation.meshes[]"},
                                     {"an entry of links", "links[]"}}) {
    if (section == name) return listed;
  }
  return std::string(section);
}

/// A visitor of settings by default.
class KeyCollector : internal::request::Visitor {
 public:
  KeyCollector(std::string section, std::string map, std::vector<MissionKey>& keys)
      : section_(std::move(section)), map_(std::move(map)), keys_(keys) {}

  template <typename Value, typename Choices>
  void choice(const Key& key, const Value& value, const Choices& choices) {
    MissionKey& added = add(key, Kind::word, "", "", "`" + std::string(word_of(choices, value)) + "`");
    for (const auto& [one, word] : choices) added.words.emplace_back(word);
  }
  void number(const Key& key, double value, const Bounds& bounds, const Only& /*only*/) {
    add_number(key, Kind::number, bounds, key.is_none_at_zero ? "" : shortest(value));
  }
  void number(const Key& key, const std::optional<double>& value, const Bounds& bounds, const Only& /*only*/) {
    add_number(key, Kind::number, bounds, value ? shortest(*value) : "");
  }
  void whole(const Key& key, int value, const Bounds& bounds) {
    add_number(key, Kind::whole, bounds, std::to_string(value));
  }
  void pair(const Key& key, double low, const Bounds& of_low, double high, const Bounds& /*of_high*/,
            const Only& /*only*/) {
    add(key, Kind::numbers, symbol_of(of_low.unit), "", "[" + shortest(low) + ", " + shortest(high) + "]");
  }
  template <typename Grid>
  void grid(const Key& key, const Grid& /*value*/, const Bounds& /*of_first*/, const Bounds& /*of_second*/) {
    add(key, Kind::numbers, "", "", "");
  }
  template <typename Device>
  void device(const Key& key, const Device& /*value*/) {
    add(key, Kind::word, "", "", "");
  }
  void flag(const Key& key, bool value) { add(key, Kind::flag, "", "", value ? "true" : "false"); }
  template <typename Home>
  void home(const Key& key, const Home& /*value*/) {
    add(key, Kind::vector, "", "", "");
  }
  template <typename... Values>
  void keys(std::span<const Own> keys, const Values&... /*values*/) {
    for (const Own& own : keys) add(own.key, own.kind, symbol_of(own.unit), "", "");
  }
  template <typename Settings>
  void map(const Key& key, const std::optional<Settings>& /*value*/) {
    instead<Settings>(key);
  }
  template <typename Settings>
  void instead(const Key& key) {
    add(key, Kind::map, "", "", "");
    KeyCollector inner(section_, map_ + std::string(key.path) + ".", keys_);
    const Settings settings = {};
    describe(settings, inner);
  }

 private:
  void add_number(const Key& key, Kind kind, const Bounds& bounds, const std::string& value) {
    MissionKey& added = add(key, kind, symbol_of(bounds.unit), ", " + bounds.text(), value);
    added.least = bounds.least;
    added.most = bounds.most;
    added.takes_least = bounds.takes_least();
    added.takes_most = bounds.takes_most();
  }

  MissionKey& add(const Key& key, Kind kind, std::string_view unit, const std::string& range,
                  const std::string& value) {
    MissionKey added;
    added.section = section_;
    added.path = map_ + std::string(key.path);
    added.kind = kind;
    added.unit = unit;
    added.is_required = key.is_required;
    added.is_old = key.is_old;
    added.text = std::string(key.says) + range + ".";
    if (!key.more.empty()) added.text.append(" ").append(key.more);
    if (key.is_required) {
      const std::size_t dot = added.path.rfind('.');
      added.text += dot == std::string::npos ? " Required." : " Required in `" + added.path.substr(0, dot) + "`.";
    }
    const std::string without = key.without.empty() ? (key.is_required ? "" : value) : std::string(key.without);
    if (!without.empty()) added.text += " Default: " + without + ".";
    return keys_.emplace_back(std::move(added));
  }

  std::string section_, map_;
  std::vector<MissionKey>& keys_;
};

}  // namespace

std::vector<MissionKey> mission_keys() {
  std::vector<MissionKey> keys;
  internal::request::each_section([&]<typename Settings>(const Settings& settings) {
    KeyCollector collector(listed_name(internal::request::kSection<Settings>), "", keys);
    describe(settings, collector);
  });
  return keys;
}

const char* name_of(MissionKey::Kind kind) {
  constexpr std::array kNames = {"number",      "whole",          "flag",          "word",    "text",
                                 "path",        "vector",         "place",         "numbers", "points",
                                 "polygons",    "list",           "map",           "maps",    "word_or_number",
                                 "word_or_map", "text_or_number", "numbers_or_map"};
  return kNames.at(static_cast<std::size_t>(kind));
}

}  // namespace vantage
