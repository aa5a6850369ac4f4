// How many threads vantage may use.
#pragma once

#include <functional>

#include "vantage/export.h"

namespace vantage {

/// Runs `action` with at most `threads` threads (0: as many as the machine has) for what vantage does in it. Results
/// do not depend on the number. An exception is thrown on.
VANTAGE_API void with_threads(int threads, const std::function<void()>& action);

}  // namespace vantage
