#include "query/leg_intervals.h"

namespace vantage::internal::query {

LegIntervals joined(LegIntervals intervals) {
  std::sort(intervals.begin(), intervals.end(), [](const LegInterval& a, const LegInterval& b) {
    return a.begin != b.begin ? a.begin < b.begin : a.end < b.end;
  });
  LegIntervals result;
  for (const LegInterval& interval : intervals) {
    if (!result.empty() && interval.begin <= result.back().end) {
      result.back().end = std::max(result.back().end, interval.end);
    } else {
      result.push_back(interval);
    }
  }
  return result;
}

LegIntervals common(const LegIntervals& a, const LegIntervals& b) {
  LegIntervals result;
  for (std::size_t i = 0, k = 0; i < a.size() && k < b.size();) {
    const LegInterval both{std::max(a[i].begin, b[k].begin), std::min(a[i].end, b[k].end)};
    const bool is_own = a[i].begin == a[i].end || b[k].begin == b[k].end;
    if (both.begin < both.end || (both.begin == both.end && is_own)) result.push_back(both);
    (a[i].end < b[k].end ? i : k)++;
  }
  return result;
}

LegIntervals without(const LegIntervals& from, const LegIntervals& taken) {
  LegIntervals result;
  for (const LegInterval& interval : from) {
    double begin = interval.begin;
    bool is_met = false;
    for (const LegInterval& gap : taken) {
      if (gap.end < interval.begin || gap.begin > interval.end) continue;
      is_met = true;
      if (gap.begin > begin) result.push_back({begin, gap.begin});
      begin = std::max(begin, gap.end);
    }
    if (begin < interval.end || !is_met) result.push_back({begin, interval.end});
  }
  return result;
}

LegIntervals where_positive(double at_begin, double at_end) {
  if (!(at_begin > 0) && !(at_end > 0)) return {};
  if (at_begin >= 0 && at_end >= 0) return {{0, 1}};
  const double crossing = std::clamp(at_begin / (at_begin - at_end), 0.0, 1.0);
  if (at_begin > 0) return {{0, crossing}};
  return {{crossing, 1}};
}

}  // namespace vantage::internal::query
