#include "flight/tour/pair_costs.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vantage::internal::flight::tour {
namespace {

constexpr double kNoTour = std::numeric_limits<double>::infinity();
constexpr double kPairRounding = 0x1p-53;

}  // namespace

double pairs_value(const PairCosts& costs, const FixedEdges& fixed, const PairsDuals& duals) {
  const std::size_t n = costs.count();
  double sum = 0, size = 0;
  const auto add = [&](double term) {
    sum += term;
    size += std::abs(term);
  };
  for (const double d : duals.of_region) add(2 * d);
  std::vector<std::vector<double>> of_sets(n, std::vector<double>(n, 0.0));
  double largest = 0;
  for (const auto& [dual, members] : duals.of_set) {
    add(2 * dual);
    std::vector<bool> in(n, false);
    for (const std::size_t m : members) in[m] = true;
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j < n; ++j) {
        if (in[i] != in[j]) of_sets[i][j] += dual;
      }
    }
  }
  for (std::size_t i = 0; i < n; ++i) {
    std::vector<std::size_t> beside, must;
    for (std::size_t j = 0; j < n; ++j) {
      if (j == i || fixed.is_out(i, j)) continue;
      beside.push_back(j);
      if (fixed.is_in(i, j)) must.push_back(j);
    }
    double least = kNoTour;
    const std::vector<double>& p = duals.of_edge_at[i];
    for (std::size_t a = 0; a < beside.size(); ++a) {
      for (std::size_t b = a + 1; b < beside.size(); ++b) {
        const std::size_t j = beside[a], k = beside[b];
        if (std::any_of(must.begin(), must.end(), [&](std::size_t m) { return m != j && m != k; })) continue;
        const double here = costs(i, j, k) - p[j] - p[k];
        largest = std::max(largest, std::abs(p[j]) + std::abs(p[k]) + std::abs(costs(i, j, k)));
        least = std::min(least, here);
      }
    }
    if (least == kNoTour) return kNoTour;  // no tour has these edges
    add(least);
    for (const std::size_t j : beside) {
      if (j > i) continue;
      const double left = p[j] + duals.of_edge_at[j][i] - duals.of_region[i] - duals.of_region[j] - of_sets[i][j];
      largest = std::max(largest, std::abs(p[j]) + std::abs(duals.of_edge_at[j][i]) + std::abs(duals.of_region[i]) +
                                      std::abs(duals.of_region[j]) + of_sets[i][j]);
      add(fixed.is_in(i, j) ? left : std::min(0.0, left));
    }
  }
  // Each term has few roundings of what it is made of, and as many as there are sets; there are at most n + n (n - 1) /
  // 2 and two of each set and region; the sum has one rounding for each term, of no more than all sizes.
  const double nn = static_cast<double>(n), sets = static_cast<double>(duals.of_set.size());
  const double terms = 2 * nn + nn * nn + sets;
  const double bound = sum - costs.error_m() - kPairRounding * (terms * (8 + sets) * largest + terms * size);
  return std::isfinite(bound) ? bound : -kNoTour;
}

}  // namespace vantage::internal::flight::tour
