// The orientation from which a target is taken in from nearest by.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "sensor/aim.h"
#include "sensor/rise.h"
#include "vantage/export.h"
#include "vantage/geometry.h"

namespace vantage::internal::sensor {

/// How near a camera with one orientation may come: along a direction d from c, a point among the corners, the target
/// is in the picture from where all four edges have let it in, at the largest need[k] / approach_k(d) with
/// approach_k(d) = -edges[k] . d.
struct AimedView {
  Aim aim;
  PictureEdges edges = {Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
  std::array<double, 4> need{};  ///< how far c is inside of each edge's plane when a corner touches it; > 0

  double approach(std::size_t edge, const Vec3& direction) const { return -edges[edge].dot(direction); }
  /// Infinite where the direction is not in the picture. `slack`: by how much farther inside all must be, per edge.
  double distance(const Vec3& direction, const std::array<double, 4>& slack = {}) const;
};

class AimFinder {
 public:
  /// `corners`: about c. `least`: needs are at the least this long.
  AimFinder(const std::vector<Vec3>& corners, const Pinhole& camera, const Mount& mount, double least);

  AimedView view(const Aim& aim) const;
  /// With the orientation that the mount allows next to the given one.
  AimedView next_to(const Aim& aim) const;
  /// For the viewpoints along a direction of unit length: an allowed orientation that is good, maybe not the best.
  /// `near`: what is found near that one, as good for the direction or better.
  AimedView best(const Vec3& direction, const std::optional<Aim>& near = {}) const;
  bool is_at_limit(const Aim& aim) const;

 private:
  using PerEdge = std::array<double, 4>;

  Aim allowed(Aim aim) const;
  PerEdge across_edges(const PictureAxes& axes, const Vec3& place) const;
  double nearness(const Aim& aim, const Vec3& direction) const;
  void nearness_planes(const Aim& aim, const Vec3& direction, std::vector<Plane2>& planes) const;
  Aim climbed(Aim aim, const Vec3& direction, double first_turn) const;

  const std::vector<Vec3>& corners_;
  Pinhole camera_;
  Angle roll_;
  double min_pitch_ = 0, max_pitch_ = 0;
  std::optional<double> yaw_;
  double least_;
};

}  // namespace vantage::internal::sensor
