#include "verify/closed_mesh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "core/format.h"
#include "vantage/error.h"
#include "verify/random.h"
#include "verify/tolerances.h"

namespace vantage::internal::verify {
namespace {

constexpr int kDirections = 24;  // tried before a point counts as lying on the surface

void check_numbers(const Mesh& mesh, const std::string& name) {
  if (mesh.empty()) throw Error(ErrorCode::mesh_empty, "the mesh has no triangles", name, "give a closed mesh");
  for (const Vec3& vertex : mesh.vertices) {
    if (!vertex.allFinite())
      throw Error(ErrorCode::coordinate_not_finite, "a vertex of the mesh is not finite", name, "write the mesh again");
    if (vertex.cwiseAbs().maxCoeff() > kFarthestCoordinate) {
      throw Error(ErrorCode::coordinate_too_large, "a vertex of the mesh is farther than 1e9 m from the origin", name,
                  "give coordinates in metres");
    }
  }
  for (const Triangle& triangle : mesh.triangles) {
    for (const std::uint32_t corner : triangle) {
      if (corner >= mesh.vertices.size()) {
        throw Error(ErrorCode::index_out_of_range,
                    "triangle corner " + std::to_string(corner) + " does not exist: the mesh has " +
                        std::to_string(mesh.vertices.size()) + " vertices",
                    name, "write the mesh again");
      }
    }
  }
}

/// For every vertex the first one at the same position.
std::vector<std::uint32_t> first_at_position(const std::vector<Vec3>& vertices) {
  std::vector<std::uint32_t> order(vertices.size()), first(vertices.size());
  std::iota(order.begin(), order.end(), 0u);
  const auto key = [&vertices](std::uint32_t i) {
    return std::array<double, 3>{vertices[i].x(), vertices[i].y(), vertices[i].z()};
  };
  std::sort(order.begin(), order.end(), [&key](auto a, auto b) { return std::pair(key(a), a) < std::pair(key(b), b); });
  for (std::size_t i = 0; i < order.size(); ++i) {
    first[order[i]] = i > 0 && vertices[order[i]] == vertices[order[i - 1]] ? first[order[i - 1]] : order[i];
  }
  return first;
}

struct EdgeSurvey {
  Topology topology;
  bool all_twice = true;
};

/// `names`: the identity of each vertex. Triangles with two corners of one name are left out.
EdgeSurvey survey(const Mesh& mesh, const std::vector<std::uint32_t>& names) {
  struct Edge {
    std::uint32_t low, high;
    int turn;
    bool joins(const Edge& other) const { return low == other.low && high == other.high; }
  };
  std::vector<Edge> edges;
  std::vector<bool> used(mesh.vertices.size(), false);
  long faces = 0;
  for (const Triangle& triangle : mesh.triangles) {
    const Triangle t{names[triangle[0]], names[triangle[1]], names[triangle[2]]};
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;
    ++faces;
    for (int i = 0; i < 3; ++i) {
      const std::uint32_t a = t[i], b = t[(i + 1) % 3];
      used[a] = true;
      edges.push_back({std::min(a, b), std::max(a, b), a < b ? 1 : -1});
    }
  }
  std::sort(edges.begin(), edges.end(),
            [](const Edge& a, const Edge& b) { return std::pair(a.low, a.high) < std::pair(b.low, b.high); });
  EdgeSurvey result;
  OpenEdges& open = result.topology.open_edges;
  result.topology.oriented = true;
  long distinct = 0;
  for (std::size_t i = 0, end = 0; i < edges.size(); i = end) {
    int turns = 0;
    for (end = i; end < edges.size() && edges[end].joins(edges[i]); ++end) turns += edges[end].turn;
    ++distinct;
    result.all_twice &= end - i == 2;
    result.topology.oriented &= turns == 0;
    if ((end - i) % 2 == 0) continue;
    if (open.count++ == 0) open.middle_of_first = 0.5 * (mesh.vertices[edges[i].low] + mesh.vertices[edges[i].high]);
  }
  result.topology.closed = open.count == 0;
  result.topology.euler = std::count(used.begin(), used.end(), true) - distinct + faces;
  return result;
}

std::size_t count_flat(const Mesh& mesh, const std::vector<std::uint32_t>& places) {
  return static_cast<std::size_t>(
      std::count_if(mesh.triangles.begin(), mesh.triangles.end(), [&](const Triangle& triangle) {
        const Triangle t{places[triangle[0]], places[triangle[1]], places[triangle[2]]};
        const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
        return t[0] == t[1] || t[1] == t[2] || t[2] == t[0] || (b - a).cross(c - a).isZero(0);
      }));
}

/// A fixed direction for each attempt: membership is a function of the point alone.
Vec3 direction(int attempt) {
  Random random(0x5eed, static_cast<std::uint64_t>(attempt));
  const double z = random.uniform(-1, 1), turn = random.uniform(0, 2 * std::numbers::pi);
  const double radius = std::sqrt(1 - z * z);
  return {radius * std::cos(turn), radius * std::sin(turn), z};
}

}  // namespace

Topology topology_of(const Mesh& mesh, const std::string& name) {
  check_numbers(mesh, name);
  std::vector<std::uint32_t> names(mesh.vertices.size());
  std::iota(names.begin(), names.end(), 0u);
  const EdgeSurvey by_index = survey(mesh, names);
  const std::vector<std::uint32_t> places = first_at_position(mesh.vertices);
  Topology topology = survey(mesh, places).topology;
  topology.flat = count_flat(mesh, places);
  if (by_index.all_twice) topology.euler = by_index.topology.euler;
  return topology;
}

ClosedMesh::ClosedMesh(const Mesh& mesh, const Vec3& origin, const std::string& name)
    : topology_(topology_of(mesh, name)) {
  if (!topology_.closed) {
    const OpenEdges& open = topology_.open_edges;
    const Vec3& at = open.middle_of_first;
    throw Error(ErrorCode::mesh_not_closed,
                "the mesh is not closed: " + std::to_string(open.count) + " edges have an odd number of triangles",
                core::format("{}, edge with its middle at ({:.10g}, {:.10g}, {:.10g})", name, at.x(), at.y(), at.z()),
                "give a closed mesh: every edge between two triangles");
  }
  std::vector<Box> boxes;
  for (const Triangle& triangle : mesh.triangles) {
    triangles_.emplace_back(mesh.vertices[triangle[0]] - origin, mesh.vertices[triangle[1]] - origin,
                            mesh.vertices[triangle[2]] - origin);
    boxes.push_back(triangles_.back().bounds());
    bounds_.extend(boxes.back());
  }
  diagonal_ = (bounds_.max - bounds_.min).norm();
  const double reach = std::max(bounds_.min.cwiseAbs().maxCoeff(), bounds_.max.cwiseAbs().maxCoeff()) + 2 * diagonal_;
  index_.emplace(boxes, reach);
}

std::optional<bool> ClosedMesh::contains(const Vec3& point) const {
  if ((point.array() < bounds_.min.array()).any() || (point.array() > bounds_.max.array()).any()) return false;
  for (int attempt = 0; attempt < kDirections; ++attempt) {
    static const auto directions = [] {
      std::array<Vec3, kDirections> all;
      for (int i = 0; i < kDirections; ++i) all[i] = direction(i);
      return all;
    }();
    const std::optional<bool> answer = contains_along(point, directions[attempt]);
    if (answer) return answer;
  }
  return std::nullopt;
}

std::optional<bool> ClosedMesh::contains_along(const Vec3& point, const Vec3& direction) const {
  const Segment ray(point, point + 1.5 * diagonal_ * direction);  // ends outside
  long winding = 0, crossings = 0;
  const bool unsure = index_->any_along(ray.from, ray.to, [&](std::uint32_t i) {
    const Intersection hit = intersect(ray, triangles_[i]);
    if (hit.contact == Contact::unsure) return true;
    if (hit.contact == Contact::crossing) {
      winding += hit.turn;
      ++crossings;
    }
    return false;
  });
  if (unsure) return std::nullopt;
  return topology_.oriented ? winding != 0 : crossings % 2 == 1;
}

double ClosedMesh::distance_to_surface(const Vec3& point) const {
  double nearest = std::numeric_limits<double>::infinity();
  index_->nearest(point, [&](std::uint32_t i) {
    nearest = std::min(nearest, distance(point, triangles_[i]));
    return nearest;
  });
  return nearest;
}

}  // namespace vantage::internal::verify
