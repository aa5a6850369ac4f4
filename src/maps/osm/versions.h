// Which version of each object is the current one: files may hold several (history files), or the same one twice.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace vantage::internal::osm {

/// Objects of one type by id. `Entry` has id, version and visible (false: deleted in this version).
template <class Entry>
class Versions {
 public:
  void add(const Entry& entry) { entries_.push_back(entry); }

  /// Call once, when all are in: keeps of each id the highest version, of equal ones the last that was added.
  void finish() {
    const auto follows = [](const Entry& a, const Entry& b) { return a.id >= b.id; };
    if (std::adjacent_find(entries_.begin(), entries_.end(), follows) != entries_.end()) keep_newest();
    deleted_ = static_cast<std::size_t>(
        std::count_if(entries_.begin(), entries_.end(), [](const Entry& entry) { return !entry.visible; }));
  }

  /// The current version, or none when there is none or it is deleted.
  const Entry* find(std::int64_t id) const {
    const Entry* const entry = newest(id);
    return entry != nullptr && entry->visible ? entry : nullptr;
  }
  bool knows(std::int64_t id) const { return newest(id) != nullptr; }  ///< be it deleted

  bool is_current(std::int64_t id, std::uint32_t version) const {
    const Entry* const entry = find(id);
    return entry != nullptr && entry->version == version;
  }

  const std::vector<Entry>& entries() const { return entries_; }  ///< by id once finish() was called, deleted ones too
  std::size_t current() const { return entries_.size() - deleted_; }
  std::size_t superseded() const { return superseded_; }  ///< entries that finish() dropped

 private:
  const Entry* newest(std::int64_t id) const {
    const auto found = std::lower_bound(entries_.begin(), entries_.end(), id,
                                        [](const Entry& entry, std::int64_t wanted) { return entry.id < wanted; });
    return found == entries_.end() || found->id != id ? nullptr : &*found;
  }

  void keep_newest() {
    std::stable_sort(entries_.begin(), entries_.end(),
                     [](const Entry& a, const Entry& b) { return a.id != b.id ? a.id < b.id : a.version < b.version; });
    std::vector<Entry> newest;
    newest.reserve(entries_.size());
    for (const Entry& entry : entries_) {
      if (!newest.empty() && newest.back().id == entry.id) {
        newest.back() = entry;
      } else {
        newest.push_back(entry);
      }
    }
    superseded_ = entries_.size() - newest.size();
    entries_ = std::move(newest);
  }

  std::vector<Entry> entries_;
  std::size_t deleted_ = 0, superseded_ = 0;
};

}  // namespace vantage::internal::osm
