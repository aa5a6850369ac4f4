// query_points against the oracle, and against the mesh.
#include <algorithm>
#include <cmath>
#include <set>

#include "trial.h"

namespace attack {
namespace {

using vantage::Outcome;
using vantage::PointAnswer;

class Queries {
 public:
  Queries(Trial& trial, std::size_t part)
      : trial_(trial), part_(part), view_(trial.parts[part]), mesh_(local_mesh(trial, trial.answer.parts[part])) {}

  void ask() {
    std::vector<Vec3> points;
    for (std::size_t k = 0; k < trial_.options.directions; ++k) points.push_back(draw());
    std::vector<Vec3> in_scene;
    for (const Vec3& p : points) in_scene.push_back(trial_.to_scene(p));
    std::string message;
    const auto answers = ask_query(trial_.c, part_, in_scene, message);
    if (!answers) {
      trial_.result.add({FindingKind::defect, 0, Vec3::Zero(), "query_points throws: " + message});
      return;
    }
    for (std::size_t k = 0; k < points.size(); ++k) {
      against_oracle(in_scene[k] - trial_.blockers.origin, (*answers)[k]);
      if (mesh_.size() > 0) against_mesh(in_scene[k] - trial_.blockers.origin, (*answers)[k]);
    }
  }

 private:
  /// Beside the end of a line of sight mostly, else anywhere.
  Vec3 draw() {
    Random& random = trial_.random;
    Vec3 direction = random.direction();
    const SeenTarget& target = view_.exact.target();
    if (!target.all_sides && target.normal.dot(direction) < 0 && random.chance(0.95)) direction = -direction;
    double away = random.magnitude(1e-3, 1.2) * trial_.c.range;
    const double end = mesh_.last_exit(view_.centre, direction);
    if (end > 1e-9 * trial_.c.range && random.chance(0.7))
      away = end * (1 + random.sign() * random.magnitude(3e-6, 0.3));
    return view_.centre + away * direction;
  }

  void against_oracle(const Vec3& p, const PointAnswer& answer) {
    const SeenTarget& target = view_.exact.target();
    const Vec3 from_centre = p - view_.centre;
    const double away = from_centre.norm();
    const double step = kDepth + trial_.rounding() / away;
    const Vec3 nearer = p - step * from_centre, farther = p + step * from_centre;
    const double height = target.all_sides ? away : target.height(p);
    if (std::abs(height) < 1e-5 * away) return;
    const double place_margin = std::abs(answer.margin_m) / away;
    if (answer.inside) {
      // Wrong deep inside what is claimed, but for the rounding of coordinates, or deep inside what is hidden.
      const bool is_deep = answer.margin_m > step * away;
      if (height < 0 || !view_.exact.in_range(nearer, trial_.c.range) ||
          is_hidden_all_round(p, is_deep ? trial_.rounding() : step * away))
        trial_.result.add({FindingKind::query_over, place_margin, trial_.to_scene(p), ""});
      return;
    }
    // A point is computed as a small triangle about it.
    if (!target.is_point() && height > 0 && view_.exact.in_range(farther, trial_.c.range) && view_.exact.clear(farther))
      trial_.result.add({FindingKind::query_under, place_margin, trial_.to_scene(p), names(answer)});
    if (!target.is_point() && height > 0) check_names(nearer, farther, answer);
  }

  bool is_surely_hidden(const Vec3& p) const {
    return view_.exact.first_hiding(p) && view_.surely_hiding(p, TriangleFilter::not_thin);
  }

  /// Whether the target is hidden from there, and from so far away in any of some directions: towards the centre and
  /// the corners of the target, along the axes, and away from its plane.
  bool is_hidden_all_round(const Vec3& p, double radius) const {
    const SeenTarget& target = view_.exact.target();
    std::vector<Vec3> directions{view_.centre - p, target.normal, -target.normal};
    for (const Vec3& corner : target.corners) directions.push_back(corner - p);
    for (int axis = 0; axis < 3; ++axis) {
      directions.push_back(Vec3::Unit(axis));
      directions.push_back(-Vec3::Unit(axis));
    }
    return is_surely_hidden(p) && std::all_of(directions.begin(), directions.end(), [&](const Vec3& direction) {
             return is_surely_hidden(p + radius * direction.normalized());
           });
  }

  static std::string names(const PointAnswer& answer) {
    std::string text;
    for (const std::string& name : answer.blocked_by) text += (text.empty() ? "" : ", ") + name;
    return text;
  }

  void check_names(const Vec3& nearer, const Vec3& farther, const PointAnswer& answer) {
    std::set<std::string> surely, perhaps;
    for (std::size_t i = 0; i < trial_.blockers.triangles.size(); ++i) {
      const bool hides = view_.exact.hides(i, farther);
      if (hides) perhaps.insert(trial_.object_of(i));
      const Blocker& blocker = trial_.blockers.triangles[i];
      if (hides && !blocker.thin && !blocker.repeat && view_.exact.hides(i, nearer) && view_.surely_hides(i, nearer))
        surely.insert(trial_.object_of(i));
    }
    const std::set<std::string> named(answer.blocked_by.begin(), answer.blocked_by.end());
    for (const std::string& name : named) {
      if (!perhaps.contains(name))
        trial_.result.add({FindingKind::blocked_by, 0, trial_.to_scene(farther), name + " hides nothing"});
    }
    for (const std::string& name : surely) {
      if (!named.contains(name))
        trial_.result.add({FindingKind::blocked_by, 0, trial_.to_scene(farther), name + " is not named"});
    }
  }

  void against_mesh(const Vec3& p, const PointAnswer& answer) {
    const SeenTarget& target = view_.exact.target();
    const Vec3 from_centre = p - view_.centre;
    const double away = from_centre.norm();
    const Vec3 direction = from_centre / away;
    if (!target.all_sides && target.normal.dot(direction) < 1e-5) return;
    if (!std::isfinite(answer.margin_m)) return;
    const double asked = away + answer.margin_m, reached = mesh_.last_exit(view_.centre, direction);
    const double in_range = range_along(target, view_.centre, direction, trial_.c.range - trial_.c.tolerance);
    const double gap = (std::min(asked, in_range) - reached) / std::max(asked, reached);
    const double step = kDepth + trial_.rounding() / away;
    if (gap > 2 * step || reached > asked * (1 + step)) {
      trial_.result.add({FindingKind::query_mesh, std::max(gap, (reached - asked) / reached), trial_.to_scene(p),
                         gap > 0 ? "the mesh ends sooner" : "the mesh goes on"});
    }
  }

  Trial& trial_;
  std::size_t part_;
  const PartView& view_;
  ClosedMesh mesh_;
};

}  // namespace

void judge_query(Trial& trial) {
  for (std::size_t part = 0; part < trial.answer.parts.size(); ++part) Queries(trial, part).ask();
}

}  // namespace attack
