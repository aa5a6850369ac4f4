// Whether a call follows the contract of Progress, and how often it asks.
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "vantage/progress.h"

namespace vantage::testing {

/// What a call told its Progress.
struct ProgressStory {
  std::size_t calls = 0;
  std::vector<std::string> stages;              ///< in order; one may come again
  std::map<std::string, std::size_t> calls_in;  ///< per stage
  std::map<std::string, double> last_fraction;  ///< of each stage
};

/// Runs `call`, which asks at every opportunity, whatever the clock says. Expects fractions from 0 to 1 that do not
/// fall within a stage, and never two threads in the callback at once.
ProgressStory follow(const std::function<void(const Progress&)>& call);

/// The same, and stops `call` at each of its first questions, at the last, and at some between: expects
/// Error(cancelled), and no question after the one that was answered with no.
ProgressStory check_progress(const std::function<void(const Progress&)>& call);

}  // namespace vantage::testing
