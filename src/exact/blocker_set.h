// The blockers of one target, stored one after another.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "exact/blocker.h"

namespace vantage::internal::exact {

/// Blocker i owns the planes [first[i], first[i + 1]) and likewise its corners.
struct BlockerSet {
  std::vector<Plane> planes;
  std::vector<std::uint8_t> visible;  ///< per plane: 0 where a neighbour of the polygon hides all of its facet
  std::vector<std::uint32_t> first{0};
  std::vector<Vec3> corners;  ///< of the scene polygon, clipped to the target's front; none where more is hidden
  std::vector<std::uint32_t> first_corner{0};
  std::vector<std::uint32_t> polygon;  ///< index of the scene polygon
  std::vector<std::uint32_t> cover;    ///< per blocker: of the convex polygons of the target the one it hides
  std::vector<std::uint8_t> confined;  ///< per blocker: 1 where it can be seen only in front of its polygon

  std::size_t count() const { return polygon.size(); }
  std::span<const Plane> planes_of(std::size_t blocker) const {
    return {planes.data() + first[blocker], first[blocker + 1] - first[blocker]};
  }
  std::span<const Vec3> corners_of(std::size_t blocker) const {
    return {corners.data() + first_corner[blocker], first_corner[blocker + 1] - first_corner[blocker]};
  }

  /// Ends a blocker whose planes and corners have been appended; its planes are visible.
  void close(std::uint32_t scene_polygon, std::uint32_t of_target = 0) {
    first.push_back(static_cast<std::uint32_t>(planes.size()));
    first_corner.push_back(static_cast<std::uint32_t>(corners.size()));
    polygon.push_back(scene_polygon);
    cover.push_back(of_target);
    confined.push_back(0);
    visible.resize(planes.size(), 1);
  }

  /// Appends a blocker of another set.
  void append(const BlockerSet& other, std::size_t blocker, std::uint32_t of_target) {
    const auto its_planes = other.planes_of(blocker);
    const auto its_corners = other.corners_of(blocker);
    const auto its_visible = other.visible.begin() + other.first[blocker];
    planes.insert(planes.end(), its_planes.begin(), its_planes.end());
    visible.insert(visible.end(), its_visible, its_visible + static_cast<std::ptrdiff_t>(its_planes.size()));
    corners.insert(corners.end(), its_corners.begin(), its_corners.end());
    close(other.polygon[blocker], of_target);
    confined.back() = other.confined[blocker];
  }

  /// Takes the last one back.
  void drop_last() {
    first.pop_back();
    first_corner.pop_back();
    polygon.pop_back();
    cover.pop_back();
    confined.pop_back();
    planes.resize(first.back());
    visible.resize(first.back());
    corners.resize(first_corner.back());
  }
};

}  // namespace vantage::internal::exact
