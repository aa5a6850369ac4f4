#include "cli/scene_report.h"

#include <algorithm>
#include <cctype>
#include <map>
#include <utility>
#include <vector>

#include "cli/text_table.h"
#include "common/json.h"
#include "common/ledger.h"

namespace vantage::cli {
namespace {

std::map<std::string, std::pair<std::size_t, std::string>> remarks(const CityReport& report) {
  std::map<std::string, std::pair<std::size_t, std::string>> found;
  for (const CityRecord& record : report.records) {
    for (const CityRemark& remark : record.remarks) {
      auto& [number, first] = found[remark.sort];
      if (number++ == 0) first = record.object.source_id + ", " + remark.text;
    }
  }
  return found;
}

void add_city(TextTable& table, const CityReport& report) {
  table.row("read", duration(report.read_seconds), "built and checked in " + duration(report.build_seconds));
  const auto& [west, south, east, north] = report.bounds_deg;
  table.row("the map holds", "latitude " + fixed(south, 5) + " to " + fixed(north, 5), "");
  table.row("", "longitude " + fixed(west, 5) + " to " + fixed(east, 5), west > east ? "across the antimeridian" : "");
  table.heading("what is built");
  std::map<std::string, std::size_t> passed_over;
  for (const auto& [kind, number] : kinds_of(report)) table.row(kind, count(number), "");
  for (const CityPassedOver& one : report.passed_over) ++passed_over[one.reason];
  for (const auto& [reason, number] : passed_over) table.row("passed over", count(number), reason);
  if (report.outside > 0) table.row("outside the area", count(report.outside), "left out");
  const auto said = remarks(report);
  if (!said.empty()) table.heading("tags that are not as they should be");
  for (const auto& [kind, found] : said) table.row("", count(found.first), found.second);
}

void add_raster(TextTable& table, const RasterReport& report) {
  table.row("posts", count(report.columns * report.rows), count(report.columns) + " x " + count(report.rows));
  table.row("voids", count(report.voids), "posts without a height");
  table.row("heights", fixed(report.lowest_m, 2) + " to " + fixed(report.highest_m, 2), "metres");
  table.row("error", fixed(report.largest_error_m, 3), "metres, vertical, at most, measured at every post");
}

void add_tileset(TextTable& table, const TilesetReport& report) {
  table.row("files read", count(report.contents),
            count(report.documents) + " documents, " + count(report.bytes) + " bytes");
  table.row("tiles within", count(report.tiles), "of all levels that were looked at");
  table.row("missing files", count(report.holes), report.holes > 0 ? "what they hold is not in the scene" : "");
  table.row("largest error", fixed(report.largest_error_m, 3),
            "metres, geometric, of the coarsest tile that was taken");
}

}  // namespace

void add_source(TextTable& table, const LoadedScene& loaded) {
  if (loaded.city) add_city(table, *loaded.city);
  if (loaded.raster) add_raster(table, *loaded.raster);
  if (loaded.tileset) add_tileset(table, *loaded.tileset);
}

void add_ledger(TextTable& table, const Scene& scene) {
  if (scene.ledger.empty()) return;
  table.heading("what is not built as the file has it (" + count(scene.ledger.size()) + ")");
  for (const LedgerEntry& entry : scene.ledger) table.heading("  " + ledger_text(entry));
}

std::string scene_table(const LoadedScene& loaded, const std::filesystem::path& file,
                        const std::vector<WrittenScene>& written) {
  TextTable table;
  table.heading(file.string());
  if (const auto& place = loaded.scene.georeference) {
    const std::string origin = fixed(place->latitude_deg, 6) + ", " + fixed(place->longitude_deg, 6);
    table.row("origin", origin, "latitude, longitude; x east, y north, metres");
    if (!place->vertical.empty()) table.row("z from", place->vertical, "");
  }
  table.row("triangles", count(loaded.scene.mesh.triangles.size()), count(loaded.scene.objects.size()) + " objects");
  const Box box = bounding_box(loaded.scene.mesh);
  table.row("from", vector(box.min), "metres");
  table.row("to", vector(box.max), "");
  add_source(table, loaded);
  const auto is_moved = [](const WrittenScene& one) { return one.rounding_m > 0; };
  if (std::any_of(written.begin(), written.end(), is_moved)) table.heading("moved by single precision");
  for (const WrittenScene& one : written) {
    if (!is_moved(one)) continue;
    table.row("by up to", fixed(one.rounding_m * 1e6, 3), "micrometres in " + one.file + ": the hash is another one");
  }
  add_ledger(table, loaded.scene);
  const std::vector<std::string> notes = notes_of(loaded);
  if (!notes.empty()) table.heading("notes");
  for (const std::string& note : notes) table.heading("  " + note);
  return table.text();
}

}  // namespace vantage::cli
