#include <algorithm>
#include <memory>
#include <optional>

#include "cli/chosen_target.h"
#include "cli/command.h"
#include "cli/picture_options.h"
#include "cli/progress_line.h"
#include "cli/stage_sheet.h"
#include "cli/standard_streams.h"
#include "common/input.h"
#include "common/output.h"
#include "vantage/error.h"
#include "vantage/mission.h"
#include "vantage/picture.h"
#include "vantage/result.h"

namespace vantage::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* kRenderExamples =
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

struct RenderArguments {
  CommonOptions common;
  std::string mission_file, volume_file, stages, output, size, target;
  std::vector<std::string> view;
};

/// The volume of the file, with what people should know of it, and the mission of its target.
Volume volume_of_file(const RenderArguments& options, Mission& mission, const Progress& progress) {
  VolumeFile read = read_volume(options.volume_file, mission.scene(), progress);
  mission = of_volume(std::move(mission), options.target, read);
  if (!options.common.quiet) notes(read.notes);
  read.volume.notes = mission_warnings(mission, &read.volume);
  return std::move(read.volume);
}

Picture picture(const RenderArguments& options, const Mission& mission, const Volume& volume, const PictureView& view,
                std::array<int, 2> size, const Progress& progress) {
  if (!options.common.quiet) {
    if (volume.outcome != Outcome::computed) note("no volume: " + volume.reason);
    notes(volume.notes);
  }
  PictureRequest request;
  request.target = &mission.target;
  request.volume = &volume;
  request.navigation = mission.navigation;
  request.view = view;
  request.width = size[0];
  request.height = size[1];
  request.title = mission.target.name;
  request.subtitle = picture_subtitle(mission, &volume);
  for (const Warning& warning : volume.notes) request.notes.push_back(warning.text);
  return render_picture(mission.scene(), request, progress);
}

/// A picture for each volume of the mission, in files of their own where there are several.
std::vector<fs::path> draw(const RenderArguments& options, Mission mission, const PictureView& view,
                           std::array<int, 2> size, const fs::path& output, const Progress& progress) {
  if (!options.stages.empty()) {
    write_png(stage_sheet(mission, read_stages(options.stages), view, size, progress), output, progress);
    return {output};
  }
  if (!options.volume_file.empty()) {
    const Volume volume = volume_of_file(options, mission, progress);
    write_png(picture(options, mission, volume, view, size, progress), output, progress);
    return {output};
  }
  if (!options.target.empty()) mission = of_target(mission, options.target);
  const std::vector<Result> results = run_missions(mission, {options.common.threads, {}}, progress);
  if (results.size() == 1) {
    write_png(picture(options, mission, results[0].volume, view, size, progress), output, progress);
    return {output};
  }
  std::vector<fs::path> files = volume_files(output, target_names(mission));
  for (const fs::path& one : files) check_derived_output(one);
  for (std::size_t i = 0; i < results.size(); ++i) {
    const Picture drawn = picture(options, one_volume(mission, i), results[i].volume, view, size, progress);
    check_derived_output(files[i]);  // drawing may have taken long
    write_png(drawn, files[i], progress);
  }
  return files;
}

int run_render(const RenderArguments& options) {
  const bool is_sheet = !options.stages.empty();
  const PictureView view = parse_view(options.view);
  const std::array<int, 2> size =
      parse_size(!options.size.empty() ? options.size : (is_sheet ? kPanelSize : kPictureSize));
  if (!is_standard_stream(options.output)) check_picture_file(options.output);
  const MissionFile file = read_mission_argument(options.mission_file);
  std::vector<fs::path> inputs = input_files(file);
  if (!options.volume_file.empty()) {
    inputs.emplace_back(options.volume_file);
    check_readable(options.volume_file, "the volume");  // before the scene, which takes longer
  }
  check_not_an_input(options.output, inputs);
  std::optional<OutgoingFile> outgoing;
  if (is_standard_stream(options.output)) {
    if (file.combine == Combine::each && options.volume_file.empty() && options.target.empty()) {
      throw Error(ErrorCode::not_applicable, "-o - is for one picture, and the mission asks for each target's",
                  "command line, -o", "name the target with --target, or a file");
    }
    outgoing.emplace(".png");
  }
  std::vector<fs::path> files;
  {
    ProgressLine progress(options.common);
    const Progress follow = progress.callback();
    files = draw(options, resolve_mission(file, follow), view, size,
                 outgoing ? outgoing->path() : fs::path(options.output), follow);
  }
  if (outgoing) {
    outgoing->send();
    return kSuccess;
  }
  std::string text;
  for (const fs::path& one : files) text += "wrote " + one.string() + "\n";
  if (!options.common.quiet) print(text);
  return kSuccess;
}

/// "--view top mission.yaml": the second word is not part of the view, and the mission is missing.
void settle_mission(RenderArguments& options) {
  if (options.mission_file.empty() && options.view.size() > 1 && options.view[0] != "from") {
    options.mission_file = options.view.back();
    options.view.pop_back();
  }
  if (options.mission_file.empty()) throw CLI::RequiredError("mission");
}

}  // namespace

void add_render(CLI::App& app, Command& chosen) {
  CLI::App* command = app.add_subcommand("render", "Draw the scene, the target and the volume as a PNG picture");
  auto options = std::make_shared<RenderArguments>();
  command->add_option("mission", options->mission_file, "The mission file; - for standard input")
      ->option_text("MISSION (required)");
  command->add_option("-o,--output", options->output, "Where to write: .png, or - for standard output")
      ->required()
      ->option_text("FILE");
  CLI::Option* volume = command->add_option("--volume", options->volume_file, "The volume; computed if not given");
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
  command->add_option("--target", options->target, kTargetHelp)->option_text("NAME");
  add_common_options(*command, options->common);
  command->footer(kRenderExamples + exit_code_table());
  command->callback([options, &chosen] {
    settle_mission(*options);
    chosen = [options] { return with_threads(options->common, [&] { return run_render(*options); }); };
  });
}

}  // namespace vantage::cli
