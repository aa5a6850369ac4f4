// Scenes: what may hide the target. Files become a Scene, a Scene becomes a PreparedScene that serves many targets.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "vantage/error.h"
#include "vantage/export.h"
#include "vantage/geometry.h"
#include "vantage/georeference.h"
#include "vantage/progress.h"

namespace vantage {

/// Which axis of a mesh file points up. A y-up file's (x, y, z) is (x, -z, y) in the scene frame.
enum class UpAxis { y, z };

/// What an object of a scene is, as far as its source says.
enum class ObjectKind : std::uint8_t {
  other,    ///< not known
  ground,   ///< of a map: flat, or terrain
  surface,  ///< all of a raster
  building,
  building_part,
  wall,   ///< fence and hedge too
  tower,  ///< mast, chimney, tank too
  bridge,
  tree,
  stand_in,  ///< a blocker that holds the place of what was not built as it stands (Scene::ledger); no target
};

/// Who an object is.
struct SceneObject {
  std::string name = {};       ///< for people: "Empire State Building"; may be empty
  std::string source_id = {};  ///< in the source: "way/265517"; empty where the source has none
  ObjectKind kind = ObjectKind::other;

  bool operator==(const SceneObject&) const = default;
};

/// What reports, files and messages call it: "way/265517 Empire State Building".
VANTAGE_API std::string display_name(const SceneObject& object);

/// "building part", "wall", ...; "other".
VANTAGE_API const char* name_of(ObjectKind kind);

/// Something that the source of a scene says stands there, and that was not built as it stands: docs/scene.md, "The
/// ledger".
struct LedgerEntry {
  SceneObject object;  ///< its name and id as far as the source has them; the kind that it would have had
  std::string what;    ///< in the words of the source: "power=tower", "relation", "posts without a height"
  std::string reason;  ///< why it was not built as it stands: "its ring is open at 7.41, 1.11"
  /// Where, scene frame, metres; z as far as heights are known, else from -inf to inf. Nothing: the source does not
  /// say, or what it says cannot be read.
  std::optional<Box> box = std::nullopt;
  std::vector<std::vector<std::array<double, 2>>> outlines = {};  ///< x, y of rings round it, open; may be empty
  std::optional<double> height_m = std::nullopt;                  ///< above the ground, where the source says it
  /// The object of the scene that holds its place: an index into Scene::objects. Nothing: nothing holds it, so that
  /// it hides nothing, and nothing keeps clear of it.
  std::optional<std::uint32_t> stand_in = std::nullopt;
  std::string instead = {};    ///< what the stand-in is: "its outline without holes, 45 m high"; empty without one
  bool may_be_larger = false;  ///< what stands there may reach beyond the stand-in
  std::string without = {};    ///< what `scene.without` calls its kind; empty where that does not leave it out
};

/// A power line, cable car or pipeline overhead: upright facets from the ground to the height of its supports.
struct OverheadLine {
  SceneObject object;
  Mesh mesh;  ///< scene frame
};

/// What is done about what a source says stands there and that cannot be built as it stands.
enum class MissingPolicy : std::uint8_t {
  block,   ///< what has a place becomes a blocker that holds it
  warn,    ///< nothing holds its place; warnings tell of it
  refuse,  ///< Error(input), ErrorCode::scene_incomplete, where there is any
};

/// "block", "warn", "refuse".
VANTAGE_API const char* name_of(MissingPolicy policy);

/// Any triangle soup with names. Open, non-manifold, doubled, intersecting or mis-oriented triangles are all fine: they
/// are opaque from both sides.
struct Scene {
  Mesh mesh;                             ///< scene frame: metres, z up
  std::vector<std::uint32_t> object_of;  ///< per triangle: index into `objects`
  std::vector<SceneObject> objects;
  std::filesystem::path source;  ///< the file it was read from; empty when made in memory
  UpAxis up = UpAxis::z;         ///< axes of that file, used when a result is written as OBJ
  double scale = 1.0;            ///< metres in one unit of that file, used likewise
  bool states_axes = false;      ///< the file itself says which axis is up: CityJSON, an OBJ that vantage wrote

  // Counted while reading.
  std::size_t dropped_faces = 0;  ///< faces of the file that hold no triangle (fewer than 3 corners)

  /// Where it lies on the earth; nothing for a mesh that does not say. The scene frame is then the one described there.
  std::optional<Georeference> georeference;

  /// Whom pictures have to name, as whoever gave the scene says, besides what its file says: see attribution_of.
  std::string attribution = {};

  /// Of a part of a larger scene that is prepared as that is: the bounds of the larger one. So volumes in the part are
  /// the same bits as in the whole, as long as all is in the part that their targets can reach: vantage/city.h. Each
  /// object is then prepared by itself. Nothing: a scene of its own.
  std::optional<Box> whole;

  /// Of a volume that vantage wrote: how far the rounding to the file's numbers moved it, metres. Nothing where the
  /// file does not say.
  std::optional<double> rounding_m;

  /// They hide nothing, but clearance is kept from them: obstacles_of, LegDistances. Files of scenes do not hold them:
  /// the ledger there says so.
  std::vector<OverheadLine> overhead = {};

  /// What was unusual while reading but no error, for people: a sentence each, with counts and the first culprit.
  std::vector<std::string> notes;

  /// What the source says stands there, and that is not built as it stands; each with what holds its place. Empty: all
  /// that was read is in the mesh.
  std::vector<LedgerEntry> ledger = {};
};

/// Whom pictures and pages of a scene have to name: Scene::attribution, and what its georeference says, or without that
/// kOpenStreetMapCredit where an object is known by an id of OpenStreetMap ("way/265517"). Empty where nobody is known.
/// Cost: linear in the objects.
VANTAGE_API std::string attribution_of(const Scene& scene);

struct SceneReadOptions {
  UpAxis up = UpAxis::z;
  double scale = 1.0;  ///< metres in one unit of the file; > 0. Where x and y are in a CRS, of its z only

  /// CityJSON: the level of detail ("2.2") to take of each object; empty: the highest that it has. One that lacks it
  /// gives the nearest lower one, or else the nearest higher one; a note counts these. A whole number ("2") is also met
  /// by the highest of its refinements ("2.2").
  std::string lod = {};

  /// The coordinate reference system of the file's x and y: "EPSG:28992", a WKT or PROJ text; or "none": metres of no
  /// known place. Overrides what a CityJSON file says; a file whose georeference vantage wrote has none. z stays.
  std::string crs = {};

  /// Latitude and longitude (WGS 84, degrees) of the scene frame's origin. Empty: the centre of the scene where the
  /// file or `crs` says where it lies. For a file that does not, its x and y are taken as metres east and north of it.
  std::optional<std::array<double, 2>> origin_deg = std::nullopt;

  MissingPolicy missing = MissingPolicy::block;  ///< what cannot be built as the file has it: Scene::ledger
};

/// Reads .obj, .ply (ASCII, binary of either byte order), .stl (ASCII, binary), .gltf and .glb, and CityJSON 1.0 to 2.0
/// (.city.json, .json, and as text sequence .city.jsonl; see docs/scene.md); each may be compressed with gzip
/// (".obj.gz"). An OBJ that vantage wrote says its axes and unit itself, which override `up` and `scale`. The format
/// is told by the content, then by the name. Polygons with more than three corners are triangulated. Coordinates keep
/// double precision where the format has it. glTF is always y up, CityJSON z up: `up` is not used for them. In OBJ
/// files an object is what "o" begins; where one such object holds all that is in any, and groups ("g") subdivide it,
/// or where there is none, each group is an object.
///
/// Throws Error(input) naming the file, and the line or byte where there is one, for: a missing or unreadable file, an
/// unknown format, truncated or garbled content, a glTF buffer outside of the file's folder, an index out of range, a
/// coordinate that is not finite or (in metres) beyond 1e9, no triangles, content that needs more memory than there is
/// or than a mesh of that size may (4 GiB decompressed, a polygon of more than 16,384 corners); a scale that is not
/// positive and finite; a CRS that is unknown or has no value at the scene, an origin that is out of range, a
/// georeference of vantage that is garbled. Error(cancelled) when told to stop. Cost: linear in the file, on one
/// thread, but for polygons of many corners: the square of these.
VANTAGE_API Scene read_scene(const std::filesystem::path& file, const SceneReadOptions& options = {},
                             const Progress& progress = {});

/// What preparing found in a scene, and what `vantage inspect` shows.
struct SceneStatistics {
  std::size_t triangles = 0;        ///< as read
  std::size_t vertices = 0;         ///< as read
  std::size_t welded_vertices = 0;  ///< distinct positions
  std::size_t objects = 0;
  std::size_t degenerate_triangles = 0;  ///< no wider than rounding (docs/theory.md, "What is dropped and merged")
  std::size_t duplicate_triangles = 0;   ///< same three positions, either turn; dropped
  std::size_t open_edges = 0;            ///< edges with one triangle, after welding
  std::size_t nonmanifold_edges = 0;     ///< edges with more than two triangles
  std::size_t misoriented_edges = 0;     ///< edges that their two triangles run in the same direction
  std::size_t polygons = 0;              ///< convex polygons after merging coplanar neighbours
  Box bounds;                            ///< of the triangles that have an area; metres, scene frame
};

/// Writes a scene, in the scene frame; the format follows the extension: docs/command-line.md#formats. Written whole or
/// not at all. Objects without triangles, and vertices that none uses, are not written.
///   .obj  an object ("o") for each object, double precision, metres, z up
///   .glb  a node and a mesh for each object; y up, as the specification demands. Positions are single precision about
///         an origin of the object's own: of one that is 100 m wide right to 4 um, wherever it lies
///   .ply  binary, little-endian, double coordinates; one mesh: names are not kept
///   .stl  binary, single precision: one mesh; names are not kept
/// The georeference goes into the file (docs/scene.md), for .stl into FILE.place.json beside it. Returns how far the
/// numbers of the format have moved a vertex at most, metres: 0 for .obj and .ply, and where single precision holds all
/// of them. A scene that was moved has another scene_hash when it is read back, and volumes in it differ as much.
///
/// Throws Error(input) for an unknown extension, a directory, a scene without triangles, and one whose arrays do not
/// fit together; Error(output) when the file cannot be written or the format cannot hold that much. Cost: linear.
VANTAGE_API double write_scene(const Scene& scene, const std::filesystem::path& file);

/// A scene ready for visibility queries: welded, cleaned, coplanar neighbours merged into convex polygons, indexed by a
/// bounding volume hierarchy. Immutable and cheap to copy (a shared handle); any number of threads may use it at once.
/// Cost: O(n log n) in the triangles, once per scene. The Scene's triangles are copied; the Scene may be dropped.
class VANTAGE_API PreparedScene {
 public:
  /// Uses the threads of the caller's arena (TBB); the result does not depend on their number. Throws Error(input) for
  /// an index out of range, `object_of` of the wrong length, a vertex that is not finite or farther than 1e9 m from the
  /// origin; Error(cancelled) when told to stop.
  explicit PreparedScene(const Scene& scene, const Progress& progress = {});

  const SceneStatistics& statistics() const;
  const std::vector<SceneObject>& objects() const;

  /// The scene's triangles are merged to `statistics().polygons` convex polygons. The corners of one of them in order,
  /// in the scene frame, and the index of its object. Throws Error(input) for an index out of range.
  std::vector<Vec3> polygon(std::uint32_t index) const;
  std::uint32_t object_of_polygon(std::uint32_t index) const;

  struct Data;
  const Data& data() const { return *data_; }  ///< for the engine

 private:
  std::shared_ptr<const Data> data_;
};

// ---- hash: docs/hashes.md. mission_hash is in vantage/mission.h

/// SHA-256 (FIPS 180-4) of the scene's triangles: the corners as doubles in the scene frame and the index of the
/// object, in order. 64 hexadecimal digits. Names, vertices that no triangle uses and how the vertices are numbered do
/// not count. Throws Error(input) for an index out of range. Cost: linear; 0.3 s for a million triangles.
VANTAGE_API std::string scene_hash(const Scene& scene);

}  // namespace vantage
