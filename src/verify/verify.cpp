// The check of docs/verification.md: viewpoints against shadow rays.
#include "vantage/verify.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/parallel.h"
#include "core/progress_reporter.h"
#include "vantage/error.h"
#include "vantage/prove.h"
#include "verify/binomial.h"
#include "verify/limits.h"
#include "verify/link_zone.h"
#include "verify/occluders.h"
#include "verify/sensor_judge.h"
#include "verify/tolerances.h"
#include "verify/viewpoints.h"

namespace vantage {
namespace {

using internal::verify::ClosedMesh;
using internal::verify::Finding;
using internal::verify::Limits;
using internal::verify::LinkZone;
using internal::verify::Occluders;
using internal::verify::Random;
using internal::verify::SensorJudge;
using internal::verify::SensorJudgement;
using internal::verify::TargetView;
using internal::verify::Viewpoint;
using internal::verify::Viewpoints;

constexpr int kRandomEdgePoints = 2;  // an edge, besides its quarter points

/// What is known before any point is tried.
VerifyReport report_of_mesh(const internal::verify::Topology& topology, const VerifyOptions& options) {
  VerifyReport report;
  report.seed = options.seed;
  if (!options.lift_m.empty()) report.lift_m = *std::max_element(options.lift_m.begin(), options.lift_m.end());
  report.rounding_m = options.rounding_m;
  report.closed = topology.closed;
  report.open_edges = topology.open_edges;
  report.oriented = topology.closed && topology.oriented;
  report.flat_facets = topology.flat;
  report.euler = topology.euler;
  return report;
}

struct Verdict {
  explicit Verdict(Random numbers) : random(numbers) {}

  Random random;  ///< of this viewpoint, as far as they are used up
  bool on_surface = false, claimed = false, uniform = false, over = false, under = false;
  bool good = false;       ///< within the limits, and sees what has been looked at so far
  bool undecided = false;  ///< whether it is within those of the sensor; all else is good so far
  double seen_m2 = 0;      ///< of the parts that have been looked at, where a share is asked
  bool is_whole = true;    ///< likewise: all of them was seen
  bool is_enough = false;  ///< likewise: unclaimed, sees enough, but not all
  double depth = 0;        ///< from the surface of the volume, metres; for over and under
  std::size_t rays = 0;
  Vec3 position = Vec3::Zero();        ///< in the frame of the first part
  std::optional<std::size_t> blocked;  ///< the part that the viewpoint does not see whole,
  Vec3 hidden = Vec3::Zero();          ///< and a hidden point of it, in its frame
};

/// The check of a target in parts: the first part's frame is the check's, and the scene is indexed for one part at a
/// time.
class Check {
 public:
  Check(const Scene& scene, const std::vector<Target>& parts, const Sensor& sensor, const Navigation& navigation,
        const Mesh& volume, const VerifyOptions& options)
      : options_(options),
        scene_(scene),
        parts_(parts.begin(), parts.end()),
        sensor_(sensor, parts_, options.tolerance_m),
        volume_(volume, view_.origin(), "volume"),
        limits_(navigation, view_.origin()),
        asked_link_(sensor.link),
        viewpoints_(volume_, view_, sensor_.range(), options.points) {
    const auto& visible = sensor.visible;
    if (visible && visible->share < 1 && !view_.is_point()) set_share(*visible);
  }

  /// Chooses a viewpoint.
  Verdict draw(std::size_t number) const;
  /// Judges whether a viewpoint that another check has chosen is within the limits.
  void judge(Verdict& verdict) const;
  /// What look() looks at from now on. Not while other threads look.
  void turn_to(std::size_t part);
  void look(Verdict& verdict) const;
  /// When all parts have been looked at.
  void settle(Verdict& verdict) const;
  VerifyReport report(const std::vector<Verdict>& verdicts);
  const Vec3& origin() const { return view_.origin(); }
  /// What is wrong at a viewpoint that is not good.
  std::string cause(const Verdict& over_claimed);

 private:
  Vec3 in_frame_of(std::size_t part, const Vec3& position) const {
    return position + (view_.origin() - parts_[part].origin());  // nothing is rounded where the frames are the same
  }
  bool in_front(const Vec3& position, double margin_m = 0) const;
  double allowed_m(const Vec3& position) const;
  void set_share(const VisibleShare& visible);
  void look_at_share(const Vec3& position, Verdict& verdict) const;
  bool sees(const TargetView& part, const Vec3& position, Verdict& verdict) const;
  bool has_link(const Vec3& position, Verdict& verdict) const;

  VerifyOptions options_;
  const Scene& scene_;
  std::vector<TargetView> parts_;
  SensorJudge sensor_;
  const TargetView& view_ = parts_.front();
  ClosedMesh volume_;
  Limits limits_;
  std::optional<RadioLink> asked_link_;
  Viewpoints viewpoints_;
  std::optional<double> asked_m2_;  // of all parts, less what rounding may take; where a share is asked
  std::size_t part_ = 0;
  std::unique_ptr<const Occluders> occluders_;  // of that part, once it was turned to
  std::unique_ptr<const LinkZone> link_;        // of a target that is a point, where there is one
};

void Check::turn_to(std::size_t part) {
  if (occluders_ && part == part_) return;
  occluders_.reset();  // before the next one takes memory
  part_ = part;
  occluders_ = std::make_unique<Occluders>(scene_, parts_[part], sensor_.range());
  if (asked_link_ && !link_) link_ = std::make_unique<LinkZone>(scene_, view_, *asked_link_, sensor_.range());
}

void Check::set_share(const VisibleShare& visible) {
  double area = 0, outline = 0, largest = sensor_.range();
  for (const TargetView& part : parts_) {
    const std::vector<Vec3>& vertices = part.vertices();
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      const Vec3 edge = vertices[(i + 1) % vertices.size()] - vertices[i];
      outline += edge.norm();
      area += 0.5 * (vertices[i] - part.centre()).cross(edge).dot(part.normal());
    }
    largest = std::max(largest, part.origin().cwiseAbs().maxCoeff());
  }
  outline *= std::sqrt(static_cast<double>(visible.cells));
  const double rounding = internal::verify::kOutlineRoundoffs * internal::verify::kRoundoff * largest * outline;
  asked_m2_ = (visible.share - internal::verify::kShareSlack) * area - rounding;
}

/// Whether a position is in front of all parts by more than the margin, but for a point that is seen from all sides.
bool Check::in_front(const Vec3& position, double margin_m) const {
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    if (!parts_[i].in_front(in_frame_of(i, position), margin_m)) return false;
  }
  return true;
}

/// How deep on the wrong side of the surface a position may lie: one that is out of range no deeper than others.
double Check::allowed_m(const Vec3& position) const {
  const double distance = std::min((position - view_.centre()).norm(), sensor_.range());
  return options_.depth_tolerance * distance + options_.rounding_m;
}

/// `position` in the frame of the part that was turned to.
bool Check::sees(const TargetView& part, const Vec3& position, Verdict& verdict) const {
  Random& random = verdict.random;
  const auto hidden = [&](const Vec3& target_point) {
    ++verdict.rays;
    if (!occluders_->hide(position, target_point)) return false;
    verdict.blocked = part_;
    verdict.hidden = target_point;
    return true;
  };
  const std::vector<Vec3>& vertices = part.vertices();
  for (const Vec3& vertex : vertices) {
    if (hidden(vertex)) return false;
  }
  if (part.is_point()) return has_link(position, verdict);
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const Vec3& start = vertices[i];
    const Vec3 edge = vertices[(i + 1) % vertices.size()] - start;
    for (const double share : {0.25, 0.5, 0.75}) {
      if (hidden(start + share * edge)) return false;
    }
    for (int k = 0; k < kRandomEdgePoints; ++k) {
      if (hidden(start + random.uniform() * edge)) return false;
    }
  }
  // Roberts' R2 sequence (the plastic number's powers), shifted anew for every viewpoint.
  double u = random.uniform(), v = random.uniform();
  for (int k = 0; k < options_.target_samples; ++k) {
    if (hidden(part.interior(u, v))) return false;
    u = std::fmod(u + 0.7548776662466927, 1.0);
    v = std::fmod(v + 0.5698402909980532, 1.0);
  }
  const std::optional<Vec3> found = occluders_->find_hidden(position, verdict.rays);
  if (!found) return true;
  verdict.blocked = part_;
  verdict.hidden = *found;
  return false;
}

/// Whether a viewpoint that sees the antenna has a link. One that is not claimed counts only where it has more than the
/// link needs.
bool Check::has_link(const Vec3& position, Verdict& verdict) const {
  if (!link_) return true;
  const bool is_clear = verdict.claimed ? !link_->entered_by(position) : !link_->may_lack(position);
  if (is_clear) return true;
  verdict.blocked = part_;
  verdict.hidden = view_.vertices()[0];
  return false;
}

Verdict Check::draw(std::size_t number) const {
  Verdict verdict(Random(options_.seed, number));
  const Viewpoint viewpoint = viewpoints_.draw(number, verdict.random);
  verdict.position = viewpoint.position;
  const std::optional<bool> claimed = volume_.contains(viewpoint.position);
  verdict.on_surface = !claimed;  // right either way
  if (!claimed) return verdict;
  verdict.claimed = *claimed;
  verdict.uniform = viewpoint.uniform && *claimed;
  judge(verdict);
  return verdict;
}

void Check::judge(Verdict& verdict) const {
  verdict.good = verdict.undecided = verdict.is_enough = false;
  verdict.is_whole = true;
  verdict.seen_m2 = 0;
  verdict.blocked.reset();
  // Nearer to the plane than that the volume may end, and rays pass beneath what stands on it.
  const double margin_m = verdict.claimed ? 0 : allowed_m(verdict.position);
  if (!in_front(verdict.position, margin_m) || limits_.broken_by(verdict.position)) return;
  if (!verdict.claimed && limits_.may_leave_out(verdict.position)) return;
  const SensorJudgement judgement =
      verdict.claimed ? sensor_.of_claimed(verdict.position) : sensor_.of_unclaimed(verdict.position);
  verdict.good = judgement.finding != Finding::broken;
  verdict.undecided = judgement.finding == Finding::undecided;
}

void Check::look(Verdict& verdict) const {
  if (!verdict.good) return;
  const Vec3 position = in_frame_of(part_, verdict.position);
  if (asked_m2_) {
    look_at_share(position, verdict);
  } else {
    verdict.good = sees(parts_[part_], position, verdict);
  }
}

/// Claimed is right what sees enough, and unclaimed what does not see all: what cells cost is counted apart.
void Check::look_at_share(const Vec3& position, Verdict& verdict) const {
  const Occluders::SeenPart seen = occluders_->seen_part(position);
  verdict.seen_m2 += seen.area_m2;
  if (!verdict.claimed && verdict.is_whole) verdict.is_whole = sees(parts_[part_], position, verdict);
  if (seen.hidden && !verdict.blocked) {
    verdict.blocked = part_;
    verdict.hidden = *seen.hidden;
  }
  if (part_ + 1 < parts_.size()) return;
  const bool is_enough = verdict.seen_m2 >= *asked_m2_;
  verdict.is_enough = !verdict.claimed && is_enough && !verdict.is_whole && !verdict.undecided;
  verdict.good = verdict.claimed ? is_enough : verdict.is_whole;
}

/// A file's numbers are not coarser than single precision: what is stated beyond that is not believed.
double most_rounding_m(const Mesh& mesh) {
  Box box;
  for (const auto& [i, j, k] : mesh.triangles) {
    const Vec3 &a = mesh.vertices[i], &b = mesh.vertices[j], &c = mesh.vertices[k];
    if (!((b - a).cross(c - a).squaredNorm() > 0)) continue;
    for (const Vec3& corner : {a, b, c}) box.extend(corner);
  }
  if (box.empty()) return 0;
  const double largest = std::max(box.min.cwiseAbs().maxCoeff(), box.max.cwiseAbs().maxCoeff());
  return std::ldexp(std::max(largest, (box.max - box.min).maxCoeff()), -22);
}

void Check::settle(Verdict& verdict) const {
  if (!verdict.good) verdict.undecided = false;
  if (verdict.on_surface || verdict.undecided) return;
  if (verdict.good == verdict.claimed && !verdict.is_enough) return;
  verdict.depth = volume_.distance_to_surface(verdict.position);
  const bool counts = verdict.depth > allowed_m(verdict.position);
  verdict.over = counts && verdict.claimed;
  verdict.under = counts && !verdict.claimed && verdict.good;
  verdict.is_enough = counts && verdict.is_enough;
}

std::string Check::cause(const Verdict& over_claimed) {
  const Vec3& position = over_claimed.position;
  if (over_claimed.blocked) {
    turn_to(*over_claimed.blocked);
    std::optional<std::size_t> triangle = occluders_->first_hit(in_frame_of(part_, position), over_claimed.hidden);
    if (!triangle && link_) triangle = link_->entered_by(position);
    const bool named =
        triangle && *triangle < scene_.object_of.size() && scene_.object_of[*triangle] < scene_.objects.size();
    return named ? display_name(scene_.objects[scene_.object_of[*triangle]]) : "scene";
  }
  if (!in_front(position)) return "target plane";
  if (auto limit = limits_.broken_by(position)) return *limit;
  return sensor_.of_claimed(position).limit;
}

VerifyReport Check::report(const std::vector<Verdict>& verdicts) {
  VerifyReport report = report_of_mesh(volume_.topology(), options_);
  report.points = verdicts.size();
  const Verdict* worst_over = nullptr;
  const Verdict* worst_under = nullptr;
  std::size_t uniform_over = 0;
  for (const Verdict& verdict : verdicts) {
    report.inside += verdict.claimed;
    report.rays += verdict.rays;
    report.bound_points += verdict.uniform;
    uniform_over += verdict.uniform && verdict.over;
    report.undecided += verdict.undecided;
    report.over_claimed += verdict.over;
    report.under_claimed += verdict.under;
    if (asked_m2_) report.share_unclaimed = report.share_unclaimed.value_or(0) + verdict.is_enough;
    if (verdict.over && (!worst_over || verdict.depth > worst_over->depth)) worst_over = &verdict;
    if (verdict.under && (!worst_under || verdict.depth > worst_under->depth)) worst_under = &verdict;
  }
  report.over_claim_bound = internal::verify::upper_share_bound(uniform_over, report.bound_points);
  if (worst_over) {
    report.worst_over_depth_m = worst_over->depth;
    report.worst_over_point = worst_over->position + view_.origin();
    report.worst_over_cause = cause(*worst_over);
  }
  if (worst_under) {
    report.worst_under_depth_m = worst_under->depth;
    report.worst_under_point = worst_under->position + view_.origin();
  }
  return report;
}

void check_arguments(const VerifyOptions& options) {
  const auto require = [](bool holds, const char* problem, const char* where) {
    if (!holds) throw Error(ErrorCode::value_out_of_range, problem, where, "give a positive, finite number");
  };
  require(std::isfinite(options.depth_tolerance) && options.depth_tolerance >= 0, "the depth tolerance is negative",
          "verify depth_tolerance");
  require(std::isfinite(options.tolerance_m) && options.tolerance_m >= 0, "the tolerance is negative",
          "verify tolerance");
  require(std::isfinite(options.rounding_m) && options.rounding_m >= 0, "the rounding is negative", "verify rounding");
  require(options.points > 0, "there are no viewpoints to try", "verify points");
  require(options.target_samples >= 0, "the number of target samples is negative", "verify target_samples");
}

void check_place(const Target& target) {
  const double most = internal::verify::kFarthestCoordinate;
  double largest = std::abs(target.offset_m);
  for (const std::vector<Vec3>& part : target.parts) {
    for (const Vec3& vertex : part) {
      if (vertex.allFinite()) largest = std::max(largest, vertex.cwiseAbs().maxCoeff());
    }
  }
  if (!(largest > most) || !std::isfinite(largest)) return;  // what is not finite has an error of its own
  throw Error(ErrorCode::coordinate_too_large, "the target lies farther than 1e9 m from the origin",
              "target '" + target.name + "'", "give coordinates in metres");
}

/// The parts, each raised as it was for the volume, but by no more than its surface needs: what lies higher hides it.
/// `lift_m` is what was stated, and then what is believed.
std::vector<Target> raised_parts(const Scene& scene, const Target& target, double range_m, std::vector<double>& lift_m,
                                 const Progress& progress) {
  if (target.parts.empty())
    throw Error(ErrorCode::target_parts_invalid, "the target has no parts", "verify", "give one or more");
  check_place(target);
  if (!lift_m.empty() && lift_m.size() != target.parts.size()) {
    throw Error(ErrorCode::array_sizes_differ,
                "there are " + std::to_string(lift_m.size()) + " lifts for " + std::to_string(target.parts.size()) +
                    " parts of the target",
                "verify lift", "give one for each part, or none");
  }
  std::vector<Target> parts;
  const bool is_raised = std::any_of(lift_m.begin(), lift_m.end(), [](double lift) { return lift > 0; });
  std::vector<double> needed;
  if (is_raised) needed = lifts_needed_m(scene, target, range_m, progress);
  for (std::size_t i = 0; i < target.parts.size(); ++i) {
    parts.push_back(target.part(i));
    if (lift_m.empty() || !(lift_m[i] > 0)) continue;
    lift_m[i] = std::min(lift_m[i], needed[i]);
    parts.back().offset_m += lift_m[i];
  }
  return parts;
}

/// Targets of which a viewpoint must see one from each list, each as its raised parts.
using PartViews = std::vector<std::vector<std::vector<Target>>>;

PartViews raised_views(const Scene& scene, const std::vector<std::vector<Target>>& views, double range_m,
                       std::vector<double>& lift_m, const Progress& progress) {
  std::size_t parts = 0, next = 0;
  for (const std::vector<Target>& list : views) {
    if (list.empty())
      throw Error(ErrorCode::nothing_given, "a list of targets is empty", "verify", "give at least one target");
    for (const Target& target : list) parts += target.parts.size();
  }
  if (views.empty())
    throw Error(ErrorCode::nothing_given, "there are no targets", "verify", "give at least one list of them");
  if (!lift_m.empty() && lift_m.size() != parts) {
    throw Error(
        ErrorCode::array_sizes_differ,
        "there are " + std::to_string(lift_m.size()) + " lifts for " + std::to_string(parts) + " parts of the targets",
        "verify lift", "give one for each part, or none");
  }
  PartViews result;
  for (const std::vector<Target>& list : views) {
    result.emplace_back();
    for (const Target& target : list) {
      std::vector<double> own;
      const auto first = lift_m.begin() + static_cast<std::ptrdiff_t>(lift_m.empty() ? 0 : next);
      if (!lift_m.empty()) own.assign(first, first + static_cast<std::ptrdiff_t>(target.parts.size()));
      result.back().push_back(raised_parts(scene, target, range_m, own, progress));
      std::copy(own.begin(), own.end(), first);
      next += target.parts.size();
    }
  }
  return result;
}

/// Runs something for all viewpoints, on all threads, and counts them.
class ParallelLoop {
 public:
  ParallelLoop(std::size_t points, std::size_t rounds, const Progress& callback)
      : points_(points), progress_(callback), counter_(begun(progress_), points * rounds) {}

  template <typename Act>
  void operator()(const Act& act) {
    internal::parallel::for_ranges(points_, 16, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        act(i);
        counter_.add();
      }
    });
  }

 private:
  static const internal::core::ProgressReporter& begun(const internal::core::ProgressReporter& progress) {
    progress.begin("verify");
    return progress;
  }

  std::size_t points_;
  internal::core::ProgressReporter progress_;
  internal::core::ProgressCounter counter_;
};

/// What has been found of a viewpoint for the targets of one list.
struct Seen {
  bool good = false, undecided = false;  ///< of one of them; `undecided` only where none is good
  bool enough = false;                   ///< where a share is asked: of one of them
  std::string cause;                     ///< of a claimed viewpoint that sees none so far
};

/// The viewpoints of several targets: each chooses its share of them, and all are judged for each.
class MultiTargetCheck {
 public:
  MultiTargetCheck(const Scene& scene, PartViews views, const Sensor& sensor, const Navigation& navigation,
                   const Mesh& volume, const VerifyOptions& options, const Progress& callback)
      : scene_(scene),
        views_(std::move(views)),
        sensor_(sensor),
        navigation_(navigation),
        volume_(volume),
        options_(options),
        verdicts_(options.points, Verdict(Random(options.seed, 0))),
        for_each_viewpoint_(options.points, 1 + 2 * target_count(), callback),
        first_(scene, views_.front().front(), sensor, navigation, volume, options) {}

  VerifyReport run() {
    draw();
    std::vector<Seen> all(options_.points, Seen{true, false, true, {}});
    for (const std::vector<std::vector<Target>>& list : views_) {
      std::vector<Seen> seen(options_.points);
      for (const std::vector<Target>& parts : list) look(parts, seen);
      for (std::size_t i = 0; i < all.size(); ++i) {
        all[i].good = all[i].good && (seen[i].good || seen[i].undecided);
        all[i].undecided = all[i].undecided || seen[i].undecided;
        all[i].enough = all[i].enough && seen[i].enough;
        if (all[i].cause.empty() && !seen[i].good) all[i].cause = seen[i].cause;
      }
    }
    for_each_viewpoint_([&](std::size_t i) {
      verdicts_[i].good = all[i].good;
      verdicts_[i].undecided = all[i].undecided;
      verdicts_[i].is_enough = all[i].enough && !all[i].good && !all[i].undecided && !verdicts_[i].claimed;
      first_.settle(verdicts_[i]);
    });
    for (Verdict& verdict : verdicts_) verdict.blocked.reset();
    VerifyReport report = first_.report(verdicts_);
    const Verdict* worst = nullptr;
    for (const Verdict& verdict : verdicts_) {
      if (verdict.over && (!worst || verdict.depth > worst->depth)) worst = &verdict;
    }
    if (worst) report.worst_over_cause = all[static_cast<std::size_t>(worst - verdicts_.data())].cause;
    return report;
  }

 private:
  std::size_t target_count() const {
    std::size_t count = 0;
    for (const auto& list : views_) count += list.size();
    return count;
  }

  Check check_of(const std::vector<Target>& parts) const {
    return {scene_, parts, sensor_, navigation_, volume_, options_};
  }

  /// Positions are in the frame of the first target.
  void draw() {
    std::size_t number = 0;
    const std::size_t count = target_count();
    for (const auto& list : views_) {
      for (const std::vector<Target>& parts : list) {
        const Check check = check_of(parts);
        const Vec3 shift = check.origin() - first_.origin();
        for_each_viewpoint_([&](std::size_t i) {
          if (i / 8 % count != number) return;  // eight viewpoints make a round of all kinds
          verdicts_[i] = check.draw(i);
          verdicts_[i].position += shift;
        });
        ++number;
      }
    }
  }

  void look(const std::vector<Target>& parts, std::vector<Seen>& seen) {
    Check check = check_of(parts);
    const Vec3 shift = first_.origin() - check.origin();
    std::vector<Verdict> own = verdicts_;
    for (Verdict& verdict : own) verdict.position += shift;
    for (std::size_t part = 0; part < parts.size(); ++part) {
      check.turn_to(part);
      internal::parallel::for_ranges(own.size(), 16, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
          if (own[i].on_surface || seen[i].good) continue;
          if (part == 0) check.judge(own[i]);
          check.look(own[i]);
        }
      });
    }
    std::vector<std::size_t> wrong;
    for_each_viewpoint_([&](std::size_t i) {
      verdicts_[i].rays = own[i].rays;
      seen[i].enough = seen[i].enough || own[i].good || own[i].is_enough;
      if (own[i].on_surface || seen[i].good || !own[i].good) return;
      (own[i].undecided ? seen[i].undecided : seen[i].good) = true;
      if (seen[i].good) seen[i].undecided = false;
    });
    for (std::size_t i = 0; i < own.size(); ++i) {
      const bool needs_cause = own[i].claimed && !own[i].on_surface && !seen[i].good && !seen[i].undecided;
      if (needs_cause && seen[i].cause.empty() && !own[i].good) wrong.push_back(i);
    }
    // Few: none where the volume is right.
    std::stable_sort(wrong.begin(), wrong.end(), [&](std::size_t a, std::size_t b) {
      return own[a].blocked.value_or(0) < own[b].blocked.value_or(0);
    });
    for (const std::size_t i : wrong) seen[i].cause = check.cause(own[i]);
  }

  const Scene& scene_;
  PartViews views_;
  const Sensor& sensor_;
  const Navigation& navigation_;
  const Mesh& volume_;
  const VerifyOptions& options_;
  std::vector<Verdict> verdicts_;
  ParallelLoop for_each_viewpoint_;
  Check first_;
};

}  // namespace

VerifyReport verify_volume(const Scene& scene, const Target& target, const Sensor& sensor, const Navigation& navigation,
                           const Mesh& volume, const VerifyOptions& asked, const Progress& callback) {
  check_sensor(sensor);
  check_navigation(navigation, callback);
  check_arguments(asked);
  VerifyOptions options = asked;
  const std::vector<Target> parts = raised_parts(scene, target, range_limit_m(sensor), options.lift_m, callback);
  const internal::verify::Topology topology = internal::verify::topology_of(volume, "volume");
  options.rounding_m = std::min(options.rounding_m, most_rounding_m(volume));
  if (!topology.closed) return report_of_mesh(topology, options);  // it has no inside to try points in
  Check check(scene, parts, sensor, navigation, volume, options);
  std::vector<Verdict> verdicts(options.points, Verdict(Random(options.seed, 0)));
  ParallelLoop for_each_viewpoint(options.points, parts.size() + 1, callback);
  for_each_viewpoint([&](std::size_t i) { verdicts[i] = check.draw(i); });
  for (std::size_t part = 0; part < parts.size(); ++part) {
    check.turn_to(part);
    for_each_viewpoint([&](std::size_t i) { check.look(verdicts[i]); });
  }
  internal::parallel::for_ranges(options.points, 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) check.settle(verdicts[i]);
  });
  return check.report(verdicts);
}

VerifyReport verify_volume(const Scene& scene, const std::vector<std::vector<Target>>& views, const Sensor& sensor,
                           const Navigation& navigation, const Mesh& volume, const VerifyOptions& asked,
                           const Progress& progress) {
  check_sensor(sensor);
  check_navigation(navigation, progress);
  check_arguments(asked);
  VerifyOptions options = asked;
  PartViews parts = raised_views(scene, views, range_limit_m(sensor), options.lift_m, progress);
  const internal::verify::Topology topology = internal::verify::topology_of(volume, "volume");
  options.rounding_m = std::min(options.rounding_m, most_rounding_m(volume));
  if (!topology.closed) return report_of_mesh(topology, options);
  return MultiTargetCheck(scene, std::move(parts), sensor, navigation, volume, options, progress).run();
}

}  // namespace vantage
