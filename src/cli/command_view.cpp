#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "cli/command.h"
#include "cli/located_plan.h"
#include "cli/page_file.h"
#include "cli/progress_line.h"
#include "common/input.h"
#include "live/judged_flight.h"
#include "live/page_server.h"
#include "live/session.h"
#include "vantage/error.h"
#include "vantage/scene_source.h"

namespace vantage::cli {
namespace {

constexpr const char* kViewExamples =
    "EXAMPLES\n"
    "  vantage view mission.yaml\n"
    "  vantage view mission.yaml --volume volume.ply    # one that is there already; what is dragged is computed\n"
    "  vantage view mission.yaml --flight tour.plan      # flies it in the scene, and shows when what is seen\n"
    "  vantage view mission.yaml --flight track.csv --heights scene --speed 5\n"
    "  vantage view tokyo/tileset.json                   # a tileset of 3D Tiles, to draw targets in\n"
    "  vantage view mission.yaml --port 8090 --no-browser\n"
    "  ssh -L 8090:127.0.0.1:8090 host vantage view mission.yaml --port 8090 --no-browser\n"
    "\n"
    "The page is served on 127.0.0.1 alone, to whoever has the token in the address; Ctrl-C ends it, with exit code "
    "0.\n"
    "It reads the files that the mission names, and no others, and writes none: docs/view.md.\n";

struct ViewArguments {
  CommonOptions common;
  PlanArguments flight;
  std::optional<double> speed_m_s;
  std::string mission, volume, page;
  std::uint16_t port = 0;
  bool no_browser = false;
};

/// Where there is a desktop. The page can be opened by hand as well, so that it fails is no error. The browser may live
/// longer than this program: it gets a session of its own, and nothing of the terminal.
void open_browser(const std::string& address) {
  if (std::getenv("DISPLAY") == nullptr && std::getenv("WAYLAND_DISPLAY") == nullptr) return;
  const pid_t child = ::fork();
  if (child > 0) ::waitpid(child, nullptr, 0);
  if (child != 0) return;
  ::setsid();
  if (::fork() != 0) ::_exit(0);
  if (const int nothing = ::open("/dev/null", O_RDWR); nothing >= 0) {
    for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) ::dup2(nothing, stream);
  }
  ::execlp("xdg-open", "xdg-open", address.c_str(), nullptr);
  ::_exit(1);
}

/// Judged before anything is served, so that a plan that cannot be shown ends the program at once.
void show_flight(live::Session& session, const ViewArguments& options, const Progress& progress) {
  live::GivenFlight given;
  given.plan = read_plan_argument(options.flight, progress);
  given.locate = locate_options(options.flight, given.plan);
  given.speed_m_s = options.speed_m_s;
  given.name = std::filesystem::path(options.flight.plan_file).filename().string();
  session.show_flight(std::move(given), progress);
}

/// A tileset alone has no targets: there is nothing to show a volume or a flight of.
void check_has_mission(const ViewArguments& options) {
  if (source_kind(options.mission) != SceneSource::Kind::tileset) return;
  const char* const option = !options.volume.empty()             ? "--volume"
                             : !options.flight.plan_file.empty() ? "--flight"
                                                                 : nullptr;
  if (!option) return;
  throw Error(ErrorCode::not_applicable, std::string(option) + " is for missions, and a tileset alone is none", option,
              "write a mission with 'scene: {tiles: tileset.json}' and a target, and give that");
}

int run_view(const ViewArguments& options) {
  if (options.flight.plan_file == "-") {
    throw Error(ErrorCode::stdin_not_possible, "the plan must be a file", "--flight", "write it to a file first");
  }
  if (options.mission == "-") {
    throw Error(ErrorCode::stdin_not_possible, "the mission must be a file: names in it start from its folder",
                "command line", "write it to a file first");
  }
  check_has_mission(options);
  std::string page = read_page("index.html", options.page);
  live::PageServer server(options.port);
  live::Session session;
  {
    ProgressLine progress(options.common);
    if (source_kind(options.mission) == SceneSource::Kind::tileset) {
      session.open_tileset(options.mission, progress.callback());
    } else {
      session.open_file(options.mission, progress.callback());
    }
    if (!options.volume.empty()) session.show_volume(options.volume, progress.callback());
    if (!options.flight.plan_file.empty()) show_flight(session, options, progress.callback());
  }
  const InterruptGuard guard;
  print(server.address() + "\n");
  if (!options.common.quiet) note("Open this address in a browser; Ctrl-C ends it");
  if (!options.no_browser) open_browser(server.address());
  server.run(std::move(session), std::move(page), options.common.threads, [] { return noted_signal() != 0; });
  return kSuccess;
}

}  // namespace

void add_view(CLI::App& app, Command& chosen) {
  CLI::App* command =
      app.add_subcommand("view", "Show a mission in the browser, where the volume follows what is dragged");
  auto options = std::make_shared<ViewArguments>();
  command->add_option("mission", options->mission, "The mission file, or a tileset.json of 3D Tiles alone")
      ->required()
      ->option_text("MISSION");
  command->add_option("--volume", options->volume, "Show this volume of the mission at first, instead of computing it")
      ->option_text("FILE");
  CLI::Option* flight =
      command
          ->add_option("--flight", options->flight.plan_file,
                       "Fly this plan in the scene: .plan, .waypoints, .kml, .kmz, .gpx, .geojson, .csv")
          ->option_text("PLAN");
  add_options_of_plan(*command, options->flight, *flight);
  command->add_option("--speed", options->speed_m_s, "Of legs for which the plan states none, metres per second")
      ->option_text("M/S")
      ->needs(flight);
  command->add_option("--port", options->port, "Port of 127.0.0.1 (default: one that is free)")->option_text("N");
  command->add_flag("--no-browser", options->no_browser, "Do not open a browser, only print the address");
  command->add_option("--page", options->page, "The page, where it is not installed: web/dist/index.html of 'make web'")
      ->option_text("FILE");
  finish(*command, options, kViewExamples, chosen, run_view);
}

}  // namespace vantage::cli
