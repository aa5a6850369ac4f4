// The targets that are dragged through real cities.
#pragma once

#include "support/cities.h"
#include "vantage/target.h"

namespace vantage::bench {

constexpr double kDragRange = 300, kDragStep = 0.1;  // metres
constexpr int kDragSteps = 50;                       // then back to where it began

/// Charlotte or Munich.
inline Target dragged_target(const City& city) {
  if (&city == &kMunich) return Target::polygon({{-5, -112, 0}, {25, -112, 0}, {22, -97, 0}, {-8, -97, 0}});
  return Target::polygon({{-346.654, -59.171, 1}, {-369.28, -39.471, 1}, {-340.906, -29.727, 1}});
}

/// One corner moves along x.
inline void drag_corner(int step, Target& target) { target.parts[0][0].x() += kDragStep * (step % kDragSteps); }

}  // namespace vantage::bench
