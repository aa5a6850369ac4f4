#include "flight/tour/pairs_master.h"

#include <algorithm>
#include <limits>

namespace vantage::internal::flight::tour {
namespace {

constexpr std::size_t kNoRegion = std::numeric_limits<std::size_t>::max();
constexpr double kConnected = 1e-6;  // an edge with more is one

}  // namespace

std::vector<std::vector<bool>> short_cuts(const std::vector<std::vector<double>>& weights) {
  const std::size_t n = weights.size();
  std::vector<std::vector<bool>> found;
  std::vector<bool> seen(n, false);
  for (std::size_t start = 0; start < n; ++start) {
    if (seen[start]) continue;
    std::vector<bool> part(n, false);
    std::vector<std::size_t> stack = {start};
    std::size_t size = 0;
    part[start] = seen[start] = true;
    while (!stack.empty()) {
      const std::size_t i = stack.back();
      stack.pop_back();
      ++size;
      for (std::size_t j = 0; j < n; ++j) {
        if (weights[i][j] > kConnected && !part[j]) {
          part[j] = seen[j] = true;
          stack.push_back(j);
        }
      }
    }
    if (size < n) found.push_back(std::move(part));
  }
  if (!found.empty()) return found;
  std::vector<std::vector<double>> w = weights;
  std::vector<std::vector<bool>> group(n, std::vector<bool>(n, false));
  std::vector<std::size_t> active;
  for (std::size_t i = 0; i < n; ++i) {
    group[i][i] = true;
    active.push_back(i);
  }
  while (active.size() > 1) {
    std::vector<double> tie(n, 0.0);
    std::vector<std::size_t> left = active;
    std::size_t last = kNoRegion, before = kNoRegion;
    double cut = 0;
    while (!left.empty()) {
      const auto most =
          std::max_element(left.begin(), left.end(), [&](std::size_t a, std::size_t b) { return tie[a] < tie[b]; });
      before = last;
      last = *most;
      cut = tie[last];
      left.erase(most);
      for (const std::size_t i : left) tie[i] += w[last][i];
    }
    const auto members = static_cast<std::size_t>(std::count(group[last].begin(), group[last].end(), true));
    if (cut < 2 - 1e-4 && members > 1 && members + 1 < n) found.push_back(group[last]);
    for (const std::size_t i : active) {
      if (i == last || i == before) continue;
      w[before][i] += w[last][i];
      w[i][before] = w[before][i];
    }
    for (std::size_t i = 0; i < n; ++i) group[before][i] = group[before][i] || group[last][i];
    active.erase(std::find(active.begin(), active.end(), last));
  }
  return found;
}

}  // namespace vantage::internal::flight::tour
