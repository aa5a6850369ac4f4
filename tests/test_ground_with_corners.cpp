// The space above grounds whose triangles have corners on each other's sides.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>
#include <utility>
#include <vector>

#include "core/progress_reporter.h"
#include "solid/ground_band.h"
#include "support/grounds.h"
#include "support/random.h"
#include "support/solids.h"
#include "support/wording.h"
#include "vantage/error.h"
#include "vantage/volume.h"

namespace vantage {
namespace {

using testing::above;
using testing::first_open_edge;
using testing::GroundCase;
using testing::holds;
using testing::kGroundCases;
using testing::make_hemisphere;
using testing::make_hills;
using testing::Random;
using testing::slack;
using testing::walls_inside;

/// Each triangle in two, at a corner on one of its sides that its neighbour there may not have.
Mesh split_in_two(const Mesh& mesh, Random& random) {
  Mesh result = mesh;
  for (Triangle& t : result.triangles) std::rotate(t.begin(), t.begin() + random.integer(0, 2), t.end());
  for (std::size_t i = 0, count = mesh.triangles.size(); i < count; ++i) {
    const auto [a, b, c] = result.triangles[i];
    const auto corner = static_cast<std::uint32_t>(result.vertices.size());
    const double share = random.uniform(0.1, 0.9);
    result.vertices.emplace_back(result.vertices[a] + share * (result.vertices[b] - result.vertices[a]));
    result.triangles[i] = {a, corner, c};
    result.triangles.push_back({corner, b, c});
  }
  return result;
}

TEST(GroundWithCorners, NoWallsStandWhereTheGroundGoesOn) {
  Random random(47);
  for (const GroundCase& at : kGroundCases) {
    SCOPED_TRACE(at.scale);
    const Volume dome = make_hemisphere(at.origin, 60 * at.scale);
    Mesh ground = make_hills(random, 50 * at.scale, 6 * at.scale, 6, at.origin);
    const Volume whole = cut_to_navigation(dome, above(ground, 4 * at.scale, 25 * at.scale));
    for (int times = 1; times <= 3; ++times) {
      ground = split_in_two(ground, random);
      const Volume cut = cut_to_navigation(dome, above(ground, 4 * at.scale, 25 * at.scale));
      ASSERT_EQ(cut.outcome, Outcome::computed) << cut.reason;
      EXPECT_EQ(first_open_edge(cut.mesh), "");
      EXPECT_EQ(walls_inside(cut, at.origin, 50 * at.scale), 0) << "of " << cut.mesh.triangles.size() << " facets";
      const double rounding = 1e-9 + 1e-15 * at.origin.cwiseAbs().maxCoeff() / at.scale;
      EXPECT_NEAR(enclosed_volume(cut.mesh) / enclosed_volume(whole.mesh), 1, rounding);
      EXPECT_NEAR(surface_area(cut.mesh) / surface_area(whole.mesh), 1, 1e-6 + rounding);
    }
  }
}

TEST(GroundWithCorners, AStepOfTheGroundIsNoWallAboveIt) {
  Mesh ground;  // two halves, at x = 0 one 2 m over the other, with corners of their own
  ground.vertices = {{-50, -50, 0}, {0, -50, 0},  {0, 50, 0},  {-50, 50, 0},
                     {0, -50, 2},   {50, -50, 2}, {50, 50, 2}, {0, 50, 2}};
  ground.triangles = {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {4, 6, 7}};
  const Volume cut = cut_to_navigation(make_hemisphere(Vec3::Zero(), 60), above(ground, 4, 25));
  ASSERT_EQ(cut.outcome, Outcome::computed) << cut.reason;
  EXPECT_EQ(walls_inside(cut, Vec3::Zero(), 50), 0) << "of " << cut.mesh.triangles.size() << " facets";
  // The upper half of the dome has no hole: the step alone is upright.
  double upright_m2 = 0;
  for (const Triangle& t : cut.mesh.triangles) {
    const Vec3 &a = cut.mesh.vertices[t[0]], &b = cut.mesh.vertices[t[1]], &c = cut.mesh.vertices[t[2]];
    if (std::max({std::abs(a.x()), std::abs(b.x()), std::abs(c.x())}) < 1e-9)
      upright_m2 += (b - a).cross(c - a).norm() / 2;
  }
  EXPECT_GT(upright_m2, 2 * 90);
  EXPECT_LT(upright_m2, 2 * 2 * 100 + 1);  // at the bottom and at the top of the band
}

/// Three triangles, two of which end beside an end of a side of the first: `gap` from it and from each other.
Mesh make_corners_beside_an_end(const Vec3& origin, double length, double gap) {
  const double turn = gap / length, share = 0.6;
  const Vec3 a(0, 0, 0), b(length, 0, 0), c(length * std::cos(turn), length * std::sin(turn), 0);
  const Vec3 d(length - share * length, -share * share * gap, 5 * length);
  const Vec3 back = (a - c) / length;
  const Vec3 e = c + share * length * back + Vec3(share * share * gap * back.y(), -share * share * gap * back.x(), 0) +
                 Vec3(0, 0, 7 * length);
  Mesh mesh;
  for (const Vec3& v : {a, b, c, Vec3(length / 2, -length, 0), d, Vec3(length, length, 3 * length), e,
                        Vec3(length, length, 6 * length)}) {
    mesh.vertices.emplace_back(origin + v);
  }
  mesh.triangles = {{0, 3, 1}, {1, 5, 4}, {2, 7, 6}};
  return mesh;
}

/// That what is left of a dome about `origin` is closed, and keeps the limit but for `rounding` metres. How many points
/// were found inside.
int expect_kept(const Mesh& ground, const Vec3& origin, double size, double rounding, Random& random) {
  const Volume dome = make_hemisphere(origin - Vec3(0, 0, size), 12 * size);
  const Navigation navigation = above(ground, 0.5 * size, 3 * size);
  const Volume cut = cut_to_navigation(dome, navigation);
  EXPECT_EQ(cut.outcome, Outcome::computed) << cut.reason;
  EXPECT_EQ(first_open_edge(cut.mesh), "");
  int inside = 0;
  for (int i = 0; i < 300; ++i) {
    const Vec3 p = origin + size * random.in_box({Vec3(-0.2, -1, 0), Vec3(1.2, 1, 9)});
    const double by = slack(*navigation.above_ground, p);
    if (std::abs(by) < rounding || !holds(dome.mesh, p)) continue;
    EXPECT_EQ(holds(cut.mesh, p), by > 0) << (p - origin).transpose() << " keeps the limit by " << by;
    inside += by > 0;
  }
  return inside;
}

TEST(GroundWithCorners, CornersBesideAnEndOfASideEndTheSplitting) {
  Random random(101);
  constexpr double kRounding = 8 * std::numeric_limits<double>::epsilon();
  for (const double far : {1e9, 1e7}) {
    Mesh ground = make_corners_beside_an_end(Vec3::Zero(), 1, 0.8 * kRounding * far);
    testing::append(ground, {{{far, 0, 0}, {far, 1, 0}, {far - 1, 0, 0}}, {{0, 1, 2}}});
    EXPECT_GT(expect_kept(ground, Vec3::Zero(), 1, 1e-5, random), 2);
  }
  const Vec3 origin(4e6, 5e6, 100);
  for (const double gap : {0.3, 0.5, 0.8, 0.9, 1.1, 2.0}) {
    const Mesh ground = make_corners_beside_an_end(origin, 0.3, gap * kRounding * 5e6);
    EXPECT_GT(expect_kept(ground, origin, 0.3, 1e-6, random), 2);
  }
}

TEST(GroundWithCorners, CornersThatRoundingMovedLeaveNoClaimTooMuch) {
  Random random(103);
  for (const GroundCase& at : kGroundCases) {
    const double step = std::numeric_limits<double>::epsilon() * (at.origin.cwiseAbs().maxCoeff() + at.scale);
    int inside = 0;
    for (int round = 0; round < 60; ++round) {
      SCOPED_TRACE(::testing::Message() << at.scale << " round " << round);
      // Corners on one line, each some roundings from its place, with triangles to either side of it.
      std::vector<double> places = {0, 1};
      while (places.size() < 5) places.push_back(random.chance(0.5) ? random.integer(0, 1) : random.uniform(0, 1));
      Mesh ground;
      const double slope = random.chance(0.5) ? 0 : random.uniform(-1, 1);
      while (ground.triangles.size() < 6) {
        const auto corner = [&](double along, double beside) {
          const Vec3 moved = step * random.point(-12, 12);
          return Vec3(at.origin + at.scale * Vec3(along, 0.3 * along + beside, slope * along) + moved);
        };
        double from = places[static_cast<std::size_t>(random.integer(0, 4))];
        double to = places[static_cast<std::size_t>(random.integer(0, 4))];
        if (from == to) continue;
        if (from > to) std::swap(from, to);
        const double beside = random.chance(0.5) ? -0.5 : 0.5;
        const auto first = static_cast<std::uint32_t>(ground.vertices.size());
        ground.vertices.push_back(corner(from, 0));
        ground.vertices.push_back(corner(to, 0));
        ground.vertices.push_back(corner(0.5 * (from + to), beside));
        ground.triangles.push_back({first, first + 1, first + 2});
      }
      inside += expect_kept(ground, at.origin, at.scale, 1e-6 * at.scale + 1000 * step, random);
    }
    EXPECT_GT(inside, 500) << at.scale;
  }
}

TEST(GroundWithCorners, AFarTriangleMovesNoGroundNearBy) {
  // A corner that lies a millionth of a metre below the side of its neighbours.
  const Mesh ground{{{-9, -9, 0}, {9, -9, 0}, {9, 9, 0}, {-9, 9, 0}, {0, -9, -1e-6}, {-9, -20, 0}, {9, -20, 0}},
                    {{0, 1, 2}, {0, 2, 3}, {0, 5, 4}, {4, 6, 1}, {5, 6, 4}}};
  Mesh with_far = ground;
  testing::append(with_far, {{{1e9, 0, 0}, {1e9, 1, 0}, {1e9 - 1, 0, 0}}, {{0, 1, 2}}});
  const Volume dome = make_hemisphere(Vec3::Zero(), 40);
  EXPECT_EQ(cut_to_navigation(dome, above(with_far, 4, 25)).mesh.vertices,
            cut_to_navigation(dome, above(ground, 4, 25)).mesh.vertices);
}

TEST(GroundWithCorners, SeamsThatDifferByRoundingAreOne) {
  Random random(107);
  for (const GroundCase& at : kGroundCases) {
    SCOPED_TRACE(at.scale);
    const Volume dome = make_hemisphere(at.origin, 60 * at.scale);
    Mesh ground = make_hills(random, 50 * at.scale, 6 * at.scale, 6, at.origin);
    const Volume whole = cut_to_navigation(dome, above(ground, 4 * at.scale, 25 * at.scale));
    // Each triangle gets corners of its own, a rounding of their coordinates away.
    Mesh apart;
    for (const Triangle& t : ground.triangles) {
      const auto first = static_cast<std::uint32_t>(apart.vertices.size());
      for (const std::uint32_t v : t) {
        const Vec3& corner = ground.vertices[v];
        const double step = std::numeric_limits<double>::epsilon() * corner.cwiseAbs().maxCoeff();
        apart.vertices.emplace_back(corner + step * random.point(-1, 1));
      }
      apart.triangles.push_back({first, first + 1, first + 2});
    }
    const Volume cut = cut_to_navigation(dome, above(apart, 4 * at.scale, 25 * at.scale));
    ASSERT_EQ(cut.outcome, Outcome::computed) << cut.reason;
    EXPECT_EQ(first_open_edge(cut.mesh), "");
    EXPECT_EQ(walls_inside(cut, at.origin, 50 * at.scale), 0) << "of " << cut.mesh.triangles.size() << " facets";
    EXPECT_LT(cut.mesh.triangles.size(), 2 * whole.mesh.triangles.size());
    EXPECT_NEAR(enclosed_volume(cut.mesh) / enclosed_volume(whole.mesh), 1, 1e-8);
  }
}

TEST(GroundWithCorners, AStopIsHeardWhileSidesAreSplit) {
  Random random(109);
  const Mesh ground = split_in_two(make_hills(random, 50, 6, 20, Vec3::Zero()), random);
  const internal::core::ProgressReporter::AskAlways always;
  int asked = 0, most = 1 << 30;
  const Progress progress = [&](std::string_view, double) { return ++asked < most; };
  const auto make = [&] {
    asked = 0;
    internal::solid::make_ground_band(ground, 4, 25, bounding_box(ground), Vec3::Zero(), {},
                                      internal::core::ProgressReporter(progress));
  };
  make();
  const int total = asked;
  EXPECT_GT(total, 1000);
  for (most = 1; most < total; most *= 3) {
    testing::expect_code(make, ErrorCode::cancelled);
    EXPECT_EQ(asked, most);
  }
}

}  // namespace
}  // namespace vantage
