#include "cli/command.h"

#include <cerrno>
#include <cstdio>
#include <cstring>

#include "mission/numbers.h"
#include "parallel/parallel.h"
#include "vantage/error.h"

namespace vantage::cli {

void add_common_options(CLI::App& command, CommonOptions& options) {
  command.add_option("--threads", options.threads, "Threads to use; 0 (default): as many as the machine has")
      ->check(CLI::Range(0, 1024))
      ->option_text("N");
  command.add_flag("--progress", options.progress, "Tell each stage on standard error, even if it is no terminal");
  command.add_flag("-q,--quiet", options.quiet, "Print nothing but errors and results that were asked for");
}

int with_threads(const CommonOptions& options, const Command& command) {
  int exit_code = kSuccess;
  parallel::with_threads(options.threads, [&] { exit_code = command(); });
  return exit_code;
}

double positive_option(const std::string& name, const std::string& text) {
  const mission_io::ParsedNumber parsed = mission_io::parse_number(text);
  if (parsed.fault == mission_io::NumberFault::none && parsed.value > 0) return parsed.value;
  const std::string advice = parsed.fault == mission_io::NumberFault::none
                                 ? "write a number greater than 0"
                                 : mission_io::number_advice(text, parsed.fault);
  throw Error(ErrorKind::input, name + " must be a positive number, not " + mission_io::in_quotes(text),
              "command line, " + name, advice);
}

void print(const std::string& text) {
  errno = 0;
  const bool is_written = std::fwrite(text.data(), 1, text.size(), stdout) == text.size() && std::fflush(stdout) == 0;
  if (is_written) return;
  throw Error(ErrorKind::output, std::string("the result could not be written: ") + std::strerror(errno),
              "standard output", "make room on the disk, or send it elsewhere");
}

void note(const std::string& text) { std::fprintf(stderr, "vantage: %s\n", text.c_str()); }

}  // namespace vantage::cli
