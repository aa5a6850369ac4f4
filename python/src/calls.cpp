#include "calls.h"

#include <nanobind/stl/string.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <deque>
#include <thread>

#include "vantage/error.h"

namespace vantage::python {
namespace {

using Clock = std::chrono::steady_clock;

/// How often Python hears of a computation.
constexpr auto kOften = std::chrono::milliseconds(50);

/// The process that computed first; 0: none did.
std::atomic<pid_t> first_process = 0;

void check_process() {
  pid_t none = 0;
  const pid_t here = getpid();
  if (first_process.compare_exchange_strong(none, here) || none == here) return;
  throw Error(ErrorCode::not_applicable,
              "this process was forked from one that had used vantage, whose threads are missing here",
              "process " + std::to_string(here),
              "start processes with multiprocessing.get_context(\"spawn\") or \"forkserver\"");
}

void check_callback(const nb::object& callback) {
  if (callback.is_none() || PyCallable_Check(callback.ptr())) return;
  throw Error(ErrorCode::wrong_type, "progress is neither a function nor True or False", "progress",
              "pass a function of a stage and a fraction, or True for a bar");
}

/// Threads that wait for jobs.
class Workers {
 public:
  void run(std::function<void()> job) {
    const std::lock_guard lock(mutex_);
    if (jobs_.size() >= idle_) std::thread([this] { serve(); }).detach();
    jobs_.push_back(std::move(job));
    changed_.notify_one();
  }

 private:
  [[noreturn]] void serve() {
    const HeldSignals held;
    std::unique_lock lock(mutex_);
    while (true) {
      ++idle_;
      changed_.wait(lock, [&] { return !jobs_.empty(); });
      --idle_;
      const std::function<void()> job = std::move(jobs_.front());
      jobs_.pop_front();
      lock.unlock();
      job();
      lock.lock();
    }
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::function<void()>> jobs_;
  std::size_t idle_ = 0;
};

}  // namespace

void run_on_worker(std::function<void()> job) {
  static auto* const workers = new Workers;  // its threads wait for it until the process ends
  workers->run(std::move(job));
}

Bridge::Bridge(nb::object callback) : callback_(std::move(callback)), bar_(nb::none()) {
  check_process();
  if (callback_.is(nb::bool_(true))) {
    const nb::object module = called([] { return PyImport_ImportModule("vantage._progress"); });
    callback_ = bar_ = called([&] { return PyObject_CallMethod(module.ptr(), "Bar", nullptr); });
  }
  if (callback_.is(nb::bool_(false))) callback_ = nb::none();
  check_callback(callback_);
}

Bridge::~Bridge() {
  if (bar_.is_none()) return;
  guarded([&] {
    PyObject* const closed = PyObject_CallMethod(bar_.ptr(), "close", nullptr);
    if (closed == nullptr) PyErr_WriteUnraisable(bar_.ptr());
    Py_XDECREF(closed);
  });
}

Progress Bridge::progress() {
  return [this](std::string_view stage, double fraction) {
    const std::lock_guard lock(mutex_);
    has_news_ = true;
    stage_ = stage;
    fraction_ = fraction;
    return !is_cancelled_ && !is_ending();
  };
}

void Bridge::finish() {
  const std::lock_guard lock(mutex_);
  is_finished_ = true;
  changed_.notify_all();
}

void Bridge::serve() {
  while (true) {
    std::string stage;
    double fraction = 0;
    bool has_news = false, is_last = false;
    {
      const Released released;
      std::unique_lock lock(mutex_);
      is_last = changed_.wait_for(lock, kOften, [&] { return is_finished_; });
      has_news = std::exchange(has_news_, false);
      stage = stage_;
      fraction = fraction_;
    }
    attend(stage, fraction, has_news);  // also of work that is done before the first wait is over
    if (is_last) return;
  }
}

Progress Bridge::progress_here() {
  next_ = Clock::now() + kOften;
  return [this, caller = std::this_thread::get_id()](std::string_view stage, double fraction) {
    if (std::this_thread::get_id() == caller && Clock::now() >= next_) {
      if (is_given_up()) return false;
      const TakenBack held;
      attend(std::string(stage), fraction, true);
      next_ = Clock::now() + kOften;
    }
    return !is_stopped() && !is_ending();
  };
}

bool Bridge::is_stopped() {
  const std::lock_guard lock(mutex_);
  return is_cancelled_;
}

void Bridge::attend(const std::string& stage, double fraction, bool has_news) {
  if (is_stopped()) return;  // the computation is about to stop
  try {
    if (PyErr_CheckSignals() != 0) throw nb::python_error();
    if (has_news && !callback_.is_none()) call_python(stage, fraction);
  } catch (...) {
    raised_ = std::current_exception();
    const std::lock_guard lock(mutex_);
    is_cancelled_ = true;
  }
}

void Bridge::call_python(const std::string& stage, double fraction) {
  const nb::object answer =
      called([&] { return PyObject_CallFunction(callback_.ptr(), "sd", stage.c_str(), fraction); });
  if (!answer.is(nb::bool_(false))) return;
  stopped_while_ = stage;
  const std::lock_guard lock(mutex_);
  is_cancelled_ = true;
}

void Bridge::raise(const std::exception_ptr& failure) const {
  if (raised_) std::rethrow_exception(raised_);
  if (failure) std::rethrow_exception(failure);
  // The work was done before it could notice the stop. The callback said no all the same.
  if (is_cancelled_) throw Error(ErrorCode::cancelled, "cancelled while " + stopped_while_, "", "");
}

}  // namespace vantage::python
