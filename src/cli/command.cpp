#include "cli/command.h"

#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstring>

#include "common/input.h"
#include "vantage/error.h"
#include "vantage/progress.h"

namespace vantage::cli {
namespace {

using Clock = std::chrono::steady_clock;

double processor_seconds() {
  timespec used{};
  ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &used);
  return static_cast<double>(used.tv_sec) + 1e-9 * static_cast<double>(used.tv_nsec);
}

// Set when the libraries are loaded and initialised, just before main().
const double g_loading_seconds = processor_seconds();
const Clock::time_point g_start = Clock::now();

/// printable() between newlines and tabs.
std::string printable_lines(std::string_view text) {
  std::string shown;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find_first_of("\n\t"), text.size());
    shown += printable(text.substr(0, end));
    if (end < text.size()) shown += text[end];
    text.remove_prefix(std::min(text.size(), end + 1));
  }
  return shown;
}

ErrorCode code_of(NumberFault fault) {
  if (fault == NumberFault::not_a_number) return ErrorCode::not_a_number;
  return fault == NumberFault::unknown_unit ? ErrorCode::value_syntax : ErrorCode::value_out_of_range;
}

}  // namespace

double loading_seconds() { return g_loading_seconds; }

double seconds_since_start() {
  return g_loading_seconds + std::chrono::duration<double>(Clock::now() - g_start).count();
}

std::string exit_code_table() {
  return "\n"
         "EXIT CODES\n"
         "  0      done\n"
         "  1      wrong: verify, verify-tour, prove, check, report, compute --prove; none: compute, stand, "
         "orbit;\n"
         "         too many facets: simplify; targets left out: tour\n"
         "  2      bad input, bad arguments, or a result that could not be written\n"
         "  3      a defect of vantage: please report it together with the input\n"
         "  4      prove, report or compute --prove neither proved nor refuted the volume;\n"
         "         tour of a mission with 'tour.gap': the gap is larger, or fewer positions may do with --fewest;\n"
         "         check: the plan has commands that could not be judged\n"
         "  128+n  stopped by signal n. 130: Ctrl-C. 141: whoever read the output stopped reading\n"
         "  After 2, 3 and 128+n existing files are as they were. A second Ctrl-C ends the program at once.\n";
}

void add_common_options(CLI::App& command, CommonOptions& options) {
  command.add_option("--threads", options.threads, "Threads to use; 0 (default): as many as the machine has")
      ->check(CLI::Range(0, 1024))
      ->option_text("N");
  command.add_flag(
      "--progress", options.progress,
      "Report each stage on standard error, from the beginning on. Without it what takes over a second says "
      "how far it is; VANTAGE_PROGRESS=never in the environment: only on a terminal");
  command.add_flag("-q,--quiet", options.quiet, "Suppress all output except errors and requested results");
}

int with_threads(const CommonOptions& options, const Command& command) {
  int exit_code = kSuccess;
  vantage::with_threads(options.threads, [&] { exit_code = command(); });
  return exit_code;
}

double positive_option(const std::string& name, const std::string& text) {
  const ParsedNumber parsed = parse_number(text);
  if (parsed.fault == NumberFault::none && parsed.value > 0) return parsed.value;
  const std::string advice =
      parsed.fault == NumberFault::none ? "write a number greater than 0" : number_advice(text, parsed.fault);
  throw Error(code_of(parsed.fault), name + " must be a positive number, not " + in_quotes(text),
              "command line, " + name, advice);
}

double length_option(const std::string& name, const std::string& text) {
  const ParsedNumber parsed = parse_length(text);
  if (parsed.fault == NumberFault::none) return parsed.value;
  throw Error(code_of(parsed.fault), name + " must be a length, not " + in_quotes(text), "command line, " + name,
              length_advice(text, parsed.fault));
}

double positive_length_option(const std::string& name, const std::string& text) {
  const double length = length_option(name, text);
  if (length > 0) return length;
  throw Error(ErrorCode::value_out_of_range, name + " must be a positive length, not " + in_quotes(text),
              "command line, " + name, "write a length greater than 0");
}

std::function<std::string(std::string)> to_metres(const std::string& name) {
  return [name](const std::string& text) { return shortest(length_option(name, text)); };
}

void print(std::string_view given) {
  // A terminal obeys some bytes, and data of others may hold them.
  const std::string shown = ::isatty(STDOUT_FILENO) == 1 ? printable_lines(given) : std::string();
  const std::string_view text = shown.empty() ? given : shown;
  errno = 0;
  const bool is_written = std::fwrite(text.data(), 1, text.size(), stdout) == text.size() && std::fflush(stdout) == 0;
  if (is_written) return;
  if (errno == EPIPE) throw ClosedPipe();
  throw Error(ErrorCode::output_unwritable, std::string("the result could not be written: ") + std::strerror(errno),
              "standard output", "make room on the disk, or send it elsewhere");
}

void note(const std::string& text) { std::fprintf(stderr, "vantage: %s\n", printable(text).c_str()); }

void notes(const std::vector<Warning>& warnings) {
  for (const Warning& warning : warnings) note(warning.text);
}

}  // namespace vantage::cli
