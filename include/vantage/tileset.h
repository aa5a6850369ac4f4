// Scenes from tilesets of 3D Tiles.
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "vantage/export.h"
#include "vantage/progress.h"
#include "vantage/scene.h"

namespace vantage {

/// Which part of a tileset is read, and how fine.
struct TilesetOptions {
  /// Latitude and longitude (WGS 84, degrees) of the middle, which becomes the origin of the scene frame. Empty: all is
  /// read, and the origin is the middle of that.
  std::optional<std::array<double, 2>> center_deg = std::nullopt;
  std::optional<double> radius_m = std::nullopt;  ///< with a centre; > 0. Tiles 100 m beyond it are not read

  /// Metres of geometric error: a tile whose error is larger is refined, where it can be. >= 0.
  double detail_m = 1.0;

  /// z of a plane that is the ground: an object of the kind ground, as wide as the circle or the scene. Empty: none but
  /// what the tileset has.
  std::optional<double> ground_m = std::nullopt;

  /// The coordinate reference system of a tileset in projected metres: "EPSG:3946"; or "none": metres of no known
  /// place. Empty: as the tileset says, on the earth (ECEF, EPSG:4978) or nowhere.
  std::string crs = {};

  MissingPolicy missing = MissingPolicy::block;  ///< what cannot be built as the tiles have it: Scene::ledger
};

/// What reading found.
struct TilesetReport {
  std::size_t documents = 0;         ///< tileset.json, external ones too, and subtrees
  std::size_t tiles = 0;             ///< within the radius, at all levels that were looked at
  std::size_t contents = 0;          ///< files with surfaces that were read
  std::size_t without_surfaces = 0;  ///< files of points or lines
  std::size_t bytes = 0;             ///< of all these
  std::size_t triangles = 0;         ///< of the scene
  std::size_t objects = 0;           ///< of the scene
  std::size_t objects_outside = 0;   ///< in tiles that were read, but wholly beyond the radius: left out

  /// Files that are missing or cannot be read. Each is an entry of Scene::ledger: where nothing holds its place,
  /// volumes may claim too much behind it.
  std::size_t holes = 0;
  std::string first_hole = {};  ///< the first of them, and what is wrong with it
  /// Coarser tiles that were taken, too, as finer ones that were to replace them cannot be read.
  std::size_t coarser_kept = 0;
  std::size_t unreadable_properties = 0;  ///< names and ids of features that are garbled: taken as missing
  std::string first_unreadable = {};      ///< the file of the first of them, and what is wrong with it
  /// Primitives of glTF with features by texture (EXT_mesh_features), one for each pixel. These are not told apart: the
  /// primitive belongs to other features that it has, or else to its node's object.
  std::size_t features_by_texture = 0;

  double largest_error_m = 0;  ///< the geometric error of the coarsest tile that was taken
  std::size_t coarse = 0;  ///< tiles that were taken though their error is larger than asked: they have no finer ones

  /// Of a tileset on the earth: how far the ellipsoid lies below the horizontal plane through the origin, at the
  /// farthest corner of the scene. There z is as much less than the height above the ellipsoid.
  double rim_drop_m = 0;
  /// There: how far x and y are from the projection that the georeference names.
  double rim_shift_m = 0;
};

struct TilesetScene {
  Scene scene;
  TilesetReport report;
};

/// Whether the file of a tileset is an address on the network, "https://..." or "http://...".
VANTAGE_API bool is_web_address(const std::filesystem::path& file);

/// Reads a tileset of 3D Tiles 1.0 or 1.1: `file` is its tileset.json. All other files must lie in its folder or below.
/// It may be a web address; all files then come from that server, which gets what the address has as `key`, and what
/// it gives as `session`, with every request. libcurl is loaded for it. Nothing is kept on disk.
///
/// Contents are glTF, GLB, b3dm, i3dm and cmpt; clouds of points are held by a box. Draco and meshopt compression are
/// unpacked where vantage was built with these libraries. Textures are not read. Each feature of a batch table or of
/// EXT_structural_metadata is an object, named by its id ("gml_id") and name or address; where a tile has no features,
/// each node is.
///
/// A tile that is finer than `detail_m` or has no finer ones is taken. With REPLACE refinement finer tiles stand for
/// their parent, with ADD they are added to it. A tileset on the earth is turned, not bent, into the frame about the
/// origin: straight lines stay straight, and z is the height above the plane that touches the ellipsoid at the origin.
/// A file that cannot be read is a hole: see the report, and Scene::ledger. Where it was to replace a coarser tile (up
/// to three levels above), that is taken as well; else the box of its tile stands in (TilesetOptions::missing).
///
/// Throws Error(input) for: a tileset.json that cannot be read, options that are out of range, a centre outside of the
/// tileset, nothing within the radius, no file that can be read, a tileset without end (more than 5 million tiles,
/// 20,000 tileset.json and subtrees with 1 GiB of text, 32 GiB of files, or 200 million triangles); where a file needs
/// a library that vantage was built without, or libcurl is not installed; a server that refuses the key or ends the
/// session (401, 403); a file that did not come, but with MissingPolicy::warn. Error(cancelled) when told to stop.
/// Cost: linear in the tiles looked at and the files read, on one thread.
VANTAGE_API TilesetScene read_tileset(const std::filesystem::path& file, const TilesetOptions& options = {},
                                      const Progress& progress = {});

/// The sentences that tell a report.
VANTAGE_API std::vector<std::string> notes_of(const TilesetReport& report);

}  // namespace vantage
