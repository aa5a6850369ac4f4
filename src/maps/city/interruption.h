// How loops far below whoever has the progress are stopped: outlines may have any number of corners.
#pragma once

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
  /// The same for those that wait themselves.
  static void check() {
    if (const core::ProgressReporter* const progress = current()) progress->check();
  }
  static bool is_followed() { return current() != nullptr && current()->is_followed(); }

 private:
  static const core::ProgressReporter*& current() {
    thread_local const core::ProgressReporter* progress = nullptr;
    return progress;
  }

  const core::ProgressReporter* before_;
};

}  // namespace vantage::internal::city
