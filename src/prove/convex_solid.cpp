#include "prove/convex_solid.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include "prove/orientation.h"

namespace vantage::internal::prove {

ConvexSolid ConvexSolid::tetrahedron(const std::array<Vec3, 4>& corners) {
  const auto& [a, b, c, d] = corners;
  ConvexSolid solid;
  solid.faces_ = {{a, b, c}, {a, b, d}, {b, c, d}, {c, a, d}};
  return solid;
}

std::size_t ConvexSolid::corner_count() const {
  std::size_t count = 0;
  for (const ConvexPolygon& face : faces_) count += face.size();
  return count;
}

Box ConvexSolid::box() const {
  Box box;
  for (const ConvexPolygon& face : faces_) {
    for (const Vec3& corner : face) box.extend(corner);
  }
  return box;
}

Vec3 ConvexSolid::middle() const {
  Vec3 sum = Vec3::Zero();
  for (const ConvexPolygon& face : faces_) sum += middle_of(face) / static_cast<double>(faces_.size());
  return sum;
}

namespace {

bool is_before(const Vec3& a, const Vec3& b) {
  return std::tuple(a.x(), a.y(), a.z()) < std::tuple(b.x(), b.y(), b.z());
}

/// On an edge, the same for both of its faces.
Vec3 cut_edge(const Vec3& a, double over_a, const Vec3& b, double over_b) {
  if (is_before(b, a)) return cut_edge(b, over_b, a, over_a);
  return a + over_a / (over_a - over_b) * (b - a);
}

/// What points in a plane with that normal span (Andrew 1979).
ConvexPolygon span_of(const ConvexPolygon& points, const Vec3& normal) {
  const Vec3 u = normal.unitOrthogonal(), v = normal.cross(u);
  struct Placed {
    Eigen::Vector2d at;
    Vec3 point;
  };
  std::vector<Placed> placed;
  for (const Vec3& point : points) placed.push_back({{u.dot(point), v.dot(point)}, point});
  std::sort(placed.begin(), placed.end(), [](const Placed& a, const Placed& b) {
    return a.at.x() < b.at.x() || (a.at.x() == b.at.x() && a.at.y() < b.at.y());
  });
  std::vector<Placed> chain;
  for (const int way : {1, -1}) {
    const std::size_t first = chain.size();
    for (const Placed& next : placed) {
      while (chain.size() > first + 1 && turn(chain[chain.size() - 2].at, chain.back().at, next.at) <= 0) {
        chain.pop_back();
      }
      chain.push_back(next);
    }
    if (way == 1) std::reverse(placed.begin(), placed.end());
    chain.pop_back();
  }
  if (chain.empty()) chain.push_back(placed.front());
  ConvexPolygon corners;
  for (const Placed& corner : chain) corners.push_back(corner.point);
  return corners;
}

}  // namespace

/// What a cut moves a corner by, sideways, and how far numbers tell on which side of a plane it is.
double ConvexSolid::step_m() const {
  constexpr double kRoundings = 8;
  double largest = 0;
  for (const ConvexPolygon& face : faces_) {
    for (const Vec3& corner : face) largest = std::max(largest, corner.cwiseAbs().maxCoeff());
  }
  return kRoundings * std::numeric_limits<double>::epsilon() * largest;
}

/// Farther out by what was lost: all that it stands for and that lies in the half-space is near to what is left.
ConvexSolid ConvexSolid::within(const HalfSpace& side) const {
  return part_in({side.normal, side.offset + lost_m_ + uneven_m_ + step_m()});
}

/// Both parts have the same corners on cut edges. So what the one loses along an edge the other one has.
std::pair<ConvexSolid, ConvexSolid> ConvexSolid::split(const HalfSpace& side) const {
  return {part_in(side), part_in({-side.normal, -side.offset})};
}

ConvexSolid ConvexSolid::part_in(const HalfSpace& side) const {
  ConvexSolid left;
  ConvexPolygon lid;
  bool is_cut = false, has_inside = false;
  for (const ConvexPolygon& face : faces_) {
    ConvexPolygon kept;
    for (std::size_t i = 0; i < face.size(); ++i) {
      const Vec3 &here = face[i], &next = face[i + 1 < face.size() ? i + 1 : 0];
      const double at_here = side.over(here), at_next = side.over(next);
      if (at_here <= 0) kept.push_back(here);
      if (at_here == 0) lid.push_back(here);
      is_cut = is_cut || at_here > 0;
      has_inside = has_inside || at_here < 0;
      if ((at_here < 0 && at_next > 0) || (at_here > 0 && at_next < 0)) {
        kept.push_back(cut_edge(here, at_here, next, at_next));
        lid.push_back(kept.back());
      }
    }
    if (!kept.empty()) left.faces_.push_back(std::move(kept));
  }
  if (!is_cut) return *this;
  if (!has_inside) return {};
  if (!lid.empty()) left.faces_.push_back(span_of(lid, side.normal));
  const double step = step_m();
  left.lost_m_ = lost_m_ + uneven_m_ + step;
  left.uneven_m_ = uneven_m_ + step;
  return left;
}

}  // namespace vantage::internal::prove
