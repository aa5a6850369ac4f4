#include "flight/tour/touring_program.h"

#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

namespace vantage::internal::flight::tour {
namespace {

constexpr double kDirectionUnit = 0x1p-30;
constexpr double kRounding = 0x1p-53;

// ---- of the barriers, in parts of the size of the program -----------------------------------------------------------
constexpr double kFlat = 0.5 * kOutsideOfSize;  // a hull that is thinner in a direction is made so thick
constexpr double kFirstBarrier = 0.3;           // the gap of the first step, of the length
constexpr double kAgainBarrier = 3e-3;          // and of the first one after half-spaces were added
constexpr double kLessBarrier = 0.1;
constexpr double kFirstKept = 1e-3;   // from here on the vectors are looked at
constexpr double kOfPoints = 1e-11;   // where there is nothing to choose; of the size
constexpr int kMostNewtonSteps = 25;  // for one strength of the barrier; five are usual
constexpr double kNewtonDone = 0.1;   // of the squared decrement; below 1 the next step's vectors are short enough
constexpr double kToTheWall = 0.97;

/// A leg with a barrier for its length t: the least of t - strength log(t^2 - |e|^2), and where it counts as
/// `at_least`,
/// - strength log(t - at_least). Its gradient is the leg's vector, shorter than 1.
struct LegTerm {
  Vec3 gradient;
  Eigen::Matrix3d hessian;
};

/// For a leg that counts as at_least > 0: the best t.
double length_with_barrier(double squared, double at_least, double strength) {
  const double low = std::max(at_least, std::sqrt(squared));
  double near = 0, far = 3 * strength;  // above low
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (near + far), t = low + middle;
    const double slope = 1 - 2 * strength * t / (t * t - squared) - strength / (t - at_least);
    (slope < 0 ? near : far) = middle;
  }
  return low + far;
}

LegTerm leg_term(const Vec3& leg, double at_least, double strength) {
  const double squared = leg.squaredNorm();
  LegTerm term;
  if (at_least > 0) {
    const double t = length_with_barrier(squared, at_least, strength);
    const double q = t * t - squared;
    const double by_length =
        -2 * strength / q + 4 * strength * t * t / (q * q) + strength / ((t - at_least) * (t - at_least));
    const double moved = 4 * strength * t / (q * q) / by_length;
    term.gradient = 2 * strength / q * leg;
    term.hessian = 2 * strength / q * Eigen::Matrix3d::Identity() +
                   4 * strength / (q * q) * (1 - t * moved) * leg * leg.transpose();
    return term;
  }
  const double root = std::sqrt(strength * strength + squared);
  const double t = strength + root;
  term.gradient = leg / t;
  term.hessian = (Eigen::Matrix3d::Identity() - leg * leg.transpose() / (t * root)) / t;
  return term;
}

/// The hull of a stop and the half-spaces that stand for it.
struct Stop {
  const Hull* hull = nullptr;
  bool fixed = false;
  Vec3 inside = Vec3::Zero();
  std::vector<HalfSpace> half_spaces;

  void add(HalfSpace half_space, double least_thickness) {
    if (half_space.thickness_m < least_thickness) half_space.offset += 0.5 * least_thickness;
    half_spaces.push_back(half_space);
  }
  double least_slack(const Vec3& at) const {
    double least = std::numeric_limits<double>::infinity();
    for (const HalfSpace& h : half_spaces) least = std::min(least, h.offset - h.normal.dot(at));
    return least;
  }
};

class Solver {
 public:
  Solver(const TouringProgram& program, const TouringOptions& options) : program_(program), options_(options) {
    Box all;
    for (const Hull* hull : program.hulls) all.extend(hull->box());
    size_ = std::max((all.max - all.min).norm(), std::numeric_limits<double>::min());
    for (const Hull* hull : program.hulls) {
      Stop stop{hull, hull->is_point(), hull->inside(), {}};
      if (!stop.fixed) {
        for (const HalfSpace& h : hull->half_spaces()) stop.add(h, kFlat * size_);
      }
      stops_.push_back(std::move(stop));
      points_.push_back(hull->inside());
    }
    free_ = std::any_of(stops_.begin(), stops_.end(), [](const Stop& s) { return !s.fixed; });
  }

  TouringSolution solve() {
    if (free_ && program_.leg_count() > 0) {
      double barrier = kFirstBarrier;
      for (int round = 0; round < options_.most_rounds; ++round) {
        follow_path(barrier);
        if (best_bound_ >= options_.enough_m || !add_half_spaces()) break;
        barrier = kAgainBarrier;
      }
    }
    keep_best();
    TouringSolution solution{std::move(points_), std::move(best_), best_bound_, std::move(added_)};
    return solution;
  }

 private:
  Vec3 leg_vector(const std::vector<Vec3>& points, std::size_t leg) const {
    return points[(leg + 1) % points.size()] - points[leg];
  }

  /// The directions of the legs as they are after the next step of Newton's method, by its own linear system: these,
  /// not the gradients at the points, are in balance to the last digits, even where legs are short.
  std::vector<Direction> directions() {
    if (!free_) strength_ = kOfPoints * size_;
    assemble();
    solve_blocks();
    std::vector<Direction> list;
    for (std::size_t leg = 0; leg < program_.leg_count(); ++leg) {
      const LegTerm term = leg_term(leg_vector(points_, leg), program_.at_least(leg), strength_);
      list.push_back(direction_of(Vec3(term.gradient + term.hessian * leg_vector(step_, leg))));
    }
    return list;
  }

  double count() const {
    double all = 0;
    for (const Stop& s : stops_) all += static_cast<double>(s.half_spaces.size());
    return all + 2.0 * static_cast<double>(program_.leg_count());
  }

  void follow_path(double barrier) {
    const double length = std::max(touring_length(program_, points_), 1e-3 * size_);
    const double by_gap = length / count();
    const double last = std::max(options_.gap, 1e-12) * by_gap;
    for (strength_ = barrier * by_gap;; strength_ = std::max(last, kLessBarrier * strength_)) {
      for (int step = 0; step < kMostNewtonSteps && newton_step(); ++step) {
      }
      if (strength_ <= last) return;
      if (strength_ <= kFirstKept * by_gap) keep_best();
      if (best_bound_ >= options_.enough_m) return;
    }
  }

  /// The weaker the barrier, the better, until rounding has a part in it.
  void keep_best() {
    std::vector<Direction> list = directions();
    const double bound = touring_bound(program_, list);
    if (bound > best_bound_ || best_.empty()) {
      best_bound_ = bound;
      best_ = std::move(list);
    }
  }

  /// The gradient at points + share * step, along the step.
  double slope_at(const std::vector<Vec3>& step, double share) const {
    double slope = 0;
    const std::size_t count = points_.size();
    for (std::size_t leg = 0; leg < program_.leg_count(); ++leg) {
      const std::size_t next = (leg + 1) % count;
      const Vec3 turn = step[next] - step[leg];
      const Vec3 vector = points_[next] - points_[leg] + share * turn;
      const double at_least = program_.at_least(leg), squared = vector.squaredNorm();
      const double t = at_least > 0 ? length_with_barrier(squared, at_least, strength_)
                                    : strength_ + std::sqrt(strength_ * strength_ + squared);
      slope += (at_least > 0 ? 2 * strength_ / (t * t - squared) : 1 / t) * vector.dot(turn);
    }
    for (std::size_t k = 0; k < count; ++k) {
      const Vec3 at = points_[k] + share * step[k];
      for (const HalfSpace& h : stops_[k].half_spaces) {
        slope += strength_ * h.normal.dot(step[k]) / (h.offset - h.normal.dot(at));
      }
    }
    return slope;
  }

  double share_to_walls(const std::vector<Vec3>& step) const {
    double share = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < points_.size(); ++k) {
      for (const HalfSpace& h : stops_[k].half_spaces) {
        const double speed = h.normal.dot(step[k]);
        if (speed > 0) share = std::min(share, (h.offset - h.normal.dot(points_[k])) / speed);
      }
    }
    return share;
  }

  /// False when there is nothing more to win.
  bool newton_step() {
    assemble();
    const double before = solve_blocks();  // gradient . step, negative
    const double decrement = -before / strength_;
    if (!(decrement > kNewtonDone)) return false;
    double share = std::min(1.0, kToTheWall * share_to_walls(step_));
    // The slope rises along the step, as the function is convex.
    for (int i = 0; i < 20; ++i) {
      const double slope = slope_at(step_, share);
      if (!(slope > 0.3 * -before)) break;
      share *= std::max(0.1, before / (before - slope));
    }
    for (std::size_t k = 0; k < points_.size(); ++k) points_[k] += share * step_[k];
    return share > 1e-6;
  }

  /// The Newton system: blocks on the diagonal, to the next stop, and to the last one.
  void assemble() {
    const std::size_t count = points_.size();
    diagonal_.assign(count, Eigen::Matrix3d::Zero());
    next_.assign(count, Eigen::Matrix3d::Zero());
    last_.assign(count, Eigen::Matrix3d::Zero());
    gradient_.assign(count, Vec3::Zero());
    for (std::size_t leg = 0; leg < program_.leg_count(); ++leg) {
      const std::size_t to = (leg + 1) % count;
      const LegTerm term = leg_term(leg_vector(points_, leg), program_.at_least(leg), strength_);
      diagonal_[leg] += term.hessian;
      diagonal_[to] += term.hessian;
      gradient_[leg] -= term.gradient;
      gradient_[to] += term.gradient;
      if (stops_[leg].fixed || stops_[to].fixed) continue;
      if (to + 1 == count) {
        last_[leg] -= term.hessian;
      } else if (to == 0) {
        last_[0] -= term.hessian;
      } else {
        next_[leg] -= term.hessian;
      }
    }
    for (std::size_t k = 0; k < count; ++k) {
      if (stops_[k].fixed) {
        diagonal_[k].setIdentity();
        gradient_[k].setZero();
      }
      std::array<double, 9> sum = {};  // the gradient, and six numbers of the symmetric Hessian
      for (const HalfSpace& h : stops_[k].half_spaces) {
        const double by_slack = 1 / (h.offset - h.normal.dot(points_[k]));
        const double x = by_slack * h.normal.x(), y = by_slack * h.normal.y(), z = by_slack * h.normal.z();
        const std::array<double, 9> more = {x, y, z, x * x, x * y, x * z, y * y, y * z, z * z};
        for (std::size_t i = 0; i < 9; ++i) sum[i] += more[i];
      }
      gradient_[k] += strength_ * Vec3(sum[0], sum[1], sum[2]);
      Eigen::Matrix3d hessian;
      hessian << sum[3], sum[4], sum[5], sum[4], sum[6], sum[7], sum[5], sum[7], sum[8];
      diagonal_[k] += strength_ * hessian;
    }
  }

  /// Fills step_; returns gradient . step.
  double solve_blocks() {
    const std::size_t count = points_.size(), end = count - 1;
    std::vector<Vec3> right(count);
    for (std::size_t k = 0; k < count; ++k) right[k] = -gradient_[k];
    inverse_.resize(count);
    for (std::size_t k = 0; k < end; ++k) {
      inverse_[k] = diagonal_[k].inverse();
      const Eigen::Matrix3d last_inverse = last_[k].transpose() * inverse_[k];
      if (k + 1 < end) {
        const Eigen::Matrix3d next_inverse = next_[k].transpose() * inverse_[k];
        diagonal_[k + 1] -= next_inverse * next_[k];
        last_[k + 1] -= next_inverse * last_[k];
        right[k + 1] -= next_inverse * right[k];
      }
      diagonal_[end] -= last_inverse * last_[k];
      right[end] -= last_inverse * right[k];
    }
    step_.resize(count);
    step_[end] = diagonal_[end].inverse() * right[end];
    double product = gradient_[end].dot(step_[end]);
    for (std::size_t k = end; k-- > 0;) {
      Vec3 left = right[k] - last_[k] * step_[end];
      if (k + 1 < end) left -= next_[k] * step_[k + 1];
      step_[k] = inverse_[k] * left;
      product += gradient_[k].dot(step_[k]);
    }
    return product;
  }

  /// Where a point lies outside of its hull; false if none does. Those inside stay, the others go inside.
  bool add_half_spaces() {
    const double tolerance =
        std::max(options_.in_hull * std::max(touring_length(program_, points_), 1e-3 * size_), kOutsideOfSize * size_);
    bool any = false;
    for (std::size_t k = 0; k < points_.size(); ++k) {
      Stop& stop = stops_[k];
      if (stop.fixed) continue;
      const NearestInHull near = stop.hull->nearest(points_[k], 0.1 * tolerance);
      if (near.distance_m <= tolerance) continue;
      const Vec3 normal = (points_[k] - near.point) / near.distance_m;
      const HalfSpace added = stop.hull->half_space(normal);
      stop.add(added, kFlat * size_);
      added_.emplace_back(k, added);
      any = true;
    }
    if (!any) return false;
    for (std::size_t k = 0; k < points_.size(); ++k) {
      if (stops_[k].fixed) continue;
      Vec3& point = points_[k];
      point += 0.02 * (stops_[k].inside - point);
      for (int i = 0; i < 60 && !(stops_[k].least_slack(point) > 0); ++i) point += 0.5 * (stops_[k].inside - point);
    }
    return true;
  }

  const TouringProgram& program_;
  const TouringOptions& options_;
  double size_ = 0;
  bool free_ = false;
  double strength_ = 0;
  double best_bound_ = -std::numeric_limits<double>::infinity();
  std::vector<Direction> best_;
  std::vector<std::pair<std::size_t, HalfSpace>> added_;
  std::vector<Stop> stops_;
  std::vector<Vec3> points_, gradient_, step_;
  std::vector<Eigen::Matrix3d> diagonal_, next_, last_, inverse_;
};

}  // namespace

Direction direction_of(const Vec3& vector) {
  const double norm = vector.norm();
  if (!(norm > 0) || !std::isfinite(norm)) return {0, 0, 0};
  double scale = (norm > 1 ? 1 / norm : 1.0) / kDirectionUnit;
  for (;; scale *= 1 - 0x1p-50) {
    Direction direction;
    std::int64_t squared = 0;
    for (int k = 0; k < 3; ++k) {
      direction[k] = static_cast<std::int32_t>(scale * vector[k]);
      squared += std::int64_t{direction[k]} * direction[k];
    }
    if (squared <= std::int64_t{1} << (2 * kDirectionBits)) return direction;
  }
}

Vec3 vector_of(const Direction& direction) {
  return kDirectionUnit *
         Vec3(static_cast<double>(direction[0]), static_cast<double>(direction[1]), static_cast<double>(direction[2]));
}

TouringSolution solve_touring(const TouringProgram& program, const TouringOptions& options) {
  return Solver(program, options).solve();
}

double touring_part(const Hull& hull, const Direction* before, const Direction* behind) {
  Vec3 direction = Vec3::Zero();  // exact: whole numbers up to 2^31 times 2^-30
  if (before) direction += vector_of(*before);
  if (behind) direction -= vector_of(*behind);
  return direction.dot(hull.lowest(direction));
}

double touring_bound_of(std::span<const double> parts, double reach_m, double moved_m) {
  double sum = 0;
  for (const double part : parts) sum += part;
  // For each point: |direction|_1 <= 2 sqrt(3), the product and its sum have 5 roundings, 2 more are in what lowest()
  // may overlook, each of 2 sqrt(3) R at most. The sum of the m terms adds m roundings of 2 sqrt(3) R each.
  const double m = static_cast<double>(parts.size());
  return sum - (4 * m + 40) * kRounding * reach_m - 2.001 * moved_m;
}

double touring_bound(const TouringProgram& program, std::span<const Direction> directions) {
  if (directions.empty()) return 0;
  const std::size_t count = program.hulls.size();
  std::vector<double> parts;
  double reach = 0, moved = 0;
  for (std::size_t k = 0; k < count; ++k) {
    const Direction* before = k > 0 || program.closed ? &directions[(k + count - 1) % count] : nullptr;
    parts.push_back(touring_part(*program.hulls[k], before, k < directions.size() ? &directions[k] : nullptr));
    reach += program.hulls[k]->reach_m();
    moved += program.hulls[k]->moved_m();
  }
  double added = 0;
  for (std::size_t leg = 0; leg < directions.size(); ++leg) {
    const double at_least = program.at_least(leg);
    // A norm of three numbers is within three roundings. It is rounded up to whole units, as whoever checks it may do.
    const double norm = std::ceil((1 + 4 * kRounding) * vector_of(directions[leg]).norm() / kDirectionUnit);
    if (at_least > 0) added += at_least * std::max(0.0, 1 - norm * kDirectionUnit);
  }
  return touring_bound_of(parts, reach + added, moved) + added * (1 - 8 * kRounding);
}

double touring_length(const TouringProgram& program, std::span<const Vec3> points) {
  double length = 0;
  for (std::size_t leg = 0; leg < program.leg_count(); ++leg) {
    length += std::max(program.at_least(leg), (points[(leg + 1) % points.size()] - points[leg]).norm());
  }
  return length;
}

}  // namespace vantage::internal::flight::tour
