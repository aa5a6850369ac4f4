// Reads mesh files of every format that vantage knows, into the file's own axes. read_scene (vantage/scene.h) is on top
// of it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "io/axes_text.h"
#include "io/mesh_source.h"
#include "vantage/geometry.h"
#include "vantage/scene.h"

namespace vantage::internal::io {

enum class MeshFormat { obj, ply, stl, gltf, cityjson };

/// What a reader saw and did not build as it stands.
struct Missing {
  LedgerEntry entry;  ///< its box and outlines are in the file's axes, until to_scene_frame has moved them
  /// What holds its place under MissingPolicy::block; empty where nothing can. `entry.instead` says what it is.
  Mesh holder = {};
  /// Of the ledger that the file states: where it is, and what holds its place, is believed as far as the mesh bears it
  /// out, since other programs may have changed that.
  bool is_stated = false;
};

/// A mesh as its file describes it: in the file's unit and axes, polygons cut into triangles. All indices are in range,
/// all coordinates finite, there is at least one triangle, and every object has one. Vertices that no triangle uses
/// stay.
struct RawMesh {
  MeshFormat format = MeshFormat::obj;
  std::vector<Vec3> vertices;
  std::vector<Triangle> triangles;
  std::vector<std::uint32_t> object_of;  ///< per triangle: index into `objects`
  std::vector<SceneObject> objects;      ///< texts in UTF-8, no control characters; a name or an id; may repeat
  std::size_t dropped_faces = 0;         ///< faces with fewer than 3 corners

  /// The coordinate reference system of x and y, if the file names one, and where it does.
  std::string crs, crs_place;
  std::optional<Georeference> georeference;  ///< as vantage wrote it; x and y then are metres about its origin
  std::optional<Axes> axes;                  ///< likewise, of OBJ
  std::optional<double> rounding_m;          ///< likewise: how far the file's numbers moved a volume
  std::vector<std::string> notes;            ///< as Scene::notes
  std::vector<Missing> ledger;               ///< as Scene::ledger
};

/// Reads a file of any known format, compressed or not. Throws as read_scene does.
/// `lod`, `crs`: as in SceneReadOptions.
RawMesh read_mesh_file(const std::filesystem::path& file, const core::ProgressReporter& progress = {},
                       const core::ReadLimits& limits = {}, const std::string& lod = {}, const std::string& crs = {});

/// Moves a mesh from its file's axes and unit into the scene frame: z up, scaled, about the origin where it has a
/// place. glTF is y up and CityJSON z up whatever the options say. Fills in `georeference`. Boxes of the ledger that
/// cannot be moved are dropped, their entries are not. Throws Error(input) if a coordinate is then beyond
/// kMaxCoordinate, and for places as read_scene does.
void to_scene_frame(RawMesh& mesh, const SceneReadOptions& options, const std::filesystem::path& file,
                    const core::ProgressReporter& progress);

}  // namespace vantage::internal::io
