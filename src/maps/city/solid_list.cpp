#include "maps/city/solid_list.h"

#include <algorithm>
#include <limits>
#include <string>

#include "core/format.h"
#include "core/parallel.h"
#include "core/progress_reporter.h"
#include "core/solid_check.h"
#include "maps/city/building_solid.h"
#include "maps/city/grid_rings.h"
#include "maps/city/interruption.h"
#include "vantage/error.h"

namespace vantage::internal::city {
namespace {

constexpr std::size_t kGrain = 64;
constexpr double kLeastRise = 10;     // metres of ground under a stand-in that it is not cut for
constexpr double kLeastPiece = 30;    // metres across: no smaller stand-in is cut,
constexpr double kLeastWall = 15;     // no smaller wall,
constexpr double kMostPieces = 50;    // nor one that is so often smaller than the whole
constexpr double kCutOverlap = 0.05;  // metres: what is too narrow to be a piece of its own is in the next one

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

/// A shape and the z that its heights count from.
struct Standing {
  Shape shape;
  double ground_m = 0;
};

/// Halves a footprint until the ground under each piece rises by no more than `rise_m`, so that none is high over a
/// valley.
void cut(const Footprint& footprint, const Ground& ground, double rise_m, double least_m,
         std::vector<Footprint>& pieces) {
  const auto range = ground.range({footprint});
  PlanBounds bounds;
  bounds.extend(footprint);
  Eigen::Index axis = 0;
  const double across = (bounds.max - bounds.min).maxCoeff(&axis);
  if (range.highest - range.lowest <= rise_m || across <= least_m) {
    pieces.push_back(footprint);
    return;
  }
  // Not where a needle would be cut off that is too narrow to be a piece of its own.
  for (const double share : {0.5, 0.45, 0.55, 0.4, 0.6}) {
    const double middle = bounds.min[axis] + share * across;
    PlanBounds lower = bounds, upper = bounds;
    lower.max[axis] = middle + kCutOverlap;
    upper.min[axis] = middle - kCutOverlap;
    std::vector<Footprint> parts;
    std::size_t slivers = 0;
    for (const auto& [min, max] : {lower, upper}) {
      const Footprint half{{min, {max.x(), min.y()}, max, {min.x(), max.y()}}, {}};
      const std::vector<Footprint> own = intersect({footprint}, {half}, &slivers);
      parts.insert(parts.end(), own.begin(), own.end());
    }
    if (slivers > 0) continue;
    for (const Footprint& part : parts) cut(part, ground, rise_m, least_m, pieces);
    return;
  }
  pieces.push_back(footprint);
}

/// What stands in, or a wall, hides all that may stand on any ground under it: from the lowest, or from `lowest` where
/// that is lower, to its height above the highest.
std::vector<Standing> raised(const Shape& shape, const Ground& ground, double lowest, bool is_wall) {
  std::vector<Footprint> pieces;
  PlanBounds bounds;
  bounds.extend(shape.footprint);
  const double least = std::max(is_wall ? kLeastWall : kLeastPiece, (bounds.max - bounds.min).maxCoeff() / kMostPieces);
  const bool is_flat = shape.form.roof == RoofShape::flat;
  const double rise =
      is_flat ? std::max(is_wall ? 0 : kLeastRise, shape.form.top_m) : std::numeric_limits<double>::infinity();
  cut(shape.footprint, ground, rise, least, pieces);
  std::vector<Standing> all;
  for (Footprint& piece : pieces) {
    const auto range = ground.range({piece});
    Standing& one = all.emplace_back(Standing{shape, std::min(range.lowest, lowest)});
    const double rises = range.highest - one.ground_m;
    one.shape.footprint = std::move(piece);
    one.shape.form.top_m += rises;
    one.shape.form.is_box |= !is_flat && rises > 0;
    if (shape.form.deck_m > 0) one.shape.form.deck_m += rises;
  }
  return all;
}

/// A mesh for each shape, or for each piece of one. Fills the record's ground and area, and the faults.
std::vector<Mesh> build(Item& item, const Ground& ground) {
  const std::vector<Footprint> footprints = footprints_of(item);
  double together = 0;
  if (item.stand != Item::Stand::each) {
    const auto range = ground.range(item.standing.empty() ? footprints : item.standing);
    together = item.stand == Item::Stand::above ? range.highest : range.lowest;
  }
  item.record.ground_m = ground_under(item, item.shapes.front(), ground, together);
  item.record.footprint_m2 = area_m2(footprints);
  std::vector<Standing> all;
  const bool is_wall = item.record.object.kind == ObjectKind::wall;
  for (const Shape& shape : item.shapes) {
    if (shape.tree || (!is_wall && item.record.object.kind != ObjectKind::stand_in)) {
      all.push_back({shape, ground_under(item, shape, ground, together)});
      continue;
    }
    const double lowest = item.standing.empty() ? std::numeric_limits<double>::infinity() : together;
    const std::vector<Standing> pieces = raised(shape, ground, lowest, is_wall);
    all.insert(all.end(), pieces.begin(), pieces.end());
  }
  std::vector<Mesh> pieces;
  bool is_raised = false;
  for (const Standing& one : all) {
    is_raised |= !is_wall && one.shape.form.top_m > item.shapes.front().form.top_m;
    CitySolid solid = make_solid(one.shape, one.ground_m);
    const bool is_told = !item.faults.empty() && item.faults.back().reason == solid.repair;  // of the piece before
    if (!solid.repair.empty() && !is_told) item.faults.push_back({solid.repair, "a flat roof as high as its top"});
    pieces.push_back(std::move(solid.mesh));
  }
  if (is_raised) {
    const std::string which = all.size() > 1 ? core::format("in {} pieces, each ", all.size()) : "";
    item.faults.push_back({"", which + "up to its height above the highest ground under it"});
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

/// The hull of each outline, as high as its top.
void take_hulls(std::vector<Shape>& shapes) {
  for (Shape& shape : shapes) {
    if (shape.footprint.outer.empty()) continue;
    const Grid grid(shape.footprint);
    shape.footprint = {grid.to_metres(hull_of(grid.to_grid(shape.footprint.outer))), {}};
    shape.form.is_box |= shape.form.roof != RoofShape::flat;
  }
}

/// Hulls stand in for what cannot be built; nothing where they cannot either: one object out of line must not cost all
/// the others.
Mesh solid_of(Item& item, const Ground& ground, const core::ProgressReporter& progress) {
  std::string wrong;
  for (const bool as_hulls : {false, true}) {
    try {
      if (as_hulls) take_hulls(item.shapes);
      std::vector<Mesh> pieces = build(item, ground);
      check(item, pieces, ground, progress);
      if (as_hulls) item.faults.push_back({wrong, "the hull of its outline"});
      return joined(pieces, item.record);
    } catch (const Error& error) {
      if (error.kind() == ErrorKind::cancelled) throw;
      if (!as_hulls) wrong = error.problem();
    }
  }
  item.faults.push_back({wrong, ""});
  constexpr double kUnknown = std::numeric_limits<double>::infinity();
  const PlanBounds place = bounds_of(item.shapes);
  item.entry.box = Box{{place.min.x(), place.min.y(), -kUnknown}, {place.max.x(), place.max.y(), kUnknown}};
  return {};
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
