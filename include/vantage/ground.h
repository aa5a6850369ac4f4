// The ground that heights are measured from.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "vantage/export.h"
#include "vantage/geometry.h"
#include "vantage/scene.h"

namespace vantage {

/// A plane, or triangles. Beyond the triangles, in plan, there is no ground.
struct Ground {
  double plane_z_m = 0;  ///< without triangles: the ground lies at this z everywhere
  /// Scene frame, metres; shared, since it may be as large as the scene. Triangles may face up or down, and may lie
  /// over each other. Vertical ones do not count.
  std::shared_ptr<const Mesh> surface = {};
};

/// The ground of a scene: its objects of ObjectKind::ground, or else of ObjectKind::surface, which is the highest of
/// ground, roofs and trees. Flat ground of a map goes on beyond the map: it is a plane. Nothing where the scene has no
/// such object with triangles. Cost: linear.
VANTAGE_API std::optional<Ground> ground_of(const Scene& scene);

/// The triangles of one object. Throws Error(input) for an index out of range and an object without triangles.
VANTAGE_API Ground ground_of(const Scene& scene, std::uint32_t object);

/// How high the ground is, for many places.
class VANTAGE_API GroundLevels {
 public:
  /// Cost: O(n log n) in the triangles.
  explicit GroundLevels(const Ground& ground);
  ~GroundLevels();
  GroundLevels(GroundLevels&&) noexcept;
  GroundLevels& operator=(GroundLevels&&) noexcept;

  /// z of the lowest and the highest piece of ground at a place: they differ where pieces lie over each other.
  struct Range {
    double lowest_m, highest_m;
  };
  /// Nothing where there is no ground. A place within a few roundings of the border of the ground may be taken for
  /// either side.
  std::optional<Range> at(double x, double y) const;

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace vantage
