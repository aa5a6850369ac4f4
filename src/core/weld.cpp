#include "core/weld.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>
#include <tuple>

#include "core/edges.h"
#include "core/parallel.h"
#include "core/portable_math.h"

namespace vantage::internal::core {
namespace {

/// The vertices in the order of their coordinates, those in one place in the order of their indices.
std::vector<std::uint32_t> order_of_positions(const std::vector<Vec3>& vertices) {
  std::vector<std::uint32_t> order(vertices.size());
  std::iota(order.begin(), order.end(), 0u);
  const auto key = [&](std::uint32_t v) {
    const Vec3& p = vertices[v];
    return std::make_tuple(p.x(), p.y(), p.z(), v);
  };
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
  return order;
}

std::uint64_t mix(std::uint64_t x) {  // splitmix64's finalizer
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ull;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebull;
  return x ^ (x >> 31);
}

std::uint32_t place_of(const Triangle& t, std::uint32_t vertex) {
  return static_cast<std::uint32_t>(std::find(t.begin(), t.end(), vertex) - t.begin());
}

/// The uses of an edge by triangles, in pairs: a backward and a forward one each.
class EdgePairs {
 public:
  /// Keeps references.
  EdgePairs(const Mesh& mesh, const std::vector<Triangle>& owners) : mesh_(mesh), owners_(owners) {}

  template <typename Visit>
  void for_each(std::span<const EdgeUse> edge, const Visit& visit) {
    if (edge.size() == 2) return edge[0].forward ? visit(edge[1], edge[0]) : visit(edge[0], edge[1]);
    order_.assign(edge.begin(), edge.end());
    if (!owners_.empty()) take_pairs_of_owners(visit);
    if (!order_.empty()) take_pairs_about_the_solid(visit);
  }

 private:
  std::pair<std::uint32_t, std::uint32_t> owners_of(const EdgeUse& use) const {
    const Triangle& t = mesh_.triangles[use.triangle];
    return {owners_[use.triangle][place_of(t, use.low)], owners_[use.triangle][place_of(t, use.high)]};
  }

  /// Those that are the only two of their owners.
  template <typename Visit>
  void take_pairs_of_owners(const Visit& visit) {
    const auto before = [&](const EdgeUse& a, const EdgeUse& b) {
      return std::tuple(owners_of(a), a.forward, a.triangle) < std::tuple(owners_of(b), b.forward, b.triangle);
    };
    std::sort(order_.begin(), order_.end(), before);
    std::vector<EdgeUse> left;
    for (std::size_t begin = 0, end = 0; begin < order_.size(); begin = end) {
      while (end < order_.size() && owners_of(order_[end]) == owners_of(order_[begin])) ++end;
      if (end - begin == 2 && !order_[begin].forward && order_[begin + 1].forward) {
        visit(order_[begin], order_[begin + 1]);
      } else {
        left.insert(left.end(), order_.begin() + static_cast<std::ptrdiff_t>(begin),
                    order_.begin() + static_cast<std::ptrdiff_t>(end));
      }
    }
    order_.swap(left);
  }

  /// Those that have the solid between them: from each that runs it from high to low to the next that runs it from low
  /// to high, turning round the edge through the inside.
  template <typename Visit>
  void take_pairs_about_the_solid(const Visit& visit) {
    const Vec3 &low = mesh_.vertices[order_[0].low], &high = mesh_.vertices[order_[0].high];
    const Vec3 along = (high - low).normalized(), u = along.unitOrthogonal(), v = along.cross(u);
    const auto angle = [&](const EdgeUse& use) {
      const Vec3 arm = third_corner(use) - low;
      const double turned = portable::atan2(arm.dot(v), arm.dot(u));
      return std::isnan(turned) ? 0 : turned;  // of an edge without length
    };
    std::sort(order_.begin(), order_.end(), [&](const EdgeUse& a, const EdgeUse& b) {
      return std::tuple(angle(a), a.triangle) < std::tuple(angle(b), b.triangle);
    });
    // Counter-clockwise about the edge a triangle that runs it forward has the solid before it, and one that runs it
    // backward has it after it: brackets that match.
    std::vector<EdgeUse> open;
    for (std::size_t round = 0; round < 2; ++round) {
      for (const EdgeUse& use : order_) {
        if (!use.forward && round == 0) open.push_back(use);
        if (!use.forward || open.empty() || is_taken(use)) continue;
        visit(open.back(), use);
        taken_.push_back(use.triangle);
        open.pop_back();
      }
    }
    taken_.clear();
  }

  const Vec3& third_corner(const EdgeUse& use) const {
    const Triangle& t = mesh_.triangles[use.triangle];
    const auto other = std::find_if(t.begin(), t.end(), [&](std::uint32_t v) { return v != use.low && v != use.high; });
    return mesh_.vertices[other == t.end() ? t[0] : *other];
  }
  bool is_taken(const EdgeUse& use) const {
    return std::find(taken_.begin(), taken_.end(), use.triangle) != taken_.end();
  }

  const Mesh& mesh_;
  const std::vector<Triangle>& owners_;
  std::vector<EdgeUse> order_;
  std::vector<std::uint32_t> taken_;
};

}  // namespace

Mesh welded(const Mesh& mesh) {
  const std::vector<std::uint32_t> order = order_of_positions(mesh.vertices);
  Mesh result;
  std::vector<std::uint32_t> new_index(mesh.vertices.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    if (i == 0 || mesh.vertices[order[i]] != mesh.vertices[order[i - 1]]) {
      result.vertices.push_back(mesh.vertices[order[i]]);
    }
    new_index[order[i]] = static_cast<std::uint32_t>(result.vertices.size() - 1);
  }
  for (const Triangle& t : mesh.triangles) {
    const Triangle n = {new_index[t[0]], new_index[t[1]], new_index[t[2]]};
    if (n[0] != n[1] && n[1] != n[2] && n[2] != n[0]) result.triangles.push_back(n);
  }
  return result;
}

// Points are dealt out by their hash, so that threads share nothing and each looks up in a small table.
std::vector<std::uint32_t> first_at_position(const std::vector<Vec3>& points,
                                             const std::vector<std::uint32_t>& owners) {
  constexpr std::size_t kBits = 6, kParts = std::size_t{1} << kBits;
  struct Entry {
    std::uint64_t hash;
    std::uint32_t point;
  };
  std::vector<std::uint64_t> hashes(points.size());
  parallel::for_ranges(points.size(), 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      for (int a = 0; a < 3; ++a)
        hashes[i] = mix(hashes[i] + 0x9e3779b97f4a7c15ull + std::bit_cast<std::uint64_t>(points[i][a] + 0.0));
      if (!owners.empty()) hashes[i] = mix(hashes[i] + owners[i]);
    }
  });
  std::array<std::size_t, kParts + 1> first{};
  for (const std::uint64_t hash : hashes) ++first[(hash >> (64 - kBits)) + 1];
  std::partial_sum(first.begin(), first.end(), first.begin());
  std::vector<Entry> entries(points.size());
  std::array<std::size_t, kParts + 1> next = first;
  for (std::uint32_t i = 0; i < points.size(); ++i) entries[next[hashes[i] >> (64 - kBits)]++] = {hashes[i], i};
  std::vector<std::uint32_t> first_at(points.size());
  parallel::for_ranges(kParts, 1, [&](std::size_t part, std::size_t) {
    const std::span<const Entry> own(entries.data() + first[part], first[part + 1] - first[part]);
    constexpr std::uint32_t kFree = ~0u;
    const std::size_t mask = std::bit_ceil(2 * own.size() + 1) - 1;
    std::vector<std::uint32_t> slots(mask + 1, kFree);  // into `own`
    for (std::uint32_t i = 0; i < own.size(); ++i) {
      std::size_t slot = own[i].hash & mask;
      const auto differs = [&](const Entry& e) {
        return e.hash != own[i].hash || points[e.point] != points[own[i].point] ||
               (!owners.empty() && owners[e.point] != owners[own[i].point]);
      };
      while (slots[slot] != kFree && differs(own[slots[slot]])) slot = (slot + 1) & mask;
      if (slots[slot] == kFree) slots[slot] = i;
      first_at[own[i].point] = own[slots[slot]].point;
    }
  });
  return first_at;
}

void split_where_pieces_touch(Mesh& mesh, const std::vector<Triangle>& owners) {
  // Corners of triangles that are one vertex: those of the two triangles at an edge, at either end of it.
  DisjointSets corners(3 * mesh.triangles.size());
  const auto corner = [&](const EdgeUse& use, std::uint32_t vertex) {
    return 3 * use.triangle + place_of(mesh.triangles[use.triangle], vertex);
  };
  const std::vector<EdgeUse> uses = edge_uses(mesh.triangles, mesh.vertices.size());
  EdgePairs pairs(mesh, owners);
  for_each_edge(uses, [&](std::span<const EdgeUse> edge) {
    pairs.for_each(edge, [&](const EdgeUse& a, const EdgeUse& b) {
      corners.join(corner(a, edge[0].low), corner(b, edge[0].low));
      corners.join(corner(a, edge[0].high), corner(b, edge[0].high));
    });
  });
  constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> vertex_of(3 * mesh.triangles.size(), kNone);  // by the set's first corner
  std::vector<char> is_taken(mesh.vertices.size(), 0);
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::uint32_t i = 0; i < 3; ++i) {
      std::uint32_t& vertex = vertex_of[corners.find(3 * t + i)];
      std::uint32_t& v = mesh.triangles[t][i];
      if (vertex == kNone && is_taken[v]) {
        vertex = static_cast<std::uint32_t>(mesh.vertices.size());
        mesh.vertices.push_back(Vec3(mesh.vertices[v]));
      } else if (vertex == kNone) {
        vertex = v;
        is_taken[v] = 1;
      }
      v = vertex;
    }
  }
}

std::vector<std::uint32_t> facing_facets(const std::vector<Triangle>& triangles) {
  struct Facet {
    Triangle corners;  // in order
    bool is_odd;       // that order turned the facet round
    std::uint32_t triangle;
    auto key() const { return std::tie(corners, is_odd, triangle); }
  };
  std::vector<Facet> facets;
  facets.reserve(triangles.size());
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    Facet facet{triangles[t], false, t};
    for (const std::size_t i : {0, 1, 0}) {
      if (facet.corners[i] <= facet.corners[i + 1]) continue;
      std::swap(facet.corners[i], facet.corners[i + 1]);
      facet.is_odd = !facet.is_odd;
    }
    facets.push_back(facet);
  }
  std::sort(facets.begin(), facets.end(), [](const Facet& a, const Facet& b) { return a.key() < b.key(); });
  std::vector<std::uint32_t> found;
  for (std::size_t begin = 0, end = 0; begin < facets.size(); begin = end) {
    while (end < facets.size() && facets[end].corners == facets[begin].corners) ++end;
    std::size_t odd = begin;
    while (odd < end && !facets[odd].is_odd) ++odd;
    for (std::size_t i = 0; begin + i < odd && odd + i < end; ++i) {
      found.push_back(facets[begin + i].triangle);
      found.push_back(facets[odd + i].triangle);
    }
  }
  return found;
}

SplitEdges split_shared_edges(Mesh& mesh) {
  SplitEdges result;
  const std::size_t count = mesh.triangles.size();
  // The triangle's part at the vertex that it runs to becomes a new triangle.
  const auto split = [&](const EdgeUse& use, std::uint32_t middle) {
    Triangle& t = mesh.triangles[use.triangle];
    const std::uint32_t from = use.forward ? use.low : use.high, to = use.forward ? use.high : use.low;
    Triangle part = t;
    part[place_of(t, from)] = middle;
    t[place_of(t, to)] = middle;
    mesh.triangles.push_back(part);
    result.part_of.push_back(use.triangle < count ? use.triangle : result.part_of[use.triangle - count]);
  };
  const auto third_corner = [&](const EdgeUse& use) {
    const Triangle& t = mesh.triangles[use.triangle];
    return t[0] ^ t[1] ^ t[2] ^ use.low ^ use.high;
  };
  const std::vector<Triangle> no_owners;
  // A triangle that is split once in a round has other sides then, and waits for the next round: each of its sides once
  // or twice. Halving a side more often would leave it without length.
  constexpr int kRounds = 64;
  for (int round = 0; round < kRounds; ++round) {
    bool has_split = false;
    result.is_done = true;
    std::vector<char> is_split(mesh.triangles.size(), 0);
    const std::vector<EdgeUse> uses = edge_uses(mesh.triangles, mesh.vertices.size());
    EdgePairs pairs(mesh, no_owners);
    for_each_edge(uses, [&](std::span<const EdgeUse> edge) {
      if (edge.size() == 2) return;
      std::vector<std::pair<EdgeUse, EdgeUse>> found;
      pairs.for_each(edge, [&](const EdgeUse& a, const EdgeUse& b) { found.emplace_back(a, b); });
      for (std::size_t i = 1; i < found.size(); ++i) {
        const auto& [a, b] = found[i];
        result.is_done = false;
        if (is_split[a.triangle] || is_split[b.triangle]) continue;
        // The parts of two that face each other would face each other, too.
        if (third_corner(a) == third_corner(b)) continue;
        has_split = true;
        is_split[a.triangle] = is_split[b.triangle] = 1;
        const auto middle = static_cast<std::uint32_t>(mesh.vertices.size());
        mesh.vertices.push_back((mesh.vertices[a.low] + mesh.vertices[a.high]) / 2);
        split(a, middle);
        split(b, middle);
      }
    });
    if (!has_split) break;
  }
  return result;
}

}  // namespace vantage::internal::core
