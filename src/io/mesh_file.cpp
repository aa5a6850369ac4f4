#include "io/mesh_file.h"

#include <algorithm>
#include <array>
#include <new>
#include <utility>

#include "io/mesh_readers.h"
#include "io/object_text.h"
#include "io/sidecar.h"
#include "io/text_cursor.h"
#include "io/tileset.h"
#include "vantage/error.h"

namespace vantage::internal::io {
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
  if (bytes.starts_with("\xef\xbb\xbf")) bytes.remove_prefix(3);
  TextCursor text(bytes);
  text.skip_spaces();
  return !text.at_end() && text.peek() == '{';
}

}  // namespace

MeshFormat mesh_format(const MeshSource& source) {
  const std::string_view bytes = source.bytes();
  const std::string extension = source.extension();
  if (bytes.starts_with("glTF")) return MeshFormat::gltf;
  if (is_tile(bytes)) fail_for_tileset(source);
  if (bytes.starts_with("ply\n") || bytes.starts_with("ply\r")) return MeshFormat::ply;
  if (is_binary_stl(bytes) || is_ascii_stl(bytes)) return MeshFormat::stl;
  const bool named_json = extension == ".json" || extension == ".jsonl";
  if (looks_like_json(bytes)) {
    if (is_cityjson(bytes)) return MeshFormat::cityjson;
    if (is_tileset(bytes)) fail_for_tileset(source);
    const bool is_gltf = !named_json || bytes.find("\"asset\"") != std::string_view::npos;
    return is_gltf ? MeshFormat::gltf : MeshFormat::cityjson;
  }
  if (extension == ".obj" || looks_like_obj(bytes)) return MeshFormat::obj;
  if (extension == ".ply") return MeshFormat::ply;
  if (extension == ".stl") return MeshFormat::stl;
  if (extension == ".gltf" || extension == ".glb") return MeshFormat::gltf;
  if (named_json) return MeshFormat::cityjson;
  source.fail(
      ErrorCode::mesh_format_unknown, "the format of the mesh file is unknown",
      "give an OBJ, PLY, STL, glTF, GLB or CityJSON file; it may be compressed with gzip. Of a map or a raster of "
      "heights 'vantage scene' makes a scene, and missions take them as scene.osm and scene.raster");
}

RawMesh read_any(const MeshSource& source, const core::ProgressReporter& progress, const core::ReadLimits& limits,
                 const std::string& lod, const std::string& crs) {
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
      case MeshFormat::cityjson:
        return read_cityjson(source, progress, limits, lod, crs);
    }
  } catch (const std::bad_alloc&) {
    source.fail(ErrorCode::out_of_memory, "there is not enough memory to read the mesh",
                "cut the mesh to the part that is needed");
  }
  throw Error(ErrorCode::internal_defect, "a mesh format without a reader", source.file().string(), "");
}

RawMesh read_mesh_file(const std::filesystem::path& file, const core::ProgressReporter& progress,
                       const core::ReadLimits& limits, const std::string& lod, const std::string& crs) {
  try {
    const MeshSource source = load_mesh_source(file, progress, limits);
    RawMesh mesh = read_any(source, progress, limits, lod, crs);
    if (mesh.format == MeshFormat::stl) {
      Sidecar beside = read_sidecar(source, progress);
      mesh.georeference = std::move(beside.georeference);
      mesh.rounding_m = beside.rounding_m;
      mesh.ledger = std::move(beside.ledger);
    }
    return mesh;
  } catch (const std::bad_alloc&) {
    throw Error(ErrorCode::out_of_memory, "there is not enough memory to load the file", file.string(),
                "cut the mesh to the part that is needed");
  }
}

}  // namespace vantage::internal::io

namespace vantage {

Scene read_scene(const std::filesystem::path& file, const SceneReadOptions& options, const Progress& callback) {
  const internal::core::ProgressReporter progress(callback, file.string());
  internal::core::ReadLimits limits;
  if (options.scale > 0) limits.unit_m = options.scale;
  limits.both_diagonals = options.missing == MissingPolicy::block;
  internal::io::RawMesh raw = internal::io::read_mesh_file(file, progress, limits, options.lod, options.crs);
  const bool was_projected = !raw.crs.empty() || !options.crs.empty();
  SceneReadOptions used = options;
  if (raw.axes) {
    used.up = raw.axes->up;
    used.scale = raw.axes->unit_m;
    if ((options.up == UpAxis::y && used.up == UpAxis::z) || (options.scale != 1 && options.scale != used.scale)) {
      raw.notes.push_back("the file says \"" + internal::io::axes_text(*raw.axes) + "\": taken so");
    }
  }
  internal::io::to_scene_frame(raw, used, file, progress);
  internal::io::apply_policy(raw, options.missing, file, progress);
  Scene result;
  result.mesh.vertices = std::move(raw.vertices);
  result.mesh.triangles = std::move(raw.triangles);
  result.object_of = std::move(raw.object_of);
  result.objects = std::move(raw.objects);
  result.source = file;
  result.up = raw.format == internal::io::MeshFormat::gltf       ? UpAxis::y
              : raw.format == internal::io::MeshFormat::cityjson ? UpAxis::z
                                                                 : used.up;
  result.scale = was_projected ? 1 : used.scale;
  result.states_axes = raw.axes.has_value() || raw.format == internal::io::MeshFormat::cityjson;
  result.dropped_faces = raw.dropped_faces;
  result.georeference = std::move(raw.georeference);
  result.rounding_m = raw.rounding_m;
  result.notes = std::move(raw.notes);
  for (internal::io::Missing& missing : raw.ledger) result.ledger.push_back(std::move(missing.entry));
  return result;
}

}  // namespace vantage
