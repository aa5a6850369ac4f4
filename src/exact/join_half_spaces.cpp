// Both sides of a point as one solid: docs/theory.md, "A single point".
//
// Each side is closed by a wall in the target's plane: a fan about the centre. The walls go. The rims that are left are
// star-shaped about the centre, but differ where the sides differ by their tolerance. Between them, in the plane, lies
// what one side has and the other has not; it is triangulated, and the rims get a common vertex where they cross.
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <unordered_map>
#include <utility>

#include "core/causes.h"
#include "core/edges.h"
#include "core/pieces.h"
#include "exact/half_space_volume.h"
#include "vantage/error.h"

namespace vantage::internal::exact {
namespace {

using Vec2 = Eigen::Vector2d;

/// Vertices of both rims nearer to each other than this part of their distance from the centre become one: there the
/// nearer one counts.
constexpr double kSamePlace = 1e-12;

double cross(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

/// Positive where c lies to the left of the line from a to b.
double turn(const Vec2& a, const Vec2& b, const Vec2& c) { return cross(b - a, c - a); }

int sign(double value) { return (value > 0) - (value < 0); }

[[noreturn]] void fail() {
  throw Error(ErrorCode::internal_defect, "the two sides of the point could not be joined", "target",
              "please report this with the mission and the scene");
}

/// Where the surface of a side meets the plane.
struct Rim {
  std::vector<std::uint32_t> vertices;  ///< counter-clockwise about the centre, from the u axis; the first once more
  std::unordered_map<std::uint32_t, std::uint32_t> triangle_from;  ///< of the surface, by the vertex its edge begins at
  /// New vertices on the edge that begins at a vertex, counter-clockwise.
  std::unordered_map<std::uint32_t, std::vector<std::uint32_t>> added;
};

/// A corner of a region between the rims.
struct Corner {
  std::uint32_t vertex;
  bool is_outer;
};

class Joiner {
 public:
  explicit Joiner(HalfSpaceVolume& joined) : joined_(joined), mesh_(joined.mesh) {}

  void run(const HalfSpaceVolume& front, const HalfSpaceVolume& back, const std::vector<std::uint32_t>& of_front,
           const std::vector<std::uint32_t>& of_back, std::uint32_t wall) {
    wall_ = wall;
    const Rim rim = add(front, of_front, 1);
    Rim other = add(back, of_back, -1);
    std::reverse(other.vertices.begin(), other.vertices.end());
    rims_ = {rim, std::move(other)};
    std::array<std::array<std::size_t, 5>, 2> axes{};
    for (int r = 0; r < 2; ++r) axes[r] = find_axes(rims_[r]);
    for (std::size_t q = 0; q < 4; ++q) {
      std::array<std::span<const std::uint32_t>, 2> sections;
      for (int r = 0; r < 2; ++r) {
        sections[r] = std::span(rims_[r].vertices).subspan(axes[r][q], axes[r][q + 1] - axes[r][q] + 1);
      }
      walk(sections[0], sections[1]);
    }
    split_edges(rims_[0], true);
    split_edges(rims_[1], false);
    for (Triangle& t : mesh_.triangles) {
      for (std::uint32_t& v : t) v = renamed(v);
    }
    core::drop_unused_vertices(mesh_);
  }

 private:
  Vec2 at(std::uint32_t vertex) const { return mesh_.vertices[vertex].head<2>(); }
  std::uint32_t renamed(std::uint32_t vertex) const {
    const auto found = same_.find(vertex);
    return found == same_.end() ? vertex : found->second;
  }

  /// Adds a side's surface without its wall, and returns its rim in the order in which the surface runs it.
  Rim add(const HalfSpaceVolume& side, const std::vector<std::uint32_t>& number, double direction) {
    const auto shift = static_cast<std::uint32_t>(mesh_.vertices.size());
    for (const Vec3& v : side.mesh.vertices) mesh_.vertices.emplace_back(v.x(), direction * v.y(), direction * v.z());
    Rim rim;
    std::unordered_map<std::uint32_t, std::uint32_t> next;
    for (std::size_t t = 0; t < side.cause_of.size(); ++t) {
      const auto& [a, b, c] = side.mesh.triangles[t];
      if (side.causes[side.cause_of[t]].kind == CauseKind::target_plane) {
        next[c + shift] = b + shift;  // the wall runs the centre, `to`, `from`
        continue;
      }
      mesh_.triangles.push_back({a + shift, b + shift, c + shift});
      joined_.cause_of.push_back(number[side.cause_of[t]]);
      joined_.polygon_of.push_back(side.polygon_of[t]);
    }
    const auto first = std::find_if(next.begin(), next.end(), [&](const auto& edge) {
      return mesh_.vertices[edge.first].y() == 0 && mesh_.vertices[edge.first].x() > 0;
    });
    if (first == next.end()) fail();
    rim.vertices.push_back(first->first);
    while (rim.vertices.size() <= next.size()) rim.vertices.push_back(next.at(rim.vertices.back()));
    if (rim.vertices.back() != rim.vertices.front()) fail();
    for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t) {
      for (std::size_t e = 0; e < 3; ++e) {
        const std::uint32_t from = mesh_.triangles[t][e], to = mesh_.triangles[t][(e + 1) % 3];
        const auto edge = next.find(from);
        if (edge != next.end() && edge->second == to) rim.triangle_from[from] = t;
      }
    }
    return rim;
  }

  /// Where the rim crosses the axes: it has vertices there, as the map's quadrants end there.
  std::array<std::size_t, 5> find_axes(const Rim& rim) const {
    std::array<std::size_t, 5> places{};
    std::size_t found = 0;
    for (std::size_t i = 0; i < rim.vertices.size(); ++i) {
      const Vec2 p = at(rim.vertices[i]);
      if (p.x() != 0 && p.y() != 0) continue;
      if (found == places.size()) fail();
      places[found++] = i;
    }
    if (found != places.size()) fail();
    return places;
  }

  // ---- the walk along both rims through a quadrant ------------------------------------------------------------------

  void walk(std::span<const std::uint32_t> front, std::span<const std::uint32_t> back) {
    std::size_t i = 0, j = 0;
    outer_ = 0;
    meet(front[0], back[0]);
    while (i + 1 < front.size()) {
      const std::uint32_t f = front[i + 1], b = back[j + 1];
      const bool is_front_last = i + 2 == front.size(), is_back_last = j + 2 == back.size();
      // Positive: the front's vertex comes first. The last ones, on the axis, come together.
      double order = cross(at(f), at(b));
      if (is_front_last != is_back_last) order = is_back_last ? 1 : -1;
      const bool is_same = is_front_last == is_back_last && is_one_place(f, b);
      if (is_same || order == 0 || (is_front_last && is_back_last)) {
        cross_if_swapped(is_same ? 0 : farther_out(f, b), front[i], f, back[j], b);
        meet(f, b);
        ++i;
        ++j;
      } else if (order > 0) {
        const int outer = -sign(turn(at(back[j]), at(b), at(f)));
        cross_if_swapped(outer, front[i], f, back[j], b);
        pass(f, 0, back[j], outer);
        ++i;
      } else {
        const int outer = sign(turn(at(front[i]), at(f), at(b)));
        cross_if_swapped(outer, front[i], f, back[j], b);
        pass(b, 1, front[i], outer);
        ++j;
      }
    }
    finish_region();
  }

  bool is_one_place(std::uint32_t a, std::uint32_t b) const {
    return (at(a) - at(b)).norm() <= kSamePlace * at(a).norm();
  }
  int farther_out(std::uint32_t front, std::uint32_t back) const { return sign(at(front).norm() - at(back).norm()); }

  /// Both rims have a vertex in this direction.
  void meet(std::uint32_t front, std::uint32_t back) {
    if (is_one_place(front, back)) {
      same_[back] = front;
      if (at(back).norm() < at(front).norm()) mesh_.vertices[front] = mesh_.vertices[back];
      touch(front);
      return;
    }
    outer_ = farther_out(front, back);
    region_.push_back({outer_ > 0 ? front : back, true});
    region_.push_back({outer_ > 0 ? back : front, false});
  }

  /// A vertex of one rim between two of the other: an edge is known by its first vertex, counter-clockwise.
  void pass(std::uint32_t vertex, int rim, std::uint32_t edge_of_other, int outer) {
    if (outer == 0) {
      rims_[1 - rim].added[edge_of_other].push_back(vertex);
      touch(vertex);
      return;
    }
    outer_ = outer;
    region_.push_back({vertex, (outer > 0) == (rim == 0)});
  }

  void cross_if_swapped(int outer, std::uint32_t f0, std::uint32_t f1, std::uint32_t b0, std::uint32_t b1) {
    if (outer * outer_ >= 0) return;
    const double from = turn(at(b0), at(b1), at(f0)), to = turn(at(b0), at(b1), at(f1));
    const double along = std::clamp(from / (from - to), 0.0, 1.0);
    const Vec2 place = from == to ? at(f0) : Vec2(at(f0) + along * (at(f1) - at(f0)));
    const auto vertex = static_cast<std::uint32_t>(mesh_.vertices.size());
    mesh_.vertices.emplace_back(place.x(), place.y(), 0);
    rims_[0].added[f0].push_back(vertex);
    rims_[1].added[b0].push_back(vertex);
    touch(vertex);
  }

  /// The rims touch: a region ends there, and another begins.
  void touch(std::uint32_t vertex) {
    region_.push_back({vertex, outer_ <= 0});
    finish_region();
    outer_ = 0;
    region_.push_back({vertex, true});
  }

  // ---- regions between the rims -------------------------------------------------------------------------------------

  /// Triangulates a region that is monotone in the angle about the centre (M. de Berg et al., "Computational Geometry",
  /// 3.3, with the angle in the place of y), and begins anew.
  void finish_region() {
    const std::vector<Corner> corners = std::exchange(region_, {});
    if (corners.size() < 3) return;
    std::vector<Corner> stack = {corners[0], corners[1]};
    for (std::size_t k = 2; k < corners.size(); ++k) {
      const Corner& corner = corners[k];
      const bool is_last = k + 1 == corners.size();
      if (is_last || corner.is_outer != stack.back().is_outer) {
        const bool is_outer = !stack.back().is_outer;
        for (std::size_t s = 0; s + 1 < stack.size(); ++s) {
          if (is_outer) {
            emit(corner.vertex, stack[s + 1].vertex, stack[s].vertex);
          } else {
            emit(corner.vertex, stack[s].vertex, stack[s + 1].vertex);
          }
        }
        stack = {stack.back(), corner};
        continue;
      }
      Corner last = stack.back();
      stack.pop_back();
      while (!stack.empty()) {
        const double bend = turn(at(stack.back().vertex), at(last.vertex), at(corner.vertex));
        if (corner.is_outer ? bend <= 0 : bend >= 0) break;
        if (corner.is_outer) {
          emit(stack.back().vertex, last.vertex, corner.vertex);
        } else {
          emit(corner.vertex, last.vertex, stack.back().vertex);
        }
        last = stack.back();
        stack.pop_back();
      }
      stack.push_back(last);
      stack.push_back(corner);
    }
  }

  /// Given counter-clockwise. What the front has and the back has not ends here downwards.
  void emit(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    if (outer_ > 0) std::swap(b, c);
    mesh_.triangles.push_back({a, b, c});
    joined_.cause_of.push_back(wall_);
    joined_.polygon_of.push_back(kNoPolygon);
  }

  // ---- new vertices on the rims -------------------------------------------------------------------------------------

  void split_edges(Rim& rim, bool is_forward) {
    for (std::size_t i = 0; i + 1 < rim.vertices.size(); ++i) {
      const auto found = rim.added.find(rim.vertices[i]);
      if (found == rim.added.end()) continue;
      std::vector<std::uint32_t> chain = {rim.vertices[i]};
      chain.insert(chain.end(), found->second.begin(), found->second.end());
      chain.push_back(rim.vertices[i + 1]);
      if (!is_forward) std::reverse(chain.begin(), chain.end());
      split_triangle(rim, chain);
    }
  }

  /// The triangle on the edge from the chain's first vertex to its last becomes one on each link.
  void split_triangle(Rim& rim, const std::vector<std::uint32_t>& chain) {
    const std::uint32_t t = rim.triangle_from.at(chain.front());
    const Triangle old = mesh_.triangles[t];
    const auto begin = static_cast<std::size_t>(std::find(old.begin(), old.end(), chain.front()) - old.begin());
    const std::uint32_t top = old[(begin + 2) % 3];
    mesh_.triangles[t] = {chain[0], chain[1], top};
    std::uint32_t last = t;
    for (std::size_t k = 1; k + 1 < chain.size(); ++k) {
      last = static_cast<std::uint32_t>(mesh_.triangles.size());
      mesh_.triangles.push_back({chain[k], chain[k + 1], top});
      joined_.cause_of.push_back(joined_.cause_of[t]);
      joined_.polygon_of.push_back(joined_.polygon_of[t]);
    }
    // The triangle may have another edge on the rim.
    const auto other = rim.triangle_from.find(chain.back());
    if (other != rim.triangle_from.end() && other->second == t) other->second = last;
  }

  HalfSpaceVolume& joined_;
  Mesh& mesh_;
  std::uint32_t wall_ = 0;
  std::array<Rim, 2> rims_;
  std::unordered_map<std::uint32_t, std::uint32_t> same_;  // vertices of the back that are the front's
  int outer_ = 0;                                          // the rim that is farther out: 1 front, -1 back
  std::vector<Corner> region_;
};

/// Gives what is left of the wall the causes of its neighbours, from the rim inwards.
void dissolve_wall(HalfSpaceVolume& side) {
  const auto is_wall = [&](std::uint32_t t) { return side.causes[side.cause_of[t]].kind == CauseKind::target_plane; };
  std::vector<std::vector<std::uint32_t>> neighbours(side.mesh.triangles.size());
  std::vector<std::uint32_t> front;
  const auto uses = core::edge_uses(side.mesh.triangles, side.mesh.vertices.size());
  core::for_each_edge(uses, [&](std::span<const core::EdgeUse> edge) {
    for (const core::EdgeUse& from : edge) {
      for (const core::EdgeUse& to : edge) {
        if (!is_wall(to.triangle) || from.triangle == to.triangle) continue;
        neighbours[from.triangle].push_back(to.triangle);
        if (!is_wall(from.triangle)) front.push_back(from.triangle);
      }
    }
  });
  for (std::size_t next = 0; next < front.size(); ++next) {
    for (const std::uint32_t t : neighbours[front[next]]) {
      if (!is_wall(t)) continue;
      side.cause_of[t] = side.cause_of[front[next]];
      side.polygon_of[t] = side.polygon_of[front[next]];
      front.push_back(t);
    }
  }
}

StageCounts operator+(StageCounts a, const StageCounts& b) {
  a.candidate_blockers += b.candidate_blockers;
  a.visible_blockers += b.visible_blockers;
  a.visible_facets += b.visible_facets;
  a.constraint_edges += b.constraint_edges;
  return a;
}

std::vector<std::uint32_t> numbers_of(const std::vector<Cause>& causes, core::CauseList& list) {
  std::vector<std::uint32_t> numbers;
  for (const Cause& cause : causes) numbers.push_back(list.add(cause));
  return numbers;
}

}  // namespace

HalfSpaceVolume join_half_spaces(const HalfSpaceVolume& front, const HalfSpaceVolume& back) {
  HalfSpaceVolume joined;
  core::CauseList list;
  const std::vector<std::uint32_t> of_front = numbers_of(front.causes, list), of_back = numbers_of(back.causes, list);
  const std::uint32_t wall = list.add({CauseKind::target_plane, "target plane"});
  joined.causes = list.causes();
  Joiner(joined).run(front, back, of_front, of_back, wall);
  dissolve_wall(joined);
  core::compact_causes(joined.mesh, joined.cause_of, joined.causes);
  joined.counts = front.counts + back.counts;
  joined.height = std::max(front.height, back.height);
  joined.range_height = std::max(front.range_height, back.range_height);
  return joined;
}

}  // namespace vantage::internal::exact
