#include "io/shell_check.h"

#include <algorithm>
#include <tuple>

namespace vantage::internal::io {

ShellCheck::Result ShellCheck::result() {
  std::sort(edges_.begin(), edges_.end(),
            [](const Edge& a, const Edge& b) { return std::tie(a.low, a.high) < std::tie(b.low, b.high); });
  bool misoriented = false;
  for (std::size_t first = 0, end = 0; first < edges_.size(); first = end) {
    int balance = 0;
    for (; end < edges_.size() && edges_[end].low == edges_[first].low && edges_[end].high == edges_[first].high; ++end)
      balance += edges_[end].direction;
    if ((end - first) % 2 != 0) return Result::open;
    misoriented |= balance != 0;
  }
  return misoriented ? Result::misoriented : Result::closed;
}

}  // namespace vantage::internal::io
