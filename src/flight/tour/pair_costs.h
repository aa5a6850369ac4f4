// What pairs of neighbours cost, and what duals prove of tours: see the head of pairs_bound.h.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <set>
#include <vector>

#include "flight/tour/cells.h"
#include "flight/tour/hull.h"
#include "flight/tour/insertion_bound.h"
#include "flight/tour/pairs_bound.h"
#include "flight/tour/touring_program.h"
#include "flight/tour/turning.h"
#include "vantage/geometry.h"

namespace vantage::internal::flight::tour {

using PairEdge = std::array<std::size_t, 2>;
inline PairEdge edge_of(std::size_t i, std::size_t j) { return {std::min(i, j), std::max(i, j)}; }

/// What is fixed at a node.
struct FixedEdges {
  std::set<PairEdge> inside, outside;
  bool is_out(std::size_t i, std::size_t j) const { return outside.contains(edge_of(i, j)); }
  bool is_in(std::size_t i, std::size_t j) const { return inside.contains(edge_of(i, j)); }
};

/// The shortest polyline in an order, and the vectors of its legs, which prove its length; without one points to begin
/// with.
struct AlongTour {
  std::vector<Vec3> points;        // of each region
  std::vector<std::size_t> stops;  // in order, ends included
  std::vector<Direction> legs;     // from each stop to the next one
};

/// The vectors of all pairs and the costs that follow.
class PairCosts {
 public:
  PairCosts(const Cells& cells, const TourSpace& space, const AlongTour& along)
      : regions_(cells.region_count()), count_(regions_ + (space.closed ? 0 : 1)) {
    vectors_.resize(count_);
    for (std::size_t i = 0; i < count_; ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        const bool anywhere = i >= regions_;
        vectors_[i].push_back(anywhere ? Direction{} : direction_of(unit_of(along.points[i] - along.points[j])));
      }
    }
    // Where legs of the tour have no length, or nearly so, only these vectors prove that they need none.
    for (std::size_t k = 0; k < along.legs.size(); ++k) {
      const std::size_t from = along.stops[k], to = along.stops[(k + 1) % along.stops.size()];
      Direction& vector = vectors_[std::max(from, to)][std::min(from, to)];
      vector = along.legs[k];
      if (to < from) {
        for (std::int32_t& x : vector) x = -x;
      }
    }
    const std::vector<std::vector<double>> apart = level_distances(cells, space.turn_radius_m);
    costs_.assign(count_, std::vector<double>(count_ * count_, 0.0));
    for (std::size_t i = 0; i < regions_; ++i) {
      const double dwell = space.dwell_m.empty() ? 0 : space.dwell_m[i];
      const Hull& hull = *cells[i].hull;
      for (std::size_t j = 0; j < count_; ++j) {
        for (std::size_t k = j + 1; k < count_; ++k) {
          if (i == j || i == k) continue;
          double& here = costs_[i][j * count_ + k];
          here = cost(hull, vector(i, j), vector(i, k), dwell);
          if (space.turn_radius_m > 0 && dwell <= 0 && !hull.is_point()) {
            here += turning_part(between(j, i), between(i, k), apart[i][j], apart[i][k], space.turn_radius_m);
          }
          costs_[i][k * count_ + j] = here;
        }
      }
      error_ += (2 * 44 * 0x1p-53 * hull.reach_m() + 2.001 * hull.moved_m()) * 2 + 4 * 0x1p-53 * dwell;
    }
  }

  std::size_t count() const { return count_; }
  /// The cost of region i between j and k, but for rounding.
  double operator()(std::size_t i, std::size_t j, std::size_t k) const { return costs_[i][j * count_ + k]; }
  /// All rounding of the costs of a tour: as for touring_bound, at every region.
  double error_m() const { return error_; }
  const std::vector<std::vector<Direction>>& vectors() const { return vectors_; }

 private:
  static Vec3 unit_of(const Vec3& vector) {
    const double norm = vector.norm();
    return norm > 0 ? Vec3(vector / norm) : vector;
  }
  Vec3 vector(std::size_t i, std::size_t j) const {
    return j < i ? vector_of(vectors_[i][j]) : Vec3(-vector_of(vectors_[j][i]));
  }
  /// The direction of the leg from one region to another.
  Direction between(std::size_t from, std::size_t to) const {
    if (from < to) return vectors_[to][from];
    Direction back = vectors_[from][to];
    for (std::int32_t& x : back) x = -x;
    return back;
  }
  std::vector<std::vector<double>> level_distances(const Cells& cells, double turn_radius_m) const {
    std::vector<std::vector<double>> apart(count_, std::vector<double>(count_, 0.0));
    for (std::size_t i = 0; i < regions_ && turn_radius_m > 0; ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        apart[i][j] = apart[j][i] = level_distance_m(*cells[j].hull, *cells[i].hull, vectors_[i][j]);
      }
    }
    return apart;
  }
  static double cost(const Hull& hull, const Vec3& one, const Vec3& other, double dwell) {
    if (dwell > 0) return one.dot(hull.lowest(one)) + other.dot(hull.lowest(other)) + dwell;
    const Vec3 both = one + other;  // exact
    return both.dot(hull.lowest(both));
  }

  std::size_t regions_, count_;
  std::vector<std::vector<Direction>> vectors_;
  std::vector<std::vector<double>> costs_;
  double error_ = 0;
};

/// What is proved by some duals, whatever they are: see the head of pairs_bound.h. All that rounding may add is taken
/// off.
double pairs_value(const PairCosts& costs, const FixedEdges& fixed, const PairsDuals& duals);

}  // namespace vantage::internal::flight::tour
