// How a caller follows a long computation, and stops it; and how many threads it may use.
#pragma once

#include <functional>
#include <string_view>

#include "vantage/export.h"

namespace vantage {

/// Called from time to time with the name of the stage and the fraction of it that is done (0 to 1). The fraction does
/// not fall within a stage; a stage may begin again, for the next mesh say. Returning false cancels: the running call
/// throws Error with ErrorKind::cancelled soon, within tenths of a second on the largest scenes, and does not call
/// again. Never called from two threads at once, but not always from the same one; an empty function is allowed
/// everywhere.
using Progress = std::function<bool(std::string_view stage, double fraction)>;

// ---- How many threads vantage may use

/// Runs `action` with at most `threads` threads (0: as many as the machine has) for what vantage does in it. Results
/// do not depend on the number. An exception is thrown on.
VANTAGE_API void with_threads(int threads, const std::function<void()>& action);

}  // namespace vantage
