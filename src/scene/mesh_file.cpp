#include "scene/mesh_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <new>

#include "scene/mesh_readers.h"
#include "scene/text_cursor.h"
#include "vantage/error.h"

namespace vantage::scene {
namespace {

/// Whether the first statement, comments aside, is one of those that OBJ files begin with.
bool looks_like_obj(std::string_view bytes) {
  constexpr std::array<std::string_view, 11> kFirst = {"v", "vn", "vt", "f",      "o",     "g",
                                                       "s", "l",  "p",  "mtllib", "usemtl"};
  TextCursor text(bytes);
  for (text.skip_spaces(); !text.at_end() && text.peek() == '#'; text.skip_spaces()) text.rest_of_line();
  return std::find(kFirst.begin(), kFirst.end(), text.word()) != kFirst.end();
}

bool looks_like_json(std::string_view bytes) {
  TextCursor text(bytes);
  text.skip_spaces();
  return !text.at_end() && text.peek() == '{';
}

}  // namespace

MeshFormat mesh_format(const MeshSource& source) {
  const std::string_view bytes = source.bytes();
  const std::string extension = source.extension();
  if (bytes.starts_with("glTF")) return MeshFormat::gltf;
  if (bytes.starts_with("ply\n") || bytes.starts_with("ply\r")) return MeshFormat::ply;
  if (is_binary_stl(bytes) || is_ascii_stl(bytes)) return MeshFormat::stl;
  if (looks_like_json(bytes)) return MeshFormat::gltf;
  if (extension == ".obj" || looks_like_obj(bytes)) return MeshFormat::obj;
  if (extension == ".ply") return MeshFormat::ply;
  if (extension == ".stl") return MeshFormat::stl;
  if (extension == ".gltf" || extension == ".glb") return MeshFormat::gltf;
  source.fail("the format of the mesh file is unknown",
              "give an OBJ, PLY, STL, glTF or GLB file; it may be compressed with gzip");
}

RawMesh read_any(const MeshSource& source, ReadProgress& progress, const ReadLimits& limits) {
  try {
    switch (mesh_format(source)) {
      case MeshFormat::obj:
        return read_obj(source, progress, limits);
      case MeshFormat::ply:
        return read_ply(source, progress, limits);
      case MeshFormat::stl:
        return read_stl(source, progress, limits);
      case MeshFormat::gltf:
        return read_gltf(source, progress, limits);
    }
  } catch (const std::bad_alloc&) {
    source.fail("there is not enough memory to read the mesh", "cut the mesh to the part that is needed");
  }
  throw Error(ErrorKind::internal, "a mesh format without a reader", source.file().string(), "");
}

RawMesh read_mesh_file(const std::filesystem::path& file, const Progress& callback, const ReadLimits& limits) {
  ReadProgress progress(callback, file);
  try {
    return read_any(load_mesh_source(file, progress, limits), progress, limits);
  } catch (const std::bad_alloc&) {
    throw Error(ErrorKind::input, "there is not enough memory to load the file", file.string(),
                "cut the mesh to the part that is needed");
  }
}

void to_scene_frame(RawMesh& mesh, UpAxis up, double scale, const std::filesystem::path& file) {
  if (!(scale > 0) || !std::isfinite(scale)) {
    throw Error(ErrorKind::input, "the scale of a mesh must be positive and finite", file.string(),
                "give the length of the file's unit in metres");
  }
  const bool y_up = up == UpAxis::y || mesh.format == MeshFormat::gltf;
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    Vec3& v = mesh.vertices[i];
    if (y_up) v = Vec3(v.x(), -v.z(), v.y());
    v *= scale;
    if (v.cwiseAbs().maxCoeff() <= kMaxCoordinate) continue;
    throw Error(ErrorKind::input,
                "vertex " + std::to_string(i) + " (counted from 0) is more than " +
                    std::to_string(static_cast<long>(kMaxCoordinate / 1000)) + " km from the origin",
                file.string(), "check the scale, or correct the vertex");
  }
}

}  // namespace vantage::scene

namespace vantage {

Scene read_scene(const std::filesystem::path& file, const SceneReadOptions& options, const Progress& progress) {
  scene::RawMesh raw = scene::read_mesh_file(file, progress);
  scene::to_scene_frame(raw, options.up, options.scale, file);
  Scene result;
  result.mesh.vertices = std::move(raw.vertices);
  result.mesh.triangles = std::move(raw.triangles);
  result.object_of = std::move(raw.object_of);
  result.objects = std::move(raw.objects);
  result.source = file;
  result.up = raw.format == scene::MeshFormat::gltf ? UpAxis::y : options.up;
  result.scale = options.scale;
  result.dropped_faces = raw.dropped_faces;
  return result;
}

}  // namespace vantage
