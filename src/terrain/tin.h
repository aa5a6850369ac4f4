// A triangulated irregular network that grows where it is worst.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <queue>
#include <vector>

#include "vantage/geometry.h"

namespace vantage::terrain {

/// An incremental Delaunay triangulation of points over a rectangle (Bowyer, Watson, 1981, with exact predicates), and
/// greedy insertion into it: Garland and Heckbert, "Fast polygonal approximation of terrains and height fields", 1995,
/// algorithm IV. Each candidate is kept with the facet that it lies over, each facet knows its worst, and a heap the
/// worst of all; an insertion touches only the facets that it replaces.
class Tin {
 public:
  static constexpr std::uint32_t kNone = 0xffffffff;

  /// Corners in turn from the lower left: (min.x, min.y), (max.x, min.y), (max.x, max.y), (min.x, max.y).
  explicit Tin(const std::array<Vec3, 4>& corners);

  /// Makes a point a vertex, whatever its error; before there are candidates. It must lie in the rectangle or on its
  /// border. Returns its index; that of the vertex in its place if there is one.
  std::uint32_t insert(const Vec3& point);
  /// Points that may become vertices; in the rectangle or on its border. Once. Neighbours in the list had better be
  /// neighbours in the plane.
  void add_candidates(const std::vector<Vec3>& points);
  /// Inserts the worst candidate until none differs from its facet by more than `max_error` vertically. Calls
  /// `progress` with the worst error every few thousand insertions.
  void refine(double max_error, const std::function<void(double)>& progress);

  const std::vector<Vec3>& points() const { return points_; }
  /// Counter-clockwise, indices into points().
  struct Facet {
    std::array<std::uint32_t, 3> corner{};
    std::array<std::uint32_t, 3> neighbour{kNone, kNone, kNone};  ///< across from each corner
    std::uint32_t candidates = kNone;                             ///< the first of a chain
    std::uint32_t worst = kNone;                                  ///< candidate
    double error = -1;                                            ///< its error
  };
  const std::vector<Facet>& facets() const { return facets_; }

 private:
  struct Edge {
    std::uint32_t from, to, outside;
  };
  struct Worst {
    double error;
    std::uint32_t facet, candidate;
    bool operator<(const Worst& other) const {
      return error != other.error ? error < other.error : candidate > other.candidate;
    }
  };

  std::uint32_t locate(const Vec3& point, std::uint32_t start) const;
  std::uint32_t vertex_in_place(std::uint32_t facet, const Vec3& point) const;
  bool in_circle(std::uint32_t facet, const Vec3& point) const;
  void insert_vertex(std::uint32_t vertex, std::uint32_t facet);
  void find_cavity(const Vec3& point, std::uint32_t facet);
  void fill_cavity(std::uint32_t vertex);
  void share_out(std::uint32_t vertex);
  void give(std::uint32_t candidate, std::uint32_t facet, double error);
  double error_over(std::uint32_t candidate, std::uint32_t facet) const;
  void drop(std::uint32_t candidate, std::uint32_t facet);

  std::vector<Vec3> points_;  ///< vertices and candidates
  std::vector<Facet> facets_;
  std::vector<std::uint32_t> next_;  ///< per candidate, the next of its facet's chain
  std::priority_queue<Worst> queue_;
  std::uint32_t last_ = 0;  ///< a facet near the last insertion

  // Of one insertion.
  std::vector<std::uint32_t> cavity_, mark_, fan_;
  std::uint32_t round_ = 0;
  std::vector<Edge> rim_;
  std::vector<std::uint32_t> starting_at_, ending_at_;  ///< per vertex of the rim, the new facet whose edge does
};

}  // namespace vantage::terrain
