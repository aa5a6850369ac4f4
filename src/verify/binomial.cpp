#include "verify/binomial.h"

#include <cmath>

namespace vantage::internal::verify {
namespace {

/// Probability of `hits` or fewer in `trials`, each with probability 0 < share < 1. Sums upwards from zero hits in
/// logarithms: the first term may be far below the smallest double.
double at_most(std::size_t hits, std::size_t trials, double share) {
  const double log_odds = std::log(share) - std::log1p(-share);
  double log_term = static_cast<double>(trials) * std::log1p(-share);
  double sum = 0;
  for (std::size_t k = 0; k <= hits; ++k) {
    sum += std::exp(log_term);
    log_term += std::log(static_cast<double>(trials - k)) - std::log(static_cast<double>(k + 1)) + log_odds;
  }
  return sum;
}

}  // namespace

double upper_share_bound(std::size_t hits, std::size_t trials, double confidence) {
  if (hits >= trials) return 1;
  if (hits == 0) return -std::expm1(std::log1p(-confidence) / static_cast<double>(trials));
  double low = static_cast<double>(hits) / static_cast<double>(trials), high = 1;
  for (int i = 0; i < 60; ++i) {  // halving: 60 times exhausts a double
    const double middle = (low + high) / 2;
    if (middle <= low || middle >= high) break;
    (at_most(hits, trials, middle) > 1 - confidence ? low : high) = middle;
  }
  return high;
}

}  // namespace vantage::internal::verify
