// Takes the place of src/cli/progress_line.cpp in vantage_progress_gaps: the program itself, but for a line at its end
// that says how long at most it did not ask whether to go on, and where.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <string>

#include "cli/progress_line.h"

namespace vantage::cli {
namespace {

using Clock = std::chrono::steady_clock;

double seconds(Clock::duration duration) { return std::chrono::duration<double>(duration).count(); }

/// Of all threads: what else the machine does counts less here.
double processor_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

/// Of the whole process: from its start to its end.
class Record {
 public:
  ~Record() {
    asked("the end", 1);
    std::fprintf(stderr, "gap: %.3f s of %.2f s (processor: %.3f of %.2f), %zu calls, from %s to %s%s\n", largest_,
                 seconds(Clock::now() - start_), largest_work_, processor_seconds(), calls_, from_.c_str(), to_.c_str(),
                 fell_.empty() ? "" : (", FALLS in " + fell_).c_str());
  }

  void asked(std::string_view stage, double fraction) {
    const Clock::time_point now = Clock::now();
    const std::string place = std::string(stage) + " " + std::to_string(static_cast<int>(100 * fraction)) + " %";
    const double work = processor_seconds() - last_work_;
    largest_ = std::max(largest_, seconds(now - last_));
    if (work > largest_work_) {
      largest_work_ = work;
      from_ = place_;
      to_ = place;
    }
    const char* const shown = std::getenv("VANTAGE_GAPS");  // gaps of more seconds than this are told one by one
    if (shown != nullptr && work > std::atof(shown)) {
      std::fprintf(stderr, "  %.3f s (processor: %.3f) from %s to %s\n", seconds(now - last_), work, place_.c_str(),
                   place.c_str());
    }
    if (stage == stage_ && fraction < fraction_) fell_ = stage;
    stage_ = stage;
    fraction_ = fraction;
    place_ = place;
    last_ = Clock::now();
    last_work_ = processor_seconds();
    ++calls_;
  }

 private:
  Clock::time_point start_ = Clock::now(), last_ = start_;
  std::string stage_, place_ = "the start", from_, to_, fell_;
  double fraction_ = 0, largest_ = 0, largest_work_ = 0, last_work_ = 0;
  std::size_t calls_ = 0;
};

Record g_record;

}  // namespace

ProgressLine::ProgressLine(const CommonOptions& /*options*/) : form_(Form::none) {}

ProgressLine::~ProgressLine() = default;

Progress ProgressLine::callback() {
  return [this](std::string_view stage, double fraction) { return report(stage, fraction); };
}

bool ProgressLine::report(std::string_view stage, double fraction) {
  if (noted_signal() != 0) return false;
  g_record.asked(stage, fraction);
  return true;
}

void ProgressLine::wipe() {}

}  // namespace vantage::cli
