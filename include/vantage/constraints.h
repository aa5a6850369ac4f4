// What the sensor can do and where the vehicle may fly.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "vantage/geometry.h"
#include "vantage/ground.h"
#include "vantage/sensor.h"

namespace vantage {

/// A closed mesh to stay in.
struct KeepInMesh {
  Mesh mesh;         ///< closed, outward oriented, free of self-intersections; scene frame, metres
  std::string name;  ///< for messages and for causes in reports
};

/// What lies straight above and below a polygon, between two heights.
struct Zone {
  using Ring = std::vector<Eigen::Vector2d>;

  /// Scene frame, x and y, metres: 3 corners or more, either turn, the first one not repeated. No side may cross or
  /// touch another one, of the same ring or of another; the sides of `holes` lie inside `outer`, and in no other hole.
  /// At most kMostCorners in all.
  Ring outer;
  std::vector<Ring> holes;
  double min_z_m = -std::numeric_limits<double>::infinity();  ///< scene z; infinite: without bound
  double max_z_m = std::numeric_limits<double>::infinity();   ///< likewise; above min_z_m
  std::string name;                                           ///< for messages and for causes in reports

  static constexpr std::size_t kMostCorners = 20'000;
};

/// Where the vehicle may fly: the intersection of all that is given. Empty: everywhere. The borders of limits belong to
/// what is allowed.
struct Navigation {
  struct Altitude {
    double min_m = 0.0, max_m = 0.0;  ///< scene z, min < max
  };
  std::optional<Altitude> altitude;
  std::vector<Box> keep_in;          ///< the volume is cut to their union, with that of `keep_in_zones`
  std::vector<Zone> keep_in_zones;   ///< likewise
  std::vector<Box> keep_out;         ///< each is taken away
  std::vector<Zone> keep_out_zones;  ///< likewise
  std::vector<KeepInMesh> meshes;    ///< the volume is cut to each

  /// How far a viewpoint is above the ground at its x and y. Where pieces of ground lie over each other there, it is
  /// that far above each of them. Where there is no ground, nothing is allowed.
  struct AboveGround {
    double min_m = 0.0, max_m = 0.0;  ///< min < max
    Ground ground;
  };
  std::optional<AboveGround> above_ground = {};

  bool empty() const {
    return !altitude && keep_in.empty() && keep_in_zones.empty() && keep_out.empty() && keep_out_zones.empty() &&
           meshes.empty() && !above_ground;
  }
};

}  // namespace vantage
