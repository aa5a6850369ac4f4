// A triangulated irregular network that grows where it is worst.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <queue>
#include <vector>

#include "core/progress_reporter.h"
#include "vantage/geometry.h"

namespace vantage::internal::terrain {

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
  /// Points that may become vertices; in the rectangle or on its border. Neighbours in the list had better be
  /// neighbours in the plane. Returns the index of the first; the others follow.
  std::uint32_t add_candidates(const std::vector<Vec3>& points);
  /// The middle between two candidates where the surface shall run straight from one to the other. It never becomes a
  /// vertex: when it is the worst, the first of its candidates that is none yet does; when all are, it is settled.
  struct Middle {
    std::array<std::uint32_t, 4> candidates{kNone, kNone, kNone, kNone};  ///< the two, and others, if any
  };
  /// Once, after all candidates.
  void add_middles(std::vector<Middle> middles);
  /// Inserts the worst candidate until none, and no middle, differs from its facet by more than `max_error` vertically.
  /// Calls `progress` with the worst error every few dozen insertions.
  void refine(double max_error, const std::function<void(double)>& progress);
  /// Where two facets make a convex quadrilateral whose corners all but lie on a circle, as those of a raster's cell
  /// do, folds it along the diagonal that is higher where the two cross: Delaunay's choice would depend on rounding.
  /// Leaves it where a candidate would then differ by more than `max_error`. Last: the network may not be Delaunay
  /// afterwards, and takes no more points. tin_fold.cpp.
  void fold_up(double max_error, const core::ProgressReporter& progress = {});

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
  void add(const std::vector<Vec3>& candidates);
  bool insert_for(const Worst& worst, double max_error);
  bool insert_candidate(std::uint32_t candidate, std::uint32_t start, double max_error);
  void insert_vertex(std::uint32_t vertex, std::uint32_t facet);
  void find_cavity(const Vec3& point, std::uint32_t facet);
  void fill_cavity(std::uint32_t vertex);
  void share_out(std::uint32_t vertex);
  void give(std::uint32_t candidate, std::uint32_t facet, double error);
  double error_over(std::uint32_t candidate, const std::array<std::uint32_t, 3>& corner) const;
  void drop(std::uint32_t candidate, std::uint32_t facet);
  bool fold(std::uint32_t facet, std::size_t side, double max_error);
  void replace_neighbour(std::uint32_t facet, std::uint32_t old, std::uint32_t now);

  std::vector<Vec3> points_;     ///< vertices, candidates, middles
  std::vector<Middle> middles_;  ///< the last of the points
  std::vector<Facet> facets_;
  std::vector<std::uint32_t> next_;  ///< per candidate, the next of its facet's chain
  std::priority_queue<Worst> queue_;
  std::uint32_t last_ = 0;  ///< a facet near the last insertion

  // For one insertion.
  std::vector<std::uint32_t> cavity_, mark_, fan_;
  std::uint32_t round_ = 0;
  std::vector<Edge> rim_;
  std::vector<std::uint32_t> starting_at_, ending_at_;  ///< per vertex of the rim, the new facet whose edge does
};

}  // namespace vantage::internal::terrain
