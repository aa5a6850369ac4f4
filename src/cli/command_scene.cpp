// vantage scene: a map, CityJSON, a height raster or any mesh -> a scene file with its place on the earth.
#include <memory>
#include <set>

#include "cli/command.h"
#include "cli/progress_line.h"
#include "cli/scene_options.h"
#include "cli/scene_report.h"
#include "common/atomic_file.h"
#include "common/json.h"
#include "common/output.h"
#include "common/shown_address.h"
#include "vantage/error.h"
#include "vantage/result.h"
#include "vantage/scene_source.h"

namespace vantage::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* kSceneExamples =
    "EXAMPLES\n"
    "  vantage scene city.osm.pbf --center 40.7484,-73.9857 --radius 600 -o scene.glb\n"
    "  vantage scene city.osm.pbf --bbox -73.99,40.74,-73.97,40.76 --terrain N40W074.hgt -o scene.obj\n"
    "  vantage scene city.osm.gz --set level=3.2 --set levels=4 --without trees --without walls -o scene.ply\n"
    "  vantage scene town.city.json --lod 2.2 -o scene.glb\n"
    "  vantage scene city.osm.pbf --center \"40.7484, -73.9857\" --radius 600     # writes nothing: what would be "
    "built\n"
    "  vantage scene dsm.tif --center 51.999,4.37 --radius 200 --error 0.1 -o scene.ply\n"
    "  vantage scene tokyo/tileset.json --center 35.67,139.76 --radius 400 --detail 1 -o scene.glb\n"
    "  vantage scene delft.obj --crs EPSG:28992 --origin 52.0116,4.3571 -o scene.obj\n"
    "\n"
    "The scene frame: x east, y north, z up, metres, about the origin: the centre that is asked for, or else that of\n"
    "the file. The place travels in the file. Beside each output of a map goes a report, scene.report.json, that says\n"
    "what became of every object. docs/scene.md has the table of defaults that --set changes.\n";

struct SceneArguments {
  CommonOptions common;
  SceneOptions scene;
  std::vector<std::string> outputs;
  bool json = false;
};

void check_scene_outputs(const SceneArguments& options, SceneSource::Kind kind) {
  std::set<fs::path> seen;
  for (const std::string& output : options.outputs) {
    check_scene_output(output);
    if (kind == SceneSource::Kind::map) check_derived_output(report_file(output));
    check_not_an_input(output, {options.scene.input, options.scene.terrain});
    if (!seen.insert(fs::path(output).lexically_normal()).second) {
      throw Error(ErrorCode::output_named_twice, "an output is named twice", output,
                  "give each output a name of its own");
    }
  }
}

int run_scene(const SceneArguments& options) {
  const SceneSource source = scene_source(options.scene, "the file");
  check_scene_outputs(options, source.kind);
  ProgressLine progress(options.common);
  const LoadedScene loaded = load_scene(source, progress.callback());

  std::vector<std::unique_ptr<AtomicFile>> files;
  std::vector<WrittenScene> written;
  for (const std::string& output : options.outputs) {
    StagedScene staged = stage_scene(loaded.scene, output);
    for (auto& file : staged.files) files.push_back(std::move(file));
    written.push_back({output, staged.rounding_m});
    if (!loaded.city) continue;
    check_derived_output(report_file(output));
    files.push_back(std::make_unique<AtomicFile>(report_file(output)));
    files.back()->write(json_text(loaded));
    files.back()->seal();
  }
  stop_if_interrupted();
  commit_all(files);
  if (options.json) {
    print(json_text(loaded));
  } else if (!options.common.quiet) {
    print(scene_table(loaded, shown_address(source.file), written));
  }
  return kSuccess;
}

}  // namespace

void add_scene(CLI::App& app, Command& chosen) {
  CLI::App* command =
      app.add_subcommand("scene", "Make a scene from a map, CityJSON, 3D Tiles, a height raster or a mesh");
  auto options = std::make_shared<SceneArguments>();
  command
      ->add_option("input", options->scene.input,
                   "OpenStreetMap (.osm, .osm.gz, .osm.bz2, .osm.pbf), CityJSON, a raster of heights (GeoTIFF, .hgt), "
                   "a tileset.json of 3D Tiles, or a mesh")
      ->required()
      ->option_text("FILE");
  command
      ->add_option(
          "-o,--output", options->outputs,
          "Where to write: " + scene_extensions_text() + "; may be repeated. Without it, only the report is printed")
      ->allow_extra_args(false)
      ->option_text("FILE");
  add_scene_options(*command, options->scene);
  command->add_flag("--json", options->json, "Print the report instead of a summary");
  finish<SceneArguments>(*command, options, kSceneExamples, chosen, run_scene);
}

}  // namespace vantage::cli
