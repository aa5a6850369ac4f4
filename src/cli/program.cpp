#include "cli/program.h"

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <exception>
#include <new>
#include <sstream>
#include <string>
#include <vector>

#include "cli/command.h"
#include "cli/interrupt.h"
#include "cli/usage_error.h"
#include "vantage/city.h"
#include "vantage/error.h"
#include "vantage/spheres.h"
#include "vantage/version.h"

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
    "  vantage simplify volume.ply --facets 500 -o small.ply\n"
    "  vantage devices\n"
    "  vantage cameras\n"
    "  vantage keys sensor\n"
    "  vantage spheres -c config.yaml\n"
    "  vantage render mission.yaml --volume volume.ply -o picture.png\n"
    "  vantage report mission.yaml -o report.html\n"
    "  vantage view mission.yaml\n"
    "  vantage stand mission.yaml\n"
    "  vantage orbit mission.yaml --radius 60\n"
    "\n"
    "MISSION and POINTS may be -, standard input. `vantage keys` lists what a mission file may say;\n"
    "docs/mission-file.md has examples, docs/command-line.md describes the commands.\n";

int print_error(const Error& error, const std::string& name) {
  const std::string command = name.empty() ? "vantage" : "vantage " + name;
  const Error told = error.with_where(error.where().empty() ? command : error.where())
                         .with_fix(error.fix().empty() ? "see '" + command + " --help'" : error.fix());
  std::fprintf(stderr, "vantage: %s", message_of(told).c_str());
  return exit_code(error.kind());
}

/// `name`: of the command.
int run_guarded(const Command& command, const std::string& name) {
  try {
    return command();
  } catch (const ClosedPipe&) {
    return kSignalled + SIGPIPE;
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::cancelled) return print_error(error, name);
    note("stopped; nothing was written");
    return kSignalled + noted_signal();
  } catch (const std::bad_alloc&) {
    return print_error(Error(ErrorCode::out_of_memory, "the memory is used up", "",
                             "take a smaller scene, a shorter max_range, or a machine with more memory"),
                       name);
  } catch (const std::exception& error) {
    return print_error(Error(ErrorCode::internal_defect, std::string("unexpected failure: ") + error.what(), "",
                             "this is a defect of vantage: please report it together with the input"),
                       name);
  }
}

/// So that they are listed; with_options() sees to what they do, but for "help -- compute" and the like.
void add_help(CLI::App& app, Command& chosen) {
  CLI::App* help = app.add_subcommand("help", "Show the help text of a command: vantage help compute");
  help->add_option("command")->option_text("COMMAND");
  CLI::App* version = app.add_subcommand("version", "Print the version");
  for (CLI::App* command : {help, version}) {
    command->callback([command, &chosen] {
      chosen = [command] {
        print(command->help("vantage"));
        return kSuccess;
      };
    });
  }
}

/// "help" and "version" are other words for options.
std::vector<std::string> with_options(std::vector<std::string> arguments) {
  if (arguments.empty()) return arguments;
  const bool stands_alone = arguments.size() == 1 || arguments[1].substr(0, 1) != "-";
  if (arguments[0] == "version" && stands_alone) arguments[0] = "--version";
  if (arguments[0] == "help" && stands_alone) {
    arguments.erase(arguments.begin());
    arguments.emplace_back("--help");
  }
  return arguments;
}

/// A command of the Python package.
Error batch_is_elsewhere() {
  return {ErrorCode::component_missing, "'batch' comes with the Python package, not with this program", "command line",
          "install the package 'vantage' for Python, and call 'python -m vantage batch' (docs/python-batch.md)"};
}

void add_commands(CLI::App& app, Command& chosen) {
  add_scene(app, chosen);
  add_inspect(app, chosen);
  add_compute(app, chosen);
  add_query(app, chosen);
  add_verify(app, chosen);
  add_prove(app, chosen);
  add_compare(app, chosen);
  add_check(app, chosen);
  add_tour(app, chosen);
  add_verify_tour(app, chosen);
  add_simplify(app, chosen);
  add_devices(app, chosen);
  add_cameras(app, chosen);
  add_keys(app, chosen);
  add_spheres(app, chosen);
  add_render(app, chosen);
  add_report(app, chosen);
  add_view(app, chosen);
  add_stand(app, chosen);
  add_orbit(app, chosen);
  add_help(app, chosen);
  add_docs(app, chosen);
}

/// Listed only: vantage/__main__.py runs it.
void add_batch(CLI::App& app) {
  app.add_subcommand("batch", "Compute the volumes of a table of targets, on all cores or a cluster");
}

int run(const std::vector<std::string>& typed, Host host) {
  // A closed pipe or a file size limit must end in an exit code, not in the program's death.
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
  enable_maps();
  enable_spheres();

  CLI::App app("The closed volume of every position from which a whole convex polygon is visible.", "vantage");
  app.set_version_flag("--version", "vantage " VANTAGE_VERSION);
  app.require_subcommand(1);
  app.footer(kExamples + exit_code_table());
  Command chosen;
  add_commands(app, chosen);
  if (host == Host::python) add_batch(app);

  const std::vector<std::string> arguments = with_options(typed);
  if (!arguments.empty() && arguments[0] == "batch") return print_error(batch_is_elsewhere(), "");
  const bool names_command = !arguments.empty() && arguments[0].substr(0, 1) != "-";
  if (names_command && !find_command(app, arguments[0])) return print_error(unknown_command(app, arguments[0]), "");
  try {
    app.parse(std::vector<std::string>(arguments.rbegin(), arguments.rend()));
  } catch (const Error& error) {  // of an option that is a length
    return print_error(error, names_command ? arguments[0] : "");
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() != 0) return print_error(usage_error(app, error, arguments), "");
    std::ostringstream text;  // of --help or --version
    app.exit(error, text, text);
    const auto print_text = [&] {
      print(text.str());
      return kSuccess;
    };
    return run_guarded(print_text, "");
  }
  return run_guarded(chosen, app.get_subcommands().front()->get_name());
}

}  // namespace

int run_program(const std::vector<std::string>& arguments, Host host) {
  try {
    return run(arguments, host);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "vantage: unexpected failure: %s\n", error.what());
    return kDefect;
  }
}

}  // namespace vantage::cli
