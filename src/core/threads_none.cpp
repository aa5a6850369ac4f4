// VANTAGE_THREADS=none: everything on the caller's thread.
#include <algorithm>

#include "core/parallel.h"

namespace vantage::internal::parallel {

void for_ranges(std::size_t count, std::size_t grain, const std::function<void(std::size_t, std::size_t)>& body) {
  for (std::size_t begin = 0; begin < count; begin += grain) body(begin, std::min(count, begin + grain));
}

void both(const std::function<void()>& first, const std::function<void()>& second) {
  first();
  second();
}

void with_threads(int, const std::function<void()>& body) { body(); }

int thread_limit() { return 1; }

}  // namespace vantage::internal::parallel
