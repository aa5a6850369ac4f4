// What the program's commands share: each parses its arguments, then runs.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <memory>
#include <string>

namespace vantage::cli {

/// Exit codes of the program.
enum ExitCode : int {
  kSuccess = 0,
  kCheckFailed = 1,  ///< `verify` found the volume wrong
  kBadInput = 2,     ///< wrong arguments or files, or a result that could not be written
  kDefect = 3,       ///< vantage itself is at fault
  kSignalled = 128,  ///< and the number of the signal that ended it, as shells report it
};

/// Runs a parsed command and returns its exit code; throws vantage::Error.
using Command = std::function<int()>;

/// Each adds one command to `app`. Parsing it stores what is to be done in `chosen`, which must outlive the parsing.
void add_inspect(CLI::App& app, Command& chosen);
void add_compute(CLI::App& app, Command& chosen);
void add_query(CLI::App& app, Command& chosen);
void add_verify(CLI::App& app, Command& chosen);
void add_compare(CLI::App& app, Command& chosen);
void add_devices(CLI::App& app, Command& chosen);
void add_spheres(CLI::App& app, Command& chosen);
void add_render(CLI::App& app, Command& chosen);
void add_scene(CLI::App& app, Command& chosen);

/// Options of every command.
struct CommonOptions {
  bool quiet = false;     ///< nothing on standard output or standard error but errors and what was asked for
  bool progress = false;  ///< a line per stage on standard error, terminal or not
  int threads = 0;        ///< 0: as many as the machine has
};
void add_common_options(CLI::App& command, CommonOptions& options);

/// Runs `command` with at most the threads that the options allow.
int with_threads(const CommonOptions& options, const Command& command);

/// The end of every add_...: the common options, the examples, and `run(*options)` when the command is chosen.
template <typename Options>
void finish(CLI::App& command, const std::shared_ptr<Options>& options, const char* examples, Command& chosen,
            int (*run)(const Options&)) {
  add_common_options(command, options->common);
  command.footer(examples);
  command.callback([options, &chosen, run] {
    chosen = [options, run] { return with_threads(options->common, [&] { return run(*options); }); };
  });
}

/// The positive number of option `name`; throws Error(input).
double positive_option(const std::string& name, const std::string& text);

/// Writes `text` to standard output and makes sure that it arrived; throws Error(output), say for a full disk.
void print(const std::string& text);

/// Writes a line to standard error.
void note(const std::string& text);

}  // namespace vantage::cli
