// Where points are in the plan of a zone.
#pragma once

#include "vantage/navigation.h"

namespace vantage::internal::query {

/// Borders too.
inline bool boxes_meet(const Box& a, const Box& b) {
  return (a.min.array() <= b.max.array()).all() && (b.min.array() <= a.max.array()).all();
}

/// Calls visit(a, b) for the sides of all rings.
template <typename Visit>
void for_each_side(const Zone& zone, const Visit& visit) {
  const auto visit_ring = [&](const Zone::Ring& ring) {
    for (std::size_t i = 0; i < ring.size(); ++i) visit(ring[i], ring[(i + 1) % ring.size()]);
  };
  visit_ring(zone.outer);
  for (const Zone::Ring& hole : zone.holes) visit_ring(hole);
}

/// The bounds of a zone, its heights above ground left aside.
Box box_of(const Zone& zone);

enum class ZonePlace { outside, border, inside };

/// In plan: a ray eastward crosses the sides of a polygon and its holes an odd number of times from inside. Cost:
/// linear in the corners.
ZonePlace place_in(const Zone& zone, const Eigen::Vector2d& p);

}  // namespace vantage::internal::query
