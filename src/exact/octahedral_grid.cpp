#include "exact/octahedral_grid.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <numbers>

#include "core/portable_math.h"
#include "core/text.h"
#include "vantage/error.h"

namespace vantage::internal::exact {
namespace {

constexpr int kTrial = 16;        // lines of the grid on which the facets' depth below the sphere is measured
constexpr int kStarts = 2;        // places for each line, along a side of the map, where a search for a line may begin
constexpr int kMostLines = 2500;  // 25 million triangles at most
constexpr double kLeastSnap = 1e-8;  // a hundred times numerics::kSnap: the same cells for all snapping up to this
constexpr double kSafety = 0.9;      // the depth falls with the square of the spacing only in the limit

// Lines at the same angles along the axes, t / (1 + t), would make cells halfway to the horizon that need the most
// lines. Moved by this much of the map they are about as wide as others, which takes a fifth of the facets away.
// Lines i and n - i add up to 1.
constexpr double kMoved = 0.0221;

double line_at(int i, int n) {
  if (i == 0) return 0;
  if (i == n) return 1;
  const double t = portable::tan(std::numbers::pi / 2 * i / n);
  return t / (1 + t) - kMoved * portable::sin(2 * std::numbers::pi * i / n);
}

// How far the plane through three points of a ball's sphere can lie inside it.
double depth_below(const Vec3& a, const Vec3& b, const Vec3& c, double radius) {
  const Vec3 u = b - a, v = c - a, w = c - b;
  const double area2 = u.cross(v).norm();
  const double circumradius = u.norm() * v.norm() * w.norm() / (2 * area2);
  return circumradius >= radius ? radius : radius - std::sqrt(radius * radius - circumradius * circumradius);
}

double deepest_on_trial_grid(const target::RangeRegion& range) {
  double deepest = 0;
  const auto depth = [&](const OctahedralPoint& p, const OctahedralPoint& q, const OctahedralPoint& r) {
    const std::size_t ball = range.nearest_ball(to_direction((p + q + r) / 3));
    const auto lift = [&](const OctahedralPoint& x) {
      return Vec3(to_direction(x) / range.gauge(ball, to_direction(x)));
    };
    return depth_below(lift(p), lift(q), lift(r), range.radius());
  };
  for (int quadrant = 0; quadrant < 4; ++quadrant) {
    for (int i = 0; i < kTrial; ++i) {
      for (int j = 0; i + j < kTrial; ++j) {
        const double sa = quadrant & 1 ? -1 : 1, sb = quadrant & 2 ? -1 : 1;
        const double a0 = sa * line_at(i, kTrial), a1 = sa * line_at(i + 1, kTrial);
        const double b0 = sb * line_at(j, kTrial), b1 = sb * line_at(j + 1, kTrial);
        deepest = std::max(deepest, depth({a0, b0}, {a1, b0}, {a0, b1}));
        if (i + j + 1 < kTrial) deepest = std::max(deepest, depth({a1, b0}, {a1, b1}, {a0, b1}));
      }
    }
  }
  return deepest;
}

}  // namespace

OctahedralGrid::OctahedralGrid(const target::RangeRegion& region, double tolerance) : tolerance_(tolerance) {
  const double needed = kTrial * std::sqrt(deepest_on_trial_grid(region) / (kSafety * tolerance));
  if (!(needed <= kMostLines)) {
    const double least = tolerance * (needed / kMostLines) * (needed / kMostLines);
    throw Error(ErrorCode::tolerance_too_fine,
                "the tolerance is too fine for this range: the mesh would have too many facets",
                "tolerance " + core::metres_text(tolerance) + " at range " + core::metres_text(region.radius()),
                "give a tolerance of at least " + core::metres_text(1.001 * least));
  }
  n_ = std::max(8, static_cast<int>(std::ceil(needed)));
  for (int i = 0; i <= n_; ++i) lines_.push_back(line_at(i, n_));
  for (int i = 0, k = 0; k <= kStarts * n_; ++k) {
    while (i + 1 < n_ && lines_[i + 1] * kStarts * n_ <= k) ++i;
    starts_.push_back(i);
  }
  states_.assign(static_cast<std::size_t>(2 * n_) * (2 * n_), unknown);
}

int OctahedralGrid::locate(double coordinate) const {
  const double x = std::min(std::abs(coordinate), 1.0);
  int i = starts_[static_cast<std::size_t>(x * kStarts * n_)];
  while (i > 0 && lines_[i] > x) --i;
  while (i + 1 < n_ && lines_[i + 1] <= x) ++i;
  if (coordinate >= 0) return i;
  return lines_[i] == x ? -i : -i - 1;
}

template <typename Visit>
void OctahedralGrid::for_cells_on(const OctahedralPoint& from, const OctahedralPoint& to, double snap,
                                  const Visit& visit) const {
  const double margin = 4 * std::max(snap, kLeastSnap);
  const OctahedralPoint along = to - from;
  const int j0 = locate(std::min(from.y(), to.y()) - margin), j1 = locate(std::max(from.y(), to.y()) + margin);
  const int i0 = locate(std::min(from.x(), to.x()) - margin), i1 = locate(std::max(from.x(), to.x()) + margin);
  for (int j = j0; j <= j1; ++j) {
    double left = std::min(from.x(), to.x()), right = std::max(from.x(), to.x());
    if (i0 < i1 && j0 < j1 && along.y() != 0) {  // of a slanted segment the part in this row
      const double enters = std::clamp((line(j) - margin - from.y()) / along.y(), 0.0, 1.0);
      const double leaves = std::clamp((line(j + 1) + margin - from.y()) / along.y(), 0.0, 1.0);
      left = from.x() + enters * along.x();
      right = from.x() + leaves * along.x();
      if (left > right) std::swap(left, right);
    }
    for (int i = i0; i <= i1; ++i)
      if (has_cell(i, j) && line(i) <= right + margin && line(i + 1) >= left - margin) visit(i, j);
  }
}

void OctahedralGrid::mark(const OctahedralPoint& from, const OctahedralPoint& to, double snap) {
  for_cells_on(from, to, snap, [&](int i, int j) { states_[index(i, j)] = mixed; });
}

bool OctahedralGrid::is_coarse(const target::RangeRegion& region, const OctahedralPoint& from,
                               const OctahedralPoint& to, double snap) {
  fineness_.resize(states_.size(), not_measured);
  bool found = false;
  for_cells_on(from, to, snap, [&](int i, int j) {
    std::uint8_t& known = fineness_[index(i, j)];
    if (known == not_measured) known = is_coarse_cell(region, i, j) ? coarse : fine;
    found = found || known == coarse;
  });
  return found;
}

bool OctahedralGrid::is_coarse_cell(const target::RangeRegion& region, int i, int j) const {
  const Corners c = corners(i, j);
  std::size_t ball = region.nearest_ball(to_direction(inside(i, j)));
  const auto lift = [&](int a, int b) {
    const Vec3 direction = to_direction(node(a, b));
    return Vec3(direction / region.gauge(direction, ball));
  };
  const Vec3 p = lift(c.a1, c.b0), q = lift(c.a0, c.b1);
  return region.is_deeper_than(tolerance_, {lift(c.a0, c.b0), p, q}) ||
         (!at_horizon(i, j) && region.is_deeper_than(tolerance_, {p, lift(c.a1, c.b1), q}));
}

void OctahedralGrid::mark_square(const OctahedralPoint& middle, double reach) {
  const int i0 = locate(middle.x() - reach), i1 = locate(middle.x() + reach);
  const int j0 = locate(middle.y() - reach), j1 = locate(middle.y() + reach);
  for (int j = j0; j <= j1; ++j) {
    for (int i = i0; i <= i1; ++i)
      if (has_cell(i, j)) states_[index(i, j)] = mixed;
  }
}

void OctahedralGrid::settle(const std::function<bool(const OctahedralPoint&)>& is_range_at) {
  runs_.clear();
  mixed_cells_.clear();
  first_run_.assign(1, 0);
  for (int j = -n_; j < n_; ++j) {
    settle_row(j, is_range_at);
    list_row(j);
    first_run_.push_back(static_cast<std::uint32_t>(runs_.size()));
  }
}

void OctahedralGrid::settle_row(int j, const std::function<bool(const OctahedralPoint&)>& is_range_at) {
  const int width = row_width(j), width_below = has_cell(0, j - 1) ? row_width(j - 1) : 0;
  std::uint8_t* const row = &states_[index(0, j)];
  const std::uint8_t* const below = width_below ? &states_[index(0, j - 1)] : nullptr;
  for (int i = -width; i < width;) {
    if (row[i] != unknown) {
      ++i;
      continue;
    }
    const int begin = i;
    State state = unknown;  // that of a settled cell below, if there is one
    for (; i < width && row[i] == unknown; ++i) {
      if (state == unknown && i >= -width_below && i < width_below && below[i] >= range)
        state = static_cast<State>(below[i]);
    }
    if (state == unknown) state = is_range_at(inside(begin + (i - begin) / 2, j)) ? range : blocked;
    // Cells of the range are not looked at again: where a rim were missing, all that it bounds would be over-claimed.
    if (state == range && !(is_range_at(inside(begin, j)) && is_range_at(inside(i - 1, j)))) state = mixed;
    std::fill(row + begin, row + i, static_cast<std::uint8_t>(state));
  }
}

void OctahedralGrid::list_row(int j) {
  const int width = row_width(j);
  const std::uint8_t* const row = &states_[index(0, j)];
  for (int i = -width; i < width;) {
    const int begin = i;
    while (i < width && row[i] == range) ++i;
    if (i > begin) runs_.push_back({begin, i});
    for (; i < width && row[i] != range; ++i)
      if (row[i] == mixed) mixed_cells_.emplace_back(i, j);
  }
}

// A point inside a cell.
OctahedralPoint OctahedralGrid::inside(int i, int j) const {
  const double shift = at_horizon(i, j) ? 1.0 / 3 : 0.5;  // halves of squares at the horizon
  const auto between = [&](int k) {
    const double low = line(k), high = line(k + 1);
    return k >= 0 ? low + shift * (high - low) : high - shift * (high - low);
  };
  return {between(i), between(j)};
}

}  // namespace vantage::internal::exact
