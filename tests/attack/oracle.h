// What a viewpoint sees of a target, told by the scene's triangles as stored. Exact.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "seen_target.h"
#include "separation.h"
#include "vantage/scene.h"

namespace attack {

/// A scene triangle that is wider than rounding (vantage/volume.h), relative to the oracle's origin.
struct Blocker {
  Corners corners;
  vantage::Box box;
  std::uint32_t object = 0;
  bool thin = false;    ///< not higher than kThin over its longest side
  bool repeat = false;  ///< the same three places as an earlier triangle
};

/// The height up to which the engine takes a triangle for nothing, metres.
inline constexpr double kThin = 1.01e-9;

/// The triangles, about an origin that is chosen so that subtracting it rounds nothing.
struct Blockers {
  explicit Blockers(const vantage::Scene& scene, const std::vector<vantage::Target>& targets);

  Vec3 origin = Vec3::Zero();
  std::vector<Blocker> triangles;
  Vec3 middle = Vec3::Zero();  ///< of the triangles' bounding box
  double merging = 0;          ///< how far merging may take corners to be off: vantage/volume.h, metres
  double largest = 0;          ///< the greatest coordinate of scene and targets as stored, metres
};

/// Which triangles to ask.
enum class TriangleFilter { all, not_thin };

/// One target before one scene. Keeps a reference to the blockers.
class View {
 public:
  View(const Blockers& blockers, SeenTarget target);

  const SeenTarget& target() const { return target_; }

  /// Whether the triangle reaches into the interior of conv(point, target): it hides some of the target from there.
  /// Of a point target: whether the line of sight passes through the triangle.
  bool hides(std::size_t triangle, const Vec3& point) const;
  /// The first that hides, from index `begin` on.
  std::optional<std::size_t> first_hiding(const Vec3& point, TriangleFilter filter = TriangleFilter::all,
                                          std::size_t begin = 0) const;
  bool clear(const Vec3& point) const { return !first_hiding(point); }

  /// Whether every point of the facet sees all of the target past the triangle: the interior of their convex hull is
  /// free of it.
  bool facet_clear(std::size_t triangle, const Corners& facet) const;
  std::optional<std::size_t> first_hiding(const Corners& facet, TriangleFilter filter = TriangleFilter::all) const;

  /// Whether all corners are within `range`.
  bool in_range(const Vec3& point, double range) const;

 private:
  /// A plane through the viewpoint and a side of the target that has all of the target on one side.
  struct Support {
    Vec3 a, b;
    int side;
  };
  const std::vector<Support>& supports(const Vec3& point) const;
  bool outside_pyramid(const Corners& triangle, const Vec3& point) const;
  bool below(const Blocker& blocker) const;

  const Blockers& blockers_;
  SeenTarget target_;
  vantage::Box box_;
  std::vector<int> side_;    ///< of each triangle's plane: where the target is; 2: on both sides
  std::vector<bool> below_;  ///< triangles that lie behind the target's plane, well away from it
  mutable Vec3 supports_of_;
  mutable std::vector<Support> supports_;
  mutable std::vector<SeparatingPlane> last_plane_;  ///< of each triangle: what kept it apart from the last facet
};

}  // namespace attack
