// The floor: how far from the centre the volume begins, in each direction. docs/theory.md, "Limits in the chart".
#pragma once

#include <array>
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

/// Made of bodies. Beyond a body of sides that are kept is what is beyond all of its planes, beyond a convex one that
/// is taken away what is beyond any of them: there the inverse depth is at most the least, or the greatest, of the
/// planes'. Of a star-shaped body each plane counts in the cone of its facet, from the centre. The floor is the
/// farthest of the bodies.
class Floor {
 public:
  /// So many times numerics::kShrink, in parts of the distance, limits are moved away from what they keep out.
  static constexpr double kShrinks = 30;

  enum class Kind { kept, convex, star };
  struct Body {
    std::uint32_t first, end;  ///< of its planes
    Kind kind;
    std::uint32_t first_cone = 0;  ///< of a star
  };
  /// Of a facet of a star: for each edge a plane through it and the centre, e . x = 0; 1 in the corner across. So in
  /// the facet's own plane these are its barycentric coordinates.
  using Cone = std::array<Vec3, 3>;
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
  /// With these, too; nullopt as above.
  std::optional<Floor> with(const std::vector<ChartLimits::Star>& stars) const;

  bool empty() const { return bodies_.empty(); }
  const std::vector<Plane>& planes() const { return planes_; }
  std::uint32_t label(std::uint32_t plane) const { return labels_[plane]; }
  const std::vector<Body>& bodies() const { return bodies_; }
  const std::vector<Facet>& facets() const { return facets_; }
  std::span<const Plane> planes_of(const Body& body) const {
    return {planes_.data() + body.first, body.end - body.first};
  }
  /// The cone of a plane of a star.
  const Cone& cone_of(const Body& body, std::uint32_t plane) const {
    return cones_[body.first_cone + plane - body.first];
  }
  /// By how much a star's planes differ at most, in parts, in the corner of a facet across from an edge where they
  /// meet.
  double steepness() const { return steepness_; }
  Value at(const OctahedralPoint& point) const;
  /// Of a body those that may be the greatest, or the least, or whose cones may hold it, near a point.
  std::span<const std::uint32_t> planes_at(const OctahedralPoint& point, std::uint32_t body) const {
    const Listed& listed = listed_at(point);
    return {listed.planes.data() + listed.first[body], listed.first[body + 1] - listed.first[body]};
  }
  /// Appends a body's planes that are listed in the cells round a part of a quadrant of the map, where something that
  /// is taken away reaches beyond this distance; some of them twice.
  void planes_over(std::uint32_t body, int quadrant, std::span<const Vec3> part, double beyond,
                   std::vector<std::uint32_t>& found) const;

 private:
  /// Planes that may be a body's least, or greatest, in a cell of the map.
  struct Listed {
    std::vector<std::uint32_t> planes, first;  // first: per body
    double farthest = 0;                       // corner of a facet of what is taken away
  };

  void add_kept(const std::vector<ChartLimits::Side>& sides, double reach);
  bool add_removed(const ChartLimits::Body& body);
  bool add_star(const ChartLimits::Star& star);
  /// Per cell: bodies and their planes.
  using Found = std::vector<std::vector<std::pair<std::uint32_t, std::uint32_t>>>;
  void list_planes();
  void list_kept(std::uint32_t body, Found& found) const;
  void list_facet(const Facet& facet, Found& found);
  const Listed& listed_at(const OctahedralPoint& point) const;
  std::size_t cell_index(int quadrant, int i, int j) const {
    return (static_cast<std::size_t>(quadrant * side_ + j)) * static_cast<std::size_t>(side_) +
           static_cast<std::size_t>(i);
  }
  template <typename Visit>
  void for_each_cell(int quadrant, std::span<const Vec3> part, const Visit& visit) const;
  Value value_in_star(const Body& body, std::span<const std::uint32_t> planes, const Vec3& direction) const;

  std::vector<Plane> planes_;
  std::vector<std::uint32_t> labels_;
  std::vector<Body> bodies_;
  std::vector<Facet> facets_;
  std::vector<Cone> cones_;
  double steepness_ = 0;
  int side_ = 0;  // cells along the side of a quadrant in which the planes that matter are listed
  std::vector<Listed> cells_;
};

}  // namespace vantage::internal::exact
