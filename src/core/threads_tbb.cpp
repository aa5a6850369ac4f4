// VANTAGE_THREADS=tbb: oneTBB, whose threads steal work from each other. For programs.
#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/parallel_invoke.h>
#include <oneapi/tbb/task_arena.h>

#include <optional>
#include <stdexcept>
#include <string_view>
#include <typeinfo>

#include "core/parallel.h"
#include "core/system_limits.h"

namespace vantage::internal::parallel {
namespace {

/// oneTBB makes its threads when they are first wanted, and throws a runtime_error of these words where it cannot.
template <typename Action>
void run_or_say_why_not(const Action& action) {
  try {
    action();
  } catch (const std::runtime_error& error) {
    if (typeid(error) == typeid(std::runtime_error) && std::string_view(error.what()).starts_with("pthread_")) {
      core::fail_for_threads();
    }
    throw;
  }
}

}  // namespace

void for_ranges(std::size_t count, std::size_t grain, const std::function<void(std::size_t, std::size_t)>& body) {
  run_or_say_why_not([&] {
    tbb::parallel_for(
        tbb::blocked_range<std::size_t>(0, count, grain), [&](const auto& range) { body(range.begin(), range.end()); },
        tbb::simple_partitioner());
  });
}

void both(const std::function<void()>& first, const std::function<void()>& second) {
  run_or_say_why_not([&] { tbb::parallel_invoke(first, second); });
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
  run_or_say_why_not([&] { arena.execute(body); });
}

int thread_limit() { return tbb::this_task_arena::max_concurrency(); }

}  // namespace vantage::internal::parallel
