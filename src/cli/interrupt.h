// Ending on request: Ctrl-C and its kin.
#pragma once

#include <array>
#include <csignal>

namespace vantage::cli {

/// While one lives, the first SIGINT, SIGTERM or SIGHUP is only noted, so that the program can end with nothing left
/// half-written; the second ends it at once. Signals that the program was started to ignore stay ignored. One at a
/// time.
class InterruptGuard {
 public:
  InterruptGuard();
  ~InterruptGuard();
  InterruptGuard(const InterruptGuard&) = delete;
  InterruptGuard& operator=(const InterruptGuard&) = delete;

  static constexpr std::array kSignals = {SIGINT, SIGTERM, SIGHUP};

 private:
  std::array<struct sigaction, kSignals.size()> old_{};
};

/// The signal that was noted, 0 if none was.
int noted_signal();

/// Throws Error(cancelled) if one was.
void stop_if_interrupted();

}  // namespace vantage::cli
