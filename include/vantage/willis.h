// Configuration files of the program published with Willis, Hague, Wolek, Brink, "GPU-Accelerated 3D Polygon Visibility
// Volumes", 2024: docs/willis-config.md.
#pragma once

#include <filesystem>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "vantage/devices.h"
#include "vantage/export.h"
#include "vantage/geometry.h"
#include "vantage/progress.h"
#include "vantage/scene.h"
#include "vantage/spheres.h"
#include "vantage/volume.h"

namespace vantage {

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
