// Mission files: docs/mission-file.md.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "vantage/constraints.h"
#include "vantage/scene.h"
#include "vantage/scene_source.h"
#include "vantage/spheres.h"
#include "vantage/target.h"
#include "vantage/volume.h"

namespace vantage {

/// How the volume is computed.
enum class Method {
  exact,    ///< compute_visibility
  spheres,  ///< compute_visibility_spheres
};

/// A target by what people know. It is laid on the scene's ground: in the plane nearest to the ground under it, raised
/// until no ground under it lies above that.
struct GroundTarget {
  std::string osm;  ///< an area of the scene's map, "way/123"; not convex: its convex parts; or
  std::optional<std::array<double, 2>> center_deg;  ///< latitude and longitude (WGS 84) of a rectangle's centre
  double width_m = 0, length_m = 0;                 ///< > 0; the length runs along the heading
  double heading_deg = 0;                           ///< clockwise from north
};

/// Where a navigation mesh was read from, and what read_mission_scene has still to settle about it.
struct NavigationFile {
  std::filesystem::path path;
  std::string place;           ///< "mission.yaml:9:13", for messages
  bool in_scene_axes = false;  ///< the mesh is in the axes of the scene's file, which is not read yet: OBJ
  bool in_scene_unit = false;  ///< likewise
  std::optional<Georeference> georeference;  ///< of the frame that it is in, as its file says
};

/// A mission file, read and checked. Paths are absolute; navigation meshes are read.
struct Mission {
  std::filesystem::path file;
  SceneSource scene;
  Target target;
  std::vector<Target> other_parts;  ///< of a target that is not convex: the volume is that of all parts together

  /// What read_mission_scene resolves. Until then the coordinates of the target and of the boxes are in this reference
  /// system ("EPSG:4326": longitude, latitude, z); empty: the scene frame. With a GroundTarget the target is not there.
  std::string crs;
  std::optional<GroundTarget> ground_target;

  Sensor sensor;
  Navigation navigation;
  Method method = Method::exact;
  ExactOptions exact;
  SpheresOptions spheres;                        ///< but for the threads: those of `exact` count for both methods
  std::vector<NavigationFile> navigation_files;  ///< of navigation.meshes, in the same order
  std::string target_place;  ///< "mission.yaml:9:13": put in front of the place in errors about the target
};

/// Throws Error(input) with file, line and column for: a missing or unreadable file, YAML that does not parse, an
/// unknown key (with the nearest known one), a wrong type, a number that is NaN or infinite, a missing required key,
/// edges that do not describe the vertices' polygon, and all that make_target_frame and the navigation checks refuse.
Mission read_mission(const std::filesystem::path& file);

/// The same of a mission file's text, which came from elsewhere. `file` stands for it in messages and reports; paths in
/// the text start from its folder, the current one where it has none.
Mission read_mission_text(std::string_view text, const std::filesystem::path& file);

/// Reads the mission's scene, and puts what the mission gives on the earth or by name into its frame: afterwards `crs`
/// and `ground_target` are empty, `target`, `other_parts` and the boxes complete. Boxes lie askew in the frame: a box
/// to stay in becomes the largest one of the frame inside it, a box to stay out of the smallest round it. Navigation
/// meshes in OBJ take the axes and the unit of the scene's file; those that say where on the earth they lie are moved
/// there, where the scene says so too. A target of the map without a name of its own gets the object's. Ground that
/// ends under a target that is laid on it is extended: flat ground as it is, a map's terrain by building more of it
/// (LoadedScene::notes). Throws as load_scene does, and Error(input) with the place in the mission file for: a scene
/// that does not say where on the earth it lies, a position without a value, an object that the map does not have, a
/// target farther off the ground than max_range or beyond ground that cannot be extended, a navigation mesh whose
/// heights are measured from another level than the scene's, and all that make_target_frame refuses.
LoadedScene read_mission_scene(Mission& mission, const Progress& progress = {});

/// All that `vantage compute` does but writing: reads the scene, prepares it, computes, cuts. Fills Volume::seconds.
/// Uses at most `mission.exact.threads` threads for all of it. Throws as read_scene, the method and
/// cut_to_navigation do, with the place in the mission file put in front of errors about the target. Cost: the sum of
/// theirs; the scene is read and prepared anew each time, so use those functions for many targets of one scene.
Volume compute_mission(const Mission& mission, const Progress& progress = {});

}  // namespace vantage
