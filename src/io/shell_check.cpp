#include "io/shell_check.h"

#include <algorithm>
#include <tuple>

namespace vantage::internal::io {

ShellCheck::Result ShellCheck::result() {
  std::sort(edges_.begin(), edges_.end(),
            [](const Edge& a, const Edge& b) { return std::tie(a.low, a.high) < std::tie(b.low, b.high); });
  bool misoriented = false;
  open_ends_.clear();
  for (std::size_t first = 0, end = 0; first < edges_.size(); first = end) {
    int balance = 0;
    for (; end < edges_.size() && edges_[end].low == edges_[first].low && edges_[end].high == edges_[first].high; ++end)
      balance += edges_[end].direction;
    if ((end - first) % 2 != 0) open_ends_.insert(open_ends_.end(), {edges_[first].low, edges_[first].high});
    misoriented |= balance != 0;
  }
  if (!open_ends_.empty()) return Result::open;
  return misoriented ? Result::misoriented : Result::closed;
}

}  // namespace vantage::internal::io
