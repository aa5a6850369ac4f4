#include "core/progress_reporter.h"

#include <algorithm>
#include <chrono>
#include <mutex>
#include <utility>

#include "core/text.h"
#include "vantage/error.h"

namespace vantage::internal::core {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kPause{10};  // between two calls of the callback

std::atomic<int> g_asks_always{0};

}  // namespace

struct ProgressReporter::State {
  State(const Progress& callback, std::string place) : progress(callback), where(std::move(place)) {}

  /// With the mutex locked.
  void call() {
    if (!cancelled && !progress(stage.load(), fraction.load())) cancelled = true;
    next = (Clock::now() + kPause).time_since_epoch().count();
  }

  void throw_if_cancelled() const {
    if (!cancelled) return;
    throw Error(ErrorCode::cancelled, std::string("cancelled while ") + stage.load(), where, "");
  }

  const Progress& progress;
  const std::string where;
  std::mutex mutex;
  std::atomic<bool> cancelled = false;
  std::atomic<const char*> stage = "starting";
  std::atomic<Clock::rep> next = 0;
  std::atomic<double> fraction = 0;
};

ProgressReporter::ProgressReporter(const Progress& progress, std::string where) : asks_always_(g_asks_always > 0) {
  if (progress) state_ = std::make_shared<State>(progress, std::move(where));
}

void ProgressReporter::begin(const char* stage) const {
  if (!state_) return;
  {
    const std::lock_guard lock(state_->mutex);
    state_->stage = stage;
    state_->fraction = 0;
    state_->call();
  }
  state_->throw_if_cancelled();
}

void ProgressReporter::finish() const {
  if (!state_) return;
  raise(from_ + share_);
  {
    const std::lock_guard lock(state_->mutex);
    state_->call();
  }
  state_->throw_if_cancelled();
}

bool ProgressReporter::is_due() const {
  return asks_always_ || state_->cancelled.load(std::memory_order_relaxed) ||
         Clock::now().time_since_epoch().count() >= state_->next.load(std::memory_order_relaxed);
}

void ProgressReporter::raise(double fraction) const {
  fraction = std::min(fraction, 1.0);
  double before = state_->fraction.load(std::memory_order_relaxed);
  while (fraction > before && !state_->fraction.compare_exchange_weak(before, fraction)) {
  }
}

void ProgressReporter::ask() const {
  {
    // Nobody waits for a thread that asks just now, but for tests, which count what is asked.
    std::unique_lock lock(state_->mutex, std::defer_lock);
    if (asks_always_) {
      lock.lock();
    } else if (!lock.try_lock()) {
      return state_->throw_if_cancelled();
    }
    if (is_due()) state_->call();  // another thread may just have asked
  }
  state_->throw_if_cancelled();
}

ProgressReporter ProgressReporter::part(double from, double to) const {
  ProgressReporter part = *this;
  part.from_ = from_ + share_ * from;
  part.share_ = share_ * (to - from);
  return part;
}

ProgressReporter ProgressReporter::limited(double most_work, std::string advice, double per_unit) const {
  ProgressReporter limited = *this;
  limited.limit_ = std::make_shared<Limit>();
  limited.limit_->most = most_work;
  limited.limit_->per_unit = per_unit;
  limited.limit_->advice = std::move(advice);
  return limited;
}

void ProgressReporter::check_work(double more) const {
  if (limit_->done.load() + more <= limit_->most * limit_->per_unit) return;
  constexpr double kMillion = 1e6;
  const std::string most =
      limit_->most < kMillion ? number_text(limit_->most) : number_text(limit_->most / kMillion) + " million";
  throw Error(ErrorCode::work_too_large,
              "the work would be too much: more than " + most + " facets would have to go through boolean operations",
              state_ ? state_->where : "", limit_->advice + "; or raise 'work_limit' and be patient");
}

ProgressReporter::AskAlways::AskAlways() { ++g_asks_always; }

ProgressReporter::AskAlways::~AskAlways() { --g_asks_always; }

bool ProgressBridge::ask(void* bridge, double fraction) noexcept {
  auto* const self = static_cast<ProgressBridge*>(bridge);
  try {
    self->progress_.report(fraction);
    return true;
  } catch (...) {
    const std::lock_guard lock(self->mutex_);
    if (!self->thrown_) self->thrown_ = std::current_exception();
    return false;
  }
}

void ProgressBridge::rethrow() const {
  if (thrown_) std::rethrow_exception(thrown_);
}

}  // namespace vantage::internal::core
