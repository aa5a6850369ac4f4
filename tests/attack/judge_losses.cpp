// What is not claimed though all of the target is seen from there.
#include <algorithm>
#include <cmath>

#include "trial.h"

namespace attack {
namespace {

using vantage::Outcome;

/// Lower over the target's plane than this, an angle, the engine says that it leaves things out.
constexpr double kGrazing = 3e-6;

class Losses {
 public:
  Losses(Trial& trial, std::size_t part)
      : trial_(trial), view_(trial.parts[part]), mesh_(local_mesh(trial, trial.answer.parts[part])) {}

  void measure() {
    double seen = 0, lost = 0;
    for (std::size_t k = 0; k < trial_.options.directions; ++k) {
      Vec3 direction = trial_.random.direction();
      const SeenTarget& target = view_.exact.target();
      if (!target.all_sides && target.normal.dot(direction) < 0) direction = -direction;
      const auto [reached, possible] = ends(direction);
      seen += std::pow(possible, 3);
      lost += std::pow(possible, 3) - std::pow(reached, 3);
    }
    if (seen > 0) trial_.result.lost = std::max(trial_.result.lost, lost / seen);
    // Of a point what a triangle of half a millimetre loses at silhouettes is stated, and more than that is rare.
    if (view_.exact.target().is_point()) return;
    for (std::size_t k = 0; k < trial_.options.directions / 2; ++k) ends(beside_an_edge());
  }

 private:
  Vec3 beside_an_edge() {
    Random& random = trial_.random;
    const auto& triangles = trial_.blockers.triangles;
    if (triangles.empty()) return random.direction();
    const Corners& t = triangles[random.integer(0, static_cast<int>(triangles.size()) - 1)].corners;
    const int k = random.integer(0, 2);
    const double along = random.uniform(0, 1);
    const Vec3 to = (1 - along) * t[k] + along * t[(k + 1) % 3] - view_.centre;
    return (to.normalized() + random.magnitude(1e-6, 1e-1) * random.direction()).normalized();
  }

  struct Ends {
    double reached, possible;
  };

  /// How far the mesh goes along a direction, and how far it could.
  Ends ends(const Vec3& direction) {
    const SeenTarget& target = view_.exact.target();
    const double rise = target.normal.dot(direction);
    if (!target.all_sides && rise < kGrazing) return {0, 0};
    const double most = range_along(target, view_.centre, direction, trial_.c.range - trial_.c.tolerance);
    const double reached = std::min(mesh_.last_exit(view_.centre, direction), most);
    const double next = reached * (1 + 3 * kDepth) + 2 * trial_.rounding();
    const auto clear = [&](double t) { return view_.exact.clear(view_.centre + t * direction); };
    if (next >= most || !clear(std::max(next, 1e-9 * most))) return {reached, reached};
    double low = next, high = most;
    if (clear(most)) low = most;
    for (int step = 0; step < 40 && high - low > 1e-9 * most; ++step) {
      const double middle = 0.5 * (low + high);
      (clear(middle) ? low : high) = middle;
    }
    report(view_.centre + 0.5 * (low + reached) * direction, reached, low);
    return {reached, low};
  }

  void report(const Vec3& place, double reached, double possible) {
    const double gap = (possible - reached) / possible;
    trial_.result.worst_gap = std::max(trial_.result.worst_gap, gap);
    if (mesh_.size() > 0 && (mesh_.locate(place) != Place::outside ||
                             mesh_.distance(place) <= kDepth * (place - view_.centre).norm() + trial_.rounding()))
      return;
    trial_.result.add({FindingKind::under_claim, gap, trial_.to_scene(place), ""});
  }

  Trial& trial_;
  const PartView& view_;
  ClosedMesh mesh_;
};

/// A place from which all parts are seen and in range, well away from everything; NaN when none was found.
/// `least`: height over the target's plane.
Vec3 find_clear(Trial& trial, const std::vector<View>& views, double least, std::size_t tries) {
  for (std::size_t k = 0; k < tries; ++k) {
    const SeenTarget& target = views[0].target();
    Vec3 direction = trial.random.direction();
    if (!target.all_sides && target.normal.dot(direction) < 0) direction = -direction;
    const double most = range_along(target, target.centre, direction, trial.c.range - trial.c.tolerance);
    if (most <= 0) continue;
    Vec3 p = target.centre + trial.random.magnitude(1e-4, 1) * most * direction;
    const bool good = std::all_of(views.begin(), views.end(), [&](const View& view) {
      const bool high = view.target().all_sides || view.target().height(p) > std::max(least, 1e-4 * most);
      return high && view.in_range(p, trial.c.range - trial.c.tolerance) && view.clear(p);
    });
    if (good) return p;
  }
  return Vec3::Constant(NAN);
}

/// The least height over the target's plane that a triangle has within its outline, of triangles that rise above the
/// plane there; infinity: nothing is over the target. In doubles.
double lowest_over(const Trial& trial, const SeenTarget& target) {
  double lowest = INFINITY;
  for (const Blocker& blocker : trial.blockers.triangles) {
    std::vector<Vec3> polygon(blocker.corners.begin(), blocker.corners.end());
    const std::size_t n = target.corners.size();
    for (std::size_t i = 0; i < n && !polygon.empty(); ++i) {
      const Vec3 &a = target.corners[i], inward = target.normal.cross(target.corners[(i + 1) % n] - a);
      std::vector<Vec3> kept;
      for (std::size_t k = 0; k < polygon.size(); ++k) {
        const Vec3 &from = polygon[k], &to = polygon[(k + 1) % polygon.size()];
        const double at_from = inward.dot(from - a), at_to = inward.dot(to - a);
        if (at_from >= 0) kept.push_back(from);
        if (at_from * at_to < 0) kept.emplace_back(from + at_from / (at_from - at_to) * (to - from));
      }
      polygon = kept;
    }
    double low = INFINITY, high = -INFINITY;
    for (const Vec3& p : polygon) {
      low = std::min(low, target.height(p));
      high = std::max(high, target.height(p));
    }
    if (high > -1e-6) lowest = std::min(lowest, low);
  }
  return lowest;
}

/// Whether something is so near to a point that it hides part of what stands for the point.
bool is_beside_point(const Trial& trial) {
  const SeenTarget& target = trial.parts[0].exact.target();
  if (!target.is_point()) return false;
  return std::ranges::any_of(trial.blockers.triangles, [&](const Blocker& blocker) {
    return distance_to_triangle(target.centre, blocker.corners) <= point_radius(trial.c.range);
  });
}

std::vector<View> grown_views(const Trial& trial) {
  std::vector<View> views;
  for (const PartView& part : trial.parts)
    views.emplace_back(trial.blockers, moved_in(part.exact.target(), -part.margin, -part.margin));
  return views;
}

}  // namespace

void judge_losses(Trial& trial) {
  for (std::size_t part = 0; part < trial.answer.parts.size(); ++part)
    if (trial.answer.parts[part].outcome == Outcome::computed) Losses(trial, part).measure();
}

void judge_outcome(Trial& trial) {
  const Outcome outcome = trial.answer.volume.outcome;
  if (outcome == Outcome::outside_limits) return;
  if (outcome == Outcome::blocked_at_once && is_beside_point(trial)) return;
  const double least = outcome == Outcome::blocked_at_once ? 2e-3 * small_world(trial.c.range) : 0;
  const Vec3 p = find_clear(trial, grown_views(trial), least, 400);
  if (p.allFinite()) trial.result.add({FindingKind::bad_outcome, 0, trial.to_scene(p), trial.result.status});
}

// A triangle that hides no part of the target may yet be refused where it is over it by less than the lift that the
// engine states: a world smaller than its millimetres.
void judge_refusal(Trial& trial) {
  if (trial.answer.refusal != "pierced" && trial.answer.refusal != "under the ground") return;
  const std::vector<View> views = grown_views(trial);
  const Vec3 p = find_clear(trial, views, 0, 400);
  if (!p.allFinite()) return;
  const double most_lift = 2.011e-3 * small_world(trial.c.range) + 7 * trial.parts[0].margin;
  const bool is_low = trial.answer.refusal == "pierced" &&
                      std::any_of(views.begin(), views.end(),
                                  [&](const View& view) { return lowest_over(trial, view.target()) < most_lift; });
  trial.result.add(
      {is_low ? FindingKind::lift_refusal : FindingKind::false_refusal, 0, trial.to_scene(p), trial.answer.message});
}

}  // namespace attack
