#include "maps/city/triangulate.h"

#include <CDT.h>

#include <utility>

#include "maps/city/interruption.h"
#include "vantage/error.h"

namespace vantage::internal::city {
namespace {

bool is_strictly_convex(const GridRing& ring) {
  const std::size_t count = ring.size();
  if (count < 3) return false;
  // All corners turn left, and all as seen from the first: no second time round.
  for (std::size_t i = 0; i < count; ++i) {
    if (turn(ring[i], ring[(i + 1) % count], ring[(i + 2) % count]) <= 0) return false;
  }
  for (std::size_t i = 1; i + 1 < count; ++i) {
    if (turn(ring[0], ring[i], ring[i + 1]) <= 0) return false;
  }
  return true;
}

/// A fan; of many corners one triangle for each half, quarter and so on, since the triangles of a fan of thousands all
/// lie next to each other, and whatever looks at those that are near takes time with the square of their number.
std::vector<Triangle> triangles_of_convex(std::size_t count) {
  constexpr std::uint32_t kFan = 256;
  std::vector<Triangle> result;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> open = {{0, static_cast<std::uint32_t>(count - 1)}};
  while (!open.empty()) {
    const auto [first, last] = open.back();
    open.pop_back();
    if (last - first < kFan) {
      for (std::uint32_t i = first + 1; i < last; ++i) result.push_back({first, i, i + 1});
      continue;
    }
    const std::uint32_t middle = first + (last - first) / 2;
    result.push_back({first, middle, last});
    open.emplace_back(middle, last);
    open.emplace_back(first, middle);
  }
  return result;
}

std::vector<Triangle> triangles_of(const std::vector<GridRing>& rings) {
  std::vector<CDT::V2d<double>> points;
  std::vector<CDT::Edge> edges;
  for (const GridRing& ring : rings) {
    const auto first = static_cast<CDT::VertInd>(points.size()), count = static_cast<CDT::VertInd>(ring.size());
    for (CDT::VertInd i = 0; i < count; ++i) {
      points.emplace_back(static_cast<double>(ring[i].x), static_cast<double>(ring[i].y));
      edges.emplace_back(first + i, first + (i + 1) % count);
    }
  }
  try {
    const CDT::DuplicatesInfo duplicates = CDT::RemoveDuplicatesAndRemapEdges(points, edges);
    std::vector<std::uint32_t> first_of(points.size(), ~0u);  // the corner that a point stands for
    for (std::uint32_t i = 0; i < duplicates.mapping.size(); ++i) {
      std::uint32_t& first = first_of[duplicates.mapping[i]];
      first = std::min(first, i);
    }
    CDT::Triangulation<double> cdt(CDT::VertexInsertionOrder::Auto, CDT::IntersectingConstraintEdges::NotAllowed, 0);
    cdt.insertVertices(points);
    cdt.insertEdges(edges);
    cdt.eraseOuterTrianglesAndHoles();
    std::vector<Triangle> result;
    result.reserve(cdt.triangles.size());
    for (const CDT::Triangle& t : cdt.triangles) {
      result.push_back({first_of[t.vertices[0]], first_of[t.vertices[1]], first_of[t.vertices[2]]});
    }
    return result;
  } catch (const CDT::Error& error) {
    throw Error(ErrorCode::internal_defect, std::string("an outline could not be triangulated: ").append(error.what()),
                "outline", "please report this with the map");
  }
}

}  // namespace

std::vector<Triangle> triangulate(const std::vector<GridRing>& rings) {
  constexpr std::size_t kMany = 500;
  if (rings.size() == 1 && is_strictly_convex(rings[0])) return triangles_of_convex(rings[0].size());
  std::size_t corners = 0;
  for (const GridRing& ring : rings) corners += ring.size();
  return corners < kMany ? triangles_of(rings) : Interruption::run_apart([rings] { return triangles_of(rings); });
}

}  // namespace vantage::internal::city
