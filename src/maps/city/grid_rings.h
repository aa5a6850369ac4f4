// Rings on the grid of footprints, where whether three points turn left is decided exactly.
#pragma once

#include <Eigen/Geometry>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "maps/city/footprint.h"

namespace vantage::internal::city {

/// In units of kGrid about an origin of the object's own. Up to 2 kLargest, so that no product below overflows.
struct GridPoint {
  std::int64_t x = 0, y = 0;

  auto operator<=>(const GridPoint&) const = default;
};
using GridRing = std::vector<GridPoint>;  ///< open, like Ring

constexpr std::int64_t kLargest = (std::int64_t{1} << 29) - 1;  ///< 65 km; twice that still turns within 64 bits

/// Twice the signed area of the triangle (o, a, b): > 0 where it turns left.
inline std::int64_t turn(const GridPoint& o, const GridPoint& a, const GridPoint& b) {
  return (a.x - o.x) * (b.y - o.y) - (a.y - o.y) * (b.x - o.x);
}
/// (a - o) . (b - o)
inline std::int64_t dot(const GridPoint& o, const GridPoint& a, const GridPoint& b) {
  return (a.x - o.x) * (b.x - o.x) + (a.y - o.y) * (b.y - o.y);
}
/// Whether `p` lies on the segment between `a` and `b`, its ends included.
inline bool on_segment(const GridPoint& p, const GridPoint& a, const GridPoint& b) {
  return turn(p, a, b) == 0 && dot(p, a, b) <= 0;
}

/// Between metres and the grid about an origin, which is itself a multiple of kGrid: lossless there and back.
class Grid {
 public:
  /// About the middle of the points.
  explicit Grid(const std::vector<const Ring*>& rings);
  explicit Grid(const Footprint& footprint);

  /// Whether every point is finite and within kLargest.
  bool holds(const Ring& ring) const;
  GridPoint to_grid(const Vec2& point) const;  ///< to the nearest
  GridRing to_grid(const Ring& ring) const;
  Vec2 to_metres(const GridPoint& point) const {
    return origin_ + Vec2(static_cast<double>(point.x), static_cast<double>(point.y)) * kGrid;
  }
  Ring to_metres(const GridRing& ring) const;

 private:
  void centre_on(const std::vector<const Ring*>& rings);

  Vec2 origin_ = Vec2::Zero();
};

enum class PointLocation { inside, boundary, outside };
PointLocation locate(const GridPoint& point, const GridRing& ring);  ///< by the even-odd rule

double signed_area(const GridRing& ring);  ///< in units of the grid, squared

using GridBox = Eigen::AlignedBox<std::int64_t, 2>;
GridBox box_of(const GridRing& ring);

/// A ring that goes round every place in the box as often: of corners in a row that lie beyond the same side of it, the
/// first and the last are kept.
GridRing near_box(const GridRing& ring, const GridBox& box);

/// Convex; A. M. Andrew's monotone chain (1979). Fewer than 3 corners where all lie on one line.
GridRing hull_of(GridRing points);

/// How the sides of some rings meet each other, other than in the corners between neighbours.
struct Meeting {
  bool crossing = false;  ///< sides pass through each other, or lie on one another over a length
  bool touching = false;  ///< a corner lies on a side or on another corner
};
/// Called with the numbers of two rings, or twice the same, for each pair of their sides that meet.
using MeetingVisit = std::function<void(std::size_t a, std::size_t b, bool crossing)>;
/// Cost: O(n log n) for outlines as they are drawn.
void for_each_meeting(const std::vector<GridRing>& rings, const MeetingVisit& visit);
Meeting meeting_of(const std::vector<GridRing>& rings);

/// A corner that lies on a side of which it is not an end, or on another corner.
struct Touch {
  std::size_t corner = 0;  ///< counted over all rings
  std::size_t side = 0;    ///< that begins at this corner, counted likewise
};
/// All of them: where two corners are in one place, each lies on two sides of the other.
std::vector<Touch> touches_of(const std::vector<GridRing>& rings);

}  // namespace vantage::internal::city
