#include "scene/convex_polygons.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <optional>
#include <span>

#include "core/convex_corners.h"
#include "core/edges.h"
#include "core/parallel.h"

namespace vantage::internal::scene {
namespace {

constexpr std::size_t kLargestPolygon = 32;  // corners; blockers cost in proportion
constexpr std::size_t kLargestFan = 8;       // triangles on one edge that are tried pairwise

struct Candidate {
  double length2;
  std::uint32_t first, second;  // triangles
  std::uint32_t from, to;       // the shared edge
  bool operator<(const Candidate& other) const {
    if (length2 != other.length2) return length2 > other.length2;
    if (first != other.first) return first < other.first;
    return second < other.second;
  }
};

class Merger {
 public:
  Merger(const std::vector<Vec3>& vertices, const std::vector<Triangle>& triangles,
         const std::vector<std::uint32_t>& object_of, double slack)
      : vertices_(vertices), triangles_(triangles), object_of_(object_of), slack_(slack) {}

  ConvexPolygons run(SceneStatistics& statistics) {
    normals_.resize(triangles_.size());
    parallel::for_ranges(triangles_.size(), 4096, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) normals_[i] = normal_of(triangles_[i]);
    });
    const std::vector<Candidate> candidates = find_candidates(statistics);
    loops_.resize(triangles_.size());
    turns_left_.resize(triangles_.size());
    parent_.resize(triangles_.size());
    for (std::uint32_t i = 0; i < triangles_.size(); ++i) parent_[i] = i;
    for (const Candidate& candidate : candidates) merge(candidate);
    return collect();
  }

 private:
  using Loop = std::vector<std::uint32_t>;

  Vec3 normal_of(const Triangle& t) const {
    return (vertices_[t[1]] - vertices_[t[0]]).cross(vertices_[t[2]] - vertices_[t[0]]).normalized();
  }

  std::vector<Candidate> find_candidates(SceneStatistics& statistics) const {
    const std::vector<core::EdgeUse> sides = core::edge_uses(triangles_, vertices_.size());
    std::vector<Candidate> candidates;
    core::for_each_edge(sides, [&](std::span<const core::EdgeUse> edge) {
      statistics.open_edges += edge.size() == 1;
      statistics.nonmanifold_edges += edge.size() > 2;
      if (edge.size() == 2) statistics.misoriented_edges += edge[0].forward == edge[1].forward;
      if (edge.size() > kLargestFan) return;
      for (std::size_t i = 0; i < edge.size(); ++i)
        for (std::size_t j = i + 1; j < edge.size(); ++j) add_candidate(edge[i], edge[j], candidates);
    });
    parallel::sort(candidates, std::less<>());
    return candidates;
  }

  const Vec3& apex_of(const core::EdgeUse& side) const {
    const Triangle& t = triangles_[side.triangle];
    return vertices_[*std::ranges::find_if(t, [&](std::uint32_t v) { return v != side.low && v != side.high; })];
  }

  void add_candidate(const core::EdgeUse& a, const core::EdgeUse& b, std::vector<Candidate>& out) const {
    const std::uint32_t first = a.triangle, second = b.triangle;
    if (object_of_[first] != object_of_[second]) return;
    const Vec3 from = vertices_[a.low], edge = vertices_[a.high] - from;
    const Vec3 to_first = apex_of(a) - from, to_second = apex_of(b) - from;
    if (std::abs(normals_[first].dot(to_second)) > slack_) return;
    if (std::abs(normals_[second].dot(to_first)) > slack_) return;
    if (edge.cross(to_first).dot(edge.cross(to_second)) > 0) return;  // folded onto each other
    out.push_back({edge.squaredNorm(), first, second, a.low, a.high});
  }

  std::uint32_t root(std::uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }

  Loop loop_of(std::uint32_t polygon) const {
    if (!loops_[polygon].empty()) return loops_[polygon];
    const Triangle& t = triangles_[polygon];
    return {t[0], t[1], t[2]};
  }

  // Turns the loop so that the edge between `from` and `to` is its closing edge, running back -> front. False when the
  // loop does not have that edge any more.
  static bool close_with(Loop& loop, std::uint32_t from, std::uint32_t to) {
    for (std::size_t i = 0; i < loop.size(); ++i) {
      if (loop[i] == from && loop[(i + 1) % loop.size()] == to) {
        std::rotate(loop.begin(), loop.begin() + (i + 1) % loop.size(), loop.end());
        return true;
      }
    }
    return false;
  }

  void merge(const Candidate& candidate) {
    const std::uint32_t a = root(candidate.first), b = root(candidate.second);
    if (a == b) return;
    Loop left = loop_of(a), right = loop_of(b);
    std::uint32_t from = candidate.from, to = candidate.to;
    if (!close_with(left, from, to)) {
      std::swap(from, to);
      if (!close_with(left, from, to)) return;
    }
    if (!close_with(right, to, from)) {
      std::reverse(right.begin(), right.end());
      if (!close_with(right, to, from)) return;
    }
    // left: to ... from, right: from ... to. Edges shared beyond this one vanish too, and the vertices between them.
    Loop vanished;
    while (left.size() > 2 && right.size() > 2 && left[left.size() - 2] == right[1]) {
      vanished.push_back(left.back());
      left.pop_back();
      right.erase(right.begin());
    }
    while (left.size() > 2 && right.size() > 2 && left[1] == right[right.size() - 2]) {
      vanished.push_back(left.front());
      left.erase(left.begin());
      right.pop_back();
    }
    if (right.size() < 3 || left.size() + right.size() - 2 > kLargestPolygon) return;
    // Always from the same plane, that of the polygon's first triangle, or small deviations would add up.
    const Vec3& on_plane = vertices_[triangles_[a][0]];
    const auto is_off = [&](std::uint32_t v) { return std::abs(normals_[a].dot(vertices_[v] - on_plane)) > slack_; };
    if (std::any_of(right.begin(), right.end(), is_off)) return;
    // The normal of a sliver may be too rough for its own corners.
    if (loops_[a].empty() && std::any_of(left.begin(), left.end(), is_off)) return;
    const std::size_t seam = left.size() - 1;
    left.insert(left.end(), right.begin() + 1, right.end() - 1);
    if (turn_at(left, 0, normals_[a]) < -slack_ || turn_at(left, seam, normals_[a]) < -slack_) return;
    const bool turns_left = vanished.empty() && turns_left_everywhere(a) && turns_left_everywhere(b) &&
                            turn_at(left, 0, normals_[a]) > slack_ && turn_at(left, seam, normals_[a]) > slack_;
    if (!turns_left && !is_convex(left, normals_[a], vanished)) return;
    loops_[a] = std::move(left);
    turns_left_[a] = turns_left;
    loops_[b] = {};
    parent_[b] = a;
  }

  // How far a vertex of a loop sticks out of the line between its neighbours.
  double turn_at(const Loop& loop, std::size_t i, const Vec3& normal) const {
    const std::size_t n = loop.size();
    return core::distance_right_of(vertices_[loop[(i + n - 1) % n]], vertices_[loop[(i + 1) % n]], vertices_[loop[i]],
                                   normal);
  }

  // Whether each vertex of a polygon is a corner beyond doubt. Two such polygons on either side of an edge make another
  // one if both ends of the edge are.
  bool turns_left_everywhere(std::uint32_t polygon) const {
    if (!loops_[polygon].empty()) return turns_left_[polygon];
    const Triangle& t = triangles_[polygon];
    const Vec3 ab = vertices_[t[1]] - vertices_[t[0]], ac = vertices_[t[2]] - vertices_[t[0]];
    return ab.cross(ac).norm() > slack_ * std::max({ab.norm(), ac.norm(), (ac - ab).norm()});
  }

  // Whether the corners of a loop hold all of its vertices, and those that are inside it now, to the slack.
  bool is_convex(const Loop& loop, const Vec3& normal, const Loop& inside) {
    const auto is_corner = corners_of(loop, normal);
    if (!is_corner) return false;
    Loop corners;
    for (std::size_t k = 0; k < loop.size(); ++k) {
      if ((*is_corner)[k]) corners.push_back(loop[k]);
    }
    for (std::size_t k = 0; k < corners.size(); ++k) {
      const Vec3 &from = vertices_[corners[k]], &to = vertices_[corners[(k + 1) % corners.size()]];
      for (std::uint32_t v : inside) {
        if (core::distance_right_of(from, to, vertices_[v], normal) > slack_) return false;
      }
    }
    return true;
  }

  std::optional<std::vector<bool>> corners_of(const Loop& loop, const Vec3& normal) {
    points_.clear();
    for (std::uint32_t v : loop) points_.push_back(vertices_[v]);
    return core::find_corners(points_, normal, {slack_, slack_});
  }

  ConvexPolygons collect() {
    ConvexPolygons result;
    result.first.push_back(0);
    for (std::uint32_t i = 0; i < triangles_.size(); ++i) {
      if (parent_[i] != i) continue;
      const Loop loop = loop_of(i);
      const auto is_corner = loops_[i].empty() || turns_left_[i] ? std::nullopt : corners_of(loop, normals_[i]);
      for (std::size_t k = 0; k < loop.size(); ++k) {
        if (!is_corner || (*is_corner)[k]) result.vertices.push_back(loop[k]);
      }
      result.first.push_back(static_cast<std::uint32_t>(result.vertices.size()));
      result.object.push_back(object_of_[i]);
    }
    return result;
  }

  const std::vector<Vec3>& vertices_;
  const std::vector<Triangle>& triangles_;
  const std::vector<std::uint32_t>& object_of_;
  const double slack_;
  std::vector<Vec3> normals_;
  std::vector<Loop> loops_;       // empty: still the triangle itself, or merged into another
  std::vector<char> turns_left_;  // of merged polygons: each vertex is a corner beyond doubt
  std::vector<Vec3> points_;      // for corners_of
  std::vector<std::uint32_t> parent_;
};

}  // namespace

ConvexPolygons merge_coplanar(const std::vector<Vec3>& vertices, const std::vector<Triangle>& triangles,
                              const std::vector<std::uint32_t>& object_of, double slack_m,
                              SceneStatistics& statistics) {
  return Merger(vertices, triangles, object_of, slack_m).run(statistics);
}

}  // namespace vantage::internal::scene
