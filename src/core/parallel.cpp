#include "core/parallel.h"

#include <chrono>
#include <exception>
#include <future>
#include <system_error>

#include "core/system_limits.h"
#include "vantage/progress.h"

namespace vantage::internal::parallel {

#if defined(__EMSCRIPTEN__) && !defined(__EMSCRIPTEN_PTHREADS__)

// WebAssembly without threads: std::async would never be ready there.
void run_while_asking(const std::function<void()>& body, const std::function<void()>& ask) {
  ask();
  body();
  ask();
}

#else

void run_while_asking(const std::function<void()>& body, const std::function<void()>& ask) {
  constexpr std::chrono::milliseconds kPause{2};
  // A new thread is bound by no limit: left to itself it would take all the threads that the machine has.
  const int threads = thread_limit();
  std::future<void> running;
  try {
    running = std::async(std::launch::async, [&] { with_threads(threads, body); });
  } catch (const std::system_error&) {
    core::fail_for_threads();
  }
  std::exception_ptr failure;
  while (running.wait_for(kPause) != std::future_status::ready) {
    if (failure) continue;
    try {
      ask();
    } catch (...) {
      failure = std::current_exception();
    }
  }
  if (failure) std::rethrow_exception(failure);
  running.get();
}

#endif

}  // namespace vantage::internal::parallel

namespace vantage {

void with_threads(int threads, const std::function<void()>& action) {
  internal::parallel::with_threads(threads, action);
}

}  // namespace vantage
