// A callback that stops a computation after half of it, and one thread for it.
#include "vantage/progress.h"

namespace example {

void stopped(const std::function<void(const vantage::Progress&)>& compute) {
  vantage::with_threads(1, [&] { compute([](std::string_view, double fraction) { return fraction < 0.5; }); });
}

}  // namespace example
