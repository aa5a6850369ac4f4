// What a position is worth as a place to look at a target from: where it lies, how to aim, how well it sees.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "vantage/export.h"
#include "vantage/geometry.h"
#include "vantage/mission.h"

namespace vantage {

/// A position and the view from it. What is not known has no value.
struct ViewDescription {
  Vec3 position = Vec3::Zero();  ///< scene frame, metres
  /// WGS 84; of a scene that says where on the earth it lies.
  std::optional<double> longitude_deg = std::nullopt, latitude_deg = std::nullopt;
  std::optional<double> above_ground_m = std::nullopt;  ///< over the highest ground straight above or below
  std::optional<double> above_sea_m = std::nullopt;     ///< over mean sea level, where sea_level_m() knows it

  double yaw_deg = 0;    ///< of the camera: clockwise from +y of the scene (north), in [0, 360)
  double pitch_deg = 0;  ///< 0 is level, -90 straight down
  /// Whether they are those to the target's centre. Else the mount does not allow these, or they leave a part of the
  /// target out of the picture: the given ones have all of it in, with the most room at its edges, where any do.
  bool is_centred = true;

  double distance_m = 0;                               ///< to the target's centre
  std::optional<double> pixel_m = std::nullopt;        ///< on the target, the largest: see ViewDescriber
  std::optional<double> incidence_deg = std::nullopt;  ///< between a normal and the line to the position, the largest
  std::optional<double> obstacle_distance_m = std::nullopt;  ///< to the nearest obstacle of the scene
  std::string obstacle = {};                                 ///< its display_name; may be empty
};

/// Describes positions for the target of a mission. Cheap to copy (a shared handle); any number of threads may use one.
///
/// The target's centre is that of its smallest enclosing circle; of a target in parts, and of several targets, the
/// middle of the box of all corners. The size of a pixel and the incidence are the worst over all points of the target;
/// where one of several targets is enough (Mission::views), of the one that has the best. The size of a pixel is that
/// of the mission's PixelLimit::Kind, or else PixelLimit::Kind::worst, and needs a camera whose pixels are known.
/// Targets count as given: the lift, 2 mm at most, is left out.
///
/// Obstacles are all objects but the ground, as with Clearance; where a scene has nothing else, all of it.
class VANTAGE_API ViewDescriber {
 public:
  /// Cost: O(n log n) in the scene's triangles. Throws Error(input) for a mission of several volumes (see one_volume).
  explicit ViewDescriber(const Mission& mission);
  /// The same for a mission in the same scene, with the same ground: what was made of these is shared. Cost: small.
  ViewDescriber(const Mission& mission, const ViewDescriber& other);

  /// Distances are right to some 1e-15 of the scene's size. Throws Error(input) for a point that is not finite. Cost:
  /// some microseconds.
  ViewDescription describe(const Vec3& position) const;

  struct Data;
  const Data& data() const { return *data_; }  ///< for searches

 private:
  std::shared_ptr<const Data> data_;
};

}  // namespace vantage
