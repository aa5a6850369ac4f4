// The ground under a straight line.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/triangle_tree.h"
#include "vantage/ground.h"

namespace vantage::internal::flight::plans {

/// A point of a polyline over a line: `share` 0 is its beginning, 1 its end; z in metres.
struct ProfilePoint {
  double share, z_m;
};

class GroundProfile {
 public:
  /// Refers to the ground's triangles, which must outlive it. Cost: O(n log n).
  explicit GroundProfile(const Ground& ground);

  /// z of the highest piece of ground along a line in plan, exact but for rounding: a corner where the ground bends,
  /// two with one share where it jumps. Where pieces that lie over each other cross between corners, it is above both.
  /// Empty where a part of the line longer than a micrometre has no ground below it.
  std::vector<ProfilePoint> along(const Eigen::Vector2d& from, const Eigen::Vector2d& to) const;

 private:
  struct Piece {
    double begin, end, z_begin, z_end;

    double z_at(double share) const {
      return end > begin ? z_begin + (z_end - z_begin) * (share - begin) / (end - begin) : z_begin;
    }
  };
  static std::vector<double> corners_of(const std::vector<Piece>& pieces, double gap);
  std::optional<Piece> piece(std::uint32_t triangle, const Eigen::Vector2d& from, const Eigen::Vector2d& along) const;

  double plane_z_m_;
  const Mesh* surface_;  ///< none: a plane
  std::optional<core::TriangleTree> tree_;
};

/// Fewer points, with each of those left out within `error_m` above or below the line between its neighbours
/// (Douglas and Peucker 1973, by vertical distance). The first and the last one stay.
std::vector<ProfilePoint> thinned(const std::vector<ProfilePoint>& points, double error_m);

}  // namespace vantage::internal::flight::plans
