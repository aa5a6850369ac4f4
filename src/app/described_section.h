// Reads and writes a section of a mission file that is described (request/description.h).
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "app/value_reader.h"
#include "app/yaml_tree.h"
#include "common/input.h"
#include "request/description.h"
#include "request/key_lists.h"
#include "vantage/devices.h"
#include "vantage/tour.h"

namespace vantage::internal::app {

/// A visitor that sets what the section says. Throws Error(input) with the place.
class SectionReader : request::Visitor {
 public:
  /// `name`: how messages call the map.
  SectionReader(const YamlNode& map, std::string name, const ValueReader& reader)
      : root_(map), reader_(reader), section_(std::move(name)) {}

  template <typename Value, typename Choices>
  void choice(const request::Key& key, Value& value, const Choices& choices) {
    const YamlNode* const node = required(key);
    if (node == nullptr) return;
    const std::string word = reader_.text(*node, name_of(key));
    std::vector<std::string_view> words;
    for (const auto& [one, its_word] : choices) {
      if (word == its_word) {
        value = one;
        return;
      }
      words.push_back(its_word);
    }
    fail_choice(key, *node, word, words);
  }
  void number(const request::Key& key, double& value, const request::Bounds& bounds, const request::Only& only) const;
  void number(const request::Key& key, std::optional<double>& value, const request::Bounds& bounds,
              const request::Only& only) const;
  void pair(const request::Key& key, double& low, const request::Bounds& of_low, double& high,
            const request::Bounds& of_high, const request::Only& only) const;
  void whole(const request::Key& key, int& value, const request::Bounds& bounds) const;
  void flag(const request::Key& key, bool& value) const;
  void grid(const request::Key& key, std::optional<std::array<int, 2>>& value, const request::Bounds& of_first,
            const request::Bounds& of_second) const;
  void device(const request::Key& key, DeviceChoice& value) const;
  void home(const request::Key& key, std::optional<TourHome>& value) const;

  template <typename Settings>
  void map(const request::Key& key, std::optional<Settings>& value) const;

 protected:
  std::string name_of(const request::Key& key) const { return section_ + "." + std::string(key.path); }
  const YamlNode& root() const { return root_; }
  const ValueReader& reader() const { return reader_; }

 private:
  const YamlNode* required(const request::Key& key) const;
  const YamlNode* node_for(const request::Key& key, const request::Only& only) const;
  int whole_of(const YamlNode& node, const std::string& name) const;
  double value_of(const YamlNode& node, const std::string& name, const request::Bounds& bounds) const;
  [[noreturn]] void fail_choice(const request::Key& key, const YamlNode& node, const std::string& word,
                                const std::vector<std::string_view>& words) const;

  const YamlNode& root_;
  const ValueReader& reader_;
  std::string section_;
};

/// A visitor that writes all keys that count.
class SectionWriter : request::Visitor {
 public:
  template <typename Value, typename Choices>
  void choice(const request::Key& key, const Value& value, const Choices& choices) {
    for (const auto& [one, word] : choices) {
      if (one == value) add(key.path, std::string(word));
    }
  }
  void number(const request::Key& key, double value, const request::Bounds& bounds, const request::Only& only);
  void number(const request::Key& key, const std::optional<double>& value, const request::Bounds& /*bounds*/,
              const request::Only& only) {
    if (value && only.holds) add(key.path, shortest(*value));
  }
  template <typename Settings>
  void map(const request::Key& key, const std::optional<Settings>& value) {
    if (!value) return;
    SectionWriter inner;
    describe(*value, inner);
    add(key.path, inner.flow());
  }
  void pair(const request::Key& key, double low, const request::Bounds& of_low, double high,
            const request::Bounds& of_high, const request::Only& only);
  void whole(const request::Key& key, int value, const request::Bounds& /*bounds*/) {
    add(key.path, std::to_string(value));
  }
  void grid(const request::Key& key, const std::optional<std::array<int, 2>>& value, const request::Bounds& of_first,
            const request::Bounds& of_second);
  void device(const request::Key& key, const DeviceChoice& value);
  void flag(const request::Key& key, bool value) { add(key.path, value ? "true" : "false"); }
  void home(const request::Key& key, const std::optional<TourHome>& value);

  /// "tour:" and a line for each key below it.
  std::string text(std::string_view section) const;
  /// "{size: 0.02, kind: worst}"; of a map without others in it.
  std::string flow() const;
  bool is_empty() const { return entries_.empty(); }

 protected:
  void add(std::string_view path, const std::string& value) { entries_.emplace_back(path, value); }

 private:
  std::vector<std::pair<std::string_view, std::string>> entries_;
};

/// Throws Error(input) for a key that is not known, and for what is no map.
void check_maps(const YamlNode& section, const std::vector<request::KeyList>& lists, const ValueReader& reader);

/// What the map says of `settings`, which may be some of its keys alone; the rest stays as it is.
template <typename Settings>
void read_keys(const YamlNode& map, const std::string& name, const ValueReader& reader, Settings& settings) {
  SectionReader visit(map, name, reader);
  describe(settings, visit);
}

/// The same of a map that has no other keys. `name`: how messages call it.
template <typename Settings>
void read_section(const YamlNode& node, const ValueReader& reader, Settings& settings,
                  const std::string& name = std::string(request::kSection<Settings>)) {
  static const std::vector<request::KeyList> kLists = request::key_lists<Settings>();
  check_maps(node, kLists, reader);
  read_keys(node, name, reader, settings);
}

template <typename Settings>
void SectionReader::map(const request::Key& key, std::optional<Settings>& value) const {
  if (const YamlNode* const node = find(root_, key.path)) {
    read_section(*node, reader_, value.emplace(), name_of(key));
  }
}

/// The text of a section, which reads back as the same.
template <typename Settings>
std::string section_text(const Settings& settings) {
  SectionWriter visit;
  describe(settings, visit);
  return visit.text(request::kSection<Settings>);
}

/// The same as a map on one line.
template <typename Settings>
std::string flow_text(const Settings& settings) {
  SectionWriter visit;
  describe(settings, visit);
  return visit.flow();
}

}  // namespace vantage::internal::app
