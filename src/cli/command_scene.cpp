// vantage scene: a map, CityJSON, a height raster or any mesh -> a scene file with its place on the earth.
#include <array>
#include <charconv>
#include <cmath>
#include <memory>
#include <set>

#include "city/settings.h"
#include "cli/command.h"
#include "cli/output_check.h"
#include "cli/progress_line.h"
#include "cli/scene_report.h"
#include "cli/text_table.h"
#include "mission/input_file.h"
#include "mission/numbers.h"
#include "solid/atomic_file.h"
#include "solid/result_files.h"
#include "solid/scene_writers.h"
#include "vantage/error.h"
#include "vantage/scene_source.h"

namespace vantage::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* kExamples =
    "EXAMPLES\n"
    "  vantage scene city.osm.pbf --center 40.7484,-73.9857 --radius 600 -o scene.glb\n"
    "  vantage scene city.osm.pbf --bbox -73.99,40.74,-73.97,40.76 --terrain N40W074.hgt -o scene.obj\n"
    "  vantage scene city.osm.gz --set level=3.2 --set levels=4 --without trees --without walls -o scene.ply\n"
    "  vantage scene town.city.json --lod 2.2 -o scene.glb\n"
    "  vantage scene dsm.tif --center 51.999,4.37 --radius 200 --error 0.1 -o scene.ply\n"
    "  vantage scene delft.obj --crs EPSG:28992 --origin 52.0116,4.3571 -o scene.obj\n"
    "\n"
    "The scene frame: x east, y north, z up, metres, about the origin: the centre that is asked for, or else that of\n"
    "the file. The place travels in the file. Beside each output of a map goes a report, scene.report.json, that says\n"
    "what became of every object. docs/scene.md has the table of defaults that --set changes.\n";

struct Options {
  CommonOptions common;
  std::string input;
  std::vector<std::string> outputs;
  std::string center, bbox, window, origin;  // as typed
  std::string radius, terrain, error;
  std::string up = "z", scale = "1", lod, crs;
  std::vector<std::string> settings, without;
  bool json = false;
};

[[noreturn]] void fail(const std::string& problem, const std::string& option, const std::string& fix) {
  throw Error(ErrorKind::input, problem, "command line, " + option, fix);
}

template <std::size_t N>
std::array<double, N> numbers(const std::string& text, const std::string& option, const std::string& form) {
  std::array<double, N> values{};
  const char* at = text.data();
  const char* const end = at + text.size();
  for (std::size_t i = 0; i < N; ++i) {
    const auto [stop, error] = std::from_chars(at, end, values[i]);
    const bool is_last = i + 1 == N;
    if (error != std::errc() || (is_last ? stop != end : stop == end || *stop != ',')) {
      fail(mission_io::in_quotes(text).append(" is not ").append(form), option, "write it without spaces: " + form);
    }
    at = stop + 1;
  }
  return values;
}

CityRegion region_of(const Options& options) {
  CityRegion region;
  if (!options.center.empty()) region.center_deg = numbers<2>(options.center, "--center", "latitude,longitude");
  if (!options.bbox.empty()) region.bbox_deg = numbers<4>(options.bbox, "--bbox", "west,south,east,north");
  if (!options.radius.empty()) region.radius_m = positive_option("--radius", options.radius);
  if (region.center_deg && options.radius.empty()) fail("--center without --radius", "--center", "add --radius METRES");
  return region;
}

/// "level=3.2".
void apply(const std::string& setting, CityOptions& options) {
  const std::string where = "--set " + setting;
  const std::size_t sign = setting.find('=');
  if (sign == std::string::npos)
    fail("'" + setting + "' sets nothing", where, "write --set NAME=VALUE, such as level=3.2");
  city::set(options, setting.substr(0, sign), positive_option(where, setting.substr(sign + 1)),
            "command line, " + where);
}

std::array<int, 4> window_of(const std::string& text) {
  std::array<int, 4> window{};
  const std::array<double, 4> values = numbers<4>(text, "--window", "column,row,columns,rows");
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (values[i] != std::floor(values[i]) || std::abs(values[i]) > 1e9) {
      fail("'" + text + "' is not a window", "--window", "give whole numbers: column,row,columns,rows");
    }
    window[i] = static_cast<int>(values[i]);
  }
  return window;
}

SceneSource source_of(const Options& options) {
  SceneSource source;
  source.file = options.input;
  source.kind = source_kind(options.input);
  source.city.region = region_of(options);
  source.city.terrain = options.terrain;
  for (const std::string& setting : options.settings) apply(setting, source.city);
  for (const std::string& kind : options.without) city::leave_out(source.city.occluders, kind, "--without " + kind);
  const CityRegion& region = source.city.region;
  source.raster.region = {region.center_deg, region.radius_m, region.bbox_deg, {}};
  if (!options.window.empty()) source.raster.region.pixels = window_of(options.window);
  if (!options.error.empty()) {
    source.city.terrain_error_m = source.raster.max_error_m = positive_option("--error", options.error);
  }
  source.mesh.up = options.up == "y" ? UpAxis::y : UpAxis::z;
  source.mesh.scale = positive_option("--scale", options.scale);
  source.mesh.lod = options.lod;
  source.mesh.crs = options.crs;
  if (!options.origin.empty()) {
    source.mesh.origin_deg = source.raster.origin_deg = numbers<2>(options.origin, "--origin", "latitude,longitude");
  }
  return source;
}

/// Options that mean nothing for this kind of file are more likely a slip than a wish.
void check_options(const Options& options, SceneSource::Kind kind) {
  using Kind = SceneSource::Kind;
  const auto only_for = [&](bool is_given, const char* option, std::initializer_list<Kind> kinds, const char* what) {
    if (!is_given || std::find(kinds.begin(), kinds.end(), kind) != kinds.end()) return;
    fail(std::string(option) + " is for " + what + ", and " + options.input + " is none", option, "leave it out");
  };
  only_for(!options.center.empty(), "--center", {Kind::map, Kind::raster}, "maps and rasters");
  only_for(!options.bbox.empty(), "--bbox", {Kind::map, Kind::raster}, "maps and rasters");
  only_for(!options.error.empty(), "--error", {Kind::map, Kind::raster}, "terrain and rasters");
  only_for(!options.terrain.empty(), "--terrain", {Kind::map}, "maps");
  only_for(!options.settings.empty(), "--set", {Kind::map}, "maps");
  only_for(!options.without.empty(), "--without", {Kind::map}, "maps");
  only_for(options.up == "y", "--up", {Kind::mesh}, "meshes");
  only_for(options.scale != "1", "--scale", {Kind::mesh}, "meshes");
  only_for(!options.lod.empty(), "--lod", {Kind::mesh}, "CityJSON files");
  only_for(!options.crs.empty(), "--crs", {Kind::mesh}, "meshes");
  only_for(!options.origin.empty(), "--origin", {Kind::mesh, Kind::raster}, "meshes, CityJSON files and rasters");
  only_for(!options.window.empty(), "--window", {Kind::raster}, "rasters");
}

void check_outputs(const Options& options) {
  std::set<fs::path> seen;
  for (const std::string& output : options.outputs) {
    check_volume_output(output);
    check_not_an_input(output, {options.input, options.terrain});
    if (!seen.insert(fs::path(output).lexically_normal()).second) {
      throw Error(ErrorKind::input, "an output is named twice", output, "give each -o a name of its own");
    }
  }
}

int run(const Options& options) {
  mission_io::check_readable(options.input, "the file", "");
  const SceneSource source = source_of(options);
  check_options(options, source.kind);
  check_outputs(options);
  ProgressLine progress(options.common);
  const LoadedScene loaded = load_scene(source, progress.callback());

  std::vector<std::unique_ptr<solid::AtomicFile>> files;
  for (const std::string& output : options.outputs) {
    for (auto& file : solid::stage_scene(loaded.scene, output)) files.push_back(std::move(file));
    if (!loaded.city) continue;
    files.push_back(std::make_unique<solid::AtomicFile>(solid::report_file(output)));
    files.back()->write(scene_json(loaded));
    files.back()->seal();
  }
  stop_if_interrupted();
  solid::commit_all(files);
  if (options.json) {
    print(scene_json(loaded));
  } else if (!options.common.quiet) {
    print(scene_table(loaded, source.file));
  }
  return kSuccess;
}

}  // namespace

void add_scene(CLI::App& app, Command& chosen) {
  CLI::App* command = app.add_subcommand("scene", "Make a scene from a map, CityJSON, a height raster or a mesh");
  auto options = std::make_shared<Options>();
  command
      ->add_option("input", options->input,
                   "OpenStreetMap (.osm, .osm.gz, .osm.bz2, .osm.pbf), CityJSON, a raster of heights (GeoTIFF, .hgt), "
                   "or a mesh")
      ->required()
      ->option_text("FILE");
  command->add_option("-o,--output", options->outputs, "Where to write: .glb, .obj, .ply or .stl; may be repeated")
      ->required()
      ->allow_extra_args(false)
      ->option_text("FILE");
  command->add_option("--center", options->center, "Centre of the area, degrees (WGS 84); with --radius")
      ->option_text("LAT,LON");
  command->add_option("--radius", options->radius, "Of the area; what reaches into it is built, whole")
      ->option_text("METRES");
  command->add_option("--bbox", options->bbox, "The area as a box, degrees")->option_text("W,S,E,N");
  command->add_option("--window", options->window, "Part of a raster, in posts")
      ->option_text("COLUMN,ROW,COLUMNS,ROWS");
  command->add_option("--terrain", options->terrain, "Ground heights: GeoTIFF, .hgt or .hgt.zip (default: a plane)")
      ->option_text("FILE");
  command
      ->add_option(
          "--error", options->error,
          "How far the ground may differ from the raster at its posts, vertically (0.5; of a raster alone 0.25)")
      ->option_text("METRES");
  command->add_option("--set", options->settings, "A default for what the map does not say, see docs/scene.md")
      ->allow_extra_args(false)
      ->option_text("NAME=VALUE");
  command->add_option("--without", options->without, "Leave out walls, towers, bridges or trees")
      ->allow_extra_args(false)
      ->option_text("KIND");
  command->add_option("--lod", options->lod, "Level of detail of CityJSON (default: the highest)")->option_text("LOD");
  command->add_option("--crs", options->crs, "Reference system of a mesh's coordinates, such as EPSG:28992")
      ->option_text("CRS");
  command->add_option("--origin", options->origin, "Origin of the scene frame (default: the middle)")
      ->option_text("LAT,LON");
  command->add_option("--up", options->up, "Axis of a mesh file that points up: y or z (default)")
      ->check(CLI::IsMember({"y", "z"}))
      ->option_text("AXIS");
  command->add_option("--scale", options->scale, "Metres in one unit of a mesh file (default 1)")->option_text("S");
  command->add_flag("--json", options->json, "Print the report instead of a summary");
  finish<Options>(*command, options, kExamples, chosen, run);
}

}  // namespace vantage::cli
