// build_city: reads, sorts out what stands where, builds each solid, checks it, and puts the scene together.
#include "vantage/city.h"

#include <algorithm>
#include <utility>

#include "core/format.h"
#include "core/stopwatch.h"
#include "maps/city/assembly.h"
#include "maps/city/ground.h"
#include "maps/city/interruption.h"
#include "maps/city/region.h"
#include "maps/city/site.h"
#include "maps/city/solid_list.h"
#include "maps/city/tile_frame.h"
#include "maps/osm/extract.h"
#include "vantage/error.h"

namespace vantage {
namespace {

/// What of the file does not belong to one building.
std::vector<std::string> notes_on(const internal::osm::Extract& extract) {
  std::vector<std::string> notes;
  std::size_t nodes = 0, members = 0;
  for (const internal::osm::Problem& problem : extract.problems) {
    nodes += problem.kind == internal::osm::Problem::Kind::missing_nodes;
    members += problem.kind == internal::osm::Problem::Kind::missing_members;
  }
  const auto tell = [&](std::size_t count, const char* what, const char* missing) {
    if (count == 0) return;
    notes.push_back(std::to_string(count) + what + (count == 1 ? " refers to " : "s refer to ") + missing +
                    " that are not in the file");
  };
  tell(nodes, " way", "nodes");
  tell(members, " relation", "ways");
  if (!extract.sorted) notes.emplace_back("the file is not sorted by type and id; it was sorted in memory");
  return notes;
}

/// What a file that says itself that it is not complete leaves out has no place: the ledger and a note say so.
void tell_of_remark(const std::string& remark, const std::filesystem::path& file, City& city) {
  if (remark.empty()) return;
  LedgerEntry entry;
  entry.what = "what the file lacks";
  entry.reason = "it says that it is not complete: " + remark;
  city.report.notes.push_back(file.filename().string() + " says that it is not complete: " + remark);
  city.scene.ledger.push_back(std::move(entry));
}

internal::geo::LonLat frame_origin(const CityOptions& options, const internal::osm::Extract& extract) {
  if (!options.frame) return internal::city::frame_origin(options.region, extract);
  return {options.frame->origin_deg[1], options.frame->origin_deg[0]};
}

internal::city::Ground ground_under(const internal::city::Site& site, const CityOptions& options,
                                    const internal::geo::LocalFrame& frame, std::vector<std::string>& notes,
                                    const Progress& progress) {
  using internal::city::Ground;
  using internal::city::Vec2;
  if (options.frame) {
    const auto& [west, south, east, north] = options.frame->ground_m;
    return Ground::plane({west, south}, {east, north});
  }
  const Vec2 margin = Vec2::Constant(options.ground_margin_m);
  const Vec2 min = site.min - margin, max = site.max + margin;
  if (options.terrain.empty()) return Ground::plane(min, max);
  return Ground::from_file(options.terrain, frame, min, max, options.terrain_error_m,
                           {options.terrain_crs, options.terrain_heights, options.missing}, notes, progress);
}

/// The ledger's entry of an item that is object `index` of the scene.
LedgerEntry entry_of(const internal::city::Item& item, const Mesh& solid, std::uint32_t index) {
  LedgerEntry entry = item.entry;
  for (const internal::city::Fault& fault : item.faults) {
    entry.reason.append(entry.reason.empty() || fault.reason.empty() ? "" : "; ").append(fault.reason);
    entry.instead.append(entry.instead.empty() || fault.instead.empty() ? "" : "; ").append(fault.instead);
    entry.may_be_larger |= fault.may_be_larger;
  }
  for (const internal::city::Shape& shape : item.shapes) {
    std::vector<std::array<double, 2>>& ring = entry.outlines.emplace_back();
    for (const internal::city::Vec2& corner : shape.footprint.outer) ring.push_back({corner.x(), corner.y()});
  }
  entry.box = bounding_box(solid);
  entry.stand_in = index;
  entry.instead.append(entry.instead.empty() ? "" : ", ");
  entry.instead.append(internal::core::format("{:.3g} m high", item.record.top_m - item.record.base_m));
  return entry;
}

/// What is not built as the map has it. Solids and items correspond; objects are those that hold triangles.
std::vector<LedgerEntry> ledger_of(const internal::city::Site& site, const std::vector<Mesh>& solids) {
  std::vector<LedgerEntry> ledger;
  std::uint32_t index = 0;
  for (std::size_t i = 0; i < solids.size(); ++i) {
    const internal::city::Item& item = site.items[i];
    if (solids[i].empty()) {
      ledger.push_back(item.entry);
      ledger.back().reason = item.faults.back().reason;
    } else if (!item.faults.empty()) {
      ledger.push_back(entry_of(item, solids[i], index));
    }
    index += solids[i].empty() ? 0 : 1;
  }
  ledger.insert(ledger.end(), site.lost.begin(), site.lost.end());
  return ledger;
}

/// Upright facets from below the lowest ground to the tops of the supports. Beyond the ground it is taken as at its
/// rim.
std::vector<OverheadLine> curtains_under(const std::vector<internal::city::Overhead>& lines,
                                         const internal::city::Ground& ground) {
  std::vector<OverheadLine> curtains;
  const Box box = bounding_box(ground.mesh());
  for (const internal::city::Overhead& line : lines) {
    curtains.push_back({line.object, {}});
    Mesh& mesh = curtains.back().mesh;
    for (std::size_t i = 0; i < line.points.size(); ++i) {
      const internal::city::Vec2& at = line.points[i];
      const internal::city::Vec2 inside = at.cwiseMax(box.min.head<2>()).cwiseMin(box.max.head<2>());
      const auto next = static_cast<std::uint32_t>(mesh.vertices.size() + 2);
      mesh.vertices.emplace_back(at.x(), at.y(), box.min.z());
      mesh.vertices.emplace_back(at.x(), at.y(), ground.height(inside) + line.height_m);
      if (i + 1 == line.points.size()) continue;
      mesh.triangles.push_back({next - 2, next, next + 1});
      mesh.triangles.push_back({next - 2, next + 1, next - 1});
    }
  }
  return curtains;
}

}  // namespace

City build_city(const std::filesystem::path& file, const CityOptions& options, const Progress& progress) {
  const auto region = internal::city::checked_region(options.region);
  if (options.frame) internal::city::check_frame(options);
  City result;

  internal::core::Stopwatch stopwatch;
  const auto read =
      options.frame ? internal::city::with_margin(region, options.frame->reach_m) : internal::city::with_margin(region);
  const internal::osm::Extract extract = internal::osm::read_extract(file, {read, internal::city::wanted}, progress);
  if (!options.partial) internal::city::check_complete(extract, file);
  if (!options.frame) internal::city::check_overlap(options.region, extract, file);
  const internal::geo::LocalFrame frame(frame_origin(options, extract));
  result.report.notes = notes_on(extract);
  result.report.read_seconds = stopwatch.lap();

  // For a part of a map all that was read is looked at, so that nothing depends on the region.
  const internal::osm::RegionFilter filter(options.frame ? std::nullopt : region);
  const internal::core::ProgressReporter reporter(progress);
  reporter.begin("outlines");
  const internal::city::Interruption interruption(reporter);
  internal::city::Site site = internal::city::make_site(extract, filter, frame, options);
  if (options.frame) internal::city::leave_out_beyond(region, frame, site);
  result.report.outside = site.outside.objects;
  result.report.bounds_deg = extract.bounds_deg;
  if (site.items.empty() && !options.frame) {
    internal::city::fail_empty(options.region, extract, site.outside, internal::city::reasons_of(site), file);
  }
  const internal::city::Ground ground = ground_under(site, options, frame, result.report.notes, progress);
  const std::vector<Mesh> solids = internal::city::build_solids(site, ground, progress);
  result.report.build_seconds = stopwatch.lap();

  const internal::geo::LonLat origin = frame.origin();
  result.report.georeference = {origin.latitude_deg, origin.longitude_deg, ground.vertical(), "EPSG:4326",
                                kOpenStreetMapCredit};
  result.scene = internal::city::assemble(site, solids, ground, options.missing);
  const std::vector<LedgerEntry> ledger = ledger_of(site, solids);
  result.scene.ledger.insert(result.scene.ledger.begin(), ledger.begin(), ledger.end());
  result.scene.overhead = curtains_under(site.overhead, ground);
  result.scene.source = file;
  tell_of_remark(extract.remark, file, result);
  result.scene.georeference = result.report.georeference;
  if (options.frame) result.scene.whole = internal::city::bounds_of_whole(*options.frame);
  for (std::size_t i = 0; i < solids.size(); ++i) {
    if (!solids[i].empty()) result.report.records.push_back(std::move(site.items[i].record));
  }
  result.report.passed_over = std::move(site.passed_over);
  return result;
}

}  // namespace vantage
