// vantage: visibility volumes of convex polygons in city scenes. Parses the command line, then runs one command.
#include <algorithm>
#include <csignal>
#include <cstdio>
#include <exception>
#include <new>
#include <string>
#include <vector>

#include "cli/command.h"
#include "cli/interrupt.h"
#include "mission/nearest_name.h"
#include "mission/numbers.h"
#include "vantage/error.h"

namespace vantage::cli {
namespace {

constexpr const char* kExamples =
    "EXAMPLES\n"
    "  vantage scene city.osm.pbf --center 40.7484,-73.9857 --radius 600 -o scene.glb\n"
    "  vantage inspect city.obj --up y\n"
    "  vantage compute mission.yaml -o volume.ply\n"
    "  vantage query mission.yaml points.csv > answers.csv\n"
    "  vantage verify mission.yaml volume.ply\n"
    "  vantage compare spheres.ply exact.ply\n"
    "  vantage devices\n"
    "  vantage spheres -c config.yaml\n"
    "  vantage render mission.yaml --volume volume.ply -o picture.png\n"
    "\n"
    "EXIT CODES\n"
    "  0  done\n"
    "  1  verify: the volume is wrong\n"
    "  2  bad input or arguments, or a result that could not be written; existing files are left as they were\n"
    "  3  a defect of vantage; existing files are left as they were\n"
    "  128 + n  stopped by signal n (130: Ctrl-C); existing files are left as they were, a second signal ends at once\n"
    "\n"
    "The mission file: docs/mission-file.md\n";

/// One line: what an error message holds may come from a file.
std::string one_line(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7F; }, ' ');
  return text;
}

void print_error(const std::string& problem, const std::string& where, const std::string& fix) {
  std::fprintf(stderr, "vantage: %s\n  where: %s\n  what to do: %s\n", one_line(problem).c_str(),
               one_line(where).c_str(), one_line(fix).c_str());
}

int exit_code(ErrorKind kind) {
  switch (kind) {
    case ErrorKind::input:
    case ErrorKind::output:
      return kBadInput;
    case ErrorKind::cancelled:
      return kSignalled + noted_signal();
    case ErrorKind::internal:
      break;
  }
  return kDefect;
}

/// The help text to look at: of the command that was named, if one was.
std::string help_command(const CLI::App& app) {
  const std::vector<CLI::App*> parsed = app.get_subcommands();
  return parsed.empty() ? "vantage --help" : "vantage " + parsed.front()->get_name() + " --help";
}

int print_usage_error(const CLI::App& app, const CLI::ParseError& error, const std::vector<std::string>& arguments) {
  if (!arguments.empty() && arguments.front().substr(0, 1) != "-" && app.get_subcommands().empty()) {
    std::vector<std::string> names;
    for (const CLI::App* command : app.get_subcommands({})) names.push_back(command->get_name());
    const std::string_view nearest =
        mission_io::nearest_name(arguments.front(), std::vector<std::string_view>(names.begin(), names.end()));
    print_error("there is no command " + mission_io::in_quotes(arguments.front()), "command line",
                "did you mean '" + std::string(nearest) + "'? 'vantage --help' lists the commands");
    return kBadInput;
  }
  if (arguments.empty()) {
    print_error("no command is given", "command line", "see 'vantage --help'");
    return kBadInput;
  }
  print_error(error.what(), "command line", "see '" + help_command(app) + "'");
  return kBadInput;
}

int run_guarded(const Command& command, const std::string& name) {
  try {
    return command();
  } catch (const Error& error) {
    if (error.kind() == ErrorKind::cancelled) {
      note("stopped; nothing was written");
      return exit_code(error.kind());
    }
    print_error(error.problem(), error.where().empty() ? "vantage " + name : error.where(),
                error.fix().empty() ? "see 'vantage " + name + " --help'" : error.fix());
    return exit_code(error.kind());
  } catch (const std::bad_alloc&) {
    print_error("the memory is used up", "vantage " + name,
                "take a smaller scene, a shorter max_range, or a machine with more memory");
    return kBadInput;
  } catch (const std::exception& error) {
    print_error(std::string("unexpected failure: ") + error.what(), "vantage " + name,
                "this is a defect of vantage: please report it together with the input");
    return kDefect;
  }
}

int run(int argument_count, char** arguments) {
  // A closed pipe or a file size limit must end in a message, not in the program's death.
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);

  CLI::App app("The closed volume of every position from which a whole convex polygon is visible.", "vantage");
  app.set_version_flag("--version", "vantage " VANTAGE_VERSION);
  app.require_subcommand(1);
  app.footer(kExamples);
  Command chosen;
  add_scene(app, chosen);
  add_inspect(app, chosen);
  add_compute(app, chosen);
  add_query(app, chosen);
  add_verify(app, chosen);
  add_compare(app, chosen);
  add_devices(app, chosen);
  add_spheres(app, chosen);
  add_render(app, chosen);

  try {
    app.parse(argument_count, arguments);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // --help, --version
    return print_usage_error(app, error, std::vector<std::string>(arguments + 1, arguments + argument_count));
  }
  return run_guarded(chosen, app.get_subcommands().front()->get_name());
}

}  // namespace
}  // namespace vantage::cli

int main(int argument_count, char** arguments) {
  try {
    return vantage::cli::run(argument_count, arguments);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "vantage: unexpected failure: %s\n", error.what());
    return vantage::cli::kDefect;
  }
}
