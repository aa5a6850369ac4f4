// VANTAGE_THREADS=std: a std::thread for each share of a loop, made when it begins. For those who embed the library
// without oneTBB, and for ThreadSanitizer, which must see every thread and lock to tell races from order.
#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#include "core/parallel.h"

namespace vantage::internal::parallel {
namespace {

/// The threads that work for one call of with_threads, and for the parallel calls inside of it.
struct Crew {
  explicit Crew(int most) : limit(most) {}
  const int limit;
  std::atomic<int> at_work = 1;  // the caller's thread is one of them
};

Crew& whole_machine() {
  static Crew crew(std::max(1, static_cast<int>(std::thread::hardware_concurrency())));
  return crew;
}

thread_local Crew* own_crew = nullptr;

Crew& crew() { return own_crew ? *own_crew : whole_machine(); }

/// Makes this thread one of a crew for a while.
class Member {
 public:
  explicit Member(Crew& joined) : left_(own_crew) { own_crew = &joined; }
  ~Member() { own_crew = left_; }
  Member(const Member&) = delete;
  Member& operator=(const Member&) = delete;

 private:
  Crew* left_;
};

/// Keeps the first exception.
class Failure {
 public:
  void keep_current() {
    const std::lock_guard lock(mutex_);
    if (!first_) first_ = std::current_exception();
    happened_ = true;
  }
  bool happened() const { return happened_; }
  void rethrow() const {
    if (first_) std::rethrow_exception(first_);
  }

 private:
  std::mutex mutex_;
  std::exception_ptr first_;
  std::atomic<bool> happened_ = false;
};

/// Threads besides the caller's, as many as the crew has left. They are joined at the end.
class Helpers {
 public:
  Helpers(std::size_t wanted, const std::function<void()>& work) : crew_(crew()) {
    while (threads_.size() < wanted && take_one()) {
      try {
        threads_.emplace_back([this, &work] {
          const Member member(crew_);
          work();
        });
      } catch (
          ...) {  // the system gives no more threads, or no memory for one: the work is done by those that there are
        --crew_.at_work;
        return;
      }
    }
  }
  ~Helpers() {
    for (std::thread& thread : threads_) {
      thread.join();
      --crew_.at_work;
    }
  }
  Helpers(const Helpers&) = delete;
  Helpers& operator=(const Helpers&) = delete;

 private:
  bool take_one() {
    int busy = crew_.at_work;
    while (busy < crew_.limit) {
      if (crew_.at_work.compare_exchange_weak(busy, busy + 1)) return true;
    }
    return false;
  }

  Crew& crew_;
  std::vector<std::thread> threads_;
};

}  // namespace

void for_ranges(std::size_t count, std::size_t grain, const std::function<void(std::size_t, std::size_t)>& body) {
  if (count == 0) return;
  const std::size_t ranges = (count - 1) / grain + 1;
  std::atomic<std::size_t> next = 0;
  Failure failure;
  const std::function<void()> work = [&] {
    while (!failure.happened()) {
      const std::size_t i = next++;
      if (i >= ranges) return;
      try {
        body(i * grain, std::min(count, (i + 1) * grain));
      } catch (...) {
        failure.keep_current();
      }
    }
  };
  {
    const Helpers helpers(ranges - 1, work);
    work();
  }
  failure.rethrow();
}

void both(const std::function<void()>& first, const std::function<void()>& second) {
  for_ranges(2, 1, [&](std::size_t begin, std::size_t) { (begin == 0 ? first : second)(); });
}

void with_threads(int threads, const std::function<void()>& body) {
  if (threads <= 0) {
    body();
    return;
  }
  Crew limited(threads);
  const Member member(limited);
  body();
}

int thread_limit() { return crew().limit; }

}  // namespace vantage::internal::parallel
