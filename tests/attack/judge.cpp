#include "judge.h"

#include <algorithm>
#include <cmath>

#include "trial.h"

namespace attack {
namespace {

using vantage::Outcome;

constexpr const char* kNames[kClasses] = {
    "over-claim", "thin over-claim", "out of range", "behind target",  "outside limits", "bad mesh",    "flat facets",
    "bad causes", "query over",      "bad outcome",  "false refusal",  "defect",         "crash",       "hang",
    "shallow",    "touching",        "query under",  "query and mesh", "blocked by",     "under-claim", "lift refusal",
    "reversed"};

}  // namespace

const char* name_of(FindingKind which) { return kNames[static_cast<int>(which)]; }

bool is_wrong(FindingKind which) { return which < FindingKind::shallow; }

void Judgement::add(Finding finding) {
  for (Finding& f : findings) {
    if (f.which != finding.which) continue;
    if (f.share < finding.share) f = std::move(finding);
    return;
  }
  findings.push_back(std::move(finding));
}

const Finding* Judgement::find(FindingKind which) const {
  const auto at = std::find_if(findings.begin(), findings.end(), [&](const Finding& f) { return f.which == which; });
  return at == findings.end() ? nullptr : &*at;
}

bool Judgement::wrong() const {
  return std::any_of(findings.begin(), findings.end(), [](const Finding& f) { return is_wrong(f.which); });
}

Trial::Trial(const Case& the_case, const Answer& the_answer, const JudgeOptions& the_options)
    : c(the_case), answer(the_answer), options(the_options), blockers(c.scene, c.parts), random(c.seed ^ 0x6a75646765) {
  for (std::size_t k = 0; k < c.parts.size(); ++k) {
    const bool made = k < answer.parts.size();
    const double lift = made && !answer.parts[k].lift_m.empty() ? answer.parts[k].lift_m[0] : 0;
    const SeenTarget target = make_seen_target(c.parts[k], lift, blockers.origin);
    const Vec3 centre = made ? Vec3(answer.parts[k].frame.origin - blockers.origin) : target.centre;
    parts.emplace_back(blockers, target, strip_width(blockers, target, c.range), centre);
    result.lift = std::max(result.lift, lift);
  }
}

bool PartView::surely_hides(std::size_t triangle, const Vec3& point) const {
  return std::all_of(inner.begin(), inner.end(), [&](const View& view) { return view.hides(triangle, point); });
}

std::optional<std::size_t> PartView::surely_hiding(const Vec3& point, TriangleFilter filter) const {
  std::optional<std::size_t> found = inner[0].first_hiding(point, filter);
  while (found && !surely_hides(*found, point)) found = inner[0].first_hiding(point, filter, *found + 1);
  return found;
}

std::optional<std::size_t> PartView::surely_hiding(const Corners& facet, TriangleFilter filter) const {
  std::optional<std::size_t> found;
  for (const View& view : inner) {
    found = view.first_hiding(facet, filter);
    if (!found) break;
  }
  return found;
}

double small_world(double range) { return std::min(1.0, range / 20); }

double point_radius(double range) { return 5e-4 * small_world(range); }

double strip_width(const Blockers& blockers, const SeenTarget& target, double range) {
  const double radius = target.is_point() ? point_radius(range) : enclosing_radius(target);
  const double largest = (target.centre + blockers.origin).cwiseAbs().maxCoeff() +
                         (target.centre - blockers.middle).cwiseAbs().maxCoeff() + radius + range;
  return 1.01 * std::max(1e-9 * std::min(1.0, radius), 8 * 2.22e-16 * largest);
}

std::string Trial::object_of(std::size_t triangle) const {
  return display_name(c.scene.objects[blockers.triangles[triangle].object]);
}

vantage::Mesh local_mesh(const Trial& trial, const vantage::Volume& volume) {
  if (faults(volume.mesh).bad_index) return {};
  vantage::Mesh mesh = volume.mesh;
  for (Vec3& v : mesh.vertices) v -= trial.blockers.origin;
  return mesh;
}

double range_along(const SeenTarget& target, const Vec3& from, const Vec3& direction, double range) {
  double least = INFINITY;
  for (const Vec3& corner : target.corners) {
    const Vec3 away = from - corner;
    const double b = away.dot(direction), under = b * b - away.squaredNorm() + range * range;
    if (under <= 0) return 0;
    least = std::min(least, std::sqrt(under) - b);
  }
  return std::max(least, 0.0);
}

Judgement judge(const Case& c, const Answer& answer, const JudgeOptions& options) {
  Trial trial(c, answer, options);
  Judgement& result = trial.result;
  if (answer.thrown) {
    result.status = answer.defect ? "defect" : "refused: " + answer.refusal;
    if (answer.defect) {
      result.add({FindingKind::defect, 0, Vec3::Zero(), answer.message});
    } else {
      judge_refusal(trial);
    }
    return result;
  }
  result.status = name_of(answer.volume.outcome);
  if (answer.volume.outcome == Outcome::computed) {
    judge_claims(trial);
  } else if (!c.sensor.link) {
    judge_outcome(trial);
  }
  // Losses and answers are judged by the line of sight alone. The zone of a link takes away more, so links are left
  // out.
  if (!c.sensor.link) judge_losses(trial);
  if (options.query && !c.sensor.link) judge_query(trial);
  if (options.reversed && c.parts.size() == 1 && !c.parts[0].is_point()) {
    const std::string differs = reversed_differs(c, answer.parts[0]);
    if (!differs.empty()) result.add({FindingKind::reversed, 0, Vec3::Zero(), differs});
  }
  return result;
}

}  // namespace attack
