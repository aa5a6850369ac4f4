// VANTAGE_THREADS=tbb: oneTBB, whose threads steal work from each other. For programs.
#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/parallel_invoke.h>
#include <oneapi/tbb/task_arena.h>

#include <optional>

#include "core/parallel.h"

namespace vantage::internal::parallel {

void for_ranges(std::size_t count, std::size_t grain, const std::function<void(std::size_t, std::size_t)>& body) {
  tbb::parallel_for(
      tbb::blocked_range<std::size_t>(0, count, grain), [&](const auto& range) { body(range.begin(), range.end()); },
      tbb::simple_partitioner());
}

void both(const std::function<void()>& first, const std::function<void()>& second) {
  tbb::parallel_invoke(first, second);
}

void with_threads(int threads, const std::function<void()>& body) {
  if (threads <= 0) {
    body();
    return;
  }
  // More threads than processors must be allowed first, or oneTBB complains on standard error and ignores the wish.
  std::optional<tbb::global_control> allowance;
  if (threads > tbb::info::default_concurrency()) {
    allowance.emplace(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
  }
  tbb::task_arena arena(threads);
  arena.execute(body);
}

int thread_limit() { return tbb::this_task_arena::max_concurrency(); }

}  // namespace vantage::internal::parallel
