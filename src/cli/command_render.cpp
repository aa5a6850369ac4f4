#include <algorithm>
#include <memory>
#include <optional>

#include "app/caveats.h"
#include "app/input_file.h"
#include "app/numbers.h"
#include "app/run_mission.h"
#include "cli/command.h"
#include "cli/output_check.h"
#include "cli/picture_options.h"
#include "cli/progress_line.h"
#include "cli/stage_sheet.h"
#include "cli/standard_streams.h"
#include "vantage/error.h"
#include "vantage/picture.h"

namespace vantage::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* kExamples =
    "EXAMPLES\n"
    "  vantage render mission.yaml -o picture.png\n"
    "  vantage render mission.yaml --volume volume.ply -o plan.png --view top\n"
    "  vantage render mission.yaml --volume volume.ply -o picture.png --view oblique 330,35 --size 2400x1600\n"
    "  vantage render mission.yaml --volume volume.ply -o picture.png --view from -120,-80,60\n"
    "  vantage render mission.yaml --stages stages/ -o sheet.png\n"
    "\n"
    "Colours tell why the volume ends there; a volume without causes has one colour. --stages makes a sheet of what\n"
    "\"vantage compute --method spheres --stages FOLDER\" wrote. Needs OpenGL 4.5, but no graphics processor and no\n"
    "display: libegl1 and libgl1-mesa-dri (Debian) do.\n";

constexpr const char* kPictureSize = "1600x1200";
constexpr const char* kPanelSize = "640x480";

struct Options {
  CommonOptions common;
  std::string mission_file, volume_file, stages, output, size;
  std::vector<std::string> view;
};

void check_output(const std::string& output) {
  if (is_standard_stream(output)) return;
  std::error_code error;
  if (format_extension(output) != ".png" && !fs::is_directory(output, error)) {
    throw Error(ErrorKind::input, "pictures are written as PNG, not as " + app::in_quotes(output), output,
                "give the output a name that ends in .png");
  }
  check_can_write(output);
}

Picture picture(const Options& options, Mission& mission, const PictureView& view, std::array<int, 2> size,
                const Progress& progress) {
  Volume volume;
  Scene scene;
  if (!options.volume_file.empty()) {
    app::check_readable(options.volume_file, "the volume", "");  // before the scene, which takes longer
    LoadedScene loaded = read_mission_scene(mission, progress);
    std::vector<std::string> notes;
    volume = read_volume(options.volume_file, loaded.scene, progress, &notes);
    if (!options.common.quiet) std::for_each(notes.begin(), notes.end(), note);
    volume.notes = app::caveats(mission, loaded, &volume);
    scene = std::move(loaded.scene);
  } else {
    app::MissionRun run = app::run_mission(mission, progress);
    volume = std::move(run.volume);
    scene = std::move(run.loaded.scene);
    if (volume.outcome != Outcome::computed && !options.common.quiet) note("no volume: " + volume.reason);
  }
  if (!options.common.quiet) std::for_each(volume.notes.begin(), volume.notes.end(), note);
  PictureRequest request;
  request.target = &mission.target;
  request.other_parts = mission.other_parts;
  request.volume = &volume;
  request.navigation = mission.navigation;
  request.view = view;
  request.width = size[0];
  request.height = size[1];
  request.title = mission.target.name;
  request.subtitle = picture_subtitle(mission, &volume);
  request.notes = volume.notes;
  return render_picture(scene, request, progress);
}

Picture sheet(const Options& options, Mission& mission, const PictureView& view, std::array<int, 2> size,
              const Progress& progress) {
  const std::vector<StageFile> stages = read_stages(options.stages);
  const Scene scene = read_mission_scene(mission, progress).scene;
  return stage_sheet(mission, scene, stages, view, size, progress);
}

int run(const Options& options) {
  const bool is_sheet = !options.stages.empty();
  const PictureView view = parse_view(options.view);
  const std::array<int, 2> size =
      parse_size(!options.size.empty() ? options.size : (is_sheet ? kPanelSize : kPictureSize));
  check_output(options.output);
  Mission mission = read_mission_argument(options.mission_file);
  mission.exact.threads = options.common.threads;
  std::vector<fs::path> inputs = input_files(mission);
  if (!options.volume_file.empty()) inputs.emplace_back(options.volume_file);
  check_not_an_input(options.output, inputs);
  std::optional<OutgoingFile> outgoing;
  if (is_standard_stream(options.output)) outgoing.emplace(".png");
  {
    ProgressLine progress(options.common);
    const auto draw = is_sheet ? sheet : picture;
    const Progress follow = progress.callback();
    write_png(draw(options, mission, view, size, follow), outgoing ? outgoing->path() : fs::path(options.output),
              follow);
  }
  if (outgoing) {
    outgoing->send();
    return kSuccess;
  }
  if (!options.common.quiet) print("wrote " + options.output + "\n");
  return kSuccess;
}

/// "--view top mission.yaml": the second word is no part of the view, and the mission is missing.
void settle_mission(Options& options) {
  if (options.mission_file.empty() && options.view.size() > 1 && options.view[0] != "from") {
    options.mission_file = options.view.back();
    options.view.pop_back();
  }
  if (options.mission_file.empty()) throw CLI::RequiredError("mission");
}

}  // namespace

void add_render(CLI::App& app, Command& chosen) {
  CLI::App* command = app.add_subcommand("render", "Draw the scene, the target and the volume as a PNG picture");
  auto options = std::make_shared<Options>();
  command->add_option("mission", options->mission_file, "The mission file; - for standard input")
      ->option_text("MISSION (required)");
  command->add_option("-o,--output", options->output, "Where to write: .png, or - for standard output")
      ->required()
      ->option_text("FILE");
  CLI::Option* volume =
      command->add_option("--volume", options->volume_file, "The volume; computed when it is not given");
  volume->option_text("FILE");
  command
      ->add_option("--view", options->view,
                   "top; oblique, with degrees round from the east and above the horizon if wanted (235,45); or from "
                   "and the camera's place, looking at the target's centre")
      ->expected(1, 2)
      ->option_text("top|oblique [A,E]|from X,Y,Z");
  command->add_option("--size", options->size, "Pixels (1600x1200; of a panel with --stages: 640x480)")
      ->option_text("WxH");
  command->add_option("--stages", options->stages, "Draw a sheet of the stages in this folder")
      ->excludes(volume)
      ->option_text("FOLDER");
  add_common_options(*command, options->common);
  command->footer(kExamples + exit_code_table());
  command->callback([options, &chosen] {
    settle_mission(*options);
    chosen = [options] { return with_threads(options->common, [&] { return run(*options); }); };
  });
}

}  // namespace vantage::cli
