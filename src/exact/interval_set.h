// Sets of disjoint closed intervals of a line or of an unrolled circle, small and reused.
#pragma once

#include <algorithm>
#include <vector>

namespace vantage::internal::exact {

struct Interval {
  double begin, end;
  double length() const { return end - begin; }
};

class IntervalSet {
 public:
  void assign(double begin, double end) {
    parts_.clear();
    if (begin < end) parts_.push_back({begin, end});
  }
  bool empty() const { return parts_.empty(); }
  const std::vector<Interval>& parts() const { return parts_; }

  /// Takes the open interval (begin, end) away.
  void subtract(double begin, double end) {
    if (!(begin < end)) return;
    scratch_.clear();
    for (const Interval& part : parts_) {
      if (begin >= part.end || end <= part.begin) {
        scratch_.push_back(part);
        continue;
      }
      if (begin > part.begin) scratch_.push_back({part.begin, begin});
      if (end < part.end) scratch_.push_back({end, part.end});
    }
    parts_.swap(scratch_);
  }

  /// Keeps what lies in [begin, end].
  void keep(double begin, double end) {
    scratch_.clear();
    for (const Interval& part : parts_) {
      const Interval kept{std::max(part.begin, begin), std::min(part.end, end)};
      if (kept.begin < kept.end) scratch_.push_back(kept);
    }
    parts_.swap(scratch_);
  }

  void drop_shorter_than(double length) {
    std::erase_if(parts_, [&](const Interval& part) { return part.length() < length; });
  }

 private:
  std::vector<Interval> parts_, scratch_;
};

}  // namespace vantage::internal::exact
