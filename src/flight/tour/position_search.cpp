#include "flight/tour/position_search.h"

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>
#include <utility>

#include "core/parallel.h"
#include "flight/tour/common_point.h"
#include "flight/tour/tour_random.h"
#include "flight/tour/tour_region.h"
#include "vantage/query.h"

namespace vantage::internal::flight::tour {
namespace {

constexpr int kSamples = 48;   // random points in each volume
constexpr int kTries = 8;      // points of its box for each of them
constexpr int kAnchors = 6;    // more points of each volume, the deepest one found among them
constexpr double kDeep = 0.9;  // of the greatest depth: deep enough to hover
constexpr double kAny = 0.5;   // likewise, deep enough to know that there is a position

Group with(const Group& group, std::size_t element) {
  Group more = group;
  more.insert(std::lower_bound(more.begin(), more.end(), element), element);
  return more;
}

Group without(const Group& group, std::size_t element) {
  Group less = group;
  less.erase(std::remove(less.begin(), less.end(), element), less.end());
  return less;
}

bool holds_one_of(const Group& group, const std::vector<Group>& conflicts) {
  return std::any_of(conflicts.begin(), conflicts.end(), [&](const Group& one) { return is_subset(one, group); });
}

bool has(const Group& group, std::size_t element) { return std::binary_search(group.begin(), group.end(), element); }

/// Points of all volumes, as deep as the margin. Throws for a volume that has none.
std::vector<Vec3> anchors_of(const FewestRequest& request, const core::ProgressReporter& progress) {
  std::vector<TourTarget> targets;
  for (const FewestTarget& target : request.targets) targets.push_back({target.name, target.volume, std::nullopt});
  std::vector<Vec3> anchors;
  for (const auto& region : make_regions(targets, request.margin_m, progress)) {
    const std::size_t count = std::min<std::size_t>(kAnchors, region->anchors().size());
    anchors.insert(anchors.end(), region->anchors().begin(),
                   region->anchors().begin() + static_cast<std::ptrdiff_t>(count));
  }
  return anchors;
}

}  // namespace

PositionSearch::PositionSearch(const FewestRequest& request, const core::ProgressReporter& progress)
    : request_(request),
      progress_(progress),
      time_limit_s_(request.time_limit_s),
      anchors_(anchors_of(request, progress)) {
  progress.begin("positions");
  const std::size_t count = request.targets.size();
  regions_.resize(count);
  core::ProgressCounter counter(progress_, 5 * count);
  parallel::for_ranges(count, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      regions_[i] = std::make_unique<const Region>(request.targets[i], request.targets[i].volume);
      counter.add();
    }
  });
  together_.assign(count, std::vector<bool>(count, false));
}

CoveringLimits PositionSearch::limits() const {
  CoveringLimits limits;
  limits.is_over = [this] { return is_over(); };
  limits.progress = progress_.part(0, 0);
  return limits;
}

double PositionSearch::depth_m(std::size_t target, const Vec3& point) const {
  return regions_[target]->exact.depths_m({&point, 1}).front();
}

bool PositionSearch::is_allowed(const Vec3& point) const {
  return !request_.airspace || request_.airspace->allows({point, point}, request_.deviation_m);
}

/// Asked again, of each target: nothing here is approximate.
Group PositionSearch::seen_from(const Vec3& point) const {
  Group seen;
  for (std::size_t i = 0; i < count(); ++i) {
    const Region& region = *regions_[i];
    if (region.depth.at_most_m(point - region.depth.origin()) < request_.margin_m) continue;
    if (!(depth_m(i, point) >= request_.margin_m)) continue;
    if (!region.target->sees || region.target->sees(point)) seen.push_back(i);
  }
  return seen;
}

void PositionSearch::add(HoverCandidate candidate) {
  for (const std::size_t a : candidate.sees) {
    for (const std::size_t b : candidate.sees) together_[a][b] = true;
  }
  candidates_.push_back(std::move(candidate));
}

const HoverCandidate* PositionSearch::known(const Group& group) const {
  const auto found = std::find_if(candidates_.begin(), candidates_.end(),
                                  [&](const HoverCandidate& one) { return is_subset(group, one.sees); });
  return found == candidates_.end() ? nullptr : &*found;
}

// ---- candidates

std::vector<Vec3> PositionSearch::random_points() const {
  SplitMix64 draw(1);
  std::vector<Vec3> points;
  for (const auto& region : regions_) {
    const Box& box = region->depth.bounds();
    int found = 0;
    for (int i = 0; i < kTries * kSamples && found < kSamples; ++i) {
      const double x = draw.uniform(box.min.x(), box.max.x()), y = draw.uniform(box.min.y(), box.max.y());
      const Vec3 point(x, y, draw.uniform(box.min.z(), box.max.z()));
      if (region->depth.at_most_m(point) < request_.margin_m) continue;
      if (region->depth.at_least_m(point) < request_.margin_m && region->depth.depth_m(point) < request_.margin_m)
        continue;
      points.push_back(region->depth.origin() + point);
      ++found;
    }
    progress_.check();
  }
  return points;
}

/// What each point sees if the depths are right.
std::vector<Group> PositionSearch::seen_by_depth(const std::vector<Vec3>& points) const {
  std::vector<Group> seen(points.size());
  core::ProgressCounter counter(progress_, points.size() * 5 / 2);
  parallel::for_ranges(points.size(), 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      for (std::size_t i = 0; i < count(); ++i) {
        const SolidDepth& depth = regions_[i]->depth;
        const Vec3 local = points[p] - depth.origin();
        if (depth.at_most_m(local) < request_.margin_m) continue;
        if (depth.at_least_m(local) >= request_.margin_m || depth.depth_m(local) >= request_.margin_m)
          seen[p].push_back(i);
      }
      counter.add();
    }
  });
  return seen;
}

void PositionSearch::sample() {
  std::vector<Vec3> points = anchors_;
  const std::vector<Vec3> more = random_points();
  points.insert(points.end(), more.begin(), more.end());
  const std::vector<Group> seen = seen_by_depth(points);
  std::vector<std::size_t> order(points.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return seen[a].size() != seen[b].size() ? seen[a].size() > seen[b].size() : seen[a] < seen[b];
  });
  for (const std::size_t p : order) {
    progress_.check();
    if (seen[p].empty() || known(seen[p]) || !is_allowed(points[p])) continue;
    Group sure = seen_from(points[p]);
    if (!sure.empty() && !known(sure)) add({points[p], std::move(sure)});
  }
  for (std::size_t i = 0; i < count(); ++i) {
    if (!has_common({i})) unseen_.push_back(i);
  }
}

std::optional<Vec3> PositionSearch::find_common(const Group& group, double share) const {
  std::vector<const SolidDepth*> solids;
  for (const std::size_t i : group) solids.push_back(&regions_[i]->depth);
  std::stable_sort(solids.begin(), solids.end(), [](const SolidDepth* a, const SolidDepth* b) {
    return a->size_m() < b->size_m();  // what is small rules out most
  });
  CommonRequest request;
  request.least_m = request_.margin_m;
  request.share = share;
  request.finest_m = request_.margin_m / 4;
  request.is_allowed = [&](const Vec3& point) { return is_allowed(point) && is_subset(group, seen_from(point)); };
  return deepest_common_point(solids, request, progress_).point;
}

bool PositionSearch::has_common(const Group& group) {
  if (known(group)) return true;
  if (holds_one_of(group, conflicts_)) return false;
  if (const auto point = find_common(group, kAny)) {
    add({*point, seen_from(*point)});
    return true;
  }
  conflicts_.push_back(group);
  return false;
}

void PositionSearch::grow() {
  for (std::size_t first = 0; first < count(); ++first) {
    progress_.report(2 * count() + first, 5 * count());
    if (has(unseen_, first)) continue;
    // The largest group that holds it.
    Group group;
    for (const HoverCandidate& one : candidates_) {
      if (has(one.sees, first) && one.sees.size() > group.size()) group = one.sees;
    }
    for (std::size_t next = 0; next < count() && !is_over(); ++next) {
      if (has(group, next) || has(unseen_, next)) continue;
      const Group more = with(group, next);
      if (!has_common(more)) continue;
      group = known(more)->sees;
    }
  }
}

// ---- groups

std::vector<Group> PositionSearch::cover() const {
  Group seen;
  for (std::size_t i = 0; i < count(); ++i) {
    if (!has(unseen_, i)) seen.push_back(i);
  }
  if (seen.empty()) return {};
  std::vector<Group> sets;
  std::vector<std::size_t> of;  // candidates whose targets no other one sees, too
  for (std::size_t c = 0; c < candidates_.size(); ++c) {
    const Group& one = candidates_[c].sees;
    bool is_more = false;
    for (std::size_t d = 0; d < candidates_.size() && !is_more; ++d) {
      const Group& other = candidates_[d].sees;
      is_more = d != c && is_subset(one, other) && (one.size() < other.size() || d < c);
    }
    if (is_more) continue;
    Group& set = sets.emplace_back();
    for (const std::size_t e : one) {
      set.push_back(static_cast<std::size_t>(std::lower_bound(seen.begin(), seen.end(), e) - seen.begin()));
    }
    of.push_back(c);
  }
  CoveringLimits how = limits();
  how.most_nodes = 50'000;  // what is better is found by dividing
  std::vector<Group> groups;
  for (const std::size_t s : least_cover(seen.size(), sets, how).chosen) groups.push_back(candidates_[of[s]].sees);
  return groups;
}

/// What is left of a group without a common position when all that can be is taken out. It becomes a conflict.
void PositionSearch::learn_conflict(const Group& group) {
  Group kept = group;
  for (const std::size_t member : group) {
    if (is_over()) break;
    const Group less = without(kept, member);
    if (less.size() > 1 && !has_common(less)) kept = less;
  }
  if (std::find(conflicts_.begin(), conflicts_.end(), kept) == conflicts_.end()) conflicts_.push_back(kept);
}

void PositionSearch::improve(std::vector<Group>& best, std::size_t least, const std::vector<Group>& conflicts,
                             const Group& apart) {
  for (const Group& one : conflicts) {
    if (std::find(conflicts_.begin(), conflicts_.end(), one) == conflicts_.end()) conflicts_.push_back(one);
  }
  Group seen;
  for (std::size_t i = 0; i < count(); ++i) {
    if (!has(unseen_, i)) seen.push_back(i);
  }
  const auto number = [&](std::size_t target) {
    return static_cast<std::size_t>(std::lower_bound(seen.begin(), seen.end(), target) - seen.begin());
  };
  const auto numbers = [&](const Group& group) {
    Group result;
    for (const std::size_t target : group) result.push_back(number(target));
    return result;
  };
  const auto affinity = [&](std::size_t a, std::size_t b) { return together_[seen[a]][seen[b]] ? 1.0 : 0.0; };
  while (best.size() > least && !is_over()) {
    progress_.report(3 * count(), 5 * count());
    std::vector<Group> rules;
    for (const Group& one : conflicts_) {
      const bool is_seen = std::none_of(one.begin(), one.end(), [&](std::size_t e) { return has(unseen_, e); });
      if (is_seen) rules.push_back(numbers(one));
    }
    const Division division = divide(seen.size(), best.size() - 1, rules, numbers(apart), affinity, limits());
    if (division.end != Division::End::found) break;
    std::vector<Group> groups, missing;
    for (const Group& one : division.groups) {
      if (one.empty()) continue;
      Group& group = groups.emplace_back();
      for (const std::size_t e : one) group.push_back(seen[e]);
      if (!has_common(group)) missing.push_back(group);
    }
    if (missing.empty()) {
      best = groups;
      continue;
    }
    for (const Group& group : missing) learn_conflict(group);
    std::vector<Group> covered = cover();  // the candidates that came on the way may do
    if (covered.size() < best.size()) best = std::move(covered);
  }
}

// ---- positions

std::vector<HoverPosition> PositionSearch::positions_of(const std::vector<Group>& groups, bool is_deep) const {
  std::vector<Vec3> points;
  for (const Group& group : groups) points.push_back(known(group)->point);
  // Each target to the position that lies deepest in its volume.
  std::vector<Group> assigned(groups.size());
  for (std::size_t i = 0; i < count(); ++i) {
    std::optional<std::size_t> best;
    for (std::size_t g = 0; g < groups.size(); ++g) {
      if (has(groups[g], i) && (!best || depth_m(i, points[g]) > depth_m(i, points[*best]))) best = g;
    }
    if (best) assigned[*best].push_back(i);
  }
  std::vector<HoverPosition> positions;
  for (std::size_t g = 0; g < groups.size(); ++g) {
    if (assigned[g].empty()) continue;
    if (is_deep) progress_.report(4 * groups.size() + g, 5 * groups.size());
    const std::optional<Vec3> deep = is_deep && !is_over() ? find_common(assigned[g], kDeep) : std::nullopt;
    const auto depth_at = [&](const Vec3& point) {
      double depth = std::numeric_limits<double>::infinity();
      for (const std::size_t i : assigned[g]) depth = std::min(depth, depth_m(i, point));
      return depth;
    };
    const Vec3 point = deep && depth_at(*deep) > depth_at(points[g]) ? *deep : points[g];
    positions.push_back({point, seen_from(point), assigned[g], depth_at(point)});
  }
  std::stable_sort(positions.begin(), positions.end(),
                   [](const HoverPosition& a, const HoverPosition& b) { return a.assigned < b.assigned; });
  return positions;
}

}  // namespace vantage::internal::flight::tour
