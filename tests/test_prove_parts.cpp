// What the proof is made of, each part against plain arithmetic: windings, distances of needles, cut polyhedra.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "prove/convex_solid.h"
#include "prove/hull.h"
#include "prove/orientation.h"
#include "prove/rounded_surface.h"
#include "prove/triangle_distance.h"
#include "prove/winding.h"
#include "support/random.h"
#include "support/solids.h"

namespace vantage {
namespace {

using internal::prove::ConvexPolygon;
using internal::prove::ConvexSolid;
using internal::prove::HalfSpace;
using internal::prove::nearest_points;
using internal::prove::NearestPoints;
using internal::prove::orientation;
using internal::prove::passage;
using internal::prove::RoundedSurface;
using internal::prove::surely_apart_by;
using internal::prove::turn;
using internal::prove::Winding;
using testing::Random;
using Corners = std::array<Vec3, 3>;
using FinePoint = Eigen::Matrix<long double, 3, 1>;

/// Whole numbers small enough that every determinant is exact in doubles.
Vec3 on_grid(Random& random, int most) {
  return {static_cast<double>(random.integer(-most, most)), static_cast<double>(random.integer(-most, most)),
          static_cast<double>(random.integer(-most, most))};
}

double volume_of(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  return (a - d).dot((b - d).cross(c - d));
}

/// Numbers along an axis that all are made smaller or larger change no side, also where their products are no doubles.
TEST(ProveParts, SidesAreExactAtEveryScale) {
  Random random(2107);
  std::size_t flat = 0, on_lines = 0;
  for (int i = 0; i < 20000; ++i) {
    const std::array<Vec3, 4> p = {on_grid(random, 3), on_grid(random, 3), on_grid(random, 3), on_grid(random, 3)};
    std::array<Vec3, 4> scaled = p;
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      const int power = random.integer(-1074, 30);
      for (Vec3& point : scaled) point[axis] = std::ldexp(point[axis], power);
    }
    const double volume = volume_of(p[0], p[1], p[2], p[3]);
    EXPECT_EQ(orientation(scaled[0], scaled[1], scaled[2], scaled[3]), (volume > 0) - (volume < 0));
    flat += volume == 0 ? 1 : 0;
    const Eigen::Vector2d a = p[0].head<2>(), b = p[1].head<2>(), c = p[2].head<2>();
    const double area = (b - a).x() * (c - a).y() - (b - a).y() * (c - a).x();
    const double far = std::ldexp(1.0, 30 * random.integer(0, 33));
    const auto at = [&](std::size_t k) { return Eigen::Vector2d(scaled[k].x(), p[k].y() * far); };
    EXPECT_EQ(turn(at(0), at(1), at(2)), (area > 0) - (area < 0));
    on_lines += area == 0 ? 1 : 0;
  }
  EXPECT_GT(flat, 1000);
  EXPECT_GT(on_lines, 1000);
}

/// The same answers after all is moved so far that sums in doubles would lose the last digits: only exact ones agree.
TEST(ProveParts, APassageIsDecidedExactly) {
  Random random(2101);
  std::size_t through = 0, beside = 0, unknown = 0;
  for (int i = 0; i < 20000; ++i) {
    const Vec3 from = on_grid(random, 3), to = on_grid(random, 3);
    const Corners t = {on_grid(random, 3), on_grid(random, 3), on_grid(random, 3)};
    const double at_from = volume_of(t[0], t[1], t[2], from), at_to = volume_of(t[0], t[1], t[2], to);
    std::array<double, 3> sides;
    for (std::size_t k = 0; k < 3; ++k) sides[k] = volume_of(from, to, t[k], t[(k + 1) % 3]);
    const auto [least, most] = std::minmax_element(sides.begin(), sides.end());
    const bool is_flat = (t[1] - t[0]).cross(t[2] - t[0]).isZero(0);
    const std::optional<int> found = passage(from, to, t);
    if (is_flat) {
      EXPECT_TRUE(!found || *found == 0);
    } else if (at_from * at_to < 0 && *least * *most > 0) {
      ++through;
      EXPECT_EQ(found, at_from > 0 ? 1 : -1);
    } else if (at_from * at_to > 0 || (*least < 0 && *most > 0)) {
      ++beside;
      EXPECT_EQ(found, 0);
    } else {
      ++unknown;
      EXPECT_EQ(found, std::nullopt);
    }
    const double step = std::ldexp(1, -30);  // exact about 2^20, and far below what determinants there are rounded by
    const Vec3 far(std::ldexp(1, 20), std::ldexp(1, 20) + 1, -std::ldexp(1, 20));
    Corners moved;
    for (std::size_t k = 0; k < 3; ++k) moved[k] = far + step * t[k];
    EXPECT_EQ(passage(far + step * from, far + step * to, moved), found);
  }
  EXPECT_GT(through, 500U);
  EXPECT_GT(beside, 5000U);
  EXPECT_GT(unknown, 500U);
}

/// Boxes in each other, some inside out, at a place where their sides are a few units of the last digit apart.
TEST(ProveParts, WindingsAreCountedExactly) {
  Random random(2102);
  const Vec3 far(4e6, -3e6, 200);
  const double unit = std::ldexp(1, -29);  // two steps between the largest numbers
  for (int round = 0; round < 200; ++round) {
    Mesh mesh;
    std::vector<std::pair<Box, int>> boxes;
    for (int k = 0; k < 4; ++k) {
      const Vec3 low = on_grid(random, 6),
                 high = low + Vec3(random.integer(1, 6), random.integer(1, 6), random.integer(1, 6));
      Mesh one = testing::make_box_mesh(far + 4 * unit * low, far + 4 * unit * high);
      const int way = random.chance(0.3) ? -1 : 1;
      for (Triangle& t : one.triangles) {
        if (way < 0) std::swap(t[0], t[1]);
      }
      testing::append(mesh, one);
      boxes.push_back({Box{low, high}, way});
    }
    Box all;
    for (const Vec3& vertex : mesh.vertices) all.extend(vertex);
    const RoundedSurface surface(mesh, 0);
    for (int k = 0; k < 20; ++k) {
      const Vec3 place = on_grid(random, 9) + Vec3::Constant(0.5);
      int expected = 0;
      for (const auto& [box, way] : boxes) {
        if ((place.array() > box.min.array()).all() && (place.array() < box.max.array()).all()) expected += way;
      }
      const Vec3 at = far + 4 * unit * place;
      Winding winding(at, all);
      for (const auto& [a, b, c] : mesh.triangles) winding.add({mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]});
      EXPECT_EQ(winding.turns(0), expected);
      EXPECT_EQ(surface.turns_round(at), expected);
    }
  }
}

/// A place of a facet that bounds nothing, as of a flap, is no place of the volume: the one in front of it is told.
TEST(ProveParts, AVolumeIsHeldWhereItIs) {
  const Mesh box = testing::make_box_mesh({1, -1, -1}, {4, 1, 1});
  const RoundedSurface surface(box, 1e-6);
  EXPECT_EQ(surface.surely_held({4, 0.2, 0.1}, 0.5), 0.0);    // its far side
  EXPECT_EQ(surface.surely_held({1, 0.05, 0.02}, 0.5), 0.0);  // its near side: behind it
  const Vec3 tip(10, 0.2, 0.1);
  const std::optional<double> nearer_m = surface.surely_held(tip, 8);
  ASSERT_TRUE(nearer_m);
  EXPECT_GT(*nearer_m, 5.9);
  EXPECT_LE(*nearer_m, 8);
  EXPECT_EQ(surface.turns_round(tip * (1 - *nearer_m / tip.norm())), 1);
  EXPECT_FALSE(surface.surely_held(tip, 5));
}

/// The distance of two triangles with the digits of long double: of each edge from each edge, and of each corner from
/// the other triangle.
long double fine_distance(const Corners& a, const Corners& b) {
  const auto fine = [](const Vec3& point) { return FinePoint(point.cast<long double>()); };
  const auto of_edges = [](const FinePoint& p, const FinePoint& q, const FinePoint& r, const FinePoint& s) {
    const FinePoint u = q - p, v = s - r, w = p - r;
    const long double uu = u.squaredNorm(), uv = u.dot(v), vv = v.squaredNorm(), area = uu * vv - uv * uv;
    long double best = std::numeric_limits<long double>::infinity();
    std::vector<long double> starts = {0, 1};
    if (area > 0) starts.push_back(std::clamp<long double>((uv * v.dot(w) - vv * u.dot(w)) / area, 0, 1));
    for (const long double along : {0.0L, 1.0L}) {  // from the ends of the other one
      if (uu > 0) starts.push_back(std::clamp<long double>(u.dot(r + along * v - p) / uu, 0, 1));
    }
    for (long double at : starts) {
      for (int step = 0; step < 4; ++step) {  // to and fro: each is the nearest of the other one
        const FinePoint on = p + at * u;
        const FinePoint other = vv > 0 ? FinePoint(r + std::clamp<long double>((on - r).dot(v) / vv, 0, 1) * v) : r;
        best = std::min(best, (on - other).norm());
        if (uu > 0) at = std::clamp<long double>((other - p).dot(u) / uu, 0, 1);
      }
    }
    return best;
  };
  const auto from_corner = [&](const FinePoint& point, const Corners& t) {
    const FinePoint u = fine(t[1]) - fine(t[0]), v = fine(t[2]) - fine(t[0]), w = point - fine(t[0]);
    const long double uu = u.squaredNorm(), uv = u.dot(v), vv = v.squaredNorm(), area = uu * vv - uv * uv;
    if (!(area > 0)) return std::numeric_limits<long double>::infinity();
    const long double x = (vv * u.dot(w) - uv * v.dot(w)) / area, y = (uu * v.dot(w) - uv * u.dot(w)) / area;
    return x >= 0 && y >= 0 && x + y <= 1 ? (w - x * u - y * v).norm() : std::numeric_limits<long double>::infinity();
  };
  long double best = std::numeric_limits<long double>::infinity();
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      best = std::min(best, of_edges(fine(a[i]), fine(a[(i + 1) % 3]), fine(b[j]), fine(b[(j + 1) % 3])));
    }
    best = std::min({best, from_corner(fine(a[i]), b), from_corner(fine(b[i]), a)});
  }
  return best;
}

/// Needles and slivers, down to widths that rounding makes, some all but parallel: what is said to be apart is not
/// nearer by a single digit. (Triangles that pass through each other have no such distance: they are 0 apart.)
TEST(ProveParts, NeedlesAreNotSaidToBeFartherApartThanTheyAre) {
  Random random(2103);
  std::size_t apart = 0, close = 0;
  for (int i = 0; i < 20000; ++i) {
    const Vec3 common = random.direction();
    const bool is_parallel = random.chance(0.4);
    const auto needle = [&](const Vec3& centre) {
      const double turned = std::pow(10.0, random.uniform(-12, -4));
      const Vec3 along = is_parallel ? (common + turned * random.direction()).normalized() : random.direction();
      const Vec3 across = random.direction();
      const double width = std::pow(10.0, random.uniform(-16, 0));
      const double length = std::pow(10.0, random.uniform(-1, 2));
      return Corners{Vec3(centre - length * along), Vec3(centre + length * along),
                     Vec3(centre + random.uniform(-1, 1) * length * along + width * across)};
    };
    const Corners a = needle(Vec3::Zero()), b = needle(std::pow(10.0, random.uniform(-6, 1)) * random.direction());
    const NearestPoints found = nearest_points(a, b);
    const double claimed = surely_apart_by(found, a, b);
    const long double exact = fine_distance(a, b);
    EXPECT_LE(claimed, exact) << "pair " << i;
    if (claimed > 0) ++apart;
    if (claimed > exact * (1 - 1e-9L)) ++close;
  }
  EXPECT_GT(apart, 10000U);
  EXPECT_GT(close, 3000U);
}

/// How far a point is outside of a solid along some direction, at least.
double outside_by(const ConvexSolid& solid, const Vec3& point) {
  internal::prove::PointHull hull;
  double largest = point.cwiseAbs().maxCoeff();
  for (const ConvexPolygon& face : solid.faces()) {
    for (const Vec3& corner : face) {
      hull.add(corner);
      largest = std::max(largest, corner.cwiseAbs().maxCoeff());
    }
  }
  const Corners dot = {point, point, point};
  const auto way = internal::prove::separate(hull, internal::prove::Obstacle(std::span<const Vec3>(dot)), largest);
  return way ? way->dot(hull.lowest(*way) - point) / way->norm() : 0;
}

/// All of a tetrahedron that is in the half-spaces is as near to what is left as is said. Some planes pass through
/// corners, along edges and faces, or a few roundings beside them.
TEST(ProveParts, ACutSolidLosesNoMoreThanItSays) {
  Random random(2104);
  std::size_t inside = 0, empty = 0;
  for (int round = 0; round < 3000; ++round) {
    const double size = std::pow(10.0, random.uniform(-3, 3));
    std::array<Vec3, 4> corners;
    for (Vec3& corner : corners) corner = random.point(-size, size);
    if (random.chance(0.3)) corners[3] = (corners[0] + corners[1] + corners[2]) / 3 + 1e-12 * random.point(-size, size);
    std::vector<HalfSpace> sides;
    ConvexSolid solid = ConvexSolid::tetrahedron(corners);
    std::vector<ConvexSolid> beyond;
    for (int k = random.integer(1, 12); k > 0; --k) {
      const Vec3 &a = corners[random.integer(0, 3)], &b = corners[random.integer(0, 3)],
                 &c = corners[random.integer(0, 3)];
      Vec3 way = random.direction();
      if (random.chance(0.3)) way = (b - a).cross(way);
      if (random.chance(0.3)) way = (b - a).cross(c - a);
      if (!(way.norm() > 0)) continue;
      way.normalize();
      double at = way.dot(random.chance(0.5) ? a : Vec3((a + b + c) / 3));
      if (random.chance(0.5)) at += size * std::pow(10.0, random.uniform(-16, 0)) * random.uniform(-1, 1);
      if (random.chance(0.7)) {
        sides.push_back({way, at});
        solid = solid.within(sides.back());
      } else {
        auto [low, high] = solid.split({way, at});
        beyond.push_back(high);
        solid = low;
      }
    }
    ASSERT_LT(solid.lost_m(), 1e-11 * size);
    if (solid.empty()) ++empty;
    for (int k = 0; k < 40; ++k) {
      std::array<double, 4> parts;
      double sum = 0;
      for (double& part : parts) sum += part = random.chance(0.2) ? 0 : std::pow(random.uniform(0, 1), 3);
      if (!(sum > 0)) continue;
      Vec3 point = Vec3::Zero();
      for (std::size_t i = 0; i < 4; ++i) point += parts[i] / sum * corners[i];
      const auto is_beyond = [&](const HalfSpace& side) { return side.over(point) > 0; };
      if (std::any_of(sides.begin(), sides.end(), is_beyond)) continue;
      ++inside;
      double nearest = std::numeric_limits<double>::infinity();
      if (!solid.empty()) nearest = outside_by(solid, point) - solid.lost_m();
      for (const ConvexSolid& part : beyond) {
        if (!part.empty()) nearest = std::min(nearest, outside_by(part, point) - part.lost_m());
      }
      EXPECT_LE(nearest, 4e-15 * size) << "round " << round;  // as the point itself is rounded
    }
  }
  EXPECT_GT(inside, 20000U);
  EXPECT_GT(empty, 20U);
}

}  // namespace
}  // namespace vantage
