#include "exact/range_arcs.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "core/portable_math.h"
#include "target/numerics.h"

namespace vantage::internal::exact {
namespace {

constexpr double kShortest = 1e-9;  // metres; less in small worlds
// Directions this near are looked at together: far above rounding, far below the size of a cell.
constexpr double kBand = 1e-9;

int piece_count(const SpaceCircle& circle, const Interval& part, const CurveSampling& sampling) {
  const double by_sagitta = 2 * portable::acos(std::max(0.0, 1 - sampling.sagitta_m / circle.radius));
  const double step = std::min(by_sagitta, sampling.length_m / circle.radius);
  return std::max(1, static_cast<int>(std::ceil(part.length() / step)));
}

// Takes out of an arc on the range sphere the pieces that the grid does without.
void drop_where_fine(const SpaceCircle& circle, const CurveSampling& sampling, const target::RangeRegion& range,
                     OctahedralGrid& grid, CircleArcs& arcs) {
  const double margin = sampling.sagitta_m / range.inner_radius();  // of a chord beside its arc
  std::vector<Interval> fine;
  for (const Interval& part : arcs.parts()) {
    const int pieces = piece_count(circle, part, sampling);
    Vec3 from = circle.at(part.begin);
    for (int k = 0; k < pieces; ++k) {
      const double begin = part.begin + part.length() * k / pieces;
      const double end = k + 1 == pieces ? part.end : part.begin + part.length() * (k + 1) / pieces;
      const Vec3 to = circle.at(end);
      const bool bent = from.x() * to.x() < 0 || from.y() * to.y() < 0;  // on the map
      if (!bent && !grid.is_coarse(range, to_octahedral(from), to_octahedral(to), margin)) {
        if (fine.empty() || fine.back().end != begin) {
          fine.push_back({begin, end});
        } else {
          fine.back().end = end;
        }
      }
      from = to;
    }
  }
  for (const Interval& interval : fine) arcs.drop(interval.begin, interval.end);
}

}  // namespace

double shortest_piece(const target::RangeRegion& range) {
  return kShortest * std::min(1.0, range.radius() / numerics::kFullRange);
}

void keep_in_range(const target::RangeRegion& range, const Vec3& from, const Vec3& to, IntervalSet& shown) {
  const double square = range.radius() * range.radius();
  const Vec3 along = to - from;
  for (std::size_t ball = 0; ball < range.ball_count(); ++ball) {
    const Vec3 centre(range.centre(ball).x(), range.centre(ball).y(), 0);
    const Vec3 a = from - centre;
    if (a.squaredNorm() <= square && (to - centre).squaredNorm() <= square) continue;
    const double p = along.squaredNorm(), q = along.dot(a), r = a.squaredNorm() - square;
    const double discriminant = q * q - p * r;
    if (discriminant <= 0) {
      shown.assign(0, 0);
      return;
    }
    const double root = std::sqrt(discriminant);
    shown.keep((-q - root) / p, (-q + root) / p);
  }
}

void keep_in_balls(const target::RangeRegion& range, std::size_t ball, std::size_t also, CircleArcs& arcs) {
  for (const std::uint32_t other : range.neighbours(ball)) {
    if (arcs.empty()) return;
    if (other == also) continue;
    const auto side = range.farther_from(ball, other);
    arcs.keep(side.normal, side.height);
  }
}

void add_arcs(const SpaceCircle& circle, CircleArcs& arcs, double shortest, const CurveSampling& sampling,
              std::vector<Skeleton::Curve>& out) {
  arcs.drop_shorter_than(shortest / circle.radius);
  for (const Interval& part : arcs.parts()) {
    const int pieces = piece_count(circle, part, sampling);
    const Vec3 normal = circle.axis_1.cross(circle.axis_2);
    std::vector<Vec3>& line = out.emplace_back(Skeleton::Curve{normal, normal.dot(circle.centre), {}}).points;
    for (int i = 0; i <= pieces; ++i) line.push_back(circle.at(part.begin + part.length() * i / pieces));
  }
}

void trace_range_creases(const BlockerSet& blockers, const DirectionTree& tree, const target::RangeRegion& range,
                         const CurveSampling& sampling, OctahedralGrid& grid, std::vector<Skeleton::Curve>& out) {
  const double inner = range.inner_radius();
  for (std::size_t i = 0; i < range.ball_count(); ++i) {
    for (const std::uint32_t j : range.neighbours(i)) {
      if (j < i) continue;
      const Eigen::Vector2d a = range.centre(i), b = range.centre(j), middle = 0.5 * (a + b),
                            along = (b - a).normalized();
      const double square = range.radius() * range.radius() - 0.25 * (b - a).squaredNorm();
      if (square <= 0) continue;
      const SpaceCircle circle{
          {middle.x(), middle.y(), 0}, {along.y(), -along.x(), 0}, Vec3::UnitZ(), std::sqrt(square)};
      CircleArcs arcs(circle);
      arcs.keep(Vec3::UnitZ(), 0);
      keep_in_balls(range, i, j, arcs);
      // Chords as long as the sampling's are as deep as the tolerance. A wider bend would add more than that.
      if ((b - a).norm() < 0.5 * sampling.length_m) drop_where_fine(circle, sampling, range, grid, arcs);
      if (arcs.empty()) continue;
      // Points of the circle have along . x = height, and |x| + |y| + z from `inner` to less than twice the range.
      const double height = along.dot(middle), near = height / inner, far = 0.5 * height / range.radius();
      for (std::uint32_t blocker :
           tree.listed_between({along.x(), along.y(), 0}, std::min(near, far) - kBand, std::max(near, far) + kBand)) {
        arcs.subtract_blocker(blockers.planes_of(blocker), true);
        if (arcs.empty()) break;
      }
      add_arcs(circle, arcs, shortest_piece(range), sampling, out);
    }
  }
}

}  // namespace vantage::internal::exact
