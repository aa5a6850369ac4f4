// Threads. Which library makes them is chosen when vantage is built (VANTAGE_THREADS): threads_*.cpp. The results are
// the same to the bit.
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <vector>

#include "core/progress_reporter.h"
#include "vantage/export.h"

namespace vantage::internal::parallel {

/// Calls `body(begin, end)` for ranges that together cover [0, count), at most `grain` long, on any thread, in any
/// order. Results must not depend on how the range was cut. An exception thrown by `body` stops the rest and is thrown
/// on.
VANTAGE_INTERNAL_API void for_ranges(std::size_t count, std::size_t grain,
                                     const std::function<void(std::size_t, std::size_t)>& body);

/// Runs `first` and `second`, possibly at the same time.
VANTAGE_INTERNAL_API void both(const std::function<void()>& first, const std::function<void()>& second);

/// Runs `body` with at most `threads` threads (0: all that the machine has) for the parallel calls made inside.
VANTAGE_INTERNAL_API void with_threads(int threads, const std::function<void()>& body);

/// How many threads parallel calls may use here.
int thread_limit();

/// Runs `body` on a thread of its own, with as many threads for the parallel calls made inside as the caller has, and
/// calls `ask` on the caller's thread every two milliseconds meanwhile. Ends when `body` has. An exception thrown by
/// either is thrown on then, that of `ask` first; it should tell `body` to stop before it throws. Where there are no
/// threads, as in WebAssembly, it is asked before `body` and after it alone.
void run_while_asking(const std::function<void()>& body, const std::function<void()>& ask);

/// Sorts with all threads. `less` must be a total order on distinct elements, so that the result is the same whatever
/// the number of threads. Throws Error(cancelled); the items are then in some order.
template <typename T, typename Less>
void sort(std::vector<T>& items, Less less, const core::ProgressReporter& progress = {}) {
  constexpr std::size_t kSerial = 1 << 14;
  const std::function<void(std::size_t, std::size_t)> run = [&](std::size_t begin, std::size_t end) {
    progress.check();
    if (end - begin <= kSerial) {
      std::sort(items.begin() + begin, items.begin() + end, less);
      return;
    }
    const std::size_t middle = begin + (end - begin) / 2;
    both([&] { run(begin, middle); }, [&] { run(middle, end); });
    progress.check();
    std::inplace_merge(items.begin() + begin, items.begin() + middle, items.begin() + end, less);
  };
  run(0, items.size());
}

}  // namespace vantage::internal::parallel
