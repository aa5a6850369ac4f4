// The visibility volume of a target: a closed mesh whose every facet knows what bounds the view there.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "vantage/each_limit.h"
#include "vantage/error.h"
#include "vantage/export.h"
#include "vantage/geometry.h"
#include "vantage/navigation.h"
#include "vantage/progress.h"
#include "vantage/scene.h"
#include "vantage/target.h"

namespace vantage {

enum class CauseKind : std::uint8_t {
  scene,         ///< beyond this facet an object of the scene hides part of the target
  range,         ///< beyond it some point of the target is farther than max_range
  target_plane,  ///< the plane of the target
  navigation,    ///< a navigation limit
  sensor,        ///< a limit of the sensor besides its range
};

/// "scene", "range", "target_plane", "navigation", "sensor".
VANTAGE_API const char* name_of(CauseKind kind);

/// One reason for part of the boundary.
struct Cause {
  CauseKind kind = CauseKind::scene;
  std::string
      name;  ///< display_name of the object; "max_range"; "target plane"; "altitude min", "agl max", "zone 0", ...
  double area_m2 = 0;  ///< of the facets that it causes

  // Of kind scene, where the method tells objects apart (the method of spheres does not).
  std::optional<std::uint32_t> object = std::nullopt;  ///< index into Scene::objects
  std::string source_id = {};                          ///< of it: an index means nothing without the scene
  ObjectKind object_kind = ObjectKind::other;          ///< likewise
};

/// The cause that an object of a scene is.
VANTAGE_API Cause cause_of_object(std::uint32_t index, const SceneObject& object);

/// How a computation ended. Everything but `computed` leaves the mesh empty, and `reason` says why in a sentence.
enum class Outcome {
  computed,
  out_of_range,     ///< no point is within max_range of all vertices
  blocked_at_once,  ///< the front is covered by the scene as closely as only its own surface is (2 mm; where max_range
                    ///< is less than 20 m, less in proportion). Of spheres: a vertex sees nothing farther than 0.1 m
                    ///< (likewise), or no point is in all of them. Of a link: something enters the zone of every
                    ///< position
  outside_limits,   ///< the navigation limits leave nothing
  no_common_view,   ///< of a target in parts: no point sees all of them; of a VisibleShare: none sees so much
};

/// "computed", "out_of_range", "blocked_at_once", "outside_limits", "no_common_view".
VANTAGE_API const char* name_of(Outcome outcome);

/// Work done at each stage, for reports and for those who tune.
struct StageCounts {
  std::size_t scene_polygons = 0;      ///< convex polygons in the scene
  std::size_t candidate_blockers = 0;  ///< polygons whose blocker was built
  std::size_t visible_blockers = 0;    ///< blockers that bound the volume somewhere
  std::size_t visible_facets = 0;      ///< facets of those
  std::size_t constraint_edges = 0;    ///< edges handed to the triangulation
  std::size_t boolean_fallbacks = 0;   ///< arrangements, and limits in the chart, that booleans had to stand in for
};

/// `total` may be more than the sum: the program counts from its start, and the reading of the mission under `read`.
struct Seconds {
  double read = 0, prepare = 0, engine = 0, navigation = 0, write = 0, total = 0;
};

/// What a volume was computed for. It travels in the volume's files, so that they can be judged wherever they are.
struct VolumeProvenance {
  std::string version;  ///< of vantage
  std::string method;   ///< "exact", "spheres"
  Target target;        ///< as given, in the scene frame
  Sensor sensor;
  std::string scene_hash, mission_hash;  ///< docs/hashes.md; empty where they were not made
  /// Of a volume for several targets, as Mission::views; `target` has no parts then.
  std::vector<std::vector<Target>> views = {};
};

/// In Volume::polygon_of: none.
inline constexpr std::uint32_t kNoPolygon = 0xFFFFFFFF;

/// The result. `mesh` is closed, oriented outward, in the scene frame. Before navigation cuts, and without a
/// VisibleShare, it is one piece of genus 0 and star-shaped about every point of the target: the segment from any point
/// inside to any point of the target stays inside.
struct Volume {
  Outcome outcome = Outcome::computed;
  std::string reason;  ///< empty when computed
  std::string hint;    ///< what to try next, where there is something

  Mesh mesh;
  std::vector<std::uint32_t> cause_of;  ///< per triangle: index into `causes`
  std::vector<Cause> causes;
  /// Per triangle: the convex polygon of the scene that hides the target beyond it (PreparedScene::polygon), or
  /// kNoPolygon where the cause is not an object of the scene. Empty where it is not known: the method of spheres does
  /// not tell it, and files do not hold it.
  std::vector<std::uint32_t> polygon_of;

  double tolerance_m = 0;      ///< bound on how far range facets lie inside the true range region
  std::vector<double> lift_m;  ///< how far each part of the target was raised: PreparedTarget::lift_m
  TargetFrame frame;           ///< of the target's first part as used, lift included; of a mesh that was given or read
                               ///< the origin alone: the middle of its box
  std::vector<Warning> notes;  ///< what to know before relying on it: the target seems to be under the ground.
                               ///< run_mission adds its own: the map ends within the range
  std::optional<Georeference> georeference;    ///< of the scene; run_mission fills it in, and writers write it
  std::optional<VolumeProvenance> provenance;  ///< run_mission adds the hashes
  StageCounts counts;
  Seconds seconds;

  /// Limits that it was computed with, besides the range, of the target and the sensor in `provenance`: compute_view.
  std::vector<Limit> kept_limits = {};

  /// Of a volume that was made from one that was read: how far that file's numbers had moved its surface already
  /// (VolumeFile::rounding_m). Writers add theirs.
  double read_rounding_m = 0;

  /// Whom files and pictures of it have to name; run_mission fills it in by attribution_of the scene. The report and
  /// GLB files have it, also where nobody knows a place on the earth.
  std::string attribution = {};

  /// Whether no position sees the whole target; `reason` says why.
  bool empty() const { return mesh.empty(); }
};

/// How many facets may go through the boolean operations of one call of this library, counted each time that they do.
/// They cost some microseconds each, where many long and narrow ones overlap some tens of them. A computation that
/// comes to more, or by an estimate will, ends with ErrorCode::work_too_large, on every machine at the same place. The
/// estimates can be many times too high where solids cover each other. A volume that takes several calls may come to
/// the limit in each: of its parts, of its limits, and where the volumes of several targets are combined.
inline constexpr double kWorkLimit = 1e7;

struct ExactOptions {
  double tolerance_m =
      0.01;         ///< how far range facets may lie inside the true sphere; > 0. Planar parts are exact to rounding
  int threads = 0;  ///< 0: as many as the machine has. The result does not depend on it
  double work_limit = kWorkLimit;  ///< of compute_parts; of compute_volume for the parts, and again for the limits. The
                                   ///< result does not depend on it, where there is one
};

/// The exact visibility volume by docs/theory.md, before navigation cuts: of the whole target, even where its sensor
/// has a VisibleShare. That is honoured by compute_parts and compute_volume, as other limits
/// besides the range are by cut_to_limits. With a link, Sensor::link, it is the volume of the positions whose zone is
/// clear: nothing is claimed wrongly, and docs/camera.md says how much is left out. Safe to call from many threads on
/// one scene. Fills everything of the result; of Seconds `engine` and `total`.
///
/// Guaranteed from the inside: no point of the result, deeper than 1e-6 of its distance to the target's centre, has any
/// part of the target hidden or out of range, but for what numbers cannot tell:
///   - a strip along the target's outline, and a layer above and below its plane. Both are 1e-9 of the target's radius
///     wide, at most 1e-9 m, or eight roundings of the largest coordinate where that is more (9e-9 m at map coordinates
///     of 5e6 m). What reaches no farther into the outline, or through the plane, counts as standing on it
///   - triangles of the scene that are no wider than 2^-50 of their longest side or of the scene's size, at most
///     1e-9 m: they hide nothing
///   - corners of the scene, which merging triangles to polygons may move by 2^-46 of the scene's size, at most
///     1e-9 m, in two directions. What hides the target from the distance h ends the view late by that times D / h at
///     the distance D: more than 1e-9 of the distance only nearer than a metre
///   - the coordinates of the mesh, which are rounded: a point must be deeper by five roundings of the largest (6e-9 m
///     at 5e6 m). That is more than 1e-6 of the distance only nearer to the target than 6 mm
///
/// Cost: it grows with what is seen from the target and with the facets of the range sphere (in proportion to max_range
/// over tolerance), hardly with the size of the scene. Milliseconds in ordinary streets; bench/results has figures.
///
/// Throws Error(input) for a target of several parts (compute_volume takes these), a tolerance
/// that is not positive and finite, a tolerance so fine for this range that the mesh would have too many facets;
/// Error(cancelled) when told to stop; Error(internal) when the boundary could not be triangulated safely: no volume
/// rather than a wrong one.
VANTAGE_API Volume compute_visibility(const PreparedTarget& target, const ExactOptions& options = {},
                                      const Progress& progress = {});

/// Topology and size of a closed mesh. `euler` is V - E + F over all pieces: 2 per piece of genus 0.
struct MeshMeasures {
  std::size_t vertices = 0, facets = 0, pieces = 0;
  long euler = 0;
  bool closed = false;    ///< every edge has exactly two triangles
  bool oriented = false;  ///< which run it in opposite directions
  double volume_m3 = 0, area_m2 = 0;
  Box bounds;
};

/// Measures any mesh, closed or not; volume and Euler number mean something for a closed one only. Vertices that no
/// triangle uses do not count, and vertices are told apart by index, not by position. Cost: linear in the triangles,
/// but for sorting the edges at each vertex. Throws Error(input) naming the triangle when an index is out of range.
VANTAGE_API MeshMeasures measure(const Mesh& mesh);

/// Holes in a mesh.
struct OpenEdges {
  std::size_t count = 0;
  Vec3 middle_of_first = Vec3::Zero();  ///< of one of them, if there is any
};

/// Edges with an odd number of triangles, where vertices at exactly the same position count as one (STL has no shared
/// vertices, other formats repeat them at seams) and triangles with two corners in one place are left out. A mesh
/// without any encloses something, even where two of its pieces touch. Cost: O(n log n).
VANTAGE_API OpenEdges find_open_edges(const Mesh& mesh);

/// A mesh as a volume with a single cause of that name, to write or to cut.
VANTAGE_API Volume volume_of_mesh(Mesh mesh, const std::string& cause);

/// What a written file holds.
struct WrittenVolume {
  double rounding_m = 0;   ///< how far rounding to the file's numbers moved the surface, at most; metres
  std::size_t facets = 0;  ///< in the file: fewer than the volume's, where rounding leaves some without area
  std::size_t turned_facets =
      0;  ///< of the volume's facets, those that rounding turned over: narrower than the rounding
};

/// Writes the mesh; the format follows the extension: docs/command-line.md#formats lists them. Written whole or not at
/// all. Read back, with vertices in one place taken for one as readers do, every file is closed (each edge is run as
/// often in one direction as in the other) and has no facet without area. Rounding cannot keep inside: where it moves
/// the surface, by up to rounding_m, the file says so, and `vantage verify` allows that much.
///   .ply  binary, little-endian, double coordinates in the scene frame, facet property `cause` (index) and the causes'
///         names in comments
///   .obj  a group per cause; the axes and the unit of the scene file: give Scene::up and Scene::scale (metres in one
///         unit, > 0), so that it loads on top of the scene. Coordinates are divided by `obj_scale`: with 1 they keep
///         every bit, with another they read back to within rounding
///   .stl  binary; scene frame. Single precision, all that the format has: far from the origin it is coarse, half a
///         metre between neighbouring numbers at a UTM northing of 4,785,000. Prefer another format there
///   .glb  a material per kind of cause; y up as the specification demands. Single precision about an origin in the
///         middle of the volume: 0.03 mm at 600 m across, wherever it lies
///   .tiles  a folder with a tileset of 3D Tiles 1.1, on the globe: docs/tilesets.md. A feature for each cause and each
///         target, with kind, name and area_m2. Single precision about the middle of the volume; needs a georeference
///         and a volume that is not empty. An old folder is replaced if it is empty, or holds a tileset that vantage
///         wrote and nothing else. It is not read as a volume
/// The georeference and rounding_m go into the file, for .stl into FILE.place.json beside it (docs/scene.md).
/// Cost: linear in the facets; the bytes are on the disk when it returns. Throws Error(output) when the file cannot be
/// written, the format cannot hold that many facets or nothing of the volume is left in it, and Error(input) for an
/// unknown extension, a directory (for .tiles another one, or no georeference), a volume whose arrays do not fit
/// together, or a scale that is not positive, not finite or so small that coordinates overflow.
VANTAGE_API WrittenVolume write_volume(const Volume& volume, const std::filesystem::path& file,
                                       UpAxis obj_up = UpAxis::z, double obj_scale = 1.0);

// ---- Volumes as solids: cut to limits of the sensor and of navigation, and intersected

/// Cuts a volume to the navigation limits. The result may have several pieces; each is closed. Facets keep their
/// causes; cut faces are CauseKind::navigation. An empty result is Outcome::outside_limits with a reason. Adds its time
/// to `navigation` and `total` of the volume's Seconds. Uses the threads of the caller's arena (TBB).
///
/// Cost: one boolean operation, O(n log n) in the facets of the volume and the limits, and the check of each mesh for
/// self-intersections, O(m log m) in its triangles. The clearance takes as many booleans as there are obstacles near
/// what the other limits leave: more than `work_limit` allows is refused before they begin.
///
/// Throws Error(input) as check_navigation does, and for a volume whose arrays do not fit together, unless it is empty;
/// Error(work_too_large); Error(cancelled) when told to stop; Error(internal) when a boolean operation fails.
VANTAGE_API Volume cut_to_navigation(const Volume& volume, const Navigation& navigation, const Progress& progress = {},
                                     double work_limit = kWorkLimit);

/// Cuts a volume to the limits of the target's sensor, besides the range and what it keeps already
/// (Volume::kept_limits, of this target and this sensor), and to the navigation limits, at once. Facets that a limit of
/// the sensor makes are CauseKind::sensor, by the names "min_range", "incidence", "pixel", "frame", "gimbal" and "sun".
/// As cut_to_navigation otherwise. A link is no such limit: compute_visibility takes it into account.
///
/// Guaranteed from the inside: the surfaces are made of facets, which take away more than the limit does, never less.
/// How much more is in docs/camera.md. Cost: besides the boolean milliseconds, with a gimbal tens of them.
VANTAGE_API Volume cut_to_limits(const Volume& volume, const PreparedTarget& target, const Navigation& navigation = {},
                                 const Progress& progress = {}, double work_limit = kWorkLimit);

/// What all the volumes claim: that of a target in parts is the intersection of its parts' volumes. May have several
/// pieces, each closed; facets keep their causes, and causes of the same kind and name become one. The tolerance
/// is the largest of the volumes', lifts are those of all, one after the other, the frame is the first one's, seconds
/// and counts are sums, notes are those of all. Where one of the volumes is empty, so is the result, with its outcome
/// and reason; where they have nothing in common, Outcome::no_common_view. Its provenance states what all were computed
/// for; none where their scenes or sensors differ. Throws Error(input) for no volumes and for
/// one whose arrays do not fit together; Error(work_too_large); Error(cancelled) when told to stop; Error(internal)
/// when a boolean operation fails. Cost: a boolean operation per volume, O(n log n) in the facets.
VANTAGE_API Volume intersect_volumes(const std::vector<Volume>& volumes, const Progress& progress = {},
                                     double work_limit = kWorkLimit);

/// What at least one of the volumes claims: that of targets of which one is enough. As intersect_volumes otherwise;
/// volumes that are empty for a good reason add nothing. Where all are, so is the result, with the first one's outcome.
VANTAGE_API Volume unite_volumes(const std::vector<Volume>& volumes, const Progress& progress = {},
                                 double work_limit = kWorkLimit);

/// The volume of a target of any number of parts, before limits besides the range: compute_visibility of each part,
/// intersected. Where no position is in front of all parts, and within range of them, that is told at once.
///
/// Of a target whose sensor has a VisibleShare: what sees at least that part of its area, is within range of all of it
/// and in front of all its parts. Guaranteed from the inside: the parts are cut into convex cells, and from each point
/// of the result so many of them are seen whole that their area is the share or more. Parts get cells in proportion to
/// their area, at least one each; what a cell of a part costs is rounded up to an eighth of an average cell. The result
/// has all that so many whole cells allow (less where StageCounts::boolean_fallbacks says that booleans stood in, and
/// there are more than 16 cells). It may have several pieces and holes, and is not star-shaped. Where all cells must be
/// seen it is the volume of the whole target. Where nothing is left, Outcome::no_common_view. Cost: a volume for each
/// cell, and an arrangement of these, in which each meets each other one; docs/camera.md has figures.
///
/// Throws as compute_visibility and intersect_volumes do.
VANTAGE_API Volume compute_parts(const PreparedTarget& target, const ExactOptions& options = {},
                                 const Progress& progress = {});

/// compute_parts, but only what keeps those limits of the sensor that are cut where the view is computed:
/// Volume::kept_limits. These are min_range, incidence, sun and the frame of a camera, of a target that is one polygon,
/// or is computed like one (compute_parts; docs/theory.md, "Limits in the chart"). Where that fails
/// (StageCounts::boolean_fallbacks), or they leave nothing, it is compute_parts: cut_to_limits then cuts it, or says
/// why nothing is left. Throws as compute_parts does. Cost: the engine's, and 0 to 90 % more for each limit; some 40 ms
/// for a camera that turns.
VANTAGE_API Volume compute_view(const PreparedTarget& target, const ExactOptions& options = {},
                                const Progress& progress = {});

/// Whether the sensor has such limits, and the target is one polygon, or is computed like one.
VANTAGE_API bool has_limits_in_view(const PreparedTarget& target);

/// All that a vehicle may use: compute_view, cut to the limits of the sensor and of navigation. Throws as these do.
/// Cost: the sum of theirs.
VANTAGE_API Volume compute_volume(const PreparedTarget& target, const Navigation& navigation = {},
                                  const ExactOptions& options = {}, const Progress& progress = {});

// ---- hash: docs/hashes.md

/// SHA-256 of a volume's mesh: the corners of its facets as doubles, in order. Causes and how the vertices are numbered
/// do not count. 64 hexadecimal digits. Throws Error(input) for an index out of range.
VANTAGE_API std::string volume_hash(const Mesh& mesh);

}  // namespace vantage
