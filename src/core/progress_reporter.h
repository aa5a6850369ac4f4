// How work is followed, stopped and bounded: the one way from a loop to the caller's Progress.
#pragma once

#include <atomic>
#include <cstddef>
#include <exception>
#include <memory>
#include <mutex>
#include <string>

#include "vantage/export.h"
#include "vantage/progress.h"

namespace vantage::internal::core {

/// Tells a Progress callback how far the work is, and stops the work when the callback says so.
///
/// A cheap handle: its copies and parts speak of the same work, and any thread may use any of them. The callback is
/// called by one thread at a time, at the beginning and at the end of a stage and else every 10 ms at most. The
/// fraction of a stage does not fall. Once the callback has returned false it is not called again, and every member
/// throws Error(cancelled), on all threads. A default reporter does nothing.
class VANTAGE_INTERNAL_API ProgressReporter {
 public:
  ProgressReporter() = default;

  /// Keeps a reference to `progress`, which may be empty. `where` is the place in Error(cancelled), say a file.
  explicit ProgressReporter(const Progress& progress, std::string where = {});

  /// Whether someone listens.
  bool is_followed() const { return state_ != nullptr; }

  /// Begins a stage, of which nothing is done yet, and asks at once. `stage` must last.
  void begin(const char* stage) const;
  /// The stage (or this part of it) is done: asks at once.
  void finish() const;

  /// The fraction that is done of the stage (or of this part of it). Looks at the clock: some ten nanoseconds.
  void report(double fraction) const {
    if (!state_) return;
    raise(from_ + share_ * fraction);
    check();
  }
  void report(std::size_t done, std::size_t total) const {
    report(static_cast<double>(done) / static_cast<double>(total > 0 ? total : 1));
  }

  /// Asks only whether to go on, and leaves the fraction as it is.
  void check() const {
    if (state_ && is_due()) ask();
  }

  /// The same for loops of a microsecond a turn and less: look at the clock at every 64th call.
  void tick() const {
    if (state_ && is_turn()) check();
  }
  void tick(std::size_t done, std::size_t total) const {
    if (state_ && is_turn()) report(done, total);
  }

  /// For a step of the stage: what it reports from 0 to 1 is told as `from` to `to`.
  ProgressReporter part(double from, double to) const;

  /// The same with a limit to the work that is counted from now on, by spend() of it, its copies and its parts. The
  /// unit is what the callers count. `advice`: what makes less work, for the error. `per_unit`: where callers count so
  /// much for what elsewhere is one unit of the limit.
  ProgressReporter limited(double most_work, std::string advice, double per_unit = 1) const;
  /// Counts work that is about to be done. Throws Error(work_too_large) where it is more than the limit leaves; the
  /// same every time, on any machine, if the callers count the same. Without a limit it does nothing.
  void spend(double work) const {
    if (!limit_) return;
    // Each try asks anew: what other threads have counted since counts, too. Not all libraries have += of an atomic
    // double.
    double done = limit_->done;
    do check_work(work);
    while (!limit_->done.compare_exchange_weak(done, done + work));
  }
  /// What was counted so far; 0 without a limit.
  double spent() const { return limit_ ? limit_->done.load() : 0; }
  /// Throws likewise where so much more work, which spend() will count later, is too much: to stop before it is begun.
  void expect(double work) const {
    if (limit_) check_work(work);
  }

  /// For tests: reporters made while one lives wait for no clock, and ask at every call of a member.
  class AskAlways {
   public:
    AskAlways();
    ~AskAlways();
    AskAlways(const AskAlways&) = delete;
    AskAlways& operator=(const AskAlways&) = delete;
  };

 private:
  struct State;
  struct Limit {
    double most;
    double per_unit;
    std::string advice;
    std::atomic<double> done = 0;
  };

  void check_work(double more) const;
  bool is_turn() const {
    thread_local unsigned calls = 0;
    return (++calls & 63U) == 0 || asks_always_;
  }
  bool is_due() const;
  void raise(double fraction) const;
  void ask() const;

  std::shared_ptr<State> state_;
  std::shared_ptr<Limit> limit_;
  bool asks_always_ = false;
  double from_ = 0, share_ = 1;  ///< of the stage
};

/// Counts what all threads together have done of a loop.
class ProgressCounter {
 public:
  /// Keeps a reference to `progress`.
  ProgressCounter(const ProgressReporter& progress, std::size_t total) : progress_(progress), total_(total) {}

  /// To be called after each step. Throws Error(cancelled).
  void add(std::size_t steps = 1) {
    const std::size_t done = done_.fetch_add(steps, std::memory_order_relaxed) + steps;
    progress_.report(done, total_);
  }

 private:
  const ProgressReporter& progress_;
  std::size_t total_;
  std::atomic<std::size_t> done_ = 0;
};

/// For libraries that ask by a plain function, from any thread, through which nothing may be thrown.
class VANTAGE_INTERNAL_API ProgressBridge {
 public:
  /// Keeps a reference to `progress`.
  explicit ProgressBridge(const ProgressReporter& progress) : progress_(progress) {}

  /// False to stop. `bridge` is this.
  static bool ask(void* bridge, double fraction) noexcept;

  /// To be called when the library is done or has given up. Throws Error(cancelled) where ask() said no, and whatever
  /// else the callback threw.
  void rethrow() const;

 private:
  const ProgressReporter& progress_;
  std::mutex mutex_;
  std::exception_ptr thrown_;
};

}  // namespace vantage::internal::core
