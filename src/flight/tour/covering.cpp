#include "flight/tour/covering.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

namespace vantage::internal::flight::tour {
namespace {

/// Counts nodes of a search, and asks the caller now and then.
class NodeCount {
 public:
  explicit NodeCount(const CoveringLimits& limits) : limits_(limits) {}

  /// False where the search must end.
  bool next() {
    if (is_cut_) return false;
    constexpr std::size_t kOften = 256;
    if (++nodes_ % kOften == 0) {
      limits_.progress.check();
      is_cut_ = limits_.is_over && limits_.is_over();
    }
    is_cut_ = is_cut_ || nodes_ > limits_.most_nodes;
    return !is_cut_;
  }
  bool is_cut() const { return is_cut_; }

 private:
  const CoveringLimits& limits_;
  std::size_t nodes_ = 0;
  bool is_cut_ = false;
};

class CoverSearch {
 public:
  CoverSearch(std::size_t count, const std::vector<Group>& sets, const CoveringLimits& limits)
      : sets_(sets), holders_(count), times_(count, 0), nodes_(limits) {
    for (std::size_t s = 0; s < sets.size(); ++s) {
      for (const std::size_t element : sets[s]) holders_[element].push_back(s);
    }
  }

  Cover run() {
    take_greedily();
    if (best_.size() > 1) branch();
    std::sort(best_.begin(), best_.end());
    return {best_, !nodes_.is_cut()};
  }

 private:
  std::size_t gain(std::size_t set) const {
    return static_cast<std::size_t>(
        std::count_if(sets_[set].begin(), sets_[set].end(), [&](std::size_t e) { return times_[e] == 0; }));
  }
  void add(std::size_t set) {
    for (const std::size_t e : sets_[set]) ++times_[e];
    chosen_.push_back(set);
  }
  void take_back() {
    for (const std::size_t e : sets_[chosen_.back()]) --times_[e];
    chosen_.pop_back();
  }

  void take_greedily() {
    while (std::find(times_.begin(), times_.end(), 0) != times_.end()) {
      std::size_t best = 0;
      for (std::size_t s = 1; s < sets_.size(); ++s) {
        if (gain(s) > gain(best)) best = s;
      }
      add(best);
    }
    best_ = chosen_;
    while (!chosen_.empty()) take_back();
  }

  /// So many sets at least are needed for what is not covered: elements of which no two are in one set.
  std::size_t at_least() const {
    std::vector<bool> is_used(sets_.size(), false);
    std::size_t needed = 0;
    for (std::size_t e = 0; e < times_.size(); ++e) {
      if (times_[e] > 0) continue;
      const bool is_free =
          std::none_of(holders_[e].begin(), holders_[e].end(), [&](std::size_t s) { return is_used[s]; });
      if (!is_free) continue;
      ++needed;
      for (const std::size_t s : holders_[e]) is_used[s] = true;
    }
    return needed;
  }

  void branch() {
    if (!nodes_.next()) return;
    std::size_t rarest = times_.size();
    for (std::size_t e = 0; e < times_.size(); ++e) {
      if (times_[e] == 0 && (rarest == times_.size() || holders_[e].size() < holders_[rarest].size())) rarest = e;
    }
    if (rarest == times_.size()) {
      if (chosen_.size() < best_.size()) best_ = chosen_;
      return;
    }
    if (chosen_.size() + at_least() >= best_.size()) return;
    std::vector<std::pair<std::size_t, std::size_t>> by_gain;
    for (const std::size_t s : holders_[rarest]) by_gain.emplace_back(gain(s), s);
    std::stable_sort(by_gain.begin(), by_gain.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
    for (const auto& entry : by_gain) {
      add(entry.second);
      branch();
      take_back();
    }
  }

  const std::vector<Group>& sets_;
  std::vector<std::vector<std::size_t>> holders_;  ///< of each element
  std::vector<int> times_;                         ///< that an element is in a chosen set
  std::vector<std::size_t> chosen_, best_;
  NodeCount nodes_;
};

class CliqueSearch {
 public:
  CliqueSearch(std::size_t count, const std::vector<Group>& conflicts, const CoveringLimits& limits)
      : is_pair_(count, std::vector<bool>(count, false)), nodes_(limits) {
    for (const Group& one : conflicts) {
      if (one.size() == 2) is_pair_[one[0]][one[1]] = is_pair_[one[1]][one[0]] = true;
    }
  }

  Group run() {
    std::vector<std::size_t> all(is_pair_.size());
    std::iota(all.begin(), all.end(), std::size_t{0});
    const auto degree = [&](std::size_t a) { return std::count(is_pair_[a].begin(), is_pair_[a].end(), true); };
    std::stable_sort(all.begin(), all.end(), [&](std::size_t a, std::size_t b) { return degree(a) > degree(b); });
    extend(all);
    std::sort(best_.begin(), best_.end());
    return best_;
  }

 private:
  void extend(const std::vector<std::size_t>& open) {
    if (taken_.size() > best_.size()) best_ = taken_;
    if (open.empty() || !nodes_.next()) return;
    // Colour classes: of each, a clique has one element at most.
    std::vector<std::vector<std::size_t>> classes;
    for (const std::size_t a : open) {
      const auto fits = std::find_if(classes.begin(), classes.end(), [&](const std::vector<std::size_t>& one) {
        return std::none_of(one.begin(), one.end(), [&](std::size_t b) { return is_pair_[a][b]; });
      });
      (fits == classes.end() ? classes.emplace_back() : *fits).push_back(a);
    }
    std::vector<std::size_t> order, colours;
    for (std::size_t c = 0; c < classes.size(); ++c) {
      for (const std::size_t a : classes[c]) {
        order.push_back(a);
        colours.push_back(c + 1);
      }
    }
    for (std::size_t i = order.size(); i-- > 0;) {
      if (taken_.size() + colours[i] <= best_.size()) return;
      std::vector<std::size_t> next;
      for (std::size_t k = 0; k < i; ++k) {
        if (is_pair_[order[i]][order[k]]) next.push_back(order[k]);
      }
      taken_.push_back(order[i]);
      extend(next);
      taken_.pop_back();
    }
  }

  std::vector<std::vector<bool>> is_pair_;
  Group taken_, best_;
  NodeCount nodes_;
};

class DivisionSearch {
 public:
  DivisionSearch(std::size_t count, std::size_t groups, const std::vector<Group>& conflicts,
                 const std::function<double(std::size_t, std::size_t)>& affinity, const CoveringLimits& limits)
      : count_(count), conflicts_(conflicts), affinity_(affinity), of_(count), groups_(groups), nodes_(limits) {
    group_of_.assign(count, kNone);
    held_.assign(conflicts.size(), std::vector<std::size_t>(groups, 0));
    for (std::size_t c = 0; c < conflicts.size(); ++c) {
      for (const std::size_t e : conflicts[c]) of_[e].push_back(c);
    }
  }

  Division run(const Group& apart) {
    if (apart.size() > groups_.size()) return {Division::End::none, {}};
    for (std::size_t g = 0; g < apart.size(); ++g) {
      if (!fits(apart[g], g)) return {Division::End::none, {}};
      put(apart[g], g);
    }
    const bool is_found = place(apart.size());
    if (!is_found) return {nodes_.is_cut() ? Division::End::cut : Division::End::none, {}};
    for (Group& group : groups_) std::sort(group.begin(), group.end());
    return {Division::End::found, groups_};
  }

 private:
  static constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

  bool fits(std::size_t element, std::size_t group) const {
    return std::none_of(of_[element].begin(), of_[element].end(),
                        [&](std::size_t c) { return held_[c][group] + 1 == conflicts_[c].size(); });
  }
  void put(std::size_t element, std::size_t group) {
    for (const std::size_t c : of_[element]) ++held_[c][group];
    group_of_[element] = group;
    groups_[group].push_back(element);
  }
  void take_out(std::size_t element, std::size_t group) {
    for (const std::size_t c : of_[element]) --held_[c][group];
    group_of_[element] = kNone;
    groups_[group].pop_back();
  }

  /// Groups that an element fits in. Of the empty ones the first is enough.
  std::vector<std::size_t> choices(std::size_t element) const {
    std::vector<std::size_t> found;
    bool has_empty = false;
    for (std::size_t g = 0; g < groups_.size(); ++g) {
      if (groups_[g].empty() && std::exchange(has_empty, true)) continue;
      if (fits(element, g)) found.push_back(g);
    }
    return found;
  }

  double worth(std::size_t element, std::size_t group) const {
    double sum = 0;
    for (const std::size_t other : groups_[group]) sum += affinity_ ? affinity_(element, other) : 0;
    return groups_[group].empty() ? 0 : sum / static_cast<double>(groups_[group].size());
  }

  bool place(std::size_t placed) {
    if (placed == count_) return true;
    if (!nodes_.next()) return false;
    // The element with the fewest choices first; of equal ones that with the most conflicts.
    std::size_t next = kNone;
    std::vector<std::size_t> where;
    for (std::size_t e = 0; e < count_; ++e) {
      if (group_of_[e] != kNone) continue;
      std::vector<std::size_t> open = choices(e);
      if (open.empty()) return false;
      const bool is_better = next == kNone || open.size() < where.size() ||
                             (open.size() == where.size() && of_[e].size() > of_[next].size());
      if (!is_better) continue;
      next = e;
      where = std::move(open);
    }
    std::vector<std::pair<double, std::size_t>> by_worth;
    for (const std::size_t g : where) by_worth.emplace_back(worth(next, g), g);
    std::stable_sort(by_worth.begin(), by_worth.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
    for (const auto& entry : by_worth) {
      put(next, entry.second);
      if (place(placed + 1)) return true;
      take_out(next, entry.second);
    }
    return false;
  }

  std::size_t count_;
  const std::vector<Group>& conflicts_;
  const std::function<double(std::size_t, std::size_t)>& affinity_;
  std::vector<std::vector<std::size_t>> of_;    ///< of each element: its conflicts
  std::vector<std::vector<std::size_t>> held_;  ///< of each conflict: how many of it are in each group
  std::vector<std::size_t> group_of_;
  std::vector<Group> groups_;
  NodeCount nodes_;
};

}  // namespace

bool is_subset(const Group& part, const Group& whole) {
  return std::includes(whole.begin(), whole.end(), part.begin(), part.end());
}

Cover least_cover(std::size_t count, const std::vector<Group>& sets, const CoveringLimits& limits) {
  return CoverSearch(count, sets, limits).run();
}

Group most_apart(std::size_t count, const std::vector<Group>& conflicts, const CoveringLimits& limits) {
  return CliqueSearch(count, conflicts, limits).run();
}

Division divide(std::size_t count, std::size_t groups, const std::vector<Group>& conflicts, const Group& apart,
                const std::function<double(std::size_t, std::size_t)>& affinity, const CoveringLimits& limits) {
  if (groups == 0) return {count == 0 ? Division::End::found : Division::End::none, {}};
  return DivisionSearch(count, groups, conflicts, affinity, limits).run(apart);
}

}  // namespace vantage::internal::flight::tour
