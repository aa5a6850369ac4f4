// Reads mesh files of every format that vantage knows, into the file's own axes. read_scene (vantage/scene.h) is on top
// of it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "scene/mesh_source.h"
#include "vantage/geometry.h"
#include "vantage/progress.h"
#include "vantage/scene.h"

namespace vantage::scene {

enum class MeshFormat { obj, ply, stl, gltf };

/// A mesh as its file describes it: in the file's unit and axes, polygons cut into triangles. All indices are in range,
/// all coordinates finite, there is at least one triangle, and every object has one. Vertices that no triangle uses
/// stay.
struct RawMesh {
  MeshFormat format = MeshFormat::obj;
  std::vector<Vec3> vertices;
  std::vector<Triangle> triangles;
  std::vector<std::uint32_t> object_of;  ///< per triangle: index into `objects`
  std::vector<std::string> objects;      ///< names, UTF-8, no control characters, not empty; may repeat
  std::size_t dropped_faces = 0;         ///< faces with fewer than 3 corners
};

/// Reads a file of any known format, compressed or not. Throws as read_scene does.
RawMesh read_mesh_file(const std::filesystem::path& file, const Progress& progress = {}, const ReadLimits& limits = {});

/// Moves a mesh from its file's axes and unit into the scene frame: scaled, z up. glTF is y up whatever `up` says.
/// Throws Error(input) if a coordinate is then beyond kMaxCoordinate.
void to_scene_frame(RawMesh& mesh, UpAxis up, double scale, const std::filesystem::path& file);

}  // namespace vantage::scene
