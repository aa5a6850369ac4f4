#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <memory>

#include "cli/command.h"
#include "cli/page_file.h"
#include "cli/progress_line.h"
#include "live/page_server.h"
#include "live/session.h"
#include "vantage/error.h"
#include "vantage/input.h"

namespace vantage::cli {
namespace {

constexpr const char* kViewExamples =
    "EXAMPLES\n"
    "  vantage view mission.yaml\n"
    "  vantage view mission.yaml --volume volume.ply    # one that is there already; what is dragged is computed\n"
    "  vantage view mission.yaml --port 8090 --no-browser\n"
    "  ssh -L 8090:127.0.0.1:8090 host vantage view mission.yaml --port 8090 --no-browser\n"
    "\n"
    "The page is served on 127.0.0.1 alone, to whoever has the token in the address; Ctrl-C ends it, with exit code "
    "0.\n"
    "It reads the files that the mission names, and no others, and writes none: docs/view.md.\n";

struct ViewArguments {
  CommonOptions common;
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

int run_view(const ViewArguments& options) {
  if (options.mission == "-") {
    throw Error(ErrorCode::stdin_not_possible, "the mission must be a file: names in it start from its folder",
                "command line", "write it to a file first");
  }
  std::string page = read_page("index.html", options.page);
  live::PageServer server(options.port);
  live::Session session;
  {
    ProgressLine progress(options.common);
    session.open_file(options.mission, progress.callback());
    if (!options.volume.empty()) session.show_volume(options.volume, progress.callback());
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
  command->add_option("mission", options->mission, "The mission file")->required()->option_text("MISSION");
  command->add_option("--volume", options->volume, "Show this volume of the mission at first, instead of computing it")
      ->option_text("FILE");
  command->add_option("--port", options->port, "Port of 127.0.0.1 (default: one that is free)")->option_text("N");
  command->add_flag("--no-browser", options->no_browser, "Do not open a browser, only print the address");
  command->add_option("--page", options->page, "The page, where it is not installed: web/dist/index.html of 'make web'")
      ->option_text("FILE");
  finish(*command, options, kViewExamples, chosen, run_view);
}

}  // namespace vantage::cli
