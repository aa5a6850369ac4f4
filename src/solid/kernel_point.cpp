#include "solid/kernel_point.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <utility>

namespace vantage::internal::solid {
namespace {

/// Sum of a[i] x[i] <= b, in up to three dimensions.
struct Row {
  std::array<double, 3> a;
  double b;
};

struct Bounds {
  std::array<double, 3> low, high;
};

/// Coordinates are about 1: what is less than this beyond a limit is on it.
constexpr double kSlack = 1e-13;

/// The point of the box with the largest coordinates that keeps the rows. Where a row in its turn is not kept the
/// solution lies on it, and the rows before it are a problem of one dimension less.
template <std::size_t kDimension>
bool solve(const std::vector<Row>& rows, std::size_t count, const Bounds& bounds, std::array<double, 3>& x) {
  for (std::size_t k = 0; k < kDimension; ++k) x[k] = bounds.high[k];
  for (std::size_t i = 0; i < count; ++i) {
    const Row& row = rows[i];
    double value = -row.b;
    for (std::size_t k = 0; k < kDimension; ++k) value += row.a[k] * x[k];
    if (value <= kSlack) continue;
    std::size_t out = 0;  // the coordinate to express by the others
    for (std::size_t k = 1; k < kDimension; ++k) out = std::abs(row.a[k]) > std::abs(row.a[out]) ? k : out;
    if (std::abs(row.a[out]) < kSlack) return false;
    if constexpr (kDimension == 1) {
      x[0] = row.b / row.a[0];
      double low = bounds.low[0], high = bounds.high[0];
      for (std::size_t j = 0; j <= i; ++j) {
        if (rows[j].a[0] > kSlack) high = std::min(high, rows[j].b / rows[j].a[0]);
        if (rows[j].a[0] < -kSlack) low = std::max(low, rows[j].b / rows[j].a[0]);
        if (std::abs(rows[j].a[0]) <= kSlack && rows[j].b < -kSlack) return false;
      }
      if (low > high + kSlack) return false;
      x[0] = high;
    } else {
      std::vector<Row> smaller;
      smaller.reserve(i + 2);
      const auto add = [&](const Row& r) {
        const double share = r.a[out] / row.a[out];
        Row reduced{{}, r.b - share * row.b};
        for (std::size_t k = 0, to = 0; k < kDimension; ++k) {
          if (k != out) reduced.a[to++] = r.a[k] - share * row.a[k];
        }
        smaller.push_back(reduced);
      };
      Row low{{}, -bounds.low[out]}, high{{}, bounds.high[out]};
      low.a[out] = -1;
      high.a[out] = 1;
      add(low);
      add(high);
      for (std::size_t j = 0; j < i; ++j) add(rows[j]);
      Bounds left{};
      for (std::size_t k = 0, to = 0; k < kDimension; ++k) {
        if (k == out) continue;
        left.low[to] = bounds.low[k];
        left.high[to++] = bounds.high[k];
      }
      std::array<double, 3> found{};
      if (!solve<kDimension - 1>(smaller, smaller.size(), left, found)) return false;
      double sum = row.b;
      for (std::size_t k = 0, from = 0; k < kDimension; ++k) {
        if (k == out) continue;
        x[k] = found[from++];
        sum -= row.a[k] * x[k];
      }
      x[out] = sum / row.a[out];
    }
  }
  return true;
}

// By Fisher and Yates. Where std::shuffle puts what is each standard library's own choice.
void shuffle(std::vector<Row>& rows) {
  std::mt19937 random(1991);
  for (std::size_t left = rows.size(); left > 1; --left) std::swap(rows[left - 1], rows[random() % left]);
}

}  // namespace

std::optional<Vec3> kernel_point(const std::vector<HalfSpace>& half_spaces, const Box& box, double margin) {
  const Vec3 centre = (box.min + box.max) / 2;
  const double size = (box.max - box.min).maxCoeff() / 2;
  if (!(size > 0)) return std::nullopt;
  std::vector<Row> rows;
  rows.reserve(half_spaces.size());
  for (const HalfSpace& h : half_spaces) {
    rows.push_back({{h.normal.x(), h.normal.y(), h.normal.z()}, (h.at - h.normal.dot(centre) - margin) / size});
  }
  shuffle(rows);
  const Vec3 half = (box.max - box.min) / (2 * size);
  const Bounds bounds{{-half.x(), -half.y(), -half.z()}, {half.x(), half.y(), half.z()}};
  std::array<double, 3> x{};
  if (!solve<3>(rows, rows.size(), bounds, x)) return std::nullopt;
  const Vec3 point = centre + size * Vec3(x[0], x[1], x[2]);
  const bool is_behind_all = std::all_of(half_spaces.begin(), half_spaces.end(),
                                         [&](const HalfSpace& h) { return h.normal.dot(point) <= h.at - margin / 2; });
  return is_behind_all ? std::optional(point) : std::nullopt;
}

}  // namespace vantage::internal::solid
