// The plane cuts a triangle in a segment from the edge that the triangle runs downward to the one that it runs upward:
// so the solid lies left of it. The neighbour at that edge runs it downward, and goes on.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <utility>

#include "core/closed_mesh_check.h"
#include "core/orientation.h"
#include "core/weld.h"
#include "core/zone_check.h"
#include "vantage/error.h"
#include "vantage/solid.h"

namespace vantage {
namespace {

using CutPoint = Eigen::Vector2d;
using CutRing = PlanPolygon::Ring;

/// An edge of the mesh by its ends, the one below the plane first.
using CutEdge = std::pair<std::uint32_t, std::uint32_t>;

struct CutSegment {
  CutEdge from, to;
  bool is_used = false;
};

double twice_area(const CutRing& ring) {
  double sum = 0;
  for (std::size_t i = 1; i + 1 < ring.size(); ++i) {
    const CutPoint a = ring[i] - ring[0], b = ring[i + 1] - ring[0];
    sum += a.x() * b.y() - a.y() * b.x();
  }
  return sum;
}

/// Sorted by the edge that they begin at.
std::vector<CutSegment> segments_at(const Mesh& mesh, double z) {
  const std::vector<std::uint32_t> first = internal::core::first_at_position(mesh.vertices);
  const auto is_above = [&](std::uint32_t v) { return mesh.vertices[v].z() > z; };
  std::vector<CutSegment> segments;
  for (const Triangle& triangle : mesh.triangles) {
    const int above = is_above(triangle[0]) + is_above(triangle[1]) + is_above(triangle[2]);
    if (above == 0 || above == 3) continue;
    CutSegment& segment = segments.emplace_back();
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t a = first[triangle[i]], b = first[triangle[(i + 1) % 3]];
      if (is_above(a) && !is_above(b)) segment.from = {b, a};
      if (is_above(b) && !is_above(a)) segment.to = {a, b};
    }
    if (segment.from == segment.to) segments.pop_back();  // a triangle with two corners in one place
  }
  std::sort(segments.begin(), segments.end(),
            [](const CutSegment& a, const CutSegment& b) { return a.from != b.from ? a.from < b.from : a.to < b.to; });
  return segments;
}

/// By the nearer end: of the six roundings none is of more than half of the edge.
CutPoint point_of(const Mesh& mesh, const CutEdge& edge, double z) {
  const Vec3 &low = mesh.vertices[edge.first], &high = mesh.vertices[edge.second];
  const double height = high.z() - low.z(), from_low = (z - low.z()) / height, from_high = (high.z() - z) / height;
  const CutPoint a = low.head<2>(), b = high.head<2>();
  const CutPoint point = from_low <= from_high ? CutPoint(a + from_low * (b - a)) : CutPoint(b + from_high * (a - b));
  return point.cwiseMax(a.cwiseMin(b)).cwiseMin(a.cwiseMax(b));
}

std::vector<CutRing> chained(const Mesh& mesh, std::vector<CutSegment> segments, double z) {
  std::vector<CutRing> rings;
  const auto next_from = [&](const CutEdge& edge) {
    auto next = std::lower_bound(segments.begin(), segments.end(), edge,
                                 [](const CutSegment& segment, const CutEdge& e) { return segment.from < e; });
    while (next != segments.end() && next->from == edge && next->is_used) ++next;
    return next != segments.end() && next->from == edge ? &*next : nullptr;
  };
  for (CutSegment& start : segments) {
    if (start.is_used) continue;
    CutRing ring;
    for (CutSegment* at = &start; at; at = next_from(at->to)) {
      at->is_used = true;
      const CutPoint point = point_of(mesh, at->from, z);
      if (ring.empty() || ring.back() != point) ring.push_back(point);
      if (at->to == start.from) break;
    }
    rings.push_back(std::move(ring));
  }
  return rings;
}

struct InOrder {
  bool operator()(const CutPoint& a, const CutPoint& b) const { return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y(); }
};

/// Cut into parts where it comes back to a point.
std::vector<CutRing> simple_parts(const CutRing& ring) {
  std::vector<CutRing> parts;
  CutRing path;
  std::map<CutPoint, std::size_t, InOrder> place;  // in the path
  for (const CutPoint& point : ring) {
    if (const auto known = place.find(point); known != place.end()) {
      const auto begin = path.begin() + static_cast<std::ptrdiff_t>(known->second);
      CutRing& part = parts.emplace_back(begin, path.end());
      for (std::size_t i = 1; i < part.size(); ++i) place.erase(part[i]);
      path.erase(begin + 1, path.end());
      continue;
    }
    place.emplace(point, path.size());
    path.push_back(point);
  }
  parts.push_back(std::move(path));
  return parts;
}

/// Without points on the line between their neighbours, and without spikes; empty when fewer than three are left.
CutRing tidied_ring(CutRing ring) {
  for (bool has_changed = true; has_changed && ring.size() >= 3;) {
    CutRing kept;
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const CutPoint& before = kept.empty() ? ring.back() : kept.back();
      const CutPoint& after = i + 1 < ring.size() ? ring[i + 1] : kept.empty() ? ring[0] : kept[0];
      const bool is_idle = ring[i] == before || ring[i] == after || internal::core::turn(before, ring[i], after) == 0;
      if (!is_idle) kept.push_back(ring[i]);
    }
    has_changed = kept.size() < ring.size();
    ring = std::move(kept);
  }
  return ring.size() >= 3 ? ring : CutRing{};
}

/// Nothing for a point on the ring.
std::optional<bool> is_inside_ring(const CutPoint& p, const CutRing& ring) {
  bool is_odd = false;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const CutPoint &a = ring[i], &b = ring[(i + 1) % ring.size()];
    if (std::max(a.y(), b.y()) < p.y() || std::min(a.y(), b.y()) > p.y()) continue;
    if (std::max(a.x(), b.x()) < p.x()) continue;
    const int way = internal::core::turn(a, b, p);
    if (way == 0 && std::min(a.x(), b.x()) <= p.x()) return std::nullopt;
    if ((a.y() > p.y()) != (b.y() > p.y()) && (way > 0) == (b.y() > a.y())) is_odd = !is_odd;
  }
  return is_odd;
}

/// For rings that do not cross: decided by the first corner or middle of a side that is not on the outer one.
bool lies_in(const CutRing& hole, const CutRing& outer) {
  for (std::size_t i = 0; i < hole.size(); ++i) {
    const CutPoint middle = (hole[i] + hole[(i + 1) % hole.size()]) / 2;
    for (const CutPoint& point : {hole[i], middle}) {
      if (const std::optional<bool> is_in = is_inside_ring(point, outer)) return *is_in;
    }
  }
  return false;
}

std::vector<PlanPolygon> nested_rings(std::vector<CutRing> rings) {
  std::stable_sort(rings.begin(), rings.end(), [](const CutRing& a, const CutRing& b) {
    return std::abs(twice_area(a)) > std::abs(twice_area(b));
  });
  std::vector<PlanPolygon> polygons;
  std::vector<Box> boxes;
  for (CutRing& ring : rings) {
    if (!internal::core::is_counter_clockwise(ring)) continue;
    Box& box = boxes.emplace_back();
    for (const CutPoint& p : ring) box.extend(Vec3(p.x(), p.y(), 0));
    polygons.push_back({std::move(ring), {}});
  }
  for (CutRing& ring : rings) {
    if (ring.empty()) continue;
    // The smallest round it; a hole in nothing is no wider than what is rounded.
    for (std::size_t i = polygons.size(); i-- > 0;) {
      const Vec3 corner(ring[0].x(), ring[0].y(), 0);
      if ((corner.array() < boxes[i].min.array()).any() || (corner.array() > boxes[i].max.array()).any()) continue;
      if (!lies_in(ring, polygons[i].outer)) continue;
      polygons[i].holes.push_back(std::move(ring));
      break;
    }
  }
  return polygons;
}

}  // namespace

double area_m2(const PlanPolygon& polygon) {
  double twice = twice_area(polygon.outer);
  for (const PlanPolygon::Ring& hole : polygon.holes) twice += twice_area(hole);
  return twice / 2;
}

std::vector<PlanPolygon> slice_mesh(const Mesh& mesh, double z_m) {
  if (!std::isfinite(z_m)) {
    throw Error(ErrorCode::value_out_of_range, "the height is not finite", "z", "give a height in metres");
  }
  internal::core::check_closed(mesh);
  internal::core::check_oriented(mesh);
  std::vector<CutRing> rings;
  for (const CutRing& ring : chained(mesh, segments_at(mesh, z_m), z_m)) {
    for (CutRing& part : simple_parts(ring)) {
      CutRing tidy = tidied_ring(std::move(part));
      if (!tidy.empty()) rings.push_back(std::move(tidy));
    }
  }
  return nested_rings(std::move(rings));
}

}  // namespace vantage
