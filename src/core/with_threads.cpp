#include "core/parallel.h"
#include "vantage/threads.h"

namespace vantage {

void with_threads(int threads, const std::function<void()>& action) {
  internal::parallel::with_threads(threads, action);
}

}  // namespace vantage
