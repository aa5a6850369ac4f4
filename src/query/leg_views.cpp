// LegViews: what hides a target from a leg is one interval for each polygon.
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "core/parallel.h"
#include "core/progress_reporter.h"
#include "core/walk_bvh.h"
#include "exact/blocker.h"
#include "query/leg_check.h"
#include "query/leg_convex.h"
#include "query/leg_hull.h"
#include "query/leg_intervals.h"
#include "query/leg_link.h"
#include "query/side.h"
#include "target/numerics.h"
#include "vantage/error.h"
#include "vantage/query.h"

namespace vantage {
namespace {

namespace query = internal::query;
using internal::core::ProgressReporter;
using query::LegIntervals;
using query::Side;

/// What one target's sides add to a view: not joined, nor by object.
struct FoundParts {
  std::vector<std::pair<std::uint32_t, LegInterval>> hidden;
  LegIntervals out_of_range, behind;
};

/// One side of a target along one leg. Positions are in the side's frame.
class SideLook {
 public:
  SideLook(const Side& side, const Leg& leg, double radius, const ProgressReporter& progress)
      : side_(side),
        leg_(leg),
        progress_(progress),
        radius_(radius),
        from_(side.frame.to_local(leg.from)),
        to_(side.frame.to_local(leg.to)) {
    const double largest =
        std::max({leg.from.norm(), leg.to.norm(), side.frame.origin.norm(), from_.norm(), to_.norm(), radius});
    slack_ = side.target.slack + internal::numerics::kRoundings * std::numeric_limits<double>::epsilon() * largest;
  }

  void add_behind(FoundParts& found) const {
    for (const LegInterval& part : query::where_positive(radius_ + slack_ - from_.z(), radius_ + slack_ - to_.z())) {
      found.behind.push_back(part);
    }
  }

  void add_out_of_range(FoundParts& found) const {
    LegIntervals in_range{{0, 1}};
    if (!side_.is_reachable) in_range.clear();
    for (std::size_t i = 0; i < side_.range.ball_count(); ++i) {
      const auto part = query::ball_part(from_, to_, centre(i), side_.range.radius() - radius_ - slack_);
      in_range = part ? query::common(in_range, {*part}) : LegIntervals{};
    }
    const LegIntervals out = query::rest_of(in_range);
    found.out_of_range.insert(found.out_of_range.end(), out.begin(), out.end());
  }

  void add_hidden(FoundParts& found) const {
    const std::optional<LegInterval> near = part_near_range();
    if (!near) return;
    const Vec3 along = leg_.to - leg_.from;
    const Leg leg{leg_.from + near->begin * along, leg_.from + near->end * along};
    const std::size_t first = found.hidden.size();
    if (side_.link) {
      const auto parts = query::link_parts(*side_.link, side_.scene.origin, leg, radius_, slack_);
      found.hidden.insert(found.hidden.end(), parts.begin(), parts.end());
    } else {
      add_blocked(leg, *near, found);
    }
    const double length = near->end - near->begin;
    for (std::size_t i = first; i < found.hidden.size(); ++i) {
      LegInterval& part = found.hidden[i].second;
      const bool is_whole = part.begin == 0 && part.end == 1;
      part = is_whole ? *near : LegInterval{near->begin + part.begin * length, near->begin + part.end * length};
      part.end = std::min(part.end, 1.0);
    }
  }

 private:
  Vec3 centre(std::size_t ball) const {
    const Eigen::Vector2d& at = side_.range.centre(ball);
    return {at.x(), at.y(), 0};
  }

  /// Where some of the tube may be in range: farther away nothing is looked for.
  std::optional<LegInterval> part_near_range() const {
    LegInterval near{0, 1};
    for (std::size_t i = 0; i < side_.range.ball_count(); ++i) {
      const auto part = query::ball_part(from_, to_, centre(i), side_.range.radius() + radius_ + slack_);
      if (!part) return std::nullopt;
      near = {std::max(near.begin, part->begin), std::min(near.end, part->end)};
    }
    if (near.begin > near.end) return std::nullopt;
    return near;
  }

  /// In shares of `leg`, a part of the whole.
  void add_blocked(const Leg& leg, const LegInterval& near, FoundParts& found) const {
    const query::LegHull hull(side_, leg, radius_ + slack_);
    const PreparedScene::Data& scene = side_.scene;
    internal::exact::BlockerBuilder builder(side_.target);
    const Vec3 from = from_ + near.begin * (to_ - from_), to = from_ + near.end * (to_ - from_);
    std::vector<Vec3> corners, clipped;
    std::vector<internal::core::Plane> planes;
    std::vector<query::HalfSpace> set;
    const auto enter = [&](const internal::core::BvhNode& node) { return hull.may_meet(node.bounds); };
    internal::core::walk_bvh(scene.bvh, enter, [&](std::uint32_t polygon) {
      progress_.tick();
      corners.clear();
      for (const std::uint32_t vertex : scene.corners_of(polygon)) corners.push_back(scene.vertices[vertex]);
      if (!hull.may_meet(corners)) return;
      internal::target::local_polygon(scene, side_.frame, polygon, corners);
      planes.clear();
      clipped.clear();
      if (!builder.build(corners, planes, clipped)) return;
      set.assign(1, {Vec3::UnitZ(), -slack_});
      for (const internal::core::Plane& plane : planes) {
        const double distance = 1 / plane.norm();
        set.push_back({plane * distance, distance - internal::numerics::kTie * distance - slack_});
      }
      if (const auto part = query::near_part(from, to, set, radius_)) {
        found.hidden.emplace_back(scene.polygon_object[polygon], *part);
      }
    });
  }

  const Side& side_;
  const Leg& leg_;
  const ProgressReporter& progress_;
  double radius_, slack_;
  Vec3 from_, to_;
};

std::vector<LegBlocker> by_object(std::vector<std::pair<std::uint32_t, LegInterval>> parts,
                                  const std::vector<SceneObject>& objects) {
  std::stable_sort(parts.begin(), parts.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<LegBlocker> blockers;
  for (std::size_t i = 0; i < parts.size();) {
    LegBlocker& blocker = blockers.emplace_back();
    blocker.object = parts[i].first;
    blocker.name = display_name(objects[blocker.object]);
    for (; i < parts.size() && parts[i].first == blocker.object; ++i) blocker.intervals.push_back(parts[i].second);
    blocker.intervals = query::joined(std::move(blocker.intervals));
  }
  return blockers;
}

/// The target of a link is one point: its zone does not depend on the side.
void look_from(const query::Sides& sides, const Leg& leg, double radius, const ProgressReporter& progress,
               FoundParts& found) {
  for (const auto& side : sides) {
    const SideLook look(*side, leg, radius, progress);
    const bool is_first = side == sides.front();
    if (is_first) look.add_out_of_range(found);
    if (!side->frame.all_sides) look.add_behind(found);
    if (is_first || !side->link) look.add_hidden(found);
  }
}

/// A target, its parts and their sides.
struct Viewed {
  PreparedTarget target;
  std::vector<query::Sides> parts;

  LegView look(const Leg& leg, double radius, const ProgressReporter& progress) const {
    FoundParts found;
    for (const query::Sides& sides : parts) {
      FoundParts of_part;
      look_from(sides, leg, radius, progress, of_part);
      found.hidden.insert(found.hidden.end(), of_part.hidden.begin(), of_part.hidden.end());
      found.out_of_range.insert(found.out_of_range.end(), of_part.out_of_range.begin(), of_part.out_of_range.end());
      found.behind.insert(found.behind.end(), of_part.behind.begin(), of_part.behind.end());
    }
    LegView view;
    view.out_of_range = query::joined(std::move(found.out_of_range));
    view.behind_target = query::joined(std::move(found.behind));
    LegIntervals lost = view.out_of_range;
    lost.insert(lost.end(), view.behind_target.begin(), view.behind_target.end());
    for (const auto& [object, part] : found.hidden) lost.push_back(part);
    view.seen = query::rest_of(query::joined(std::move(lost)));
    view.hidden_by = by_object(std::move(found.hidden), target.data().scene.objects());
    return view;
  }
};

void check_is_seen_whole(const PreparedTarget& target) {
  const std::optional<VisibleShare>& visible = target.sensor().visible;
  if (!visible || !(visible->share < 1)) return;
  throw Error(ErrorCode::not_applicable, "legs are told only from where all of a target is seen, not a share of it",
              "target '" + target.target().name + "'", "leave `visible` out, or ask about points of the leg");
}

}  // namespace

struct LegViews::Data {
  void add(std::vector<Viewed>& view, const PreparedTarget& target) const {
    check_is_seen_whole(target);
    Viewed& viewed = view.emplace_back(Viewed{target, {}});
    const PreparedTarget::Data& prepared = viewed.target.data();
    for (const PreparedTarget::Data::Part& part : prepared.parts) {
      viewed.parts.push_back(query::make_sides(prepared, part, no_limits));
    }
  }

  LegView look(const Leg& leg, double radius, const ProgressReporter& progress) const {
    std::vector<LegView> of_lists;
    for (const std::vector<Viewed>& list : views) {
      std::vector<LegView> of_targets;
      for (const Viewed& viewed : list) of_targets.push_back(viewed.look(leg, radius, progress));
      of_lists.push_back(of_targets.size() == 1 ? std::move(of_targets[0]) : any_of(of_targets));
    }
    return of_lists.size() == 1 ? std::move(of_lists[0]) : all_of(of_lists);
  }

  query::Limits no_limits;  // sides refer to it
  std::vector<std::vector<Viewed>> views;
};

LegViews::LegViews(const PreparedTarget& target) : LegViews(std::vector<std::vector<PreparedTarget>>{{target}}) {}

LegViews::LegViews(const std::vector<std::vector<PreparedTarget>>& views) : data_(std::make_unique<Data>()) {
  const auto is_empty = [](const std::vector<PreparedTarget>& view) { return view.empty(); };
  if (views.empty() || std::any_of(views.begin(), views.end(), is_empty)) {
    throw Error(ErrorCode::nothing_given, "there is no target to ask about", "views", "give one in each list or more");
  }
  for (const std::vector<PreparedTarget>& list : views) {
    std::vector<Viewed>& view = data_->views.emplace_back();
    for (const PreparedTarget& target : list) data_->add(view, target);
  }
}
LegViews::~LegViews() = default;
LegViews::LegViews(LegViews&&) noexcept = default;
LegViews& LegViews::operator=(LegViews&&) noexcept = default;

LegView LegViews::look(const Leg& leg, double radius_m, const Progress& progress) const {
  query::check_leg(leg, radius_m);
  return data_->look(leg, radius_m, ProgressReporter(progress, "leg"));
}

std::vector<LegView> LegViews::look(std::span<const Leg> legs, double radius_m, const Progress& progress) const {
  for (std::size_t i = 0; i < legs.size(); ++i) query::check_leg(legs[i], radius_m, i);
  const ProgressReporter reporter(progress, "legs");
  reporter.begin("looking from legs");
  internal::core::ProgressCounter done(reporter, legs.size());
  std::vector<LegView> views(legs.size());
  internal::parallel::for_ranges(legs.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      views[i] = data_->look(legs[i], radius_m, reporter);
      done.add();
    }
  });
  reporter.finish();
  return views;
}

}  // namespace vantage
