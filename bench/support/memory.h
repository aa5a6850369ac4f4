// Memory of the process, as Linux counts it.
#pragma once

#include <fstream>
#include <string>

namespace vantage::bench {

/// Forgets the peak so far. Where the kernel does not allow it, the peak since the start stays.
inline void reset_peak_memory() { std::ofstream("/proc/self/clear_refs") << "5\n"; }

/// Greatest resident size since then, bytes; 0 where /proc does not tell.
inline double peak_memory() {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;) {
    if (word != "VmHWM:") continue;
    double kilobytes = 0;
    status >> kilobytes;
    return 1024 * kilobytes;
  }
  return 0;
}

}  // namespace vantage::bench
