// What buildings stand on: a plane at z = 0, or terrain.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "geo/local_frame.h"
#include "maps/city/footprint.h"
#include "maps/terrain/height_grid.h"
#include "scene/triangulated_terrain.h"
#include "vantage/geometry.h"
#include "vantage/progress.h"
#include "vantage/scene.h"

namespace vantage::internal::city {

class Ground {
 public:
  /// A horizontal rectangle at z = 0.
  static Ground plane(const Vec2& min, const Vec2& max);
  /// Throws as terrain::read_height_grid does. `notes` gets what was filled and how closely the triangles follow.
  static Ground from_file(const std::filesystem::path& file, const geo::LocalFrame& frame, const Vec2& min,
                          const Vec2& max, double max_error_m, const terrain::HeightReading& reading,
                          std::vector<std::string>& notes, const Progress& progress);

  /// The range of the ground under some footprints (at least one), z in metres.
  scene::TriangulatedTerrain::Range range(const std::vector<Footprint>& footprints) const;
  double height(const Vec2& at) const;

  const Mesh& mesh() const;             ///< counter-clockwise seen from above
  const std::string& vertical() const;  ///< what z is measured from

  /// To a scene, as its last object, or before what lies beneath its voids.
  void add_to(Scene& scene, MissingPolicy missing) const;

 private:
  Mesh plane_;
  std::optional<scene::TriangulatedTerrain> surface_;
  std::string vertical_;
  Mesh beneath_;
  std::vector<LedgerEntry> voids_;
};

}  // namespace vantage::internal::city
