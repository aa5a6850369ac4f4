#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "cli/command.h"
#include "cli/progress_line.h"
#include "cli/text_table.h"
#include "mission/input_file.h"
#include "scene/georeference_text.h"
#include "vantage/scene.h"

namespace vantage::cli {
namespace {

constexpr const char* kExamples =
    "EXAMPLES\n"
    "  vantage inspect city.obj --up y\n"
    "  vantage inspect scan.ply.gz --scale 0.001     # a file in millimetres\n"
    "  vantage inspect city.glb --json | jq .open_edges\n"
    "  vantage inspect delft.city.json --lod 2.2     # CityJSON: its coordinate system is known\n"
    "  vantage inspect map.obj --crs EPSG:28992      # a file whose x and y are map coordinates\n";

struct Options {
  CommonOptions common;
  std::string scene_file;
  std::string up = "z";
  std::string scale = "1";
  std::string lod, crs;
  bool json = false;
};

std::string json_text(const Scene& scene, const SceneStatistics& found) {
  const auto vector = [](const Vec3& v) { return nlohmann::ordered_json{v.x(), v.y(), v.z()}; };
  nlohmann::ordered_json json;
  json["file"] = scene.source.string();
  json["triangles"] = found.triangles;
  json["vertices"] = found.vertices;
  json["objects"] = found.objects;
  json["dropped_faces"] = scene.dropped_faces;
  json["welded_vertices"] = found.welded_vertices;
  json["degenerate_triangles"] = found.degenerate_triangles;
  json["duplicate_triangles"] = found.duplicate_triangles;
  json["open_edges"] = found.open_edges;
  json["nonmanifold_edges"] = found.nonmanifold_edges;
  json["misoriented_edges"] = found.misoriented_edges;
  json["polygons"] = found.polygons;
  json["bounds"] = {{"min", vector(found.bounds.min)}, {"max", vector(found.bounds.max)}};
  if (scene.georeference) json["georeference"] = scene::georeference_json(*scene.georeference);
  json["notes"] = scene.notes;
  // A name is bytes from a file, and JSON takes UTF-8 only: others are replaced rather than refused.
  return json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

void add_place(TextTable& table, const Georeference& place) {
  table.heading("where it lies: metres east, north and up of this origin (WGS 84)");
  table.row("latitude", fixed(place.latitude_deg, 7), "degrees");
  table.row("longitude", fixed(place.longitude_deg, 7), "degrees");
  if (!place.vertical.empty()) table.row("z from", "", place.vertical);
  table.row("made from", "", place.source_crs.empty() ? "unknown coordinate system" : place.source_crs);
}

std::string table_text(const Scene& scene, const SceneStatistics& found) {
  const Vec3 size = found.bounds.max - found.bounds.min;
  TextTable table;
  table.heading(scene.source.string());
  table.row("triangles", count(found.triangles), "as read");
  table.row("vertices", count(found.vertices), "as read");
  table.row("objects", count(found.objects), "names that facets of a volume can carry");
  table.row("from", vector(found.bounds.min), "metres, z up");
  table.row("to", vector(found.bounds.max), "");
  // Cities are wide and flat: one much higher than wide is most often a file with y up.
  const bool is_upright = size.z() <= 2 * std::min(size.x(), size.y());
  table.row("size", vector(size), is_upright || scene.up == UpAxis::y ? "" : "is z up? --up y for a file with y up");
  if (scene.georeference) add_place(table, *scene.georeference);
  table.heading("what was mended");
  table.row("positions", count(found.welded_vertices), "vertices left after joining equal ones");
  table.row("faces without area", count(found.degenerate_triangles + scene.dropped_faces),
            "dropped: they hide nothing");
  table.row("doubled triangles", count(found.duplicate_triangles), "dropped: the same three corners again");
  table.heading("what was noticed");
  table.row("open edges", count(found.open_edges), "fine: blockers are built per polygon, not per solid");
  table.row("non-manifold edges", count(found.nonmanifold_edges), "fine: more than two triangles meet there");
  table.row("mis-oriented edges", count(found.misoriented_edges), "fine: both sides of a triangle are opaque");
  for (const std::string& note : scene.notes) table.heading("  " + note);
  table.heading("what the engine works on");
  table.row("convex polygons", count(found.polygons), "after merging coplanar neighbours");
  return table.text();
}

int run(const Options& options) {
  SceneReadOptions read_options;
  read_options.up = options.up == "y" ? UpAxis::y : UpAxis::z;
  read_options.scale = positive_option("--scale", options.scale);
  read_options.lod = options.lod;
  read_options.crs = options.crs;
  mission_io::check_readable(options.scene_file, "the scene file", "");
  ProgressLine progress(options.common);
  const Scene scene = read_scene(options.scene_file, read_options, progress.callback());
  const PreparedScene prepared(scene, progress.callback());
  print(options.json ? json_text(scene, prepared.statistics()) : table_text(scene, prepared.statistics()));
  return kSuccess;
}

}  // namespace

void add_inspect(CLI::App& app, Command& chosen) {
  CLI::App* command = app.add_subcommand("inspect", "Show what a mesh file holds, and what is wrong with it");
  auto options = std::make_shared<Options>();
  command->add_option("scene", options->scene_file, "OBJ, PLY, STL, glTF, GLB or CityJSON; may be compressed with gzip")
      ->required()
      ->option_text("FILE");
  command->add_option("--up", options->up, "Axis of the file that points up: y or z (default); glTF is always y up")
      ->check(CLI::IsMember({"y", "z"}))
      ->option_text("AXIS");
  command->add_option("--scale", options->scale, "Metres in one unit of the file (default 1)")->option_text("S");
  command->add_option("--lod", options->lod, "Of CityJSON: the level of detail to take, as 2.2; default: the highest")
      ->option_text("LOD");
  command->add_option("--crs", options->crs, "Coordinate system of x and y, as EPSG:28992; CityJSON files say it")
      ->option_text("CRS");
  command->add_flag("--json", options->json, "Print JSON instead of a table");
  finish<Options>(*command, options, kExamples, chosen, run);
}

}  // namespace vantage::cli
