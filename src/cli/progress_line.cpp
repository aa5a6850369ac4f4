#include "cli/progress_line.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>

namespace vantage::cli {
namespace {

constexpr std::chrono::milliseconds kQuietTime{1000};     // what is over sooner needs no progress
constexpr std::chrono::milliseconds kRefreshTime{100};    // faster than that is only flicker
constexpr std::chrono::milliseconds kNewStageTime{1000};  // in a file or a pipe every line stays
constexpr std::chrono::milliseconds kNewPercentTime{5000};
constexpr std::chrono::milliseconds kNothingNewTime{30000};

bool is_silenced() {
  const char* const word = std::getenv("VANTAGE_PROGRESS");
  return word && std::string_view(word) == "never";
}

}  // namespace

ProgressLine::ProgressLine(const CommonOptions& options) : is_asked_for_(options.progress) {
  if (options.quiet) return;
  if (::isatty(STDERR_FILENO) == 1) {
    form_ = Form::live;
  } else if (is_asked_for_ || !is_silenced()) {
    form_ = Form::plain;
  }
}

ProgressLine::~ProgressLine() { wipe(); }

Progress ProgressLine::callback() {
  return [this](std::string_view stage, double fraction) { return report(stage, fraction); };
}

bool ProgressLine::report(std::string_view stage, double fraction) {
  if (noted_signal() != 0) return false;
  const int percent = static_cast<int>(100 * std::clamp(fraction, 0.0, 1.0));
  const Clock::time_point now = Clock::now();
  if (form_ == Form::live) report_live(stage, percent, now);
  if (form_ == Form::plain) report_plain(stage, percent, now);
  return true;
}

void ProgressLine::report_live(std::string_view stage, int percent, Clock::time_point now) {
  if (now - start_ < kQuietTime || now - last_shown_ < kRefreshTime) return;
  std::fprintf(stderr, "\r\033[Kvantage: %.*s %d %%", static_cast<int>(stage.size()), stage.data(), percent);
  std::fflush(stderr);
  last_shown_ = now;
  is_shown_ = true;
}

void ProgressLine::report_plain(std::string_view stage, int percent, Clock::time_point now) {
  const bool is_new = stage != stage_;
  const bool is_due = is_new ? is_asked_for_ || (now - start_ >= kQuietTime && now - last_shown_ >= kNewStageTime)
                             : now - last_shown_ >= (percent == percent_ ? kNothingNewTime : kNewPercentTime);
  if (!is_due) return;
  if (is_new && percent == 0) {
    std::fprintf(stderr, "vantage: %.*s\n", static_cast<int>(stage.size()), stage.data());
  } else {
    std::fprintf(stderr, "vantage: %.*s %d %%\n", static_cast<int>(stage.size()), stage.data(), percent);
  }
  last_shown_ = now;
  stage_ = stage;
  percent_ = percent;
}

void ProgressLine::wipe() {
  if (!is_shown_) return;
  std::fputs("\r\033[K", stderr);
  std::fflush(stderr);
}

}  // namespace vantage::cli
