// Outlines for tests, and where a point lies, by the oldest of rules.
#pragma once

#include "maps/city/footprint.h"
#include "support/internals.h"

namespace vantage::testing {

inline city::Ring rectangle(double west, double south, double east, double north) {
  return {{west, south}, {east, south}, {east, north}, {west, north}};
}

/// Twice round is out again.
inline bool inside_odd(const city::Vec2& p, const city::Ring& ring) {
  bool inside = false;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const city::Vec2 &a = ring[i], &b = ring[(i + 1) % ring.size()];
    if ((a.y() > p.y()) == (b.y() > p.y())) continue;
    if (p.x() < a.x() + (p.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x())) inside = !inside;
  }
  return inside;
}

inline bool inside(const city::Vec2& p, const city::Footprint& footprint) {
  if (!inside_odd(p, footprint.outer)) return false;
  for (const city::Ring& hole : footprint.holes) {
    if (inside_odd(p, hole)) return false;
  }
  return true;
}

}  // namespace vantage::testing
