// What the program's commands share: each parses its arguments, then runs.
#pragma once

#include <CLI/CLI.hpp>
#include <exception>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "vantage/error.h"

namespace vantage::cli {

/// Exit codes of the program. What they mean is said in exit_code_table() and nowhere else.
enum ExitCode : int {
  kSuccess = 0,
  kCheckFailed = 1,
  kBadInput = 2,
  kDefect = 3,
  kUndecided = 4,
  kSignalled = 128,  ///< and the number of the signal that ended it, as shells report it
};

/// The table at the end of every help text. docs/command-line.md has the same lines.
std::string exit_code_table();

/// Runs a parsed command and returns its exit code; throws vantage::Error.
using Command = std::function<int()>;

/// Each adds one command to `app`. Parsing it stores what is to be done in `chosen`, which must outlive the parsing.
void add_inspect(CLI::App& app, Command& chosen);
void add_compute(CLI::App& app, Command& chosen);
void add_query(CLI::App& app, Command& chosen);
void add_verify(CLI::App& app, Command& chosen);
void add_prove(CLI::App& app, Command& chosen);
void add_compare(CLI::App& app, Command& chosen);
void add_simplify(CLI::App& app, Command& chosen);
void add_tour(CLI::App& app, Command& chosen);
void add_verify_tour(CLI::App& app, Command& chosen);
void add_check(CLI::App& app, Command& chosen);
void add_devices(CLI::App& app, Command& chosen);
void add_cameras(CLI::App& app, Command& chosen);
void add_keys(CLI::App& app, Command& chosen);
void add_spheres(CLI::App& app, Command& chosen);
void add_render(CLI::App& app, Command& chosen);
void add_report(CLI::App& app, Command& chosen);
void add_view(CLI::App& app, Command& chosen);
void add_stand(CLI::App& app, Command& chosen);
void add_orbit(CLI::App& app, Command& chosen);
void add_scene(CLI::App& app, Command& chosen);
void add_docs(CLI::App& app, Command& chosen);  ///< hidden: describes the commands of `app`, which must outlive it

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
void finish(CLI::App& command, const std::shared_ptr<Options>& options, const std::string& examples, Command& chosen,
            int (*run)(const Options&)) {
  add_common_options(command, options->common);
  command.footer(examples + exit_code_table());
  command.callback([options, &chosen, run] {
    chosen = [options, run] { return with_threads(options->common, [&] { return run(*options); }); };
  });
}

/// The positive number of option `name`; throws Error(input).
double positive_option(const std::string& name, const std::string& text);

/// The length of option `name`, metres: a number, or one with its unit ("400 ft"); throws Error(input).
double length_option(const std::string& name, const std::string& text);
double positive_length_option(const std::string& name, const std::string& text);

/// For CLI::Option::transform: the same, as the text of a number in metres.
std::function<std::string(std::string)> to_metres(const std::string& name);

/// Thrown when the reader of standard output has gone away, as `head` does: nothing is wrong, and no one listens.
class ClosedPipe : public std::exception {};

/// Writes `text` to standard output and makes sure that it arrived; throws Error(output), say for a full disk, and
/// ClosedPipe.
void print(std::string_view text);

/// Since the program was started, its loading included: that counts by its processor time, for no clock ran then.
double seconds_since_start();
/// The part of it before main().
double loading_seconds();

/// Writes a line to standard error.
void note(const std::string& text);
void notes(const std::vector<Warning>& warnings);  ///< a line each

}  // namespace vantage::cli
