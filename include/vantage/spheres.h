// The method of visibility spheres: depth cube maps of the target's vertices, intersected (docs/spheres.md). After
// Willis, Hague, Wolek, Brink, "GPU-Accelerated 3D Polygon Visibility Volumes", 2024.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "vantage/devices.h"
#include "vantage/export.h"
#include "vantage/geometry.h"
#include "vantage/georeference.h"
#include "vantage/navigation.h"
#include "vantage/progress.h"
#include "vantage/scene.h"
#include "vantage/target.h"
#include "vantage/volume.h"

namespace vantage {

struct SpheresOptions {
  enum class Sphere {
    conservative,  ///< each sphere lies inside what its vertex truly sees: nearest depth over each texel's footprint
    centers,       ///< joins texel centres, as the paper does: over-claims at silhouettes
  };
  enum class Split {
    euler,   ///< Algorithm 1: an edge is split while its pair intersection is not a topological sphere
    always,  ///< every edge is split `max_splits` times, whatever the test says: for measuring
  };
  Sphere sphere = Sphere::conservative;
  int cubemap = 200;                             ///< texels along a face's side, 1 to 8192
  std::optional<std::array<int, 2>> resolution;  ///< instead of the cube map's grid: samples in longitude and latitude
  /// Facets of the cube map's grid are joined where that moves them by no more than this part of their distance from
  /// the viewpoint (never outwards with `conservative`), 0 to 0.05: booleans take far less time. 0: none are joined.
  double merge = 2.5e-4;
  Split split = Split::euler;
  int max_splits = 6;       ///< how often an edge may be halved, 0 to 16
  double min_edge_m = 0.5;  ///< an edge is not split into halves shorter than this; > 0
  DeviceChoice device;
  int threads = 0;  ///< 0: as many as the machine has
};

/// A step of Algorithm 1, for those who watch or write it down (`--stages`).
struct SphereStage {
  enum class Kind { sphere, pair, split, partial, result };
  Kind kind = Kind::sphere;
  std::string name;            ///< "sphere 0", "pair 0-1", "split 0-1", "partial 2", "result"
  std::vector<Vec3> points;    ///< the vertex of a sphere, the ends of a pair, the ends and the midpoint of a split
  const Mesh* mesh = nullptr;  ///< scene frame, closed, possibly empty; null for a split. Valid during the call only
  long euler = 0;              ///< V - E + F, of `mesh`
  std::vector<long> component_euler;  ///< of each of its pieces
  double volume_m3 = 0;
  double seconds = 0;                        ///< that this step took
  std::optional<Georeference> georeference;  ///< of the scene; a mission's run fills it in
};
using StageSink = std::function<void(const SphereStage& stage)>;

/// What the run did, beyond the volume.
struct SpheresReport {
  RenderDevice device;
  std::string device_note;           ///< why the CPU is used instead of a graphics processor; may be empty
  std::size_t spheres = 0;           ///< visibility spheres made
  std::size_t pairs = 0;             ///< pair intersections tested
  std::size_t splits = 0;            ///< edges halved
  std::size_t unresolved_pairs = 0;  ///< pairs still no topological sphere where splitting had to end
  double render_seconds = 0;         ///< depth images, reading back, tessellation
  double boolean_seconds = 0;
};

/// The volume of the spheres method, before navigation cuts: what lies on the target's front, in the intersection of
/// the visibility spheres of the target's vertices and of the points where Algorithm 1 halved an edge. What hides part
/// of the target between those points is not seen: unlike compute_visibility this may claim too much, whatever the
/// resolution. The intersection may have several pieces; each is closed. A target of a single vertex is one sphere.
/// Volume::counts stays empty but for scene_polygons. Causes name the scene as a whole: depth images know no objects.
///
/// Errors as compute_visibility, and Error(input) for options out of range, a device that was insisted on and is not
/// there, a sensor with a VisibleShare. Cost: one depth image of six faces per vertex, and booleans of meshes of at
/// most 12 cubemap^2 triangles, a tenth to a third of them where facets are joined.
VANTAGE_API Volume compute_visibility_spheres(const PreparedTarget& target, const SpheresOptions& options = {},
                                              SpheresReport* report = nullptr, const StageSink& stages = {},
                                              const Progress& progress = {});

/// The visibility sphere of one viewpoint (scene frame): closed, genus 0, star-shaped about it, within `radius_m`.
VANTAGE_API Mesh visibility_sphere(const PreparedScene& scene, const Vec3& viewpoint, double radius_m,
                                   const SpheresOptions& options = {}, const Progress& progress = {});

/// Lets missions use `method: spheres`, which is in the library vantage_picture. A program calls it once, when it
/// starts, before missions are run. Any number of times, from any thread.
VANTAGE_API void enable_spheres();

// ---- Configuration files of the program of that paper: docs/willis-config.md

/// A block `mesh`. A vertex v of the file is position + rotation * (scale .* v) in the world.
struct WillisMesh {
  std::filesystem::path file;  ///< absolute
  std::string name;            ///< as written in the file
  std::string where;           ///< "config.yaml:12:13", of the file name
  Vec3 position = Vec3::Zero();
  Vec3 scale = Vec3::Ones();
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
};

/// A block `visibility_vol`. Vectors are in world axes, lengths in metres.
struct WillisVolume {
  std::string name;                                          ///< "volume 2", by its `id`, or by its place in the file
  int texels = 0;                                            ///< along a face's side: `width` and `height`
  Vec3 origin = Vec3::Zero();                                ///< the viewpoint
  Vec3 front = Vec3::UnitX(), up = Vec3::UnitY();            ///< of the cube: of length 1, at right angles
  double up_min = -std::numeric_limits<double>::infinity();  ///< heights are along `up`, from the world's origin
  double up_max = std::numeric_limits<double>::infinity();
  double radius_max = std::numeric_limits<double>::infinity();
  std::filesystem::path output;  ///< absolute
  std::string output_name;       ///< as written in the file
  std::string where;             ///< "config.yaml:20:11", of the viewpoint
  std::string output_where;
};

struct WillisConfig {
  std::filesystem::path file;         ///< absolute
  UpAxis up = UpAxis::y;              ///< of the world
  std::vector<WillisMesh> meshes;     ///< at least one
  std::vector<WillisVolume> volumes;  ///< at least one; no two have the same output
  std::vector<std::string> warnings;  ///< keys that mean nothing here, each with its place
};

/// Parses and checks the text of a configuration file. `file` gives the folder that relative paths start from and the
/// name in messages; neither it nor what it names is opened. Throws Error(input) with file, line and column.
VANTAGE_API WillisConfig parse_willis_config(std::string_view text, const std::filesystem::path& file);

/// Reads a configuration file, and checks that the meshes that it names can be read.
VANTAGE_API WillisConfig read_willis_config(const std::filesystem::path& file);

struct WillisResult {
  Volume volume;  ///< scene frame; causes: the scene, radius_max, up_min, up_max
  MeshMeasures measures;
  double seconds = 0;  ///< of this volume
};

struct WillisRun {
  std::vector<WillisResult> results;  ///< in the configuration's order
  RenderDevice device;
  std::string device_note;  ///< why it is not the device that one would hope for; may be empty
};

/// The volumes of a configuration. `options` gives the sphere, the device and the threads.
///
/// What the limits up_min and up_max cut away depends on the sphere. `centers` moves a vertex beyond a limit along `up`
/// onto it, as the published program does, which may claim what is not seen; `conservative` moves it towards the
/// viewpoint, which never does. Without radius_max a ray that meets nothing ends at the farthest corner of the scene's
/// bounding box.
///
/// Throws Error(input) as read_scene and visibility_sphere do, and for a viewpoint on a surface or inside a solid, with
/// the place in the file put in front.
VANTAGE_API WillisRun run_willis_config(const WillisConfig& config, const SpheresOptions& options,
                                        const Progress& progress = {});

}  // namespace vantage
