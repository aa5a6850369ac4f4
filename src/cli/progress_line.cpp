#include "cli/progress_line.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>

namespace vantage::cli {
namespace {

constexpr std::chrono::milliseconds kQuietTime{1000};   // what is over sooner needs no progress
constexpr std::chrono::milliseconds kRefreshTime{100};  // faster than that is only flicker

}  // namespace

ProgressLine::ProgressLine(const CommonOptions& options) : form_(Form::none) {
  if (!options.quiet && ::isatty(STDERR_FILENO) == 1) {
    form_ = Form::live;
  } else if (!options.quiet && options.progress) {
    form_ = Form::plain;
  }
}

ProgressLine::~ProgressLine() { wipe(); }

Progress ProgressLine::callback() {
  return [this](std::string_view stage, double fraction) { return report(stage, fraction); };
}

bool ProgressLine::report(std::string_view stage, double fraction) {
  if (noted_signal() != 0) return false;
  const Clock::time_point now = Clock::now();
  if (form_ == Form::plain && stage != stage_) {
    std::fprintf(stderr, "vantage: %.*s\n", static_cast<int>(stage.size()), stage.data());
  }
  if (form_ == Form::live && now - start_ >= kQuietTime && now - last_shown_ >= kRefreshTime) {
    const int percent = static_cast<int>(100 * std::clamp(fraction, 0.0, 1.0));
    std::fprintf(stderr, "\r\033[Kvantage: %.*s %d %%", static_cast<int>(stage.size()), stage.data(), percent);
    std::fflush(stderr);
    last_shown_ = now;
    is_shown_ = true;
  }
  stage_ = stage;
  return true;
}

void ProgressLine::wipe() {
  if (!is_shown_) return;
  std::fputs("\r\033[K", stderr);
  std::fflush(stderr);
}

}  // namespace vantage::cli
