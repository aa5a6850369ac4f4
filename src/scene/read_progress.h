// Calls a Progress from inside a reading loop without slowing it down.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <string_view>
#include <utility>

#include "vantage/progress.h"

namespace vantage::scene {

class ReadProgress {
 public:
  ReadProgress(const Progress& progress, std::filesystem::path file) : progress_(progress), file_(std::move(file)) {}

  /// Names what follows and reports that none of it is done.
  void begin(std::string_view stage);

  /// Reports the fraction `done` of `total`. Cheap enough for every line of a file: the clock is asked at every 256th
  /// call and the caller at most 20 times a second. Throws Error(cancelled) when the caller asks to stop.
  void update(std::uint64_t done, std::uint64_t total) {
    if (progress_ && (++calls_ & 0xff) == 0) update_slowly(done, total);
  }

  /// The same where calls are rare: the clock is asked each time.
  void update_slowly(std::uint64_t done, std::uint64_t total);

 private:
  void report(double fraction);

  const Progress& progress_;
  std::filesystem::path file_;
  std::string_view stage_;
  std::uint64_t calls_ = 0;
  std::chrono::steady_clock::time_point next_{};
};

}  // namespace vantage::scene
