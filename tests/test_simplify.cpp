// Simplified volumes: subsets, clean, as small as asked for. What is inside is judged by code of the tests' own.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "support/exact_crossings.h"
#include "support/progress_check.h"
#include "support/random.h"
#include "support/scenes.h"
#include "support/simplify_meshes.h"
#include "support/solids.h"
#include "support/wording.h"
#include "vantage/error.h"
#include "vantage/progress.h"
#include "vantage/prove.h"
#include "vantage/simplify.h"
#include "vantage/target.h"
#include "vantage/volume.h"

namespace vantage {
namespace {

using testing::append;
using testing::edges_through;
using testing::expect_error;
using testing::holds;
using testing::make_box_mesh;
using testing::narrowest_fold;
using testing::Random;
using testing::spiky_dome;

SimplifyOptions to_facets(std::size_t facets) { return {.facets = facets, .error_m = {}}; }
SimplifyOptions to_error(double error_m) { return {.facets = {}, .error_m = error_m}; }

Mesh inside_out(Mesh mesh) {
  for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

/// A box whose sides are divided into n x n squares each, vertices shared.
Mesh divided_box(int n, const Vec3& size, const Vec3& origin = Vec3::Zero()) {
  Mesh mesh;
  for (int axis = 0; axis < 3; ++axis) {
    for (int end = 0; end < 2; ++end) {
      const auto base = static_cast<std::uint32_t>(mesh.vertices.size());
      for (int i = 0; i <= n; ++i) {
        for (int k = 0; k <= n; ++k) {
          Vec3 at;
          at[axis] = end;
          at[(axis + 1) % 3] = static_cast<double>(i) / n;
          at[(axis + 2) % 3] = static_cast<double>(k) / n;
          mesh.vertices.push_back(origin + at.cwiseProduct(size));
        }
      }
      for (int i = 0; i < n; ++i) {
        for (int k = 0; k < n; ++k) {
          const auto a = base + static_cast<std::uint32_t>(i * (n + 1) + k), b = a + static_cast<std::uint32_t>(n) + 1;
          const Triangle first = {a, b, b + 1}, second = {a, b + 1, a + 1};
          for (const auto& [p, q, r] : {first, second})
            mesh.triangles.push_back(end ? Triangle{p, q, r} : Triangle{p, r, q});
        }
      }
    }
  }
  return mesh;  // the sides do not share vertices: they are told apart by place
}

double distance_to_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 normal = (b - a).cross(c - a).normalized();
  const Vec3 foot = p - normal.dot(p - a) * normal;
  const auto inside = [&](const Vec3& s, const Vec3& e) { return normal.dot((e - s).cross(foot - s)) >= 0; };
  if (inside(a, b) && inside(b, c) && inside(c, a)) return (p - foot).norm();
  double least = std::numeric_limits<double>::infinity();
  for (const auto& [s, e] : {std::pair(a, b), std::pair(b, c), std::pair(c, a)}) {
    const double along = std::clamp((p - s).dot(e - s) / (e - s).squaredNorm(), 0.0, 1.0);
    least = std::min(least, (p - s - along * (e - s)).norm());
  }
  return least;
}

double distance_to(const Mesh& solid, const Vec3& p) {
  if (holds(solid, p)) return 0;
  double least = std::numeric_limits<double>::infinity();
  for (const auto& [a, b, c] : solid.triangles) {
    least = std::min(least, distance_to_triangle(p, solid.vertices[a], solid.vertices[b], solid.vertices[c]));
  }
  return least;
}

/// Closed and oriented, nothing of it outside, and not through itself; `random` draws the points that are tried.
void expect_subset(const SimplifiedVolume& result, const Mesh& volume, Random& random) {
  EXPECT_EQ(testing::first_open_edge(result.mesh), "");
  ASSERT_EQ(result.facet_of.size(), result.mesh.triangles.size());
  for (const std::uint32_t facet : result.facet_of) EXPECT_LT(facet, volume.triangles.size());
  EXPECT_EQ(edges_through(result.mesh, volume), 0u);
  EXPECT_EQ(edges_through(volume, result.mesh), 0u);
  EXPECT_EQ(edges_through(result.mesh, result.mesh), 0u);
  const Box box = bounding_box(result.mesh);
  int inside = 0;
  for (int i = 0; i < 300; ++i) {
    const Vec3 point = random.in_box(box);
    if (!holds(result.mesh, point)) continue;
    ++inside;
    EXPECT_TRUE(holds(volume, point)) << point.transpose();
  }
  EXPECT_GT(inside, 5);
  EXPECT_GT(narrowest_fold(result.mesh), 1e-12 * (box.max - box.min).norm());
  for (std::size_t t = 0; t < result.mesh.triangles.size(); t += 7) {  // just below facets, also of narrow spikes
    const auto& [a, b, c] = result.mesh.triangles[t];
    const Vec3 &pa = result.mesh.vertices[a], &pb = result.mesh.vertices[b], &pc = result.mesh.vertices[c];
    const Vec3 normal = (pb - pa).cross(pc - pa).normalized();
    const Vec3 point = (pa + pb + pc) / 3 - 1e-6 * (box.max - box.min).norm() * normal;
    EXPECT_TRUE(!holds(result.mesh, point) || holds(volume, point)) << point.transpose();
  }
  EXPECT_LE(result.volume_after_m3, result.volume_before_m3 * (1 + 1e-12));
  EXPECT_NEAR(result.volume_before_m3, enclosed_volume(volume), 1e-9 * result.volume_before_m3);
  EXPECT_NEAR(result.volume_after_m3, enclosed_volume(result.mesh), 1e-9 * result.volume_before_m3);
  EXPECT_LE(result.lost_measured_m, result.lost_bound_m);
}

TEST(Simplify, SpikyVolumesStaySubsetsAtEveryScale) {
  Random random(11);
  for (const double size : {1e-5, 1.0, 1e4}) {
    for (const bool is_far : {false, true}) {
      const Vec3 origin = is_far ? Vec3(size * 3e4, -size * 9e4, size * 30) : Vec3::Zero();
      SCOPED_TRACE(std::to_string(size) + (is_far ? " far off" : ""));
      const Mesh volume = spiky_dome(random, 14, 7, origin, size);
      for (const std::size_t facets : {150u, 40u}) {
        const SimplifiedVolume result = simplify_volume(volume, to_facets(facets));
        EXPECT_TRUE(result.reached);
        EXPECT_LE(result.mesh.triangles.size(), facets);
        EXPECT_GE(result.mesh.triangles.size(), facets - 1);
        expect_subset(result, volume, random);
      }
    }
  }
}

/// Corners on a coarse grid: planes that coincide, corners on one line and in one plane.
TEST(Simplify, DegenerateVolumesStaySubsets) {
  Random random(12);
  for (int round = 0; round < 6; ++round) {
    Mesh volume = spiky_dome(random, 12, 6, Vec3::Zero(), 64);
    for (Vec3& v : volume.vertices) v = v.array().round();
    if (edges_through(volume, volume) > 0) continue;
    for (const std::size_t facets : {100u, 40u, 12u}) {
      expect_subset(simplify_volume(volume, to_facets(facets)), volume, random);
    }
  }
}

TEST(Simplify, VolumesOfCitiesAreStillProved) {
  for (std::uint64_t seed = 31; seed < 33; ++seed) {
    Random random(seed);
    const Scene scene = testing::random_city(random, 30, 12);
    const Target target = testing::random_target(random, 5, 2, Vec3(0, 0, 0.5), Vec3(0, 0, 1));
    const Sensor sensor{.max_range_m = 80};
    const Volume volume = compute_volume(PreparedTarget(PreparedScene(scene), target, sensor), {}, {.tolerance_m = 1});
    ASSERT_FALSE(volume.empty());
    for (const std::size_t facets : {400u, 100u}) {
      const SimplifiedVolume result = simplify_volume(volume.mesh, to_facets(facets));
      EXPECT_LE(result.mesh.triangles.size(), facets);
      EXPECT_GT(result.volume_after_m3, (facets == 400u ? 0.95 : 0.5) * result.volume_before_m3);
      expect_subset(result, volume.mesh, random);
      const ProofReport proof = prove_volume(scene, target, sensor, {}, result.mesh, {.lift_m = volume.lift_m});
      EXPECT_EQ(proof.verdict(), ProofVerdict::proved) << "seed " << seed;
    }
  }
}

TEST(Simplify, FlatSidesCostNothing) {
  const Mesh box = divided_box(8, Vec3(3, 4, 5));
  const SimplifiedVolume exact = simplify_volume(box, to_error(0));
  EXPECT_EQ(exact.mesh.triangles.size(), 12u);
  EXPECT_EQ(exact.volume_after_m3, 60);
  EXPECT_LT(exact.lost_bound_m, 1e-10);
  EXPECT_EQ(exact.facets_before, box.triangles.size());

  Mesh turned = divided_box(8, Vec3(30, 40, 50));
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  for (Vec3& v : turned.vertices) v = turn * v + Vec3(1000, 2000, 30);
  const SimplifiedVolume rounded = simplify_volume(turned, to_error(1e-6));
  EXPECT_EQ(rounded.mesh.triangles.size(), 12u);
  EXPECT_NEAR(rounded.volume_after_m3, 60000, 1e-4);
}

/// The bound holds what rounding does, and the error that is asked for holds the bound, where numbers can tell.
TEST(Simplify, TheBoundHoldsAtMapCoordinates) {
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  for (const double away : {0.0, 4e3, 5.4e6}) {
    Mesh turned = divided_box(8, Vec3(30, 40, 50));
    for (Vec3& v : turned.vertices) v = turn * v + Vec3(away, -away / 3, away / 50);
    for (const double error : {0.0, 1e-9, 1e-8, 3e-8, 1e-6}) {
      SCOPED_TRACE(::testing::Message() << away << " " << error);
      const SimplifiedVolume result = simplify_volume(turned, to_error(error));
      const double rounding = 8 * std::ldexp(away + 50, -52) + 1e-11 * 71;  // surfaces that are flat but for that
      EXPECT_LE(result.lost_measured_m, result.lost_bound_m);
      EXPECT_LE(result.lost_bound_m, error > rounding ? error : rounding + 1e-10);
    }
  }
}

/// A thin wall between two notches costs little and holds many facets: the notches become one.
TEST(Simplify, NotchesMerge) {
  constexpr int kSectors = 40;
  const auto radius = [](double azimuth, double elevation) {
    const int sector = static_cast<int>(std::lround(azimuth / (2 * std::numbers::pi) * kSectors));
    return elevation < 1.2 && (sector == 10 || sector == 12) ? 0.2 : 1.0;
  };
  const Mesh volume = testing::make_dome(Vec3::Zero(), kSectors, 8, radius).mesh;
  const SimplifiedVolume result = simplify_volume(volume, to_facets(60));
  EXPECT_LE(result.mesh.triangles.size(), 60u);
  EXPECT_GT(result.volume_after_m3, 0.85 * result.volume_before_m3);
  Random random(13);
  expect_subset(result, volume, random);
}

TEST(Simplify, NothingThatIsLostLiesFartherThanAllowed) {
  Random random(14);
  const Mesh volume = spiky_dome(random, 14, 7);
  for (const double error : {0.02, 0.1, 0.4}) {
    const SimplifiedVolume result = simplify_volume(volume, to_error(error));
    EXPECT_TRUE(result.reached);
    EXPECT_LT(result.mesh.triangles.size(), volume.triangles.size());
    EXPECT_LE(result.lost_bound_m, error);
    double farthest = 0, of_vertices = 0;
    for (int i = 0; i < 3000; ++i) {
      const Vec3 point = random.in_box(bounding_box(volume));
      if (holds(volume, point)) farthest = std::max(farthest, distance_to(result.mesh, point));
    }
    for (const Vec3& vertex : volume.vertices) {
      double nearest = std::numeric_limits<double>::infinity();
      for (const auto& [a, b, c] : result.mesh.triangles) {
        const std::vector<Vec3>& at = result.mesh.vertices;
        nearest = std::min(nearest, distance_to_triangle(vertex, at[a], at[b], at[c]));
      }
      of_vertices = std::max(of_vertices, nearest);
    }
    EXPECT_LE(farthest, error);
    EXPECT_NEAR(of_vertices, result.lost_measured_m, 1e-9);
    EXPECT_GT(of_vertices, 0.2 * error);  // what is allowed is used
    expect_subset(result, volume, random);
  }
}

TEST(Simplify, BothEndsHold) {
  Random random(15);
  const Mesh volume = spiky_dome(random, 14, 7);
  const SimplifiedVolume few = simplify_volume(volume, {.facets = 100, .error_m = 10});
  EXPECT_LE(few.mesh.triangles.size(), 100u);
  EXPECT_TRUE(few.reached);
  const SimplifiedVolume near = simplify_volume(volume, {.facets = 10, .error_m = 0.02});
  EXPECT_GT(near.mesh.triangles.size(), 10u);
  EXPECT_LE(near.lost_bound_m, 0.02);
  EXPECT_FALSE(near.reached);
}

TEST(Simplify, SmallPiecesGoAndTheLargestStays) {
  Mesh volume = make_box_mesh(Vec3::Zero(), Vec3(10, 10, 10));
  append(volume, make_box_mesh(Vec3(20, 0, 0), Vec3(21, 1, 1)));
  append(volume, make_box_mesh(Vec3(30, 0, 0), Vec3(33, 3, 3)));
  const SimplifiedVolume result = simplify_volume(volume, to_facets(24));
  EXPECT_EQ(result.mesh.triangles.size(), 24u);
  EXPECT_EQ(result.pieces, 2u);
  EXPECT_EQ(result.pieces_dropped, 1u);
  EXPECT_DOUBLE_EQ(result.volume_after_m3, 1027);
  EXPECT_GE(result.lost_bound_m, 9);  // the far corner of the small box to x = 30
  EXPECT_TRUE(holds(result.mesh, Vec3(5, 5, 5)));
  EXPECT_TRUE(holds(result.mesh, Vec3(31, 1, 1)));
  const SimplifiedVolume near = simplify_volume(volume, {.facets = 24, .error_m = 0.1});
  EXPECT_EQ(near.pieces, 3u);
  EXPECT_FALSE(near.reached);
  const SimplifiedVolume least = simplify_volume(volume, to_facets(4));
  EXPECT_EQ(least.pieces, 1u);
  EXPECT_EQ(least.mesh.triangles.size(), 4u);
  EXPECT_TRUE(holds(
      volume, (least.mesh.vertices[0] + least.mesh.vertices[1] + least.mesh.vertices[2] + least.mesh.vertices[3]) / 4));
}

/// To fill a cavity, or to drop what is round it and leave it inside out, would be wrong.
TEST(Simplify, CavitiesStay) {
  Mesh volume = divided_box(4, Vec3(10, 10, 10));
  append(volume, inside_out(divided_box(3, Vec3(2, 2, 2), Vec3(4, 4, 4))));
  append(volume, make_box_mesh(Vec3(50, 0, 0), Vec3(90, 40, 40)));
  Random random(16);
  for (const std::size_t facets : {60u, 30u, 4u}) {
    const SimplifiedVolume result = simplify_volume(volume, to_facets(facets));
    EXPECT_FALSE(holds(result.mesh, Vec3(5, 5, 5))) << facets;
    EXPECT_GE(result.pieces, 2u);
    EXPECT_EQ(result.reached, facets > 12) << result.mesh.triangles.size();
    expect_subset(result, volume, random);
    for (int i = 0; i < 200; ++i) {  // the cavity is nowhere inside out
      const Vec3 point = random.point(-1, 11);
      double turns = 0;
      for (const auto& [a, b, c] : result.mesh.triangles) {
        const Vec3 u = result.mesh.vertices[a] - point, v = result.mesh.vertices[b] - point,
                   w = result.mesh.vertices[c] - point;
        const double lu = u.norm(), lv = v.norm(), lw = w.norm();
        turns += std::atan2(u.dot(v.cross(w)), lu * lv * lw + u.dot(v) * lw + v.dot(w) * lu + w.dot(u) * lv);
      }
      EXPECT_GT(turns, -1) << point.transpose();
    }
  }
}

/// One end of a piece is inside out, and lies in another piece: there the winding number is 0. Without the piece it
/// would be 1.
TEST(Simplify, PiecesThatTakeAwayStay) {
  Mesh volume = make_box_mesh(Vec3(0, -20, -20), Vec3(40, 20, 20));
  Mesh twisted = divided_box(4, Vec3(1, 1, 1));
  for (Vec3& v : twisted.vertices) {
    const double turn = v.x() < 0.6 ? 1 : -0.5;
    v = Vec3(-16 + 24 * v.x(), turn * (v.y() - 0.5), v.z() - 0.5);
  }
  append(volume, twisted);
  const Vec3 inverted(5, 0.1, 0.1);
  ASSERT_FALSE(holds(volume, inverted));
  Random random(26);
  for (const std::size_t facets : {100u, 40u, 16u, 12u}) {
    const SimplifiedVolume result = simplify_volume(volume, to_facets(facets));
    for (int i = 0; i < 2000; ++i) {
      const Vec3 point = random.in_box({Vec3(-17, -1, -1), Vec3(9, 1, 1)});
      EXPECT_TRUE(!holds(result.mesh, point) || holds(volume, point)) << facets << ": " << point.transpose();
    }
  }
}

/// Small ones close under the surface: what is cut off there must not hold one.
TEST(Simplify, SmallCavitiesAreNotCutOff) {
  Random random(23);
  Mesh volume = testing::make_hemisphere(Vec3::Zero(), 10, 40, 20).mesh;
  std::vector<Vec3> middles;
  for (int i = 0; i < 60; ++i) {
    Vec3 direction = random.direction();
    direction.z() = std::abs(direction.z()) + 0.2;
    const Vec3 middle = direction.normalized() * 9.85;
    const bool is_free =
        std::all_of(middles.begin(), middles.end(), [&](const Vec3& m) { return (m - middle).norm() > 1; });
    if (!is_free) continue;
    middles.push_back(middle);
    append(volume, inside_out(make_box_mesh(middle - Vec3::Constant(0.02), middle + Vec3::Constant(0.02))));
  }
  ASSERT_GT(middles.size(), 20u);
  const SimplifiedVolume result = simplify_volume(volume, to_facets(4 * middles.size() + 40));
  EXPECT_EQ(result.pieces, middles.size() + 1);
  Mesh shell = result.mesh;
  std::erase_if(shell.triangles, [&](const Triangle& t) {
    return std::any_of(t.begin(), t.end(), [&](std::uint32_t v) {
      return std::any_of(middles.begin(), middles.end(),
                         [&](const Vec3& m) { return (m - shell.vertices[v]).norm() < 0.1; });
    });
  });
  EXPECT_LT(shell.triangles.size(), 400u);
  for (const Vec3& middle : middles) EXPECT_TRUE(holds(shell, middle)) << middle.transpose();
}

TEST(Simplify, HandlesStay) {
  constexpr int kAround = 24, kAcross = 12;
  Mesh ring;
  for (int i = 0; i < kAround; ++i) {
    for (int k = 0; k < kAcross; ++k) {
      const double u = 2 * std::numbers::pi * i / kAround, v = 2 * std::numbers::pi * k / kAcross;
      ring.vertices.emplace_back((3 + std::cos(v)) * std::cos(u), (3 + std::cos(v)) * std::sin(u), std::sin(v));
    }
  }
  const auto at = [&](int i, int k) { return static_cast<std::uint32_t>((i % kAround) * kAcross + k % kAcross); };
  for (int i = 0; i < kAround; ++i) {
    for (int k = 0; k < kAcross; ++k) {
      ring.triangles.push_back({at(i, k), at(i + 1, k), at(i + 1, k + 1)});
      ring.triangles.push_back({at(i, k), at(i + 1, k + 1), at(i, k + 1)});
    }
  }
  Random random(17);
  for (const std::size_t facets : {200u, 60u, 4u}) {
    const SimplifiedVolume result = simplify_volume(ring, to_facets(facets));
    EXPECT_EQ(measure(result.mesh).euler, 0);
    expect_subset(result, ring, random);
  }
}

/// Pieces that touch at a vertex or along an edge, facets that do not share vertices, facets without area.
TEST(Simplify, MeshesAsFilesHaveThem) {
  Mesh touching = divided_box(3, Vec3(1, 1, 1));
  append(touching, divided_box(3, Vec3(1, 1, 1), Vec3(1, 1, 0)));
  append(touching, divided_box(3, Vec3(1, 1, 1), Vec3(2, 2, 1)));
  Mesh soup;
  for (const Triangle& t : touching.triangles) {
    const auto base = static_cast<std::uint32_t>(soup.vertices.size());
    for (const std::uint32_t v : t) soup.vertices.push_back(touching.vertices[v]);
    soup.triangles.push_back({base, base + 1, base + 2});
  }
  soup.triangles.push_back({0, 0, 1});
  soup.vertices.emplace_back(1000, 0, 0);  // that no triangle uses
  Random random(18);
  const SimplifiedVolume result = simplify_volume(soup, to_error(0));
  EXPECT_NEAR(result.volume_after_m3, 3, 1e-12);
  EXPECT_LT(result.mesh.triangles.size(), touching.triangles.size() / 2);  // where they touch vertices stay
  EXPECT_EQ(result.pieces, 3u);
  EXPECT_LT(result.lost_measured_m, 1e-12);
  expect_subset(result, soup, random);
}

TEST(Simplify, AVolumeThatIsSmallEnoughIsLeftAsItIs) {
  const Mesh box = divided_box(2, Vec3(1, 2, 3));
  const SimplifiedVolume result = simplify_volume(box, to_facets(box.triangles.size()));
  EXPECT_EQ(result.mesh.triangles, box.triangles);
  EXPECT_EQ(result.mesh.vertices, box.vertices);
  EXPECT_TRUE(result.reached);
  EXPECT_EQ(result.lost_bound_m, 0);
  EXPECT_EQ(result.facet_of.size(), box.triangles.size());
}

TEST(Simplify, DoesNotDependOnTheNumberOfThreads) {
  Random random(19);
  const Mesh volume = spiky_dome(random, 40, 20);
  std::vector<SimplifiedVolume> results;
  for (const int threads : {1, 2, 5}) {
    with_threads(threads, [&] { results.push_back(simplify_volume(volume, to_facets(200))); });
    EXPECT_EQ(results.back().mesh.triangles, results[0].mesh.triangles);
    EXPECT_EQ(results.back().mesh.vertices, results[0].mesh.vertices);
    EXPECT_EQ(results.back().lost_bound_m, results[0].lost_bound_m);
    EXPECT_EQ(results.back().lost_measured_m, results[0].lost_measured_m);
  }
}

TEST(Simplify, TellsItsProgressAndStops) {
  Random random(20);
  const Mesh volume = spiky_dome(random, 24, 12);
  testing::check_progress([&](const Progress& progress) { simplify_volume(volume, to_facets(100), progress); });
  Mesh hollow = make_box_mesh(Vec3::Zero(), Vec3(10, 10, 10));  // left as it is, but looked at: each cavity's facets
  for (int i = 1; i < 6; ++i) append(hollow, inside_out(make_box_mesh(Vec3(i, i, i), Vec3(i + 0.5, i + 0.5, i + 0.5))));
  const auto story =
      testing::check_progress([&](const Progress& progress) { simplify_volume(hollow, to_facets(100), progress); });
  EXPECT_GT(story.calls, 60u);
}

TEST(Simplify, RefusesWhatItCannotSimplify) {
  const Mesh box = make_box_mesh(Vec3::Zero(), Vec3(1, 1, 1));
  expect_error([&] { simplify_volume(box, {}); }, ErrorCode::nothing_given, "facets");
  expect_error([&] { simplify_volume(box, to_facets(3)); }, ErrorCode::value_out_of_range, "facets");
  expect_error([&] { simplify_volume(box, to_error(-1)); }, ErrorCode::value_out_of_range, "error_m");
  expect_error([&] { simplify_volume(box, to_error(std::nan(""))); }, ErrorCode::value_out_of_range, "error_m");
  expect_error([&] { simplify_volume({}, to_facets(4)); }, ErrorCode::mesh_empty, "volume");
  expect_error([&] { simplify_volume(inside_out(box), to_facets(4)); }, ErrorCode::mesh_inside_out, "volume");
  Mesh broken = box;
  broken.triangles.pop_back();
  expect_error([&] { simplify_volume(broken, to_facets(4)); }, ErrorCode::mesh_not_closed, "volume");
  broken = box;
  std::swap(broken.triangles[3][0], broken.triangles[3][1]);
  expect_error([&] { simplify_volume(broken, to_facets(4)); }, ErrorCode::mesh_not_oriented, "volume");
  broken = box;
  broken.triangles[3][0] = 8;
  expect_error([&] { simplify_volume(broken, to_facets(4)); }, ErrorCode::index_out_of_range, "volume");
  broken = box;
  broken.vertices[3].x() = std::numeric_limits<double>::infinity();
  expect_error([&] { simplify_volume(broken, to_facets(4)); }, ErrorCode::coordinate_not_finite, "volume");
  broken.vertices[3].x() = 2e9;
  expect_error([&] { simplify_volume(broken, to_facets(4)); }, ErrorCode::coordinate_too_large, "volume");
  broken = box;
  append(broken, inside_out(make_box_mesh({0.5, 0.5, 0.5}, {9, 0.6, 0.6})));
  expect_error([&] { simplify_volume(broken, to_facets(4)); }, ErrorCode::mesh_inside_out, "volume");
  Mesh flat{{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)}, {{0, 1, 2}, {0, 2, 1}}};
  expect_error([&] { simplify_volume(flat, to_error(1)); }, ErrorCode::mesh_without_inside, "volume");
}

}  // namespace
}  // namespace vantage
