// Asks the caller, now and then, whether to go on.
#pragma once

#include <atomic>
#include <chrono>
#include <mutex>

#include "vantage/error.h"
#include "vantage/progress.h"

namespace vantage::exact {

/// Lets work on many threads be followed and cancelled through one Progress callback, which is never called from two of
/// them at once.
class Watch {
 public:
  /// Keeps a reference; an empty callback is never asked.
  explicit Watch(const Progress& progress) : progress_(progress) {}

  /// Begins a stage. Throws Error(cancelled).
  void begin(const char* stage, double fraction) {
    if (!progress_) return;
    const std::lock_guard lock(mutex_);
    stage_ = stage;
    fraction_ = fraction;
    ask();
  }

  /// To be called often, from any thread: asks every few milliseconds. Throws Error(cancelled).
  void check() {
    if (!progress_) return;
    const std::unique_lock lock(mutex_, std::try_to_lock);
    if (cancelled_) refuse();
    if (lock && Clock::now() - asked_ > std::chrono::milliseconds(5)) ask();
  }

 private:
  using Clock = std::chrono::steady_clock;

  void ask() {
    if (!cancelled_ && !progress_(stage_, fraction_)) cancelled_ = true;
    asked_ = Clock::now();
    if (cancelled_) refuse();
  }
  [[noreturn]] void refuse() const {
    throw Error(ErrorKind::cancelled, std::string("cancelled while ") + stage_, "", "");
  }

  const Progress& progress_;
  std::mutex mutex_;
  std::atomic<bool> cancelled_ = false;
  const char* stage_ = "starting";
  double fraction_ = 0;
  Clock::time_point asked_ = Clock::now();
};

}  // namespace vantage::exact
