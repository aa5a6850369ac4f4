// Progress on standard error.
#pragma once

#include <chrono>
#include <string>
#include <string_view>

#include "cli/command.h"
#include "cli/interrupt.h"
#include "vantage/progress.h"

namespace vantage::cli {

/// Follows one command. On a terminal: after a second, one line that is rewritten and in the end wiped. Elsewhere:
/// after a second plain lines, one for each new stage, a second apart or more, and now and then of a long stage. With
/// --progress a line for each stage, from the beginning on. With --quiet, and without --progress where the environment
/// variable VANTAGE_PROGRESS is "never" and there is no terminal: nothing. The first signal that asks the program to
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
  void report_live(std::string_view stage, int percent, Clock::time_point now);
  void report_plain(std::string_view stage, int percent, Clock::time_point now);
  void wipe();

  InterruptGuard guard_;
  Form form_ = Form::none;
  bool is_asked_for_;
  Clock::time_point start_ = Clock::now();
  Clock::time_point last_shown_{};
  std::string stage_;  // that was shown last
  int percent_ = 0;
  bool is_shown_ = false;
};

}  // namespace vantage::cli
