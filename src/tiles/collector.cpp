#include "tiles/collector.h"

#include <limits>
#include <optional>

#include "io/object_text.h"
#include "vantage/error.h"

namespace vantage::internal::tiles {
namespace {

constexpr std::size_t kMostTriangles = 200'000'000;

Triangle shifted(const Triangle& triangle, std::uint32_t first, bool mirrored) {
  return {triangle[0] + first, triangle[mirrored ? 2 : 1] + first, triangle[mirrored ? 1 : 2] + first};
}

}  // namespace

std::uint32_t Collector::object(const SceneObject& object) {
  const auto [entry, is_new] =
      known_.try_emplace({object.source_id, object.name}, static_cast<std::uint32_t>(objects.size()));
  if (is_new) objects.push_back(object);
  return entry->second;
}

/// The number of the first.
std::uint32_t Collector::add_points(const io::RawMesh& mesh, const Transform& into_world, const std::string& where) {
  const std::size_t first = vertices.size();
  if (triangles.size() + mesh.triangles.size() > kMostTriangles ||
      first + mesh.vertices.size() > std::numeric_limits<std::uint32_t>::max()) {
    throw Error(ErrorCode::region_invalid, "the tiles hold more than " + std::to_string(kMostTriangles) + " triangles",
                where, "give a smaller radius, or a larger detail");
  }
  for (const Vec3& vertex : mesh.vertices) {
    const Vec3 moved = into_world * vertex;
    if (!moved.allFinite()) {
      vertices.resize(first);
      throw Error(ErrorCode::coordinate_not_finite, "a coordinate of the tile is not finite", where,
                  "export the tileset again");
    }
    vertices.push_back(moved);
  }
  return static_cast<std::uint32_t>(first);
}

/// `own`: what the mesh's objects are called here.
void Collector::add_missing(const io::RawMesh& mesh, const Transform& into_world, const std::vector<std::uint32_t>& own,
                            const std::string& where) {
  constexpr std::size_t kMostMissing = 1'000'000;
  if (missing.size() + mesh.ledger.size() > kMostMissing) {
    throw Error(ErrorCode::region_invalid, "the tiles hold too much that cannot be built", where,
                "give a smaller radius, or export the tileset as meshes");
  }
  for (const io::Missing& part : mesh.ledger) {
    MissingPart& added = missing.emplace_back(MissingPart{part.entry});
    added.is_held = !part.holder.triangles.empty();
    added.entry.box.reset();  // in the coordinates of the file, as the outlines
    added.entry.outlines.clear();
    const std::optional<std::uint32_t>& holder = part.entry.stand_in;
    added.entry.stand_in = holder && *holder < own.size() ? std::optional(own[*holder]) : std::nullopt;
    const std::optional<Box>& box = part.entry.box;
    if (!box || !box->min.allFinite() || !box->max.allFinite()) continue;  // an endless one has no corners to move
    for (const Vec3& corner : io::box_mesh(*box).vertices) added.corners.push_back(into_world * corner);
  }
}

void Collector::add(const io::RawMesh& mesh, const Transform& into_world, const std::string& where) {
  const std::uint32_t first = add_points(mesh, into_world, where);
  const bool mirrored = into_world.linear().determinant() < 0;
  std::vector<std::uint32_t> own(mesh.objects.size());
  for (std::size_t i = 0; i < own.size(); ++i) own[i] = object(mesh.objects[i]);
  add_missing(mesh, into_world, own, where);
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    triangles.push_back(shifted(mesh.triangles[i], first, mirrored));
    object_of.push_back(own[mesh.object_of[i]]);
  }
}

void Collector::add_as(const SceneObject& whole, const io::RawMesh& mesh, const Transform& into_world,
                       const std::string& where) {
  const std::uint32_t first = add_points(mesh, into_world, where);
  const bool mirrored = into_world.linear().determinant() < 0;
  const std::uint32_t own = object(whole);
  add_missing(mesh, into_world, std::vector<std::uint32_t>(mesh.objects.size(), own), where);
  for (const Triangle& triangle : mesh.triangles) {
    triangles.push_back(shifted(triangle, first, mirrored));
    object_of.push_back(own);
  }
}

}  // namespace vantage::internal::tiles
