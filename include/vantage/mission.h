// Missions: what a mission file says, what it means in its scene, and what comes of it.
//
//     read_mission(file) -> MissionFile -> resolve_mission -> Mission -> run_mission -> Result
//
// Each step leaves its input as it was. Mission files are described in docs/mission-file.md.
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "vantage/camera.h"
#include "vantage/error.h"
#include "vantage/export.h"
#include "vantage/navigation.h"
#include "vantage/progress.h"
#include "vantage/scene.h"
#include "vantage/scene_source.h"
#include "vantage/sensor.h"
#include "vantage/spheres.h"
#include "vantage/target.h"
#include "vantage/tour.h"
#include "vantage/volume.h"

namespace vantage {

// ---- Volumes that are kept from one run to the next

/// What runs of missions have computed of their targets by compute_view: before the limits of navigation, and those of
/// the sensor that it does not keep. Give it to each run in RunOptions::kept, with RunOptions::prepared. A target is
/// computed again only where something has changed that its volume depends on: the scene, the target itself, the range,
/// the share that must be seen, the tolerance, the sensor where compute_view keeps one of its limits. All must be the
/// same to the bit. So results have the same bits as without it. While another limit is dragged volumes are only cut
/// again, and while one of several targets is dragged the others stay.
///
/// For the exact method; nothing is kept of targets with a radio link, nor of those without a volume. It holds what the
/// last run used and what the present one adds, at 32 bytes a facet, and the scenes of these; a target that is refused
/// is no run. Safe to use from many threads; runs of different missions at the same time take each other's place. Where
/// a scene is not given prepared, each run makes another one, and nothing fits.
class VANTAGE_API KeptVolumes {
 public:
  KeptVolumes();
  KeptVolumes(const KeptVolumes&) = delete;
  KeptVolumes& operator=(const KeptVolumes&) = delete;
  ~KeptVolumes();

  std::size_t count() const;  ///< volumes held
  std::size_t taken() const;  ///< how many volumes were not computed, in all runs so far
  void clear();               ///< drops all volumes; taken() stays

  struct Data;
  Data& data() { return *data_; }  ///< for run_mission

 private:
  std::unique_ptr<Data> data_;
};

/// How the volume is computed.
enum class Method {
  exact,    ///< compute_visibility
  spheres,  ///< compute_visibility_spheres
};

/// "exact", "spheres".
VANTAGE_API const char* name_of(Method method);

/// A simple polygon with holes, which need not be convex: metres, scene frame, or as MissionFile::crs says.
struct TargetOutline {
  Zone::Ring outer;  ///< corners in order, either turn, the first one not repeated
  std::vector<Zone::Ring> holes = {};
  /// z of each corner, of `outer` and then of the holes: in one plane, to a millimetre. Empty: it is laid on the
  /// ground.
  std::vector<double> z_m = {};
};

/// A target that is given by an object of the map, a place on the earth or polygons. It is laid on the scene's ground:
/// in the plane nearest to the ground under it, raised until no ground under it lies above that.
struct GroundTarget {
  std::string osm;  ///< an area of the scene's map, "way/123" or its name; not convex: its convex parts; or
  std::optional<std::array<double, 2>> center_deg = std::nullopt;  ///< latitude and longitude (WGS 84) of a
                                                                   ///< rectangle's centre
  double width_m = 0, length_m = 0;                                ///< > 0; the length runs along the heading
  double heading_deg = 0;                                          ///< clockwise from north
  std::vector<TargetOutline> outlines = {};                        ///< or polygons; not convex: their convex parts
  double above_ground_m = 0;                                       ///< raised by so much along z
};

/// A target that a file has. An area: GeoJSON, KML or KMZ. Positions are WGS 84. Corners with heights lie at these
/// (docs: mission-file.md), others on the ground. Or a volume: a closed mesh, in the scene frame unless it says
/// where on the earth it lies.
struct TargetFile {
  std::filesystem::path file;  ///< absolute
  std::string name;            ///< as written in the mission, for messages
  std::string feature = {};    ///< name, id or number of what counts of the file; empty: all that it has, which is one
  bool is_volume = false;      ///< what becomes Target::volume
};

/// A target that is given by faces of objects of the scene (vantage/target.h): one of the first three says of which.
/// Where several faces are meant, all of them must be seen.
struct FaceTarget {
  std::string object;  ///< SceneObject::name, source_id or display_name of one or more objects; or
  std::string osm;     ///< an object of the scene's map, "way/123" or its name, with the parts of that building; or
  std::optional<std::array<double, 2>> at_deg = std::nullopt;  ///< latitude and longitude (WGS 84): the highest object
                                                               ///< there, but for the ground
  FaceKind kind = FaceKind::roof;
  std::optional<double> facing_deg = std::nullopt;  ///< only those that face that way: see facing()
  std::optional<Vec3> nearest = std::nullopt;       ///< only the one that is nearest to this point
};

/// What the volumes of several targets become.
enum class Combine {
  all,   ///< what sees all targets: the intersection
  any,   ///< what sees one of the targets, or more: the union
  each,  ///< a volume for each target
};

/// "all", "any", "each".
VANTAGE_API const char* name_of(Combine combine);

/// A target as a mission file gives it.
struct MissionTarget {
  Target target;  ///< with a `source` its name and offset count alone, and its front where that is a GroundTarget
  /// Where it lies in the scene, which resolve_mission finds out. Nothing: where `target` says.
  std::variant<std::monostate, GroundTarget, FaceTarget, TargetFile> source = {};
  bool both_sides = false;  ///< a position sees it that sees it from the front, or from the back
  std::string place = {};   ///< in the mission file; empty for a mission made in memory
};

/// One of known_cameras().
struct CameraModel {
  std::string name;
};

/// A field of view instead of a focal length.
struct CameraFov {
  std::array<double, 2> fov_deg{};  ///< horizontal and vertical
  int width_px = 0, height_px = 0;  ///< 0: not known
};

/// A camera as a mission file gives it: one of known_cameras(), its own numbers, or a field of view.
using CameraSource = std::variant<CameraModel, Camera, CameraFov>;

/// A moment, for the direction to the sun.
struct SunTime {
  std::string text;        ///< ISO 8601 with a zone: "2026-06-21T16:00Z", "2026-06-21T18:00+02:00"
  double unix_time_s = 0;  ///< of it: seconds since 1970-01-01 UTC
};

/// A pilot who must see the aircraft, instead of a range.
struct PilotSight {
  VisualRange range;        ///< says what sensor.max_range_m is
  double eye_height_m = 0;  ///< over the target, a point: resolve_mission raises it by this
};

/// What the vehicle of a flight must stay in sight of, as a pilot, or in reach of, as an antenna: as a mission file
/// gives it. One of the first two says where it is.
struct MissionLink {
  std::string name;
  std::optional<Vec3> position = std::nullopt;                 ///< metres, scene frame, or as MissionFile::crs says; or
  std::optional<std::array<double, 2>> at_deg = std::nullopt;  ///< latitude and longitude (WGS 84), on the ground
  double height_m = 0;                                         ///< so much above that
  std::optional<double> max_range_m = std::nullopt;            ///< nothing: as far as it is free
  std::optional<PilotSight> vlos = std::nullopt;               ///< says what max_range_m is
  std::optional<RadioLink> radio = std::nullopt;               ///< the zone that must be clear too
  std::string place = {};                                      ///< in the mission file
};

/// The same in the scene frame: from one point to the vehicle.
struct FlightLink {
  std::string name;
  Vec3 point = Vec3::Zero();
  std::optional<double> max_range_m = std::nullopt;  ///< nothing: as far as it is free
  std::optional<RadioLink> radio = std::nullopt;     ///< nothing: the line of sight alone must be free
};

/// A mesh to stay in, as a mission file names it.
struct NavigationMeshFile {
  std::filesystem::path file;  ///< absolute
  std::string name;            ///< as written in the mission; in causes and messages
  /// Of the file. Where they are not given: an OBJ says it itself or has those of the scene's file, and other formats
  /// are in the scene frame.
  std::optional<UpAxis> up = std::nullopt;
  std::optional<double> scale = std::nullopt;
};

/// What heights above the ground are measured from, as a mission file names it: one of the two. An object does not
/// count as an obstacle either.
struct GroundSource {
  std::optional<double> plane_z_m = std::nullopt;  ///< the ground is flat and lies at this z
  std::string object = {};                         ///< display name, name or source_id of an object of the scene
};

/// A file of zones, as a mission file names it: GeoJSON, also of UAS zones (ED-269, ED-318), KML, or a plan of
/// QGroundControl or .waypoints, of which the fences count. Positions are WGS 84.
struct ZoneFile {
  std::filesystem::path file;                                 ///< absolute
  std::string name;                                           ///< as written in the mission; in causes and messages
  std::optional<std::array<double, 2>> z_m = std::nullopt;    ///< of zones that the file gives no heights for
  std::optional<std::array<double, 2>> agl_m = std::nullopt;  ///< likewise, above the ground
  bool any_height = false;                                    ///< without bounds, whatever the file says
  bool skip = false;  ///< areas that cannot be read are left out, and a note names them; else they are an error
};

/// Where in a mission file things are said ("mission.yaml:9:13"), for messages. Empty for a mission made in memory.
struct MissionPlaces {
  std::string scene, terrain, target, sensor, above_ground, tour;
  std::vector<std::string> navigation_meshes;
  std::vector<std::string> keep_in_zones, keep_out_zones, keep_in_files, keep_out_files;
};

/// What a mission file says, checked by itself: no other file has been opened.
struct MissionFile {
  std::filesystem::path file;  ///< for messages and reports
  SceneSource scene;           ///< paths are absolute

  /// Of the coordinates of the target and of the boxes and zones ("EPSG:4326": longitude, latitude, z); empty: the
  /// scene frame.
  std::string crs = {};
  std::vector<MissionTarget> targets{MissionTarget{}};  ///< one or more
  bool is_list = false;                                 ///< the one is written as a list of one, 'targets'
  Combine combine = Combine::all;                       ///< the targets, or the faces that the one means
  Sensor sensor;
  std::optional<CameraSource> camera = std::nullopt;  ///< says what sensor.camera is
  std::optional<PilotSight> vlos = std::nullopt;      ///< visual line of sight
  std::optional<SunTime> sun_time = std::nullopt;     ///< says where the sun stands, once the scene is known; without
                                                      ///< it sensor.sun has the direction
  Navigation navigation;                              ///< without meshes, the zones of files, ground and obstacles
  std::optional<GroundSource> ground = std::nullopt;  ///< without it the scene's
  std::vector<NavigationMeshFile> navigation_meshes = {};
  std::vector<ZoneFile> keep_in_files = {}, keep_out_files = {};  ///< their zones go with those of `navigation`
  std::optional<double> sea_level_m = std::nullopt;               ///< scene z of the mean sea level, where it is known
  Method method = Method::exact;
  /// But for the threads: RunOptions::threads. With the method of spheres the work limit counts where parts or targets
  /// are combined and for the limits, not for the spheres.
  ExactOptions exact;
  SpheresOptions spheres;  ///< likewise
  /// Of a flight that sees the targets, each by itself whatever `combine` says. Volumes do not depend on it.
  std::optional<TourSettings> tour = std::nullopt;
  /// What flights must keep everywhere. Volumes do not depend on it.
  std::vector<MissionLink> links = {};
  MissionPlaces places = {};

  /// Whether there are several targets, or one in a list: flights view each by itself.
  bool lists_targets() const { return is_list || targets.size() > 1; }
};

/// Throws Error(input) with file, line and column for: a missing or unreadable file, YAML that does not parse, an
/// unknown key (with the nearest known one), a wrong type, a number that is NaN or infinite, a missing required key,
/// edges that do not describe the vertices' polygon, a file that it names and that is not there, and all that
/// make_target_frame and the navigation checks refuse.
VANTAGE_API MissionFile read_mission(const std::filesystem::path& file);

/// The same of a mission file's text, which came from elsewhere. `file` stands for it in messages and reports; paths in
/// the text start from its folder, the current one where it has none.
VANTAGE_API MissionFile read_mission_text(std::string_view text, const std::filesystem::path& file);
/// The same of a text without `scene`, for a scene that is loaded already. `source`: what it was loaded from, whose
/// files are not looked at; of a scene that was made in memory a SceneSource without a file.
VANTAGE_API MissionFile read_mission_text(std::string_view text, const std::filesystem::path& file,
                                          const SceneSource& source);

/// The same of a text from somebody who may name the files that `opened` names, and no others, as a page that shows
/// that mission. Names are compared as they are written; the disk is not asked about another one. Nor may `crs` be any
/// text, since PROJ opens the files that some name: it is that of `opened`, or a code of an authority ("EPSG:4326").
/// Throws Error(not_applicable) for others.
VANTAGE_API MissionFile read_mission_text(std::string_view text, const std::filesystem::path& file,
                                          const SceneSource& source, const MissionFile& opened);

/// The `scene` of a mission alone: of a text without anything else. All but MissionFile::scene and sea_level_m stays as
/// it is by default.
VANTAGE_API MissionFile read_scene_text(std::string_view text, const std::filesystem::path& file);

/// The text of a mission file that reads back as the same mission. Paths below `folder`, where the text is to be
/// written, are relative to it.
VANTAGE_API std::string mission_text(const MissionFile& mission, const std::filesystem::path& folder);

/// The files that a mission was read from, and those it names: not to be overwritten by its results.
VANTAGE_API std::vector<std::filesystem::path> input_files(const MissionFile& mission);

/// A mission in its scene: everything is in the scene frame.
struct Mission {
  MissionFile as_written;
  /// The scene, and what reading or building it told; never null. Shared by the missions that are resolved in it.
  std::shared_ptr<const LoadedScene> loaded = std::make_shared<const LoadedScene>();
  Target target;  ///< what must be seen. With `views` all that is in them, for pictures and messages
  /// Where more than `target` is asked: a position of the volume sees, of each list, one target whole or more. With
  /// Combine::each there is a volume for each list. Empty: the target.
  std::vector<std::vector<Target>> views = {};
  Sensor sensor;
  Navigation navigation;
  double read_seconds = 0;                  ///< that reading and resolving took
  std::vector<Warning> notes = {};          ///< what resolving changed or left out
  std::optional<Vec3> home = std::nullopt;  ///< of the tour, where the mission file gives one
  std::vector<FlightLink> links = {};       ///< what flights must stay in sight or in reach of

  const Scene& scene() const { return loaded->scene; }
};

/// Reads the mission's scene, and puts what the mission gives on the earth or by name into its frame. Boxes lie askew
/// in the frame: a box to stay in becomes the largest one of the frame inside it, a box to stay out of the smallest
/// round it. Zones are moved corner by corner; their sides, which curve in the frame, are cut so short that a zone to
/// stay in loses, and a zone to stay out of gains, no more than a few millimetres. Navigation meshes that say where on
/// the earth they lie are moved there, where the scene says so too. A target of the map without a name of its own gets
/// the object's. Ground that ends under a target that is laid on it is extended: flat ground as it is, a map's terrain
/// by building more of it (Mission::notes).
///
/// Throws as load_scene does, and Error(input) with the place in the mission file for: a scene that does not say where
/// on the earth it lies, a position without a value, an object that the map or the scene does not have, or that has no
/// such face, a target farther off the ground than max_range or beyond ground that cannot be extended, a limit above
/// the ground in a scene that does not say what of it is ground, a navigation mesh whose heights are measured from
/// another level than the scene's, and all that make_target_frame refuses.
VANTAGE_API Mission resolve_mission(const MissionFile& mission, const Progress& progress = {});
/// The same in a scene that is loaded already. Where its ground has to be extended, Mission::loaded is another one.
VANTAGE_API Mission resolve_mission(const MissionFile& mission, std::shared_ptr<const LoadedScene> loaded,
                                    const Progress& progress = {});

/// Scene z of the mean sea level: what the mission says (scene.sea_level), or 0 where the heights of the scene have a
/// known zero (docs/mission-file.md). Nothing where neither says.
VANTAGE_API std::optional<double> sea_level_m(const Mission& mission);

/// The ground that heights of the mission are measured from: what navigation.ground names, or else the scene's. Throws
/// Error(input), with the place in the mission file, for a scene that does not say what of it is ground.
VANTAGE_API Ground ground_of(const Mission& mission);

/// How many volumes a mission has: one, but with Combine::each as many as there are targets.
VANTAGE_API std::size_t volume_count(const Mission& mission);

/// The mission of one of its volumes, as if there were no others: it has the hash of a mission of that target alone.
/// Throws Error(input) for an index out of range.
VANTAGE_API Mission one_volume(const Mission& mission, std::size_t index);

/// What to know before relying on the mission's results: Mission::notes; that map, raster or
/// ground end within the range, where what would hide part of the target is missing; that a target looks as if it were
/// given in degrees, lies far off the scene or is looked at from under the ground; that the scene seems to lie on its
/// side. `volume`: the mission's, where there is one. Cost: linear in the scene's triangles
/// the first time, then a small part of that.
VANTAGE_API std::vector<Warning> mission_warnings(const Mission& mission, const Volume* volume = nullptr);

struct RunOptions {
  int threads = 0;        ///< at most; 0: as many as the machine has
  StageSink stages = {};  ///< those of the spheres method
  /// The mission's scene (Mission::scene), where it is prepared already, and its scene_hash: to run many missions in
  /// one scene. What is not given is made anew in each run. Nothing tests that they are of this scene: with another
  /// one the volume claims what this scene hides.
  std::optional<PreparedScene> prepared = {};
  std::string scene_hash = {};
  /// For runs of a mission that changes a little from one to the next, as while it is edited: what is kept of the last
  /// one. It changes the time alone.
  std::shared_ptr<KeptVolumes> kept = {};
};

struct Result {
  Volume volume;                         ///< its notes hold mission_warnings too
  SceneStatistics scene;                 ///< what preparing found
  std::optional<SpheresReport> spheres;  ///< what the spheres method did, where it was used
};

/// Prepares the scene once, then each target, computes and cuts to the limits: a result for each volume, in the order
/// of the targets. Several are computed at once. A target that cannot be seen as it lies stops all: throws as
/// run_mission.
VANTAGE_API std::vector<Result> run_missions(const Mission& mission, const RunOptions& options = {},
                                             const Progress& progress = {});

/// What came of one of several targets: one of the two.
struct Attempt {
  std::optional<Result> result = {};
  std::optional<Error> error = {};
};

/// The same, but what is wrong with one target does not stop the others: that it cannot be seen as it lies, is too
/// large for the tolerance, or that its volume takes more work than ExactOptions::work_limit. Other errors do, before
/// any volume is computed where they are of the sensor or the navigation limits.
VANTAGE_API std::vector<Attempt> try_missions(const Mission& mission, const RunOptions& options = {},
                                              const Progress& progress = {});

/// Of a mission of one volume. Prepares the scene and the target, computes, and cuts to the navigation limits. Throws
/// as the method, PreparedTarget and cut_to_navigation do, with the place in the mission file put in front of errors
/// about the target. Cost: the sum of theirs; unless it is given, the scene is prepared anew each time.
VANTAGE_API Result run_mission(const Mission& mission, const RunOptions& options = {}, const Progress& progress = {});

/// The same of a target that is prepared already, by prepare_target of this mission: to compute and query without
/// preparing twice. Seconds::prepare is 0. Not of a mission with `views`.
VANTAGE_API Result run_mission(const Mission& mission, const PreparedTarget& target, const RunOptions& options = {},
                               const Progress& progress = {});

/// SHA-256 of what is asked, in the scene frame: docs/hashes.md. 64 hexadecimal digits.
VANTAGE_API std::string mission_hash(const Mission& mission);

/// PreparedTarget of a mission; errors about the target begin with its place in the mission file, and advise what fits
/// the object that stands in the way. `scene`: the mission's.
VANTAGE_API PreparedTarget prepare_target(const Mission& mission, const PreparedScene& scene);

/// The targets of all `views`, prepared, list by list; without views the one target, in a list alone. Throws likewise.
VANTAGE_API std::vector<std::vector<PreparedTarget>> prepare_views(const Mission& mission, const PreparedScene& scene);

}  // namespace vantage
