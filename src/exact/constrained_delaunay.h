// A constrained Delaunay triangulation in the plane.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "vantage/geometry.h"

namespace vantage::internal::exact {

/// Of points in [-1, 1] x [-1, 1], built point by point: each is put into the facet that holds it, and sides are turned
/// until no circle round a facet holds a corner that it sees (Lawson 1977). What a constraint passes through is taken
/// out and filled anew (Anglada 1997). Signs of areas and of circles are decided without rounding (Shewchuk 1997).
class ConstrainedDelaunay {
 public:
  using Point = Eigen::Vector2d;
  static constexpr std::uint32_t kOwn = 3;  ///< vertices of its own, which come first: a triangle round all others
  static constexpr std::uint32_t kNone = ~0u;

  struct Facet {
    Triangle vertices{};           ///< counter-clockwise
    Triangle neighbours{};         ///< across the side from corner i to the next one; kNone beyond its own triangle
    std::uint8_t constraints = 0;  ///< bit i: that side must stay
  };

  /// `snap`: a constraint that passes a vertex no farther away than this runs through it.
  explicit ConstrainedDelaunay(double snap);

  /// They get the next numbers, in their order.
  void add_vertices(std::span<const Point> points);

  /// Makes the way from one vertex to another of sides. Where it crosses a constraint there is a new vertex.
  void add_constraint(std::uint32_t from, std::uint32_t to);

  const std::vector<Point>& vertices() const { return vertices_; }
  /// A facet that changes keeps its number.
  const std::vector<Facet>& facets() const { return facets_; }

  /// Why it is of no use, as two points in one place make it; else empty. Then nothing more is added.
  const std::string& failure() const { return failure_; }

 private:
  /// A side of a facet.
  struct Side {
    std::uint32_t facet;
    unsigned side;
  };
  /// A corner of what was taken out, left or right of a constraint.
  struct Corner {
    std::uint32_t vertex;
    std::uint32_t beyond = kNone;  ///< the facet across the side to the next corner
    bool is_constraint = false;    ///< that side is one
  };

  /// Of a point in a facet.
  struct Place {
    unsigned beyond = 3;    ///< the side that it lies beyond; 3: it lies in the facet
    unsigned on = 3;        ///< a side that it lies on; 3: on none
    unsigned on_sides = 0;  ///< how many these are
  };

  static unsigned corner_of(const Facet& facet, std::uint32_t vertex) {
    return facet.vertices[0] == vertex ? 0 : facet.vertices[1] == vertex ? 1 : 2;
  }
  const Point& at(const Facet& facet, unsigned corner) const { return vertices_[facet.vertices[corner]]; }
  void fail(const char* reason) {
    if (failure_.empty()) failure_ = reason;
  }
  Place place_in(std::uint32_t facet, const Point& point, unsigned first) const;
  void insert(std::uint32_t vertex);
  void split_facet(std::uint32_t facet, std::uint32_t vertex);
  bool split_side(const Side& side, std::uint32_t vertex);
  void put(std::uint32_t facet, const Triangle& vertices, const Triangle& neighbours, unsigned constraints);
  void relink(std::uint32_t facet, std::uint32_t from, std::uint32_t to);
  void turn_sides_round(std::uint32_t vertex);
  bool turn_side(std::uint32_t facet, std::uint32_t vertex);
  void mark(const Side& side);
  bool is_on_way(std::uint32_t from, std::uint32_t to, std::uint32_t vertex) const;
  int side_of_way(std::uint32_t from, std::uint32_t to, std::uint32_t vertex) const;
  template <typename Wanted>
  std::optional<Side> side_to(std::uint32_t from, const Wanted& wanted) const;
  std::uint32_t step(std::uint32_t from, std::uint32_t to);
  std::uint32_t cross(Side side, std::uint32_t from, std::uint32_t to);
  std::uint32_t cross_constraint(const Side& side, std::uint32_t from, std::uint32_t to);
  void fill_cavity();
  std::uint32_t fill(const std::vector<Corner>& chain);
  void join(const Side& side, const Corner& corner, std::uint32_t next);
  void join_new_sides();

  double snap_;
  std::vector<Point> vertices_;
  std::vector<Facet> facets_;
  std::vector<std::uint32_t> facet_of_;  // per vertex: one of the facets round it
  std::uint32_t last_ = 0;               // where the next search begins
  std::uint32_t random_ = 1;
  std::string failure_;

  std::vector<std::uint32_t> cavity_;  // facets that were taken out; the first used_ of them have been put back
  std::size_t used_ = 0;
  std::vector<char> taken_out_;  // per facet, while a cavity is filled
  std::vector<Corner> left_, right_;
  struct NewSide {
    std::uint32_t from, to;
    Side side;
  };
  std::vector<NewSide> new_sides_;  // that facets of a filled cavity have, but for those along chains
};

}  // namespace vantage::internal::exact
