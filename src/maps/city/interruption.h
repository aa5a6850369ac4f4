// How loops far below whoever has the progress are stopped: outlines may have any number of corners.
#pragma once

#include <chrono>
#include <future>
#include <thread>
#include <type_traits>
#include <utility>

#include "core/progress_reporter.h"

namespace vantage::internal::city {

/// While one lives, tick() on its thread asks the caller's Progress, and throws Error(cancelled) when told to stop.
class Interruption {
 public:
  explicit Interruption(const core::ProgressReporter& progress) : before_(current()) { current() = &progress; }
  ~Interruption() { current() = before_; }
  Interruption(const Interruption&) = delete;
  Interruption& operator=(const Interruption&) = delete;

  /// To be called every few microseconds at most, and every millisecond at least.
  static void tick() {
    if (const core::ProgressReporter* const progress = current()) progress->tick();
  }
  /// What `task` returns, which asks nobody and may take long: it runs in a thread of its own, which is left to itself
  /// when this one is told to stop. So it must own all that it uses.
  template <typename Task>
  static std::invoke_result_t<Task> run_apart(Task task) {
    constexpr std::chrono::milliseconds kPause{10};
    const core::ProgressReporter* const progress = current();
    if (progress == nullptr || !progress->is_followed()) return task();
    std::packaged_task<std::invoke_result_t<Task>()> packaged(std::move(task));
    auto result = packaged.get_future();
    std::thread(std::move(packaged)).detach();
    while (result.wait_for(kPause) != std::future_status::ready) progress->check();
    return result.get();
  }

 private:
  static const core::ProgressReporter*& current() {
    thread_local const core::ProgressReporter* progress = nullptr;
    return progress;
  }

  const core::ProgressReporter* before_;
};

}  // namespace vantage::internal::city
