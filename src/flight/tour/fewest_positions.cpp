#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include "core/parallel.h"
#include "core/progress_reporter.h"
#include "core/stopwatch.h"
#include "flight/tour/common_point.h"
#include "flight/tour/covering.h"
#include "flight/tour/position_search.h"
#include "vantage/error.h"
#include "vantage/solid.h"
#include "vantage/tour.h"

namespace vantage {
namespace {

using internal::core::ProgressReporter;
using internal::flight::SolidDepth;
using internal::flight::tour::Division;
using internal::flight::tour::Group;
using internal::flight::tour::PositionSearch;

void check_request(const FewestRequest& request) {
  const auto fail = [](const char* what, const char* where, const char* advice = "give a finite number above 0") {
    throw Error(ErrorCode::value_out_of_range, what, where, advice);
  };
  constexpr const char* kNotNegative = "give a finite number, 0 or more";
  if (request.targets.empty()) {
    throw Error(ErrorCode::nothing_given, "there is no target to see", "targets", "give one target or more");
  }
  if (!(request.margin_m > 0) || !std::isfinite(request.margin_m))
    fail("the margin is not positive and finite", "margin_m");
  if (!(request.time_limit_s > 0)) fail("the time limit is not positive", "time_limit_s");
  if (!(request.deviation_m >= 0) || !std::isfinite(request.deviation_m)) {
    fail("the deviation is negative or not finite", "deviation_m", kNotNegative);
  }
  for (const FewestTarget& target : request.targets) {
    if (!(target.outer_rounding_m >= 0) || !std::isfinite(target.outer_rounding_m)) {
      fail("a rounding of an outer mesh is negative or not finite", target.name.c_str(), kNotNegative);
    }
  }
}

/// From below: sets of targets whose outer meshes have no common point. Only what is certain counts.
class OuterMeshes {
 public:
  OuterMeshes(const FewestRequest& request, const PositionSearch& search, const ProgressReporter& reporter)
      : request_(request), search_(search), reporter_(reporter) {
    for (std::size_t i = 0; i < request.targets.size(); ++i) {
      const Group& unseen = search.unseen();
      if (!std::binary_search(unseen.begin(), unseen.end(), i)) seen_.push_back(i);
    }
  }

  void make(const Progress& progress) {
    solids_.resize(request_.targets.size());
    for (const std::size_t i : seen_) {
      const FewestTarget& target = request_.targets[i];
      if (!target.outer) continue;
      Mesh mesh = target.outer(progress);
      if (!mesh.empty()) solids_[i] = std::make_unique<const Outer>(mesh, rounding_of(mesh) + target.outer_rounding_m);
    }
  }

  /// Which two of the meshes do not meet.
  void compare() {
    reporter_.begin("outer meshes");
    for (std::size_t i = 0; i < seen_.size(); ++i) {
      reporter_.report(i, seen_.size());
      for (std::size_t k = i + 1; k < seen_.size(); ++k) {
        const std::size_t a = seen_[i], b = seen_[k];
        if (!solids_[a] || !solids_[b] || search_.is_seen_together(a, b)) continue;
        reporter_.check();
        const double within = solids_[a]->rounding_m + solids_[b]->rounding_m;
        if (!solids_[a]->index.comes_near(solids_[b]->index, within)) conflicts_.push_back({a, b});
      }
    }
    reporter_.finish();
  }

  const std::vector<Group>& conflicts() const { return conflicts_; }
  /// The most of which no two meet; none where all meet.
  Group apart() const {
    Group result = most_apart(request_.targets.size(), conflicts_, search_.limits());
    if (result.size() == 1) result.clear();
    return result;
  }

  /// How many groups the targets need, from `bound` on, up to `most`.
  std::size_t raised(std::size_t bound, std::size_t most, const Group& apart) {
    while (bound < most && !search_.is_over()) {
      std::vector<Group> rules;
      for (const Group& one : conflicts_) rules.push_back(numbers(one));
      const auto affinity = [&](std::size_t a, std::size_t b) {
        return search_.is_seen_together(seen_[a], seen_[b]) ? 1.0 : 0.0;
      };
      const Division division = divide(seen_.size(), bound, rules, numbers(apart), affinity, search_.limits());
      if (division.end == Division::End::none) {
        ++bound;
        continue;
      }
      bool is_new = false;
      for (const Group& one : division.groups) {
        Group group;
        for (const std::size_t e : one) group.push_back(seen_[e]);
        is_new = learn_conflict(group) || is_new;
      }
      if (!is_new) break;
    }
    return bound;
  }

 private:
  struct Outer {
    Outer(const Mesh& mesh, double rounding) : index(mesh), depth(mesh), rounding_m(rounding) {}

    SolidIndex index;
    SolidDepth depth;
    double rounding_m;
  };

  /// More than distances are off by.
  static double rounding_of(const Mesh& mesh) {
    constexpr double kOfSize = 1e-9, kOfCoordinates = 1e-12;
    const Box box = bounding_box(mesh);
    const double largest = std::max(box.min.cwiseAbs().maxCoeff(), box.max.cwiseAbs().maxCoeff());
    return kOfSize * (box.max - box.min).norm() + kOfCoordinates * largest;
  }

  Group numbers(const Group& group) const {
    Group result;
    for (const std::size_t target : group) {
      result.push_back(static_cast<std::size_t>(std::lower_bound(seen_.begin(), seen_.end(), target) - seen_.begin()));
    }
    return result;
  }

  bool are_apart(const Group& group) {
    constexpr std::size_t kMostBoxes = 40'000;
    if (group.size() < 2 || search_.is_over()) return false;
    std::vector<const SolidDepth*> solids;
    double rounding = 0;
    for (const std::size_t i : group) {
      if (!solids_[i]) return false;
      solids.push_back(&solids_[i]->depth);
      rounding = std::max(rounding, solids_[i]->rounding_m);
    }
    return internal::flight::tour::are_surely_apart(solids, rounding, kMostBoxes, reporter_);
  }

  /// Whether a group is found to have no common point. The smallest part of it that shows it becomes a conflict.
  bool learn_conflict(const Group& group) {
    if (!are_apart(group)) return false;
    Group kept = group;
    for (const std::size_t member : group) {
      Group less = kept;
      less.erase(std::find(less.begin(), less.end(), member));
      if (are_apart(less)) kept = std::move(less);
    }
    conflicts_.push_back(kept);
    return true;
  }

  const FewestRequest& request_;
  const PositionSearch& search_;
  const ProgressReporter& reporter_;
  Group seen_;
  std::vector<std::unique_ptr<const Outer>> solids_;  ///< of all targets; null where none is known
  std::vector<Group> conflicts_;
};

/// Throws Error(cancelled); `result` then has what was found before.
void search_all(const FewestRequest& request, const Progress& progress, FewestPositions& result) {
  const ProgressReporter reporter(progress, "positions");
  PositionSearch search(request, reporter);
  search.sample();
  result.unseen = search.unseen();
  std::vector<Group> groups = search.cover();
  // Without more questions: what there is when the caller stops it.
  const auto keep = [&](bool is_deep) { result.positions = search.positions_of(groups, is_deep); };
  keep(false);
  result.necessary = groups.empty() ? 0 : 1;
  OuterMeshes outer(request, search, reporter);
  if (groups.size() > 1) {
    reporter.finish();
    const internal::core::Stopwatch watch;
    outer.make(progress);
    search.allow_more(watch.seconds());
    outer.compare();
    result.apart = outer.apart();
    result.necessary = std::max<std::size_t>(1, result.apart.size());
    if (result.necessary > 1) result.reason = FewestPositions::Reason::apart;
    reporter.begin("fewer positions");
    if (groups.size() > result.necessary) {
      search.grow();
      groups = search.cover();
      try {
        search.improve(groups, result.necessary, outer.conflicts(), result.apart);
      } catch (const Error&) {
        keep(false);
        throw;
      }
      keep(false);
    }
    const std::size_t raised = outer.raised(result.necessary, groups.size(), result.apart);
    if (raised > result.necessary) result.reason = FewestPositions::Reason::groups;
    result.necessary = raised;
  }
  if (search.is_over()) result.end = FewestPositions::End::time_limit;
  keep(true);
  reporter.finish();
}

}  // namespace

FewestPositions fewest_positions(const FewestRequest& request, const Progress& progress) {
  check_request(request);
  FewestPositions result;
  try {
    internal::parallel::with_threads(request.threads, [&] { search_all(request, progress, result); });
  } catch (const Error& error) {
    if (error.code() != ErrorCode::cancelled || result.positions.empty()) throw;
    result.end = FewestPositions::End::cancelled;
  }
  return result;
}

}  // namespace vantage
