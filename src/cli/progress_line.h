// Progress on standard error.
#pragma once

#include <chrono>
#include <string>
#include <string_view>

#include "cli/command.h"
#include "cli/interrupt.h"
#include "vantage/progress.h"

namespace vantage::cli {

/// Follows one command. On a terminal: after a second, one line that is rewritten and in the end wiped. With --progress
/// and no terminal: a plain line per stage. Else, and with --quiet: nothing. The first signal that asks the program to
/// end makes the callback say so, so that nothing is left half-written; see InterruptGuard.
class ProgressLine {
 public:
  explicit ProgressLine(const CommonOptions& options);
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  /// Valid as long as this object.
  Progress callback();

 private:
  using Clock = std::chrono::steady_clock;
  enum class Form { none, live, plain };

  bool report(std::string_view stage, double fraction);
  void wipe();

  InterruptGuard guard_;
  Form form_;
  Clock::time_point start_ = Clock::now();
  Clock::time_point last_shown_{};
  std::string stage_;
  bool is_shown_ = false;
};

}  // namespace vantage::cli
