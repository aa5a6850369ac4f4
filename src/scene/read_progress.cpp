#include "scene/read_progress.h"

#include <algorithm>

#include "vantage/error.h"

namespace vantage::scene {

void ReadProgress::begin(std::string_view stage) {
  stage_ = stage;
  report(0);
}

void ReadProgress::update_slowly(std::uint64_t done, std::uint64_t total) {
  if (!progress_ || std::chrono::steady_clock::now() < next_) return;
  report(total == 0 ? 1.0 : std::min(1.0, static_cast<double>(done) / static_cast<double>(total)));
}

void ReadProgress::report(double fraction) {
  if (!progress_) return;
  if (!progress_(stage_, fraction)) {
    throw Error(ErrorKind::cancelled, "reading was cancelled", file_.string(), "");
  }
  next_ = std::chrono::steady_clock::now() + std::chrono::milliseconds(50);
}

}  // namespace vantage::scene
