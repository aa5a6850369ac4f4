#include "depth/conservative_raster.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vantage::internal::depth {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

// A few operations, each relative to the largest inverse depth of the polygon.
constexpr double kInterpolation = 8 * kEpsilon;

/// A float that is no smaller: 2^-23 is more than rounding to the nearest takes away.
float rounded_up(double value) { return static_cast<float>(value * (1 + 0x1p-23)); }

/// Keeps the corners with side(corner) >= 0, and where the border crosses that line.
template <typename Corner, typename Side>
void keep(const std::vector<Corner>& from, std::vector<Corner>& to, const Side& side) {
  to.clear();
  const Corner* a = &from.back();
  double at_a = side(*a);
  for (const Corner& b : from) {
    const double at_b = side(b);
    if ((at_a >= 0) != (at_b >= 0)) {
      const double t = at_a / (at_a - at_b);
      to.push_back({a->u + t * (b.u - a->u), a->v + t * (b.v - a->v), a->q + t * (b.q - a->q),
                    a->margin + t * (b.margin - a->margin)});
    }
    if (at_b >= 0) to.push_back(b);
    a = &b;
    at_a = at_b;
  }
}

}  // namespace

ConservativeRaster::ConservativeRaster(const FaceBand& band, std::span<float> inverse_depths)
    : band_(band), texels_(inverse_depths) {
  edges_.reserve(band.size + 1);
  for (int i = 0; i <= band.size; ++i) edges_.push_back(band.edge(i));
}

/// The column or row that holds a coordinate; may be beyond the face by one.
int ConservativeRaster::cell(double coordinate) const {
  return static_cast<int>(std::floor(std::clamp(coordinate + 1, -1.0, 3.0) * 0.5 * band_.size));
}

void ConservativeRaster::project(std::span<const Vec3> corners, double slack) {
  polygon_.clear();
  double largest = 0;
  for (const Vec3& p : corners) {
    const double q = (1 + 4 * kEpsilon) / (p.z() - slack);
    polygon_.push_back({p.x() / p.z(), p.y() / p.z(), q, 2 * slack * q + 4 * kEpsilon});
    largest = std::max(largest, q);
  }
  rounding_ = kInterpolation * largest;
}

void ConservativeRaster::draw(std::span<const Vec3> corners, double slack) {
  if (corners.empty()) return;
  project(corners, slack);
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const Corner& c : polygon_) {
    low = std::min(low, c.low());
    high = std::max(high, c.high());
  }
  const int first = std::max(cell(low), band_.row_begin), last = std::min(cell(high), band_.row_end - 1);
  if (first == last) return draw_row(first, polygon_);
  for (int row = first; row <= last; ++row) {
    cut_row(row);
    if (!part_.empty()) draw_row(row, part_);
  }
}

/// Leaves in part_ what the row of texels sees.
void ConservativeRaster::cut_row(int row) {
  const double low = edges_[row], high = edges_[row + 1];
  keep(polygon_, half_, [low](const Corner& c) { return c.high() - low; });
  part_.clear();
  if (!half_.empty()) keep(half_, part_, [high](const Corner& c) { return high - c.low(); });
}

void ConservativeRaster::raise(float* row, int first, int last, double inverse_depth) const {
  const float value = rounded_up(inverse_depth + rounding_);
  for (int i = std::max(first, 0); i <= std::min(last, band_.size - 1); ++i) row[i] = std::max(row[i], value);
}

/// Leaves in hull_ the upper hull of the part in the plane (u, q), from left to right (Andrew 1979).
void ConservativeRaster::build_hull(const std::vector<Corner>& part) {
  half_ = part;
  std::sort(half_.begin(), half_.end(),
            [](const Corner& a, const Corner& b) { return a.u != b.u ? a.u < b.u : a.q < b.q; });
  hull_.clear();
  for (const Corner& c : half_) {
    while (hull_.size() >= 2) {
      const Corner& a = hull_[hull_.size() - 2];
      const Corner& b = hull_.back();
      if ((b.u - a.u) * (c.q - a.q) < (c.u - a.u) * (b.q - a.q)) break;
      hull_.pop_back();
    }
    hull_.push_back(c);
  }
}

/// Along the hull from its peak to the right the largest q of a texel is at its left edge, and the other way round.
void ConservativeRaster::draw_row(int row, const std::vector<Corner>& part) {
  float* texels = texels_.data() + static_cast<std::size_t>(row - band_.row_begin) * band_.size;
  build_hull(part);
  std::size_t peak = 0;
  for (std::size_t k = 1; k < hull_.size(); ++k) {
    if (hull_[k].q > hull_[peak].q) peak = k;
  }
  const int first = cell(hull_[peak].left()), last = cell(hull_[peak].right());
  raise(texels, first, last, hull_[peak].q);
  int column = std::max(last + 1, 0);
  for (std::size_t k = peak; k + 1 < hull_.size(); ++k) {
    const Corner &a = hull_[k], &b = hull_[k + 1];
    const int end = std::min(cell(b.right()), band_.size - 1);
    if (end < column) continue;
    const double slope = (b.q - a.q) / (b.right() - a.right());
    for (; column <= end; ++column) {
      const double q = std::max(b.q, std::min(a.q, a.q + slope * (edges_[column] - a.right())));
      texels[column] = std::max(texels[column], rounded_up(q + rounding_));
    }
  }
  column = std::min(first - 1, band_.size - 1);
  for (std::size_t k = peak; k > 0; --k) {
    const Corner &a = hull_[k], &b = hull_[k - 1];
    const int end = std::max(cell(b.left()), 0);
    if (end > column) continue;
    const double slope = (b.q - a.q) / (b.left() - a.left());
    for (; column >= end; --column) {
      const double q = std::max(b.q, std::min(a.q, a.q + slope * (edges_[column + 1] - a.left())));
      texels[column] = std::max(texels[column], rounded_up(q + rounding_));
    }
  }
}

}  // namespace vantage::internal::depth
