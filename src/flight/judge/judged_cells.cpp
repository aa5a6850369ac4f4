#include "flight/judge/judged_cells.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vantage::internal::flight::judge {
namespace {

constexpr std::size_t kMostCorners = 40'000'000;   // of one certificate: some 10 GB at the very most
constexpr std::size_t kMostIndices = 400'000'000;  // of one cell

BigInteger height_over(const std::array<int, 3>& normal, const BigInteger& offset, const Corners::Corner& corner) {
  BigInteger height = -(offset * corner.under);
  for (std::size_t k = 0; k < 3; ++k) {
    if (normal[k] > 0) height += corner.over[k];
    if (normal[k] < 0) height -= corner.over[k];
  }
  return height;
}

/// Between two corners on both sides of a plane, where the line between them meets it.
std::pair<WholePoint, BigInteger> between(const Corners::Corner& a, const BigInteger& at_a, const Corners::Corner& b,
                                          const BigInteger& at_b) {
  const BigInteger of_a = at_b.abs(), of_b = at_a.abs();
  WholePoint over;
  for (std::size_t k = 0; k < 3; ++k) over[k] = a.over[k] * of_a + b.over[k] * of_b;
  BigInteger under = a.under * of_a + b.under * of_b;
  BigInteger divisor = under;
  for (const BigInteger& x : over) divisor = common_divisor(divisor, x);
  for (BigInteger& x : over) x = floor_divided(x, divisor);
  return {over, floor_divided(under, divisor)};
}

}  // namespace

BigInteger dot(const Direction& direction, const WholePoint& point) {
  return BigInteger(direction[0]) * point[0] + BigInteger(direction[1]) * point[1] +
         BigInteger(direction[2]) * point[2];
}

std::uint32_t Corners::add(WholePoint over, BigInteger under) {
  if (corners_.size() >= kMostCorners) throw std::length_error("too many corners");
  Corner corner;
  for (std::size_t k = 0; k < 3; ++k) {
    corner.rounded[k] = under == BigInteger(1) ? over[k] : floor_divided(over[k], under);
    corner.near_m[k] = corner.rounded[k].scaled_down(bits_);
  }
  corner.over = std::move(over);
  corner.under = std::move(under);
  corners_.push_back(std::move(corner));
  return static_cast<std::uint32_t>(corners_.size() - 1);
}

Cell::Cell(Corners& corners, std::size_t region, std::vector<std::uint32_t> polygons, std::vector<std::uint32_t> ends,
           bool is_cut)
    : corners_(corners),
      region_(region),
      polygons_(std::move(polygons)),
      ends_(std::move(ends)),
      points_(polygons_),
      is_cut_(is_cut) {
  std::sort(points_.begin(), points_.end());
  points_.erase(std::unique(points_.begin(), points_.end()), points_.end());
}

const BigInteger& Cell::least(const Direction& direction) {
  demand(!is_empty(), "a part of a region is empty");
  const auto known = known_.find(direction);
  if (known != known_.end()) return known->second;
  // Doubles find the few corners that may be the least; whole numbers decide among them.
  constexpr double kError = 8 * std::numeric_limits<double>::epsilon();  // more than conversions and sums may lose
  const std::array<double, 3> d = {static_cast<double>(direction[0]), static_cast<double>(direction[1]),
                                   static_cast<double>(direction[2])};
  const auto about = [&](std::uint32_t point) {
    const std::array<double, 3>& p = corners_[point].near_m;
    const double size = std::abs(d[0] * p[0]) + std::abs(d[1] * p[1]) + std::abs(d[2] * p[2]);
    return std::pair(d[0] * p[0] + d[1] * p[1] + d[2] * p[2], kError * size + std::numeric_limits<double>::min());
  };
  double most = std::numeric_limits<double>::infinity();
  for (const std::uint32_t point : points_) {
    const auto [value, error] = about(point);
    most = std::min(most, value + error);
  }
  std::optional<BigInteger> least;
  for (const std::uint32_t point : points_) {
    const auto [value, error] = about(point);
    if (value - error > most) continue;
    BigInteger exact = dot(direction, corners_[point].rounded);
    if (!least || exact < *least) least = std::move(exact);
  }
  if (is_cut_) {  // what rounding down may hide
    for (const std::int64_t x : direction) *least -= BigInteger(std::abs(x));
  }
  return known_.emplace(direction, std::move(*least)).first->second;
}

std::array<Cell*, 2> Cell::cut(const std::array<int, 3>& normal, const BigInteger& offset) {
  auto [place, is_new] = parts_.try_emplace(std::pair(normal, offset));
  std::array<std::unique_ptr<Cell>, 2>& parts = place->second;
  if (is_new) parts = {side(normal, offset, 1), side(normal, offset, -1)};
  return {parts[0].get(), parts[1].get()};
}

std::unique_ptr<Cell> Cell::side(const std::array<int, 3>& normal, const BigInteger& offset, int side) {
  std::map<std::uint32_t, BigInteger> heights;
  for (const std::uint32_t point : points_) {
    const BigInteger height = height_over(normal, offset, corners_[point]);
    heights.emplace(point, side > 0 ? height : -height);
  }
  std::map<std::array<std::uint32_t, 2>, std::uint32_t> met;  // edges belong to two triangles
  std::vector<std::uint32_t> kept, ends;
  std::size_t begin = 0;
  for (const std::uint32_t end : ends_) {
    const std::size_t first = kept.size();
    for (std::size_t i = begin; i < end; ++i) {
      const std::uint32_t a = polygons_[i], b = polygons_[i == begin ? end - 1 : i - 1];
      const BigInteger &at_a = heights.at(a), &at_b = heights.at(b);
      if (at_a.sign() * at_b.sign() < 0) {
        const auto [place, is_new] = met.try_emplace({std::min(a, b), std::max(a, b)});
        if (is_new) {
          auto [over, under] = between(corners_[a], at_a, corners_[b], at_b);
          place->second = corners_.add(std::move(over), std::move(under));
        }
        kept.push_back(place->second);
      }
      if (at_a.sign() >= 0) kept.push_back(a);
    }
    begin = end;
    if (kept.size() > first) ends.push_back(static_cast<std::uint32_t>(kept.size()));
    if (kept.size() > kMostIndices) throw std::length_error("too many corners");
  }
  return std::make_unique<Cell>(corners_, region_, std::move(kept), std::move(ends), true);
}

}  // namespace vantage::internal::flight::judge
