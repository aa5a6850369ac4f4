#include "maps/terrain/raster_ground.h"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include "core/format.h"
#include "maps/terrain/post_positions.h"
#include "maps/terrain/triangulate.h"

namespace vantage::internal::terrain {
namespace {

/// What a void was filled with; heights are those of the file, in metres. What a height is given for is known.
std::string filling_text(const VoidRegion& region) {
  if (region.others > 0) return "filled as larger ones are";
  switch (region.filled) {
    case VoidRegion::Filled::from_rim:
      return core::format("filled with the highest posts of its rim, up to {:.6g} m: what is in the void may be higher",
                          region.highest_m);
    case VoidRegion::Filled::as_given:
      return core::format("filled with the height that is given for voids, {:.6g} m", region.highest_m);
    case VoidRegion::Filled::from_neighbours:
      break;
  }
  return core::format("filled from its neighbours, {:.6g} to {:.6g} m: what is in the void may be higher",
                      region.lowest_m, region.highest_m);
}

Box box_of(const VoidRegion& region, const HeightGrid& grid, const geo::LocalFrame& frame) {
  const double infinity = std::numeric_limits<double>::infinity();
  Box box;
  for (const double column : {region.first_column - 0.5, region.last_column + 0.5}) {
    for (const double row : {region.first_row - 0.5, region.last_row + 0.5}) {
      const Eigen::Vector2d corner = frame.to_local(grid.position({column, row}));
      box.extend({corner.x(), corner.y(), -infinity});
      box.extend({corner.x(), corner.y(), infinity});
    }
  }
  return box;
}

}  // namespace

std::string level_of(const HeightGrid& grid) {
  return grid.vertical.empty() ? "as in " + grid.file.filename().string() : grid.vertical;
}

std::vector<LedgerEntry> void_entries(const HeightGrid& grid, const geo::LocalFrame& frame, ObjectKind kind) {
  std::vector<LedgerEntry> entries;
  for (const VoidRegion& region : grid.void_regions) {
    LedgerEntry entry;
    entry.object.kind = kind;
    entry.what = "posts without a height";
    entry.reason = core::format(
        "{} of {}{} {} no height", region.posts == 1 ? "a post" : core::format("{} posts", region.posts),
        grid.file.filename().string(), region.others > 0 ? core::format(", in {} voids,", region.others + 1) : "",
        region.posts == 1 ? "has" : "have");
    entry.box = box_of(region, grid, frame);
    entry.instead = filling_text(region);
    entry.may_be_larger = region.filled != VoidRegion::Filled::as_given;
    entries.push_back(std::move(entry));
  }
  return entries;
}

Mesh lowest_in_voids(const HeightGrid& grid, const std::vector<Eigen::Vector2d>& places, const Eigen::Vector2d& min,
                     const Eigen::Vector2d& max) {
  Mesh mesh;
  if (grid.lowest_m.empty()) return mesh;
  const auto columns = static_cast<std::size_t>(grid.columns);
  const bool turned = grid.step.x() * grid.step.y() > 0;  // the rows run north
  const auto is_wanted = [&](const std::array<std::size_t, 4>& cell) {
    const auto is_inside = [&](std::size_t post) {
      return (places[post] - min).minCoeff() >= 0 && (max - places[post]).minCoeff() >= 0;
    };
    return std::any_of(cell.begin(), cell.end(),
                       [&](std::size_t post) { return grid.lowest_m[post] < grid.heights_m[post]; }) &&
           std::all_of(cell.begin(), cell.end(), is_inside);
  };
  for (std::size_t post = 0; post + columns + 1 < places.size(); ++post) {
    if ((post + 1) % columns == 0) continue;
    const std::array<std::size_t, 4> cell = {post, post + columns, post + columns + 1, post + 1};  // in a turn
    if (!is_wanted(cell)) continue;
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const std::size_t corner : cell) {
      mesh.vertices.emplace_back(places[corner].x(), places[corner].y(), grid.lowest_m[corner]);
    }
    const auto& z = grid.lowest_m;
    const std::uint32_t turn = z[cell[0]] + z[cell[2]] <= z[cell[1]] + z[cell[3]] ? 0 : 1;  // of the lower diagonal
    for (const std::uint32_t half : {0U, 2U}) {
      Triangle triangle{};
      for (std::uint32_t i = 0; i < 3; ++i) triangle[i] = first + (turn + half + i) % 4;
      if (turned) std::swap(triangle[1], triangle[2]);
      mesh.triangles.push_back(triangle);
    }
  }
  return mesh;
}

void append_object(Scene& scene, const Mesh& mesh, const SceneObject& object) {
  if (mesh.empty()) return;
  const auto first = static_cast<std::uint32_t>(scene.mesh.vertices.size());
  const auto index = static_cast<std::uint32_t>(scene.objects.size());
  scene.mesh.vertices.insert(scene.mesh.vertices.end(), mesh.vertices.begin(), mesh.vertices.end());
  for (const Triangle& t : mesh.triangles) scene.mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  scene.object_of.resize(scene.mesh.triangles.size(), index);
  scene.objects.push_back(object);
}

void add_voids(Scene& scene, std::uint32_t object, MissingPolicy missing, std::vector<LedgerEntry> entries,
               const Mesh& beneath) {
  for (LedgerEntry& entry : entries) {
    if (missing == MissingPolicy::block) {
      entry.stand_in = object;
    } else {  // nothing holds its place, though the surface is closed
      entry.reason.append("; ").append(entry.instead);
      entry.instead.clear();
    }
    scene.ledger.push_back(std::move(entry));
  }
  const SceneObject& above = scene.objects[object];
  append_object(scene, beneath, {above.name + " beneath voids", "", above.kind});
}

RasterGround ground_from_raster(const std::filesystem::path& file, const geo::LocalFrame& frame,
                                const Eigen::Vector2d& min, const Eigen::Vector2d& max, double max_error_m,
                                const HeightReading& reading, const std::function<void(HeightGrid& grid)>& moved,
                                std::vector<std::string>& notes, const Progress& progress) {
  HeightGrid grid = read_height_grid(file, Window{frame.origin(), min, max}, progress, reading);
  if (moved) moved(grid);
  Triangulation triangulation = triangulate(grid, frame, min, max, max_error_m, progress);
  const std::string name = file.filename().string();
  notes.push_back(core::format("the ground is {} triangles for {} posts of {}, at most {:.2f} m above them",
                               triangulation.surface.mesh().triangles.size(), triangulation.posts, name,
                               triangulation.largest_error_m));
  Mesh beneath;
  if (!grid.lowest_m.empty()) beneath = lowest_in_voids(grid, post_positions(grid, frame), min, max);
  return {std::move(triangulation.surface), std::move(beneath), void_entries(grid, frame, ObjectKind::ground),
          level_of(grid)};
}

}  // namespace vantage::internal::terrain
