// The numeric constants that files of the exact engine share, with their derivations. Lengths in metres.
//
// The user's tolerance (how far range facets may lie inside the sphere) is not here: that is a choice, these are
// properties of double arithmetic. Local coordinates are at most a few kilometres, so one rounding costs about
// 1e3 * 2^-53 = 1e-13 m, and a short chain of operations on well-shaped input stays under 1e-11 m.
#pragma once

namespace vantage::internal::numerics {

/// Points this near to the target's plane, to the line of one of its edges, or to a plane that touches the target are
/// on it: far above what rounding costs in worlds of metres, and far below any feature of a scene. Times the radius of
/// the target's enclosing circle where that is less than a metre. A wall that stands on the target's edge is taken for
/// one that touches it; a strip of the target this wide along its outline may be hidden.
inline constexpr double kOnTarget = 1e-9;

/// The same, at the least so many roundings of the largest coordinate: four each for the target's corner and for that
/// of the scene (two for a point of a sloped plane written as doubles, two for its way into the target's frame). At map
/// coordinates, 5e6 m, this is what counts: 9 nanometres.
inline constexpr double kRoundings = 8;

/// Ranges of at least so many metres make a world of ordinary size. In smaller ones the lengths below that say so are
/// smaller in proportion.
inline constexpr double kFullRange = 20;

/// Planes that hide what is below them rise at least this much, and planes this near the target's plane that hide what
/// is above them are left out: both only hide more, by a millionth of the distance. Roof polygons that stand nanometres
/// above a target on that roof would otherwise make planes so steep in inverse depth that rounding decides who is in
/// front. "This near" is the height, in parts of the distance from the centre to the nearest edge, at which the plane
/// passes the centre.
inline constexpr double kGrazing = 1e-6;

/// A plane touches the corners of a polygon that are this near to it, in metres: ten times what preparing a scene
/// allows the triangles that it merges to be out of one plane.
inline constexpr double kTouch = 1e-8;

/// Two surfaces whose inverse depths differ by less than this fraction are the same surface; the blocker with the lower
/// index owns it. Coincident planes are the rule in cities (neighbouring walls, shared edges), and rounding would
/// otherwise choose a different owner at every vertex.
inline constexpr double kTie = 1e-10;

/// The finished mesh is scaled about the target's centre by 1 - kShrink: ten times kTie, so that neither a tie given to
/// the wrong owner nor the rounding of a crease leaves a point outside the true volume.
inline constexpr double kShrink = 1e-9;

/// Vertices of the octahedral map (which spans [-1, 1]) closer than this are one vertex: 0.1 micrometres at 1 km.
/// Well-shaped crossings agree to 1e-14, but those of nearly parallel planes do not, and creases that miss each other's
/// ends are slow to triangulate. What snapping moves, refinement finds, or the check of the finished facets: a vertex
/// that is moved by this much across the crease in front of a shadow stands, at a distance d, kSnap d |g| d behind it,
/// g being the shadow's plane; for a point (|g| up to 1e4) at 100 m a millimetre, by which the facets at it are tilted.
inline constexpr double kSnap = 1e-10;

/// The most that vertices are snapped when the triangulation cannot be built otherwise: 0.1 mm at 1 km.
inline constexpr double kWidestSnap = 1e-7;

/// Polygons under the target that stand above its plane elsewhere are left at least this far below, in metres: where a
/// surface that is almost the target's plane comes through it should be away from the target. Less in small worlds.
inline constexpr double kClear = 1e-6;

/// The target may be raised by at most this much, and kClear, to clear the surface that it lies on: surfaces of real
/// meshes are planar to a millimetre at best, single-precision files to a tenth of one. Less in small worlds.
inline constexpr double kMaxLift = 2e-3;

/// Advice to raise the target goes no further, in metres: higher up it is another target.
inline constexpr double kMostRaise = 5;

/// Where the scene covers the target this closely, most likely the wrong side is looked at: the exact method warns, and
/// to the spheres method the view is blocked at once. Less in small worlds.
inline constexpr double kHandBreadth = 0.1;

}  // namespace vantage::internal::numerics
