#include "cli/interrupt.h"

#include <atomic>

#include "vantage/error.h"

namespace vantage::cli {
namespace {

std::atomic<int> g_signal{0};
static_assert(std::atomic<int>::is_always_lock_free);  // or a signal handler may not touch it

void note_or_end(int number) {
  int none = 0;
  if (g_signal.compare_exchange_strong(none, number)) return;
  std::signal(number, SIG_DFL);
  std::raise(number);  // takes effect when this handler returns
}

}  // namespace

InterruptGuard::InterruptGuard() {
  struct sigaction action {};
  action.sa_handler = note_or_end;
  action.sa_flags = SA_RESTART;
  for (std::size_t i = 0; i < kSignals.size(); ++i) {
    ::sigaction(kSignals[i], nullptr, &old_[i]);
    if (old_[i].sa_handler != SIG_IGN) ::sigaction(kSignals[i], &action, nullptr);
  }
}

InterruptGuard::~InterruptGuard() {
  for (std::size_t i = 0; i < kSignals.size(); ++i) ::sigaction(kSignals[i], &old_[i], nullptr);
}

int noted_signal() { return g_signal.load(); }

void stop_if_interrupted() {
  if (noted_signal() != 0) throw Error(ErrorCode::cancelled, "stopped by a signal", "", "");
}

}  // namespace vantage::cli
