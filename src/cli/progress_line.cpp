#include "cli/progress_line.h"

#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdio>

namespace vantage::cli {
namespace {

constexpr std::chrono::milliseconds kQuietTime{1000};   // what is over sooner needs no progress
constexpr std::chrono::milliseconds kRefreshTime{100};  // faster than that is only flicker

volatile std::sig_atomic_t g_is_interrupted = 0;

void interrupt(int) { g_is_interrupted = 1; }

}  // namespace

ProgressLine::ProgressLine(const CommonOptions& options) : form_(Form::none) {
  if (!options.quiet && ::isatty(STDERR_FILENO) == 1) {
    form_ = Form::live;
  } else if (!options.quiet && options.progress) {
    form_ = Form::plain;
  }
  struct sigaction action {};
  action.sa_handler = interrupt;
  action.sa_flags = static_cast<int>(SA_RESETHAND);
  ::sigaction(SIGINT, &action, nullptr);
}

ProgressLine::~ProgressLine() {
  wipe();
  struct sigaction action {};
  action.sa_handler = SIG_DFL;
  ::sigaction(SIGINT, &action, nullptr);
}

Progress ProgressLine::callback() {
  return [this](std::string_view stage, double fraction) { return report(stage, fraction); };
}

bool ProgressLine::report(std::string_view stage, double fraction) {
  if (g_is_interrupted != 0) return false;
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
