// Cuts a polygon in space into triangles.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "vantage/geometry.h"

namespace vantage::internal::io {

/// The corners in a plane: about the first of them, projected along the largest component of the Newell normal of the
/// first `border` corners, which then run counter-clockwise.
std::vector<Eigen::Vector2d> project_polygon(const std::vector<Vec3>& points, std::size_t border);

/// Ear clipping in the polygon's plane (Newell normal, projected along its largest component). `points` are the corners
/// in order, either turn, 3 or more; appended to `triangles` are exactly points.size() - 2 triples of indices into
/// them, with the turn of the polygon.
///
/// A simple polygon, convex or not, is covered exactly: no triangle leaves it and no two overlap. So is one whose holes
/// are joined to its border by edges that are run twice. Every corner stays a corner of some triangle, those in the
/// middle of a straight side too, so that neighbouring polygons keep meeting along whole edges; triangles without area
/// may result. Of a polygon that crosses itself, or is far from planar, the triangles still join all corners, but what
/// they cover is not defined.
///
/// Cost: linear for a convex polygon, up to quadratic in the corners otherwise.
void triangulate_polygon(const std::vector<Vec3>& points, std::vector<std::array<std::uint32_t, 3>>& triangles);

}  // namespace vantage::internal::io
