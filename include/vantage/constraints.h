// What the sensor can do and where the vehicle may fly.
#pragma once

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

/// Where the vehicle may fly: the intersection of all that is given. Empty: everywhere.
struct Navigation {
  struct Altitude {
    double min_m = 0.0, max_m = 0.0;  ///< scene z, min < max
  };
  std::optional<Altitude> altitude;
  std::vector<Box> keep_in;        ///< the volume is cut to their union
  std::vector<Box> keep_out;       ///< each is taken away
  std::vector<KeepInMesh> meshes;  ///< the volume is cut to each

  /// How far a viewpoint is above the ground at its x and y. Where pieces of ground lie over each other there, it is
  /// that far above each of them. Where there is no ground, nothing is allowed.
  struct AboveGround {
    double min_m = 0.0, max_m = 0.0;  ///< min < max
    Ground ground;
  };
  std::optional<AboveGround> above_ground = {};

  bool empty() const { return !altitude && keep_in.empty() && keep_out.empty() && meshes.empty() && !above_ground; }
};

}  // namespace vantage
