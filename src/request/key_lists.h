// The keys of each map of a described section.
#pragma once

#include <algorithm>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "request/description.h"

namespace vantage::internal::request {

struct KeyList {
  std::string name;  ///< of the map: "tour.view"
  std::vector<std::string_view> keys = {};
  std::vector<std::string_view> old_keys = {};  ///< that are read too, and that nothing suggests
};

/// A visitor that collects them.
class KeyLister : Visitor {
 public:
  explicit KeyLister(std::string_view section) { lists_.push_back({std::string(section)}); }

  template <typename Value, typename Choices>
  void choice(const Key& key, const Value& /*value*/, const Choices& /*choices*/) {
    add(key);
  }
  template <typename Number>
  void number(const Key& key, const Number& /*value*/, const Bounds& /*bounds*/, const Only& /*only*/) {
    add(key);
  }
  void pair(const Key& key, double /*low*/, const Bounds& /*of_low*/, double /*high*/, const Bounds& /*of_high*/,
            const Only& /*only*/) {
    add(key);
  }
  void whole(const Key& key, int /*value*/, const Bounds& /*bounds*/) { add(key); }
  void flag(const Key& key, bool /*value*/) { add(key); }
  template <typename Home>
  void home(const Key& key, const Home& /*value*/) {
    add(key);
  }
  template <typename Grid>
  void grid(const Key& key, const Grid& /*value*/, const Bounds& /*of_first*/, const Bounds& /*of_second*/) {
    add(key);
  }
  template <typename Device>
  void device(const Key& key, const Device& /*value*/) {
    add(key);
  }

  template <typename... Values>
  void keys(std::span<const Own> keys, const Values&... /*values*/) {
    for (const Own& own : keys) add(own.key);
  }
  template <typename Settings>
  void map(const Key& key, const std::optional<Settings>& /*value*/) {
    instead<Settings>(key);
  }
  template <typename Settings>
  void instead(const Key& key) {
    add(key);
    KeyLister inner(lists_.front().name + "." + std::string(key.path));
    const Settings settings = {};
    describe(settings, inner);
    lists_.insert(lists_.end(), inner.lists_.begin(), inner.lists_.end());
  }

  const std::vector<KeyList>& lists() const { return lists_; }

 private:
  void add(const Key& key) {
    std::string map = lists_.front().name;
    for (std::string_view rest = key.path;;) {
      const std::size_t dot = rest.find('.');
      const std::string_view word = rest.substr(0, dot);
      KeyList& list = list_of(map);
      std::vector<std::string_view>& keys = key.is_old ? list.old_keys : list.keys;
      if (std::find(keys.begin(), keys.end(), word) == keys.end()) keys.push_back(word);
      if (dot == std::string_view::npos) return;
      map.append(".").append(word);
      rest.remove_prefix(dot + 1);
    }
  }

  KeyList& list_of(const std::string& map) {
    for (KeyList& list : lists_) {
      if (list.name == map) return list;
    }
    return lists_.emplace_back(KeyList{map});
  }

  std::vector<KeyList> lists_;
};

/// The section's own list first.
template <typename Settings>
std::vector<KeyList> key_lists() {
  const Settings settings = {};
  KeyLister lister(kSection<Settings>);
  describe(settings, lister);
  return lister.lists();
}

}  // namespace vantage::internal::request
