#include <memory>
#include <optional>
#include <set>

#include "cli/command.h"
#include "cli/progress_line.h"
#include "cli/text_table.h"
#include "common/output.h"
#include "vantage/devices.h"
#include "vantage/error.h"
#include "vantage/spheres.h"

namespace vantage::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* kSpheresExamples =
    "EXAMPLES\n"
    "  vantage spheres -c config.yaml\n"
    "  vantage spheres -c config.yaml --sphere conservative --device cpu\n"
    "\n"
    "Runs a configuration file of the program published with the paper of Willis et al.: a visibility sphere for each "
    "block\n"
    "visibility_vol, written where its output_file says (.obj in world axes, or another format). Paths start from the\n"
    "configuration file. All files are written, or none. The keys: docs/willis-config.md\n";

struct SpheresArguments {
  CommonOptions common;
  std::string config_file, device = "auto", sphere = "centers";
};

/// Runs `action`; an error about an output is told with the place in the file that names it.
template <typename Action>
auto at_output(const WillisVolume& volume, const Action& action) {
  try {
    return action();
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::input && error.kind() != ErrorKind::output) throw;
    throw error.with_where(volume.output_where + ", " + error.where());
  }
}

/// All that can be known to go wrong with the outputs before anything is computed.
void check_spheres_outputs(const WillisConfig& config) {
  std::vector<fs::path> inputs = {config.file};
  for (const WillisMesh& mesh : config.meshes) inputs.push_back(mesh.file);
  std::set<fs::path> seen;
  for (const WillisVolume& volume : config.volumes) {
    at_output(volume, [&] {
      check_volume_output(volume.output);
      check_volume_place({volume.output}, std::nullopt, std::nullopt);  // such a configuration has no place
      check_not_an_input(volume.output, inputs);
      if (seen.insert(fs::weakly_canonical(volume.output)).second) return;
      throw Error(ErrorCode::output_named_twice, "two volumes are written to one file", volume.output.string(),
                  "give each output_file a name of its own");
    });
  }
}

void write(const WillisConfig& config, const std::vector<WillisResult>& results) {
  std::vector<StagedVolume> volumes;
  for (std::size_t i = 0; i < results.size(); ++i) {
    at_output(config.volumes[i], [&] {
      StagedVolume staged = stage_volume(results[i].volume, config.volumes[i].output, config.up, 1.0);
      if (!staged.files.empty()) staged.files.front()->seal();
      volumes.push_back(std::move(staged));
    });
  }
  commit_volumes(std::move(volumes));
}

std::string summary(const WillisConfig& config, const WillisRun& run) {
  const std::vector<WillisResult>& results = run.results;
  TextTable table;
  for (std::size_t i = 0; i < results.size(); ++i) {
    const MeshMeasures& measures = results[i].measures;
    table.heading(config.volumes[i].name);
    table.row("volume", fixed(measures.volume_m3, 1), "cubic metres");
    table.row("facets", count(measures.facets), count(measures.vertices) + " vertices");
    table.row("time", duration(results[i].seconds), "");
  }
  std::string text = "device: " + run.device.name + (run.device_note.empty() ? "" : " (" + run.device_note + ")") +
                     "\n" + table.text();
  for (const WillisVolume& volume : config.volumes) text += "wrote " + volume.output.string() + "\n";
  return text;
}

int run_spheres(const SpheresArguments& options) {
  SpheresOptions spheres;
  spheres.device = parse_device_choice(options.device);
  spheres.sphere = options.sphere == "centers" ? SpheresOptions::Sphere::centers : SpheresOptions::Sphere::conservative;
  spheres.threads = options.common.threads;
  const WillisConfig config = read_willis_config(options.config_file);
  check_spheres_outputs(config);
  if (!options.common.quiet) {
    for (const std::string& warning : config.warnings) note(warning);
  }
  WillisRun run;
  {
    ProgressLine progress(options.common);
    run = run_willis_config(config, spheres, progress.callback());
    write(config, run.results);
  }
  if (!options.common.quiet) print(summary(config, run));
  return kSuccess;
}

}  // namespace

void add_spheres(CLI::App& app, Command& chosen) {
  CLI::App* command = app.add_subcommand(
      "spheres", "Run a configuration file of the program published with the paper of Willis et al.");
  auto options = std::make_shared<SpheresArguments>();
  command->add_option("-c,--config", options->config_file, "The configuration file")->required()->option_text("FILE");
  command->add_option("--device", options->device, "auto (default), cpu, opengl, gpu, or a number of 'vantage devices'")
      ->option_text("DEVICE");
  command
      ->add_option("--sphere", options->sphere,
                   "centers (default): connect texel centres, like the published program; conservative: an inner bound")
      ->check(CLI::IsMember({"centers", "conservative"}))
      ->option_text("KIND");
  finish<SpheresArguments>(*command, options, kSpheresExamples, chosen, run_spheres);
}

}  // namespace vantage::cli
