// All meshes of an arrangement in one table.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/bounded.h"
#include "core/bvh.h"
#include "core/progress_reporter.h"
#include "vantage/geometry.h"

namespace vantage::internal::arrangement {

/// A closed mesh, and what it counts.
struct Operand {
  const Mesh* mesh = nullptr;  ///< each edge has two triangles, which run along it in opposite directions
  std::uint64_t weight = 1;    ///< of each point in it
  bool is_complement = false;  ///< of each point outside of it instead
};

constexpr std::uint32_t kNone = ~0u;

struct Edge {
  std::uint32_t from, to;               ///< points
  std::array<std::uint32_t, 2> facets;  ///< that have it from `from` to `to`, and the other way
};

struct Facet {
  Triangle corners;     ///< points, counter-clockwise seen from where the operand does not count
  Triangle edges;       ///< from each corner to the next
  std::uint32_t mesh;   ///< operand
  bool is_flat;         ///< without any area: nothing passes through it
  Vec3 normal;          ///< of the length of twice its area, rounded
  double off_by;        ///< no coordinate of the normal is farther off
  std::uint32_t given;  ///< its number in the operand's mesh

  unsigned corner_of(std::uint32_t point) const { return corners[0] == point ? 0 : corners[1] == point ? 1 : 2; }
};

/// Facets are numbered through, operand by operand; those of a complement are turned round. Each operand but the first
/// is moved by a vector of its own, so that nothing of two operands lies on each other but by a rare chance (Halperin
/// and Shelton, A perturbation scheme for spherical arrangements, 1998): the solids as they stand then are the ones
/// that count.
class Soup {
 public:
  /// `step`: no operand moves farther along any axis. nullopt where a mesh is not closed as Operand asks.
  static std::optional<Soup> of(std::span<const Operand> operands, double step, std::uint32_t seed);

  const std::vector<Vec3>& points() const { return points_; }
  const std::vector<Vec3>& given() const { return given_; }  ///< points, as they were before they were moved
  const std::vector<Facet>& facets() const { return facets_; }
  const std::vector<Edge>& edges() const { return edges_; }
  std::uint32_t mesh_of_edge(std::uint32_t edge) const { return facets_[edges_[edge].facets[0]].mesh; }
  double largest() const { return largest_; }  ///< coordinate
  const core::Bvh& bvh() const { return bvh_; }
  const std::vector<std::uint32_t>& order() const { return order_; }  ///< facets, as the leaves have them

  /// How far a point lies beyond a facet's plane, times twice the facet's area.
  core::Bounded height(std::uint32_t facet, std::uint32_t point) const;

  /// What holds a corner of a mesh besides this: the sum of the weights. Exact; nullopt where the corner lies on
  /// another mesh, or a mesh does not bound a solid there.
  std::optional<std::uint64_t> level_at(std::uint32_t point, std::uint32_t mesh,
                                        std::span<const Operand> operands) const;

 private:
  bool add_edges(std::uint32_t first_facet);
  void build_bvh();

  std::vector<Vec3> points_, given_;
  std::vector<Facet> facets_;
  std::vector<Edge> edges_;
  double largest_ = 0;
  core::Bvh bvh_;
  std::vector<std::uint32_t> order_;
};

}  // namespace vantage::internal::arrangement
