#include "maps/city/solid_list.h"

#include <algorithm>
#include <string>

#include "core/parallel.h"
#include "core/progress_reporter.h"
#include "core/solid_check.h"
#include "maps/city/building_solid.h"
#include "maps/city/interruption.h"
#include "vantage/error.h"

namespace vantage::internal::city {
namespace {

constexpr std::size_t kGrain = 64;

void append(Mesh& mesh, const Mesh& piece) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), piece.vertices.begin(), piece.vertices.end());
  for (const Triangle& t : piece.triangles) mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
}

std::vector<Footprint> footprints_of(const Item& item) {
  std::vector<Footprint> footprints;
  for (const Shape& shape : item.shapes) {
    if (!shape.footprint.outer.empty()) footprints.push_back(shape.footprint);
  }
  return footprints;
}

/// z that a shape's heights count from. `together` is of the whole item.
double ground_under(const Item& item, const Shape& shape, const Ground& ground, double together) {
  if (item.stand != Item::Stand::each) return together;
  return shape.tree ? ground.height(shape.tree->foot) : ground.range({shape.footprint}).lowest;
}

/// A mesh for each shape. Fills the record's ground and area, and the faults.
std::vector<Mesh> build(Item& item, const Ground& ground) {
  const std::vector<Footprint> footprints = footprints_of(item);
  double together = 0;
  if (item.stand != Item::Stand::each) {
    const auto range = ground.range(item.standing.empty() ? footprints : item.standing);
    together = item.stand == Item::Stand::above ? range.highest : range.lowest;
  }
  item.record.ground_m = ground_under(item, item.shapes.front(), ground, together);
  item.record.footprint_m2 = area_m2(footprints);
  std::vector<Mesh> pieces;
  for (const Shape& shape : item.shapes) {
    CitySolid solid = make_solid(shape, ground_under(item, shape, ground, together));
    const bool is_told = !item.faults.empty() && item.faults.back().reason == solid.repair;  // of the piece before
    if (!solid.repair.empty() && !is_told) item.faults.push_back({solid.repair, "a flat roof as high as its top"});
    pieces.push_back(std::move(solid.mesh));
  }
  return pieces;
}

/// What is wrong with the first piece that is not a solid, or nothing.
std::string fault(const std::vector<Mesh>& pieces, const std::string& name, const core::ProgressReporter& progress) {
  for (const Mesh& piece : pieces) {
    try {
      core::checked_solid(piece, name, progress);
    } catch (const Error& error) {
      if (error.kind() == ErrorKind::cancelled) throw;
      return error.problem();
    }
  }
  return {};
}

bool has_roof(const Item& item) {
  return std::any_of(item.shapes.begin(), item.shapes.end(),
                     [](const Shape& shape) { return !shape.tree && shape.form.roof != RoofShape::flat; });
}

void check(Item& item, std::vector<Mesh>& pieces, const Ground& ground, const core::ProgressReporter& progress) {
  const std::string wrong = fault(pieces, item.record.object.source_id, progress);
  if (wrong.empty()) return;
  if (has_roof(item)) {
    Item flat = item;
    for (Shape& shape : flat.shapes) shape.form.is_box = true;
    std::vector<Mesh> simpler = build(flat, ground);
    if (fault(simpler, item.record.object.source_id, progress).empty()) {
      pieces = std::move(simpler);
      item.faults.push_back({"its roof is not a solid", "a flat roof as high as its top"});
      return;
    }
  }
  item.faults.push_back({wrong, "its surface, which is open"});
}

Mesh joined(const std::vector<Mesh>& pieces, CityRecord& record) {
  Mesh mesh;
  for (const Mesh& piece : pieces) append(mesh, piece);
  const Box bounds = bounding_box(mesh);
  record.base_m = bounds.min.z();
  record.top_m = bounds.max.z();
  return mesh;
}

/// Nothing where it cannot be built: one object out of line must not cost all the others.
Mesh solid_of(Item& item, const Ground& ground, const core::ProgressReporter& progress) {
  try {
    std::vector<Mesh> pieces = build(item, ground);
    check(item, pieces, ground, progress);
    return joined(pieces, item.record);
  } catch (const Error& error) {
    if (error.kind() == ErrorKind::cancelled) throw;
    item.faults.push_back({error.problem(), ""});
    return {};
  }
}

}  // namespace

std::vector<Mesh> build_solids(Site& site, const Ground& ground, const Progress& callback) {
  std::vector<Mesh> solids(site.items.size());
  const core::ProgressReporter progress(callback);
  progress.begin("building");
  core::ProgressCounter counter(progress, site.items.size());
  const core::ProgressReporter asking = progress.part(0, 0);  // only whether to go on
  parallel::for_ranges(site.items.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    const Interruption interruption(asking);
    for (std::size_t i = begin; i < end; ++i) {
      solids[i] = solid_of(site.items[i], ground, asking);
    }
    counter.add(end - begin);
  });
  return solids;
}

}  // namespace vantage::internal::city
