// Views of several targets along one leg as one.
#include <algorithm>
#include <utility>

#include "query/leg_intervals.h"
#include "vantage/error.h"

namespace vantage {
namespace {

using internal::query::LegIntervals;

void check_views(std::span<const LegView> views) {
  if (!views.empty()) return;
  throw Error(ErrorCode::nothing_given, "there are no views to join", "legs", "give one for each target");
}

LegIntervals united(const LegIntervals& a, const LegIntervals& b) {
  LegIntervals both = a;
  both.insert(both.end(), b.begin(), b.end());
  return internal::query::joined(std::move(both));
}

std::vector<LegBlocker> blockers_of(std::span<const LegView> views) {
  std::vector<LegBlocker> all;
  for (const LegView& view : views) all.insert(all.end(), view.hidden_by.begin(), view.hidden_by.end());
  std::stable_sort(all.begin(), all.end(),
                   [](const LegBlocker& a, const LegBlocker& b) { return a.object < b.object; });
  std::vector<LegBlocker> result;
  for (LegBlocker& blocker : all) {
    if (!result.empty() && result.back().object == blocker.object) {
      result.back().intervals = united(result.back().intervals, blocker.intervals);
    } else {
      result.push_back(std::move(blocker));
    }
  }
  return result;
}

}  // namespace

LegView any_of(std::span<const LegView> views) {
  check_views(views);
  LegView result = views.front();
  for (const LegView& view : views.subspan(1)) {
    result.seen = united(result.seen, view.seen);
    result.out_of_range = internal::query::common(result.out_of_range, view.out_of_range);
    result.behind_target = internal::query::common(result.behind_target, view.behind_target);
  }
  result.hidden_by = blockers_of(views);
  for (LegBlocker& blocker : result.hidden_by) {
    blocker.intervals = internal::query::without(blocker.intervals, result.seen);
  }
  std::erase_if(result.hidden_by, [](const LegBlocker& blocker) { return blocker.intervals.empty(); });
  return result;
}

LegView all_of(std::span<const LegView> views) {
  check_views(views);
  LegView result = views.front();
  for (const LegView& view : views.subspan(1)) {
    result.seen = internal::query::common(result.seen, view.seen);
    result.out_of_range = united(result.out_of_range, view.out_of_range);
    result.behind_target = united(result.behind_target, view.behind_target);
  }
  result.hidden_by = blockers_of(views);
  return result;
}

}  // namespace vantage
