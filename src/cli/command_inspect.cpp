#include <algorithm>
#include <memory>
#include <optional>
#include <string_view>
#include <utility>

#include "cli/command.h"
#include "cli/progress_line.h"
#include "cli/scene_options.h"
#include "cli/scene_report.h"
#include "cli/text_table.h"
#include "common/input.h"
#include "common/json.h"
#include "common/objects.h"
#include "common/shown_address.h"
#include "vantage/city.h"
#include "vantage/error.h"
#include "vantage/scene.h"

namespace vantage::cli {
namespace {

constexpr const char* kInspectExamples =
    "EXAMPLES\n"
    "  vantage inspect city.obj --up y\n"
    "  vantage inspect scan.ply.gz --scale 0.001     # a file in millimetres\n"
    "  vantage inspect city.glb --json | jq .open_edges\n"
    "  vantage inspect delft.city.json --lod 2.2     # CityJSON: its coordinate system is known\n"
    "  vantage inspect map.obj --crs EPSG:28992      # a file whose x and y are map coordinates\n"
    "  vantage inspect city.osm.pbf                  # what a scene of it would hold, and what became of each object\n"
    "  vantage inspect city.osm.pbf --areas amenity=parking --areas access=customers\n"
    "  vantage inspect city.osm.pbf --areas leisure=* --json > areas.geojson\n"
    "  vantage inspect city.osm.pbf --objects \"empire state\"   # its id, height, and what a mission writes for it\n"
    "  vantage inspect city.obj --objects \"tower*\"\n"
    "  vantage inspect dsm.tif                       # heights and their place\n"
    "  vantage inspect tokyo/tileset.json --center 35.67,139.76 --radius 400     # 3D Tiles\n";

struct InspectArguments {
  CommonOptions common;
  SceneOptions scene;
  std::vector<std::string> areas;
  std::optional<std::string> objects;
  bool named = false, json = false;
};

void add_place(TextTable& table, const Georeference& place) {
  table.heading("where it lies: metres east, north and up of this origin (WGS 84)");
  table.row("latitude", fixed(place.latitude_deg, 7), "degrees");
  table.row("longitude", fixed(place.longitude_deg, 7), "degrees");
  if (!place.vertical.empty()) table.row("z from", "", place.vertical);
  table.row("made from", "", place.source_crs.empty() ? "unknown coordinate system" : place.source_crs);
}

std::string table_text(const LoadedScene& loaded, const SceneStatistics& found) {
  const Scene& scene = loaded.scene;
  const Vec3 size = found.bounds.max - found.bounds.min;
  TextTable table;
  table.heading(scene.source.string());
  table.row("triangles", count(found.triangles), "as read");
  table.row("vertices", count(found.vertices), "as read");
  table.row("objects", count(found.objects), "names that facets of a volume can carry");
  table.row("from", vector(found.bounds.min), "metres, z up");
  table.row("to", vector(found.bounds.max), "");
  // Cities are wide and flat: one much higher than wide is most often a file with y up.
  const bool is_upright = size.z() <= 2 * std::min(size.x(), size.y()) || loaded.city || loaded.raster ||
                          loaded.tileset || scene.states_axes;
  table.row("size", vector(size), is_upright || scene.up == UpAxis::y ? "" : "is z up? --up y for a file with y up");
  if (scene.georeference) add_place(table, *scene.georeference);
  if (loaded.city || loaded.raster || loaded.tileset) table.heading("what the file holds");
  add_source(table, loaded);
  table.heading("what was mended");
  table.row("positions", count(found.welded_vertices), "vertices left after joining equal ones");
  table.row("faces without area", count(found.degenerate_triangles + scene.dropped_faces),
            "dropped: they hide nothing");
  table.row("doubled triangles", count(found.duplicate_triangles), "dropped: the same three corners again");
  table.heading("what was noticed");
  table.row("open edges", count(found.open_edges), "fine: blockers are built per polygon, not per solid");
  table.row("non-manifold edges", count(found.nonmanifold_edges), "fine: more than two triangles meet there");
  table.row("mis-oriented edges", count(found.misoriented_edges), "fine: both sides of a triangle are opaque");
  for (const std::string& note : notes_of(loaded)) table.heading("  " + note);
  add_ledger(table, scene);
  table.heading("what the engine works on");
  table.row("convex polygons", count(found.polygons), "after merging coplanar neighbours");
  return table.text();
}

std::string areas_table(const std::vector<MapArea>& areas) {
  std::string text = "osm                       m2  name\n";
  for (const MapArea& area : areas) {
    const std::string size = fixed(area.area_m2, 0);
    text += area.source_id + std::string(area.source_id.size() < 18 ? 18 - area.source_id.size() : 0, ' ');
    text += std::string(size.size() < 10 ? 10 - size.size() : 0, ' ') + size + "  " + printable(area.name) + "\n";
  }
  return text;
}

int list_areas(const InspectArguments& options, const SceneSource& source) {
  const char* const option = options.areas.empty() ? "--named" : "--areas";
  if (source.kind != SceneSource::Kind::map) {
    throw Error(ErrorCode::not_applicable,
                std::string(option) + " is for maps, and " + shown_address(options.scene.input).string() + " is none",
                std::string("command line, ") + option, "leave it out, or give an OpenStreetMap file");
  }
  AreaFilter filter{{}, options.named, source.city.region};
  for (const std::string& tag : options.areas) filter.tags.push_back(area_tag(tag, "command line, --areas"));
  ProgressLine progress(options.common);
  const std::vector<MapArea> areas = read_areas(source.file, filter, progress.callback());
  print(options.json ? json_text(areas) : areas_table(areas));
  return kSuccess;
}

/// Names come last: they may have any length.
std::string objects_table(const std::vector<ListedObject>& objects) {
  const auto right = [](const std::string& text, std::size_t width) {
    return std::string(text.size() < width ? width - text.size() : 0, ' ') + text;
  };
  std::size_t longest = std::string_view("what a mission writes").size();
  for (const ListedObject& one : objects) longest = std::max(longest, std::min<std::size_t>(one.mission.size(), 48));
  const auto left = [](const std::string& text, std::size_t width) {
    return text + std::string(text.size() < width ? width - text.size() : 0, ' ');
  };
  std::string text = left("kind", 15) + "  height m         m2  " + left("what a mission writes", longest) + "  name\n";
  for (const ListedObject& one : objects) {
    const std::string area = one.footprint_m2 ? fixed(*one.footprint_m2, 0) : "-";
    text += left(name_of(one.object.kind), 15) + right(fixed(one.height_m, 1), 10) + right(area, 11) + "  " +
            left(one.mission, longest) + "  " + display_name(one.object) + "\n";
  }
  return text;
}

int list_objects_of(const InspectArguments& options, const SceneSource& source) {
  if (!options.areas.empty() || options.named) {
    throw Error(ErrorCode::conflicting_keys,
                "--objects and " + std::string(options.named ? "--named" : "--areas") + " cannot be combined",
                "command line, --objects", "give one of the two");
  }
  ProgressLine progress(options.common);
  const LoadedScene loaded = load_scene(source, progress.callback());
  const std::vector<ListedObject> objects = list_objects(loaded, *options.objects);
  print(options.json ? json_text(objects) : objects_table(objects));
  return kSuccess;
}

/// "--objects city.osm": the option takes the scene as its text.
void settle_scene(InspectArguments& options) {
  if (!options.scene.input.empty()) return;
  if (!options.objects || options.objects->empty()) throw CLI::RequiredError("scene");
  options.scene.input = std::exchange(*options.objects, "");
}

int run_inspect(const InspectArguments& options) {
  const SceneSource source = scene_source(options.scene, "the scene file");
  if (options.objects) return list_objects_of(options, source);
  if (!options.areas.empty() || options.named) return list_areas(options, source);
  ProgressLine progress(options.common);
  const LoadedScene loaded = load_scene(source, progress.callback());
  const PreparedScene prepared(loaded.scene, progress.callback());
  print(options.json ? json_text(loaded, prepared.statistics()) : table_text(loaded, prepared.statistics()));
  return kSuccess;
}

}  // namespace

void add_inspect(CLI::App& app, Command& chosen) {
  CLI::App* command =
      app.add_subcommand("inspect", "Show what a mesh, a map or a height raster contains, and what is wrong with it");
  auto options = std::make_shared<InspectArguments>();
  command
      ->add_option(
          "scene", options->scene.input,
          "OBJ, PLY, STL, glTF, GLB or CityJSON, also compressed with gzip; OpenStreetMap; a raster of heights")
      ->option_text("FILE (required)");
  add_scene_options(*command, options->scene);
  command
      ->add_option("--areas", options->areas,
                   "List the areas of a map that have this tag, such as amenity=parking or leisure=*, and no scene; "
                   "several: all of them")
      ->allow_extra_args(false)
      ->option_text("KEY=VALUE");
  command
      ->add_option("--objects", options->objects,
                   "List the objects of the scene whose name or id contains this text, or fits it where it has * or "
                   "?: kind, height, area, and what a mission writes for them. Without a text: all of them. With one, "
                   "the scene stands before it")
      ->expected(0, 1)
      ->option_text("PATTERN");
  command->add_flag("--named", options->named, "List only areas with a name");
  command->add_flag("--json", options->json, "Print JSON instead of a table; of areas GeoJSON");
  add_common_options(*command, options->common);
  command->footer(kInspectExamples + exit_code_table());
  command->callback([options, &chosen] {
    settle_scene(*options);
    chosen = [options] { return with_threads(options->common, [&] { return run_inspect(*options); }); };
  });
}

}  // namespace vantage::cli
