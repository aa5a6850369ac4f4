// How Python calls long computations: the interpreter is released, progress is told, and Ctrl-C stops them.
#pragma once

#include <chrono>
#include <condition_variable>
#include <exception>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include "interpreter.h"
#include "vantage/progress.h"

namespace vantage::python {

/// Between the thread that computes and the one that Python called from, which alone may run Python's signal handlers
/// and calls `callback(stage, fraction)`. A callback that returns False, or raises, stops the computation.
class Bridge {
 public:
  /// `callback`: None or False for none, True for a bar (vantage/_progress.py). Throws Error in a process that was
  /// forked from one that had computed: the threads of that one are not in it.
  explicit Bridge(nb::object callback);
  ~Bridge();
  Bridge(const Bridge&) = delete;
  Bridge& operator=(const Bridge&) = delete;

  /// For a computing thread other than the calling one.
  Progress progress();
  void finish();

  /// For the calling thread, which holds the interpreter: returns when finish() was called.
  void serve();

  /// For a computation on the calling thread, which has let go of the interpreter: it takes it back from time to time.
  Progress progress_here();

  /// When the computation has ended: raises what Python raised meanwhile, or else the computation's `failure`, if any,
  /// or else Error(cancelled) where it was stopped too late to notice.
  void raise(const std::exception_ptr& failure) const;

 private:
  void attend(const std::string& stage, double fraction, bool has_news);
  void call_python(const std::string& stage, double fraction);
  bool is_stopped();

  nb::object callback_, bar_;
  std::mutex mutex_;
  std::condition_variable changed_;
  bool is_finished_ = false, is_cancelled_ = false, has_news_ = false;
  std::chrono::steady_clock::time_point next_;
  std::string stage_, stopped_while_;
  double fraction_ = 0;
  std::exception_ptr raised_;
};

/// Has a thread run the job, at once. Threads stay for the jobs to come: a new one would cost as much as a small
/// volume, since it begins without the memory that the last one has given back.
void run_on_worker(std::function<void()> job);

/// What `work(progress)` returns; it runs with at most `threads` threads (0: as many as there are).
template <typename Work>
auto computed(nb::object callback, int threads, Work&& work) {
  using Value = decltype(work(Progress()));
  Bridge bridge(std::move(callback));
  std::optional<Value> value;
  std::exception_ptr failure;
  run_on_worker([&] {
    const Computing computing;
    try {
      with_threads(threads, [&] { value.emplace(work(bridge.progress())); });
    } catch (...) {
      failure = std::current_exception();
    }
    bridge.finish();  // the last that it touches here
  });
  bridge.serve();
  bridge.raise(failure);
  return std::move(*value);
}

/// The same on the calling thread: two switches of threads cost a tenth of a small volume. For work that keeps this
/// thread busy, since others cannot run signal handlers. It may hold the lock of a scene's lookups when it takes the
/// interpreter back, so nothing may wait for that lock that has the interpreter.
template <typename Work>
auto computed_here(nb::object callback, int threads, Work&& work) {
  using Value = decltype(work(Progress()));
  Bridge bridge(std::move(callback));
  std::optional<Value> value;
  std::exception_ptr failure;
  {
    const Released released;
    const Computing computing;
    const HeldSignals held;
    try {
      with_threads(threads, [&] { value.emplace(work(bridge.progress_here())); });
    } catch (...) {
      failure = std::current_exception();
    }
  }
  bridge.raise(failure);
  return std::move(*value);
}

}  // namespace vantage::python
