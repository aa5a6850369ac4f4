// Boxes and zones to stay in or out of: what lies straight above and below a polygon, between two heights.
#pragma once

#include <optional>
#include <vector>

#include "prove/convex_polygon.h"
#include "vantage/navigation.h"

namespace vantage::internal::prove {

/// Positions are relative to an origin. Its heights may be infinite.
class Prism {
 public:
  /// The prism of a zone, but for its heights above ground that is no plane.
  Prism(const Zone& zone, const Vec3& origin);

  double low() const { return low_; }
  double high() const { return high_; }
  const Box& box() const { return box_; }

  /// By how much numbers can be wrong about which side of it a point lies on: corners may be far away.
  double rounding_m() const { return rounding_m_; }

  /// Metres to its nearest side, in plan; negative outside.
  double depth_in_plan(const Vec3& point) const;
  bool holds_in_plan(const Vec3& point) const;

  /// Metres to its nearest face; negative outside: minus the distance.
  double depth(const Vec3& point) const;

  /// The parts of a polygon outside of it and inside, in convex pieces. Its heights count as moved out by `grown`,
  /// which may be negative. What is nearer than `plate` to a side, within these heights, is in neither.
  struct Parts {
    std::vector<ConvexPolygon> outside, inside;
  };
  Parts divide(const ConvexPolygon& polygon, double grown, double plate) const;

  /// Whether the points deeper than `depth_m` are in one piece, in plan: no two sides without a common corner are
  /// nearer to each other than two times that.
  bool is_one_piece(double depth_m) const;

  /// A point deep inside, in plan; its z is that of the middle between the heights, where they are finite.
  std::optional<Vec3> deep_point() const;

 private:
  struct Side {
    Eigen::Vector2d from, to;
  };
  void add_ring(const Zone::Ring& ring, const Vec3& origin);
  void finish();
  std::vector<HalfSpace> plate_about(const Side& side, double half_width) const;

  std::vector<std::vector<Side>> rings_;
  double low_, high_;
  double rounding_m_ = 0;
  Box box_;
};

}  // namespace vantage::internal::prove
