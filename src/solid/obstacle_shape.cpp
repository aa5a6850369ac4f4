#include "solid/obstacle_shape.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "core/triangle_distance.h"
#include "solid/convex_hull.h"

namespace vantage::internal::solid {
namespace {

constexpr double kRounding = 1e-9;  // of the size

/// Along the normal.
Vec3 doubled_area(const Polygon& polygon) {
  Vec3 area = Vec3::Zero();
  for (std::size_t k = 2; k < polygon.size(); ++k) {
    area += (polygon[k - 1] - polygon[0]).cross(polygon[k] - polygon[0]);
  }
  return area;
}

Vec3 normal_of(const Polygon& polygon) { return doubled_area(polygon).normalized(); }

/// Whether each edge belongs to two polygons; `opposite`: and they run it in opposite directions.
bool are_closed(const std::vector<Polygon>& polygons, const std::vector<std::uint32_t>& members, bool opposite) {
  struct Uses {
    int forward = 0, backward = 0;
  };
  std::map<std::array<double, 6>, Uses> edges;
  for (const std::uint32_t i : members) {
    const Polygon& polygon = polygons[i];
    for (std::size_t k = 0; k < polygon.size(); ++k) {
      const Vec3 &from = polygon[k], &to = polygon[(k + 1) % polygon.size()];
      const bool is_low = std::lexicographical_compare(from.begin(), from.end(), to.begin(), to.end());
      const Vec3 &low = is_low ? from : to, &high = is_low ? to : from;
      Uses& uses = edges[{low.x(), low.y(), low.z(), high.x(), high.y(), high.z()}];
      ++(is_low ? uses.forward : uses.backward);
    }
  }
  return std::all_of(edges.begin(), edges.end(), [&](const auto& edge) {
    const auto& [forward, backward] = edge.second;
    return forward + backward == 2 && (!opposite || forward == 1);
  });
}

double size_of(const std::vector<Vec3>& points) {
  Box box;
  for (const Vec3& point : points) box.extend(point);
  return (box.max - box.min).norm();
}

/// Whether the hull is as good as flat: then its normals are rounding.
bool is_flat(const Mesh& hull) {
  Vec3 normal = Vec3::Zero();  // of the largest facet
  Vec3 on_it = Vec3::Zero();
  for (const auto& [a, b, c] : hull.triangles) {
    const Vec3 area = doubled_area({hull.vertices[a], hull.vertices[b], hull.vertices[c]});
    if (area.squaredNorm() <= normal.squaredNorm()) continue;
    normal = area;
    on_it = hull.vertices[a];
  }
  normal.normalize();
  const double slack = kRounding * size_of(hull.vertices);
  return std::all_of(hull.vertices.begin(), hull.vertices.end(),
                     [&](const Vec3& vertex) { return normal.dot(on_it - vertex) <= slack; });
}

/// Whether all corners lie behind each polygon (or all before), and the polygons are closed and cover the hull once.
/// All of them face outwards, and edges run both ways: so they cover each place of the hull as often as each other.
bool bound_a_convex_solid(const std::vector<Polygon>& polygons, const std::vector<std::uint32_t>& members,
                          const std::vector<Vec3>& corners, const Mesh& hull) {
  constexpr std::size_t kFewestFacets = 4;
  if (members.size() < kFewestFacets) return false;
  const double slack = kRounding * size_of(corners);
  bool may_face_out = true, may_face_in = true;
  for (const std::uint32_t i : members) {
    const Vec3 normal = normal_of(polygons[i]);
    for (const Vec3& corner : corners) {
      const double height = normal.dot(corner - polygons[i][0]);
      may_face_out = may_face_out && height <= slack;  // NaN too
      may_face_in = may_face_in && height >= -slack;
    }
    if (!may_face_out && !may_face_in) return false;
  }
  constexpr double kSame = 1e-6;
  double area = 0, of_hull = 0;
  for (const std::uint32_t i : members) area += doubled_area(polygons[i]).norm();
  for (const auto& [a, b, c] : hull.triangles) {
    of_hull += doubled_area({hull.vertices[a], hull.vertices[b], hull.vertices[c]}).norm();
  }
  return std::abs(area - of_hull) <= kSame * of_hull && are_closed(polygons, members, true);
}

/// How near the facets of a hull are to polygons.
class Gaps {
 public:
  Gaps(const std::vector<Polygon>& polygons, const std::vector<std::uint32_t>& members, double radius)
      : polygons_(polygons), members_(members), radius_(radius) {}

  /// No where it takes too many looks, too.
  bool are_narrow(const Vec3& a, const Vec3& b, const Vec3& c) {
    const bool is_of_one = std::any_of(members_.begin(), members_.end(), [&](std::uint32_t i) {
      const Polygon& polygon = polygons_[i];
      const auto has = [&](const Vec3& p) { return std::find(polygon.begin(), polygon.end(), p) != polygon.end(); };
      return has(a) && has(b) && has(c);
    });
    over_ = radius_ * (b - a).cross(c - a).normalized();
    return is_of_one || are_narrow_in(a, b, c);
  }

 private:
  bool are_narrow_in(const Vec3& a, const Vec3& b, const Vec3& c) {
    // What is smaller needs no closer look. It is as much too far at the most.
    constexpr double kSmall = 0.015, kWidest = kWidestGap - kSmall, kHighest = 1 + kOverGaps - kSmall;  // of the radius
    if (--looks_left_ < 0) return false;
    const Vec3 middle = (a + b + c) / 3;
    const double size = std::max({(a - middle).norm(), (b - middle).norm(), (c - middle).norm()});
    const double widest = kWidest * radius_, highest = kHighest * radius_;
    const double wide = distance(middle, widest - size);
    if (!(wide <= widest)) return false;
    const double high = distance(middle + over_, highest - size);
    if (!(high <= highest)) return false;
    if ((wide + size <= widest && high + size <= highest) || size <= kSmall * radius_) return true;
    const Vec3 ab = (a + b) / 2, bc = (b + c) / 2, ca = (c + a) / 2;
    return are_narrow_in(ab, bc, ca) && are_narrow_in(a, ab, ca) && are_narrow_in(ab, b, bc) &&
           are_narrow_in(ca, bc, c);
  }

  /// To the nearest polygon, or to one that is no farther than `enough`. The last such one is asked first.
  double distance(const Vec3& point, double enough) {
    double least = std::numeric_limits<double>::infinity();
    const double enough_squared = enough > 0 ? enough * enough : -1;
    for (std::size_t m = 0; m < members_.size(); ++m) {
      const std::size_t at = (last_ + m) % members_.size();
      const Polygon& polygon = polygons_[members_[at]];
      for (std::size_t k = 2; k < polygon.size(); ++k) {
        least = std::min(least, core::squared_distance_to_triangle(point, polygon[0], polygon[k - 1], polygon[k]));
      }
      if (least <= enough_squared) {
        last_ = at;
        break;
      }
    }
    return std::sqrt(least);
  }

  const std::vector<Polygon>& polygons_;
  const std::vector<std::uint32_t>& members_;
  double radius_;
  Vec3 over_ = Vec3::Zero();  ///< the facet, to where what is grown over it ends
  int looks_left_ = 2000;
  std::size_t last_ = 0;
};

}  // namespace

std::vector<Vec3> corners_of(const std::vector<Polygon>& polygons, const std::vector<std::uint32_t>& members) {
  std::vector<Vec3> corners;
  for (const std::uint32_t i : members) corners.insert(corners.end(), polygons[i].begin(), polygons[i].end());
  std::sort(corners.begin(), corners.end(), [](const Vec3& a, const Vec3& b) {
    return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
  });
  corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
  return corners;
}

bool is_nearly_convex(const std::vector<Polygon>& polygons, const std::vector<std::uint32_t>& members,
                      double radius_m) {
  constexpr std::size_t kMost = 200;
  if (members.size() > kMost) return false;
  const std::vector<Vec3> corners = corners_of(polygons, members);
  const Mesh hull = convex_hull(corners);
  if (hull.empty() || is_flat(hull)) return false;
  if (bound_a_convex_solid(polygons, members, corners, hull)) return true;
  Gaps gaps(polygons, members, radius_m);
  return std::all_of(hull.triangles.begin(), hull.triangles.end(), [&](const Triangle& t) {
    return gaps.are_narrow(hull.vertices[t[0]], hull.vertices[t[1]], hull.vertices[t[2]]);
  });
}

Columns columns_of(const std::vector<Polygon>& polygons, const std::vector<std::uint32_t>& members) {
  constexpr double kUpright = 1e-12;  // leaning by less is within what is allowed for rounding
  double low = std::numeric_limits<double>::infinity();
  const std::vector<Vec3> corners = corners_of(polygons, members);
  for (const Vec3& corner : corners) low = std::min(low, corner.z());
  const double slack = kUpright * size_of(corners);
  std::vector<std::uint32_t> roofs, walls;
  for (const std::uint32_t i : members) {
    const double up = normal_of(polygons[i]).z();
    const bool is_low = std::all_of(polygons[i].begin(), polygons[i].end(),
                                    [&](const Vec3& corner) { return corner.z() <= low + slack; });
    if (std::abs(up) <= kUpright) {
      walls.push_back(i);
    } else if (is_low == (up > 0)) {
      return {};  // a roof without height, or what overhangs
    } else if (!is_low) {
      roofs.push_back(i);
    }
  }
  if (!are_closed(polygons, members, true)) return {};
  Columns result;
  std::map<std::array<double, 2>, std::vector<std::pair<std::uint32_t, double>>> roofs_at;  // with their heights
  for (const std::uint32_t i : roofs) {
    std::vector<Vec3>& column = result.columns.emplace_back(polygons[i]);
    for (const Vec3& corner : polygons[i]) {
      column.emplace_back(corner.x(), corner.y(), low);
      roofs_at[{corner.x(), corner.y()}].emplace_back(i, corner.z());
    }
  }
  const auto is_under = [&](const Vec3& corner, std::uint32_t roof) {
    const auto found = roofs_at.find({corner.x(), corner.y()});
    return found != roofs_at.end() && std::any_of(found->second.begin(), found->second.end(), [&](const auto& over) {
             return over.first == roof && over.second >= corner.z();
           });
  };
  for (const std::uint32_t i : walls) {
    const Polygon& wall = polygons[i];
    const auto first = roofs_at.find({wall[0].x(), wall[0].y()});
    const bool is_in_one =
        first != roofs_at.end() && std::any_of(first->second.begin(), first->second.end(), [&](const auto& over) {
          return std::all_of(wall.begin(), wall.end(), [&](const Vec3& c) { return is_under(c, over.first); });
        });
    if (!is_in_one) result.others.push_back(i);
  }
  return result;
}

}  // namespace vantage::internal::solid
