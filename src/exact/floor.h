// The floor: how far from the centre the volume begins, in each direction. docs/theory.md, "Limits in the chart".
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "core/facet_polygon.h"
#include "core/plane.h"
#include "exact/chart_limits.h"
#include "exact/octahedral_map.h"

namespace vantage::internal::exact {

using core::Plane;

/// Made of bodies. Beyond a body of sides that are kept is what is beyond all of its planes, beyond one that is taken
/// away what is beyond any of them: there the inverse depth is at most the least, or the greatest, of the planes'. The
/// floor is the farthest of the bodies.
class Floor {
 public:
  /// So many times numerics::kShrink, in parts of the distance, limits are moved away from what they keep out.
  static constexpr double kShrinks = 30;

  struct Body {
    std::uint32_t first, end;  ///< of its planes
    bool is_kept;
  };
  struct Facet {
    std::uint32_t plane, body;
    core::FacetPolygon polygon;  ///< in front of the target; edges are made by planes next to this one
  };
  /// The floor in a direction.
  struct Value {
    static constexpr std::uint32_t kNone = ~0u;
    double gauge;  ///< inverse depth for a direction of |x| + |y| + z = 1; not above 0 where there is nothing beyond
    std::uint32_t plane;
  };

  /// Of the planes that the volume begins behind; those that it ends at become `ceilings`. All are moved away by
  /// kShrinks, so that the finished mesh keeps the limits. nullopt where a plane passes so near to the centre that this
  /// cannot be told.
  static std::optional<Floor> of(const ChartLimits& limits, double reach, std::vector<ChartLimits::Side>& ceilings);

  bool empty() const { return bodies_.empty(); }
  const std::vector<Plane>& planes() const { return planes_; }
  std::uint32_t label(std::uint32_t plane) const { return labels_[plane]; }
  const std::vector<Body>& bodies() const { return bodies_; }
  const std::vector<Facet>& facets() const { return facets_; }
  std::span<const Plane> planes_of(const Body& body) const {
    return {planes_.data() + body.first, body.end - body.first};
  }
  Value at(const OctahedralPoint& point) const;
  /// Of a body those that may be the greatest, or the least, near a point.
  std::span<const std::uint32_t> planes_at(const OctahedralPoint& point, std::uint32_t body) const {
    const Listed& listed = listed_at(point);
    return {listed.planes.data() + listed.first[body], listed.first[body + 1] - listed.first[body]};
  }

 private:
  /// Planes that may be a body's least, or greatest, in a cell of the map.
  struct Listed {
    std::vector<std::uint32_t> planes, first;  // first: per body
  };

  void add_kept(const std::vector<ChartLimits::Side>& sides, double reach);
  bool add_removed(const ChartLimits::Body& body);
  /// Per cell: bodies and their planes.
  using Found = std::vector<std::vector<std::pair<std::uint32_t, std::uint32_t>>>;
  void list_planes();
  void list_kept(std::uint32_t body, Found& found) const;
  void list_facet(const Facet& facet, Found& found) const;
  const Listed& listed_at(const OctahedralPoint& point) const;

  std::vector<Plane> planes_;
  std::vector<std::uint32_t> labels_;
  std::vector<Body> bodies_;
  std::vector<Facet> facets_;
  std::vector<Listed> cells_;
};

}  // namespace vantage::internal::exact
