// Readers of a mesh weld vertices that stand in one place, and rounding puts vertices into one place. What such a mesh
// must be for its readers: closed, and without facets that have no area.
#pragma once

#include <functional>
#include <optional>

#include "core/labelled_mesh.h"

namespace vantage::internal::core {

/// Tells vertices apart by position and changes the mesh so that no facet is flat: narrower than `flat_m`, or without
/// any area where that is 0. A closed mesh stays closed: each edge is run as often in one direction as in the other.
///   - A facet with two corners in one place goes.
///   - Two facets on the same corners that face each other go.
///   - A flat facet goes, and the one across its longest side gets its third corner. No point of the surface moves by
///     more than `flat_m` for it.
/// In the result vertices in one place are one vertex where their facets hang together, and several where pieces only
/// touch: two triangles to an edge, as far as that can be. A mesh without such facets is left as it is. Returns whether
/// anything was changed. With `flat_m` 0 differences and products of coordinates should be exact (whole multiples,
/// below 2^25, of a power of two). Cost: linear, but for sorting the vertices and
/// the facets.
bool mend_welded(LabelledMesh& labelled, double flat_m);

/// Leaves out the facing_facets() of core/weld.h, and vertices that no triangle uses then.
void take_out_facing_facets(LabelledMesh& labelled);

/// As of core/weld.h: a triangle that is split gives its label to both parts. Returns whether all is done.
bool split_shared_edges(LabelledMesh& labelled);

/// For what mend_welded() with 0 has changed on a grid: takes out facing facets, splits shared edges, puts the new
/// vertices, in the middles of edges, to `place` of them, and mends again where that leaves facets without area. So two
/// triangles meet at each edge by index, but for some edges as short as a step or two of the grid. Returns how far a
/// point of the surface may have moved.
double split_on_grid(LabelledMesh& labelled, const std::function<Vec3(const Vec3&)>& place);

/// mend_welded() for who reads the coordinates as doubles: no facet is narrower than flat_width(). What is changed is
/// closed by index, too: two triangles to an edge, for which triangles at an edge that is shared are halved. Those are
/// no narrower than a quarter of flat_width(). Where the world is so small beside its coordinates that narrow facets
/// only turn into others, or are halved more often, no facet is without area at the least: the vertices go to a grid of
/// four steps of the largest coordinate first. Returns how far a point of the surface may have moved, metres: at most
/// four of those steps; nothing where nothing was changed.
std::optional<double> mend_for_doubles(LabelledMesh& labelled);

/// Whether a facet is flat, as of mend_welded().
bool has_narrow_facets(const Mesh& mesh, double flat_m);

/// A facet narrower than this has no area for who reads its coordinates as doubles: four steps of the largest of them,
/// the rounding of the area's own terms. Metres; 0 for an empty mesh.
double flat_width(const Mesh& mesh);

}  // namespace vantage::internal::core
