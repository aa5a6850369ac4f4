// A closed solid over a footprint: walls, a floor, and a roof of one of the shapes of Simple 3D Buildings.
#pragma once

#include <string>
#include <vector>

#include "maps/city/building_form.h"
#include "maps/city/footprint.h"
#include "vantage/geometry.h"

namespace vantage::internal::city {

struct CitySolid {
  Mesh mesh;  ///< closed, outward-oriented, free of self-intersections; edge-connected pieces share no vertex
  /// Why a box as high as the roof's top stands in ("dome roof over an outline that is not star-shaped"); or empty.
  std::string repair;
};

/// `ground_m`: z of the ground that the form's heights count from. The roof is a piecewise linear height over the
/// footprint (onions excepted; the shapes are in roof_profile.h and roof_surface.h), its triangles cut along the
/// creases, the floor the same triangles turned over (under roofs of rings round a centre: the outline's own), the
/// walls join the two along the outline: closed by construction. What the form leaves open is settled first. Where two
/// rings, or a ring with itself, touch in a point, that point is drawn apart by 1 mm into the solid, so that no edge
/// has four facets. Throws Error(internal) where an invariant does not hold; the caller checks with solid::check all
/// the same.
CitySolid make_solid(const Footprint& footprint, const BuildingForm& form, double ground_m);

}  // namespace vantage::internal::city
