// What a roof's height is over a footprint, where it is a concave function: the least of some planes.
//
// The roof lies over the outline's bounding rectangle (of least area, or turned to roof:direction): u runs along its
// ridge, v across, in the direction that the main face falls in. With half sides L (along u) and W (along v), m =
// min(L, W), and the roof's height R above the eaves:
//   gabled       R (1 - |v| / W)
//   hipped       R / m times the distance from the nearest side: equal pitch on all four
//   half-hipped  gabled, and at both ends cut by a slope of the same pitch that starts at R / 2
//   pyramidal    R times the least of 1 - |u| / L and 1 - |v| / W
//   skillion     R (W - v) / 2W
//   gambrel      steep up to 2/3 R half-way from the eaves to the ridge, then the rest
//   mansard      the gambrel's profile by the distance from the nearest of all four sides, half-way to m
//   round        an arc of a circle over v, or of an ellipse when R > W; chords inside the arc
//   saltbox      gabled with the ridge at v = -W / 3: the main face is the wider, shallower one
#pragma once

#include <optional>
#include <vector>

#include "maps/city/building_form.h"
#include "maps/city/footprint.h"

namespace vantage::internal::city {

/// The rectangle that a roof is drawn over.
struct RoofFrame {
  Vec2 centre = Vec2::Zero();  ///< scene frame
  Vec2 along = Vec2::UnitX(),
       across = Vec2::UnitY();             ///< unit vectors: u and v; across is where the main face falls to
  double half_length = 1, half_width = 1;  ///< along u and v
  double fill = 1;                         ///< of the rectangle's area that the outline covers

  Vec2 local(const Vec2& point) const { return {(point - centre).dot(along), (point - centre).dot(across)}; }
};

/// The smallest rectangle round some points, none of its sides shorter than `least_m`; counter-clockwise. `points`: at
/// least one, finite. Cost: O(n log n), and for many corners of the hull their square.
Ring enclosing_rectangle(const Ring& points, double least_m);

/// A direction within 30 degrees of a side of the rectangle of least area, when the outline fills 80 % of that, means
/// that side: people write N where a street runs to the north-north-east. Without one, the ridge runs along the longer
/// side (the shorter, with `roof_across`), and the main face falls to the side that looks most nearly south.
RoofFrame roof_frame(const Footprint& footprint, const BuildingForm& form);

/// Height above the eaves: a u + b v + c.
struct RoofPlane {
  double a = 0, b = 0, c = 0;

  double at(const Vec2& local) const { return a * local.x() + b * local.y() + c; }
};

/// The planes of one of the shapes in the table; none for the others.
std::vector<RoofPlane> roof_planes(RoofShape shape, const RoofFrame& frame, double roof_m);

/// With its roof's height and its bottom known: what follows from the outline has been put in. Returns it unchanged
/// when nothing is open. The rise of a pitch is over half the width across the ridge, of a skillion over all of it.
BuildingForm settled(const BuildingForm& form, const RoofFrame& frame);

/// How many chords an arc of this radius and angle takes so that it strays no more than 5 cm from them: 4 to 16.
int arc_chords(double radius_m, double angle);

}  // namespace vantage::internal::city
