// Runs a program as a user would, and keeps what came of it.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace vantage::testing {

struct ProgramRun {
  int exit_code = -1;       ///< negative: ended by this signal
  bool was_started = true;  ///< false where the folder or the program is out of reach
  bool timed_out = false;
  std::string out, err;
};

struct RunOptions {
  std::filesystem::path folder = ".";               ///< to run in
  std::string input;                                ///< of standard input
  std::optional<std::size_t> largest_file;          ///< bytes: writing more fails, as on a full disk
  std::optional<std::filesystem::path> out_file;    ///< standard output goes there, not into ProgramRun::out
  std::vector<std::pair<int, std::size_t>> limits;  ///< of the system: RLIMIT_AS and the like, and what is allowed
  bool as_nobody = false;  ///< root gives up its rights first, which are above permissions; others run as they are
  int signal = 0;  ///< sent once, as soon as `signal_when` holds of what the program has written to standard error
  std::function<bool(const std::string& err)> signal_when;
  int timeout_s = 120;
  bool shows_progress = false;  ///< else VANTAGE_PROGRESS=never: no line comes, however slow the machine is
  std::string progress_word;    ///< what VANTAGE_PROGRESS is then; empty: it is not set
};

/// Runs `program` with `arguments` and waits for its end, or kills it after the timeout.
ProgramRun run_program(const std::filesystem::path& program, const std::vector<std::string>& arguments,
                       const RunOptions& options = {});

}  // namespace vantage::testing
