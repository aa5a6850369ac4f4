#include "prove/convex_polygon.h"

#include <algorithm>
#include <utility>

namespace vantage::internal::prove {

CutPolygon cut(const ConvexPolygon& polygon, const HalfSpace& side) {
  std::vector<double> over;
  over.reserve(polygon.size());
  for (const Vec3& corner : polygon) over.push_back(side.over(corner));
  CutPolygon parts;
  const bool some_inside = std::any_of(over.begin(), over.end(), [](double value) { return value < 0; });
  const bool some_outside = std::any_of(over.begin(), over.end(), [](double value) { return value > 0; });
  if (!some_outside) {
    parts.inside = polygon;
    return parts;
  }
  if (!some_inside) {
    parts.outside = polygon;
    return parts;
  }
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const std::size_t next = (i + 1) % polygon.size();
    if (over[i] <= 0) parts.inside.push_back(polygon[i]);
    if (over[i] >= 0) parts.outside.push_back(polygon[i]);
    if (over[i] == 0 || over[next] == 0 || (over[i] < 0) == (over[next] < 0)) continue;
    const Vec3 between = polygon[i] + over[i] / (over[i] - over[next]) * (polygon[next] - polygon[i]);
    parts.inside.push_back(between);
    parts.outside.push_back(between);
  }
  return parts;
}

void subtract(const ConvexPolygon& polygon, const std::vector<HalfSpace>& region, std::vector<ConvexPolygon>& left) {
  if (part_within(polygon, region).empty()) {
    left.push_back(polygon);
    return;
  }
  ConvexPolygon rest = polygon;
  for (const HalfSpace& side : region) {
    CutPolygon parts = cut(rest, side);
    if (!parts.outside.empty()) left.push_back(std::move(parts.outside));
    rest = std::move(parts.inside);
    if (rest.empty()) return;
  }
}

ConvexPolygon part_within(ConvexPolygon polygon, const std::vector<HalfSpace>& region) {
  for (const HalfSpace& side : region) {
    polygon = cut(polygon, side).inside;
    if (polygon.empty()) break;
  }
  return polygon;
}

Vec3 middle_of(const ConvexPolygon& polygon) {
  Vec3 sum = Vec3::Zero();
  for (const Vec3& corner : polygon) sum += corner;
  return sum / static_cast<double>(polygon.size());
}

Box box_of(const ConvexPolygon& polygon) {
  Box box;
  for (const Vec3& corner : polygon) box.extend(corner);
  return box;
}

}  // namespace vantage::internal::prove
