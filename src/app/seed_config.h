// Configuration files of the program published with the seed paper: docs/seed-config.md.
#pragma once

#include <filesystem>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "vantage/geometry.h"
#include "vantage/scene.h"

namespace vantage::app {

/// A block `mesh`. A vertex v of the file is position + rotation * (scale .* v) in the world.
struct SeedMesh {
  std::filesystem::path file;  ///< absolute
  std::string name;            ///< as written in the file
  std::string where;           ///< "config.yaml:12:13", of the file name
  Vec3 position = Vec3::Zero();
  Vec3 scale = Vec3::Ones();
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
};

/// A block `visibility_vol`. Vectors are in world axes, lengths in metres.
struct SeedVolume {
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

struct SeedConfig {
  std::filesystem::path file;         ///< absolute
  UpAxis up = UpAxis::y;              ///< of the world
  std::vector<SeedMesh> meshes;       ///< at least one
  std::vector<SeedVolume> volumes;    ///< at least one; no two have the same output
  std::vector<std::string> warnings;  ///< keys that mean nothing here, each with its place
};

/// Parses and checks the text of a configuration file. `file` gives the folder that relative paths start from and the
/// name in messages; neither it nor what it names is opened. Throws Error(input) with file, line and column.
SeedConfig parse_seed_config(std::string_view text, const std::filesystem::path& file);

/// Reads a configuration file, and checks that the meshes that it names can be read.
SeedConfig read_seed_config(const std::filesystem::path& file);

}  // namespace vantage::app
