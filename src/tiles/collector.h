// Gathers the triangles and objects of all contents, in the coordinates of the tileset.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "io/mesh_file.h"
#include "tiles/bounds.h"

namespace vantage::internal::tiles {

/// What the tiles say is there and that is not built, in the coordinates of the tileset.
struct MissingPart {
  LedgerEntry entry;
  std::vector<Vec3> corners = {};  ///< of the box about it, as io::hexahedron takes them; empty where it is not known
  bool is_held = false;            ///< the box may stand in
  bool is_hole = false;            ///< a file that cannot be read: a coarser tile may stand in
};

/// Coarser tiles that hold the place of finer ones: the first object of each, and its triangles, from and to.
using CoarserTiles = std::map<std::uint32_t, std::pair<std::size_t, std::size_t>>;

class Collector {
 public:
  /// Adds a mesh, its points moved. Objects of the same id and name are one: a feature may lie in several tiles. Throws
  /// Error(region_invalid) beyond 200 million triangles, Error(input) for a coordinate that is not finite.
  void add(const io::RawMesh& mesh, const Transform& into_world, const std::string& where);
  /// The same, but all of it belongs to one object.
  void add_as(const SceneObject& object, const io::RawMesh& mesh, const Transform& into_world,
              const std::string& where);

  std::vector<Vec3> vertices;
  std::vector<Triangle> triangles;
  std::vector<std::uint32_t> object_of;  ///< per triangle
  std::vector<SceneObject> objects;
  std::vector<MissingPart> missing;
  CoarserTiles coarser;

 private:
  void add_missing(const io::RawMesh& mesh, const Transform& into_world, const std::vector<std::uint32_t>& own,
                   const std::string& where);
  std::uint32_t object(const SceneObject& object);
  std::uint32_t add_points(const io::RawMesh& mesh, const Transform& into_world, const std::string& where);

  std::map<std::pair<std::string, std::string>, std::uint32_t> known_;  // by id and name
};

}  // namespace vantage::internal::tiles
