// The ground of a scene from a raster of heights, and what is said of it.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "geo/local_frame.h"
#include "maps/terrain/height_grid.h"
#include "scene/triangulated_terrain.h"
#include "vantage/progress.h"
#include "vantage/scene.h"

namespace vantage::internal::terrain {

struct RasterGround {
  scene::TriangulatedTerrain surface;
  Mesh beneath;                     ///< in voids, where the ground may lie lower; mostly empty
  std::vector<LedgerEntry> ledger;  ///< the voids; without stand-ins
  std::string vertical;  ///< what the raster's heights are measured from; "as in dem.tif" where it does not say it
};

/// The triangles over the rectangle [min, max] of the frame, metres. `moved` may change the heights before they become
/// triangles; empty: they stay. Throws as read_height_grid and triangulate do. `notes` gets what was filled and how
/// closely the triangles follow.
RasterGround ground_from_raster(const std::filesystem::path& file, const geo::LocalFrame& frame,
                                const Eigen::Vector2d& min, const Eigen::Vector2d& max, double max_error_m,
                                const HeightReading& reading, const std::function<void(HeightGrid& grid)>& moved,
                                std::vector<std::string>& notes, const Progress& progress);

/// The cells that have a post which may lie lower, each as two triangles along its lower diagonal; of those that lie in
/// the rectangle of the frame.
Mesh lowest_in_voids(const HeightGrid& grid, const std::vector<Eigen::Vector2d>& places, const Eigen::Vector2d& min,
                     const Eigen::Vector2d& max);

/// An entry for each void: `kind` of what it would be a part of.
std::vector<LedgerEntry> void_entries(const HeightGrid& grid, const geo::LocalFrame& frame, ObjectKind kind);

/// Its triangles become those of a new object, the last one. Nothing for a mesh without triangles.
void append_object(Scene& scene, const Mesh& mesh, const SceneObject& object);

/// Adds what voids need: their entries, held by `object` where `missing` says so, and the ground beneath them as
/// another object of its kind. It hides nothing that is not hidden; heights above the ground are measured from both.
void add_voids(Scene& scene, std::uint32_t object, MissingPolicy missing, std::vector<LedgerEntry> entries,
               const Mesh& beneath);

/// What the heights of a grid are measured from; "as in dem.tif" where the file does not say it.
std::string level_of(const HeightGrid& grid);

}  // namespace vantage::internal::terrain
