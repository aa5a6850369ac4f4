// Many solids in one arrangement, against trees of booleans and against winding numbers of points.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "core/parallel.h"
#include "solid/arranged.h"
#include "solid/cell_tree.h"
#include "solid/convex_hull.h"
#include "solid/exact_winding.h"
#include "support/internals.h"
#include "support/random.h"
#include "support/solids.h"
#include "support/torus.h"

namespace vantage::testing {
namespace {

using solid::Arranged;
using solid::LabelledMesh;
using solid::Solid;
using solid::Weighted;

/// Facets of the i-th one have the label i.
std::vector<LabelledMesh> labelled(const std::vector<Mesh>& meshes) {
  std::vector<LabelledMesh> result;
  for (const Mesh& mesh : meshes) {
    result.push_back(
        {mesh, std::vector<std::uint32_t>(mesh.triangles.size(), static_cast<std::uint32_t>(result.size()))});
  }
  return result;
}

std::optional<Arranged> at_least(const std::vector<Mesh>& meshes, std::uint64_t least) {
  const std::vector<LabelledMesh> all = labelled(meshes);
  std::vector<Weighted> operands;
  for (const LabelledMesh& one : all) operands.push_back({&one});
  return solid::weighing_at_least(operands, least, {});
}

/// All that `least` of the solids share, by unions of intersections.
Solid by_booleans(const std::vector<Solid>& solids, std::size_t least) {
  std::vector<Solid> terms;
  for (unsigned chosen = 0; chosen < 1u << solids.size(); ++chosen) {
    std::vector<Solid> some;
    for (std::size_t i = 0; i < solids.size(); ++i) {
      if ((chosen >> i & 1u) != 0) some.push_back(solids[i]);
    }
    if (some.size() == least) terms.push_back(intersect(some));
  }
  return unite(terms);
}

Mesh random_hull(Random& random, double scale) {
  std::vector<Vec3> points;
  const Vec3 centre = scale * random.point(-0.4, 0.4);
  for (int i = random.integer(5, 30); i > 0; --i) points.push_back(centre + scale * random.direction());
  return solid::convex_hull(points);
}

TEST(Arrangement, HullsAgreeWithTreesOfBooleans) {
  Random random(2001);
  for (const double scale : {1e-6, 1.0, 1e4}) {
    for (int round = 0; round < 12; ++round) {
      std::vector<Mesh> meshes;
      std::vector<Solid> solids;
      for (int i = 0; i < 5; ++i) {
        meshes.push_back(random_hull(random, scale));
        solids.push_back(Solid(labelled({meshes.back()})[0]));
      }
      for (std::uint64_t least = 1; least <= meshes.size(); ++least) {
        const auto arranged = at_least(meshes, least);
        ASSERT_TRUE(arranged) << "scale " << scale << ", round " << round << ", least " << least;
        EXPECT_EQ(first_open_edge(arranged->solid.to_mesh().mesh), "");
        EXPECT_LT(arranged->epsilon_m, 4e-12 * 3 * scale);
        const Solid expected = by_booleans(solids, least), &found = arranged->solid;
        EXPECT_NEAR(found.volume(), expected.volume(), 1e-9 * scale * scale * scale)
            << "scale " << scale << ", round " << round << ", least " << least;
      }
    }
  }
}

TEST(Arrangement, FacetsKeepTheirLabels) {
  const std::vector<Mesh> meshes{make_box_mesh({0, 0, 0}, {2, 2, 2}), make_box_mesh({1, 1, 1}, {3, 3, 3})};
  const auto both = at_least(meshes, 2);
  ASSERT_TRUE(both);
  const auto [mesh, labels] = both->solid.to_mesh();
  double area[2] = {0, 0};
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& [a, b, c] = mesh.triangles[t];
    area[labels[t]] += 0.5 * (mesh.vertices[b] - mesh.vertices[a]).cross(mesh.vertices[c] - mesh.vertices[a]).norm();
  }
  EXPECT_NEAR(area[0], 3, 1e-10);
  EXPECT_NEAR(area[1], 3, 1e-10);
}

// Sides of many boxes lie in one plane, edges on edges and corners on corners.
TEST(Arrangement, BoxesOnALattice) {
  Random random(2002);
  for (const double scale : {1e-6, 1.0, 1e4}) {
    for (int round = 0; round < 25; ++round) {
      std::vector<Mesh> meshes;
      std::vector<Box> boxes;
      for (int i = random.integer(2, 7); i > 0; --i) {
        Box box;
        for (int axis = 0; axis < 3; ++axis) {
          const int from = random.integer(0, 3);
          box.min[axis] = scale * from;
          box.max[axis] = scale * (from + random.integer(1, 4 - from));
        }
        boxes.push_back(box);
        meshes.push_back(make_box_mesh(box.min, box.max));
      }
      for (std::size_t least = 1; least <= meshes.size(); ++least) {
        const auto arranged = at_least(meshes, least);
        ASSERT_TRUE(arranged) << "scale " << scale << ", round " << round << ", least " << least;
        EXPECT_EQ(first_open_edge(arranged->solid.to_mesh().mesh), "");
        int cells = 0;
        for (int cell = 0; cell < 64; ++cell) {
          const Eigen::Vector3i place(cell % 4, cell / 4 % 4, cell / 16);
          const Vec3 middle = scale * (place.cast<double>() + Vec3::Constant(0.5));
          std::size_t count = 0;
          for (const Box& box : boxes) {
            count += (middle.array() > box.min.array()).all() && (middle.array() < box.max.array()).all();
          }
          cells += count >= least;
        }
        EXPECT_NEAR(arranged->solid.volume(), cells * scale * scale * scale, 1e-8 * scale * scale * scale)
            << "scale " << scale << ", round " << round << ", least " << least;
      }
    }
  }
}

TEST(Arrangement, WeightsAndComplementsAgreeWithWindingNumbers) {
  Random random(2003);
  int all_inside = 0;
  for (int round = 0; round < 20; ++round) {
    std::vector<Mesh> meshes{make_box_mesh({-2, -2, -2}, {2, 2, 2})};
    for (int i = 0; i < 6; ++i) {
      meshes.push_back(random.chance(0.3) ? make_torus(Vec3::Zero(), 0.8, 0.3, 12, 7) : random_hull(random, 1));
      if (i % 2 == 0) {
        for (Vec3& vertex : meshes.back().vertices) vertex += Vec3(0.1 * i, 0.05 * i, 0.013 * i);
      }
    }
    const std::vector<LabelledMesh> all = labelled(meshes);
    std::vector<Weighted> operands{{&all[0], 100}};
    std::uint64_t most = 0;
    for (std::size_t i = 1; i < all.size(); ++i) {
      operands.push_back({&all[i], static_cast<std::uint64_t>(random.integer(1, 5)), random.chance(0.5)});
      most += operands.back().weight;
    }
    const std::uint64_t least = 100 + static_cast<std::uint64_t>(random.integer(0, static_cast<int>(most)));
    const auto arranged = solid::weighing_at_least(operands, least, {});
    ASSERT_TRUE(arranged) << "round " << round;
    const Mesh mesh = arranged->solid.to_mesh().mesh;
    const solid::ExactWinding result(mesh);
    std::vector<solid::ExactWinding> windings;
    for (const LabelledMesh& one : all) windings.emplace_back(one.mesh);
    int inside = 0;
    for (int i = 0; i < 500; ++i) {
      const Vec3 p = random.point(-2.2, 2.2);
      std::uint64_t level = 0;
      for (std::size_t k = 0; k < all.size(); ++k) {
        if (windings[k].holds(p) != operands[k].is_complement) level += operands[k].weight;
      }
      EXPECT_EQ(result.holds(p), level >= least) << "round " << round << ", point " << p.transpose();
      inside += level >= least;
    }
    all_inside += inside;
  }
  EXPECT_GT(all_inside, 500);
}

// As the volumes of neighbouring cells do, six solids coincide, or all but do.
TEST(Arrangement, CopiesThatAllButCoincide) {
  Random random(2004);
  for (const double apart : {0.0, 1e-15, 1e-12, 1e-9, 1e-6}) {
    for (int round = 0; round < 4; ++round) {
      const Mesh one = random_hull(random, 1);
      std::vector<Mesh> meshes;
      for (int i = 0; i < 6; ++i) {
        Mesh& copy = meshes.emplace_back(one);
        for (Vec3& vertex : copy.vertices) vertex += apart * random.point(-1, 1);
      }
      const double volume = Solid(labelled({one})[0]).volume();
      for (const std::uint64_t least : {1u, 3u, 6u}) {
        const auto arranged = at_least(meshes, least);
        ASSERT_TRUE(arranged) << "apart " << apart << ", round " << round << ", least " << least;
        const Solid& found = arranged->solid;
        EXPECT_NEAR(found.volume(), volume, 20 * apart + 1e-10) << "apart " << apart << ", least " << least;
      }
    }
  }
}

// The facets of the plate have holes, one in another: what is round a hole crosses no edge of them.
TEST(Arrangement, HolesInFacets) {
  const Mesh plate = make_box_mesh({-10, -10, -1}, {10, 10, 1});
  std::vector<Mesh> meshes{plate};
  for (const double half : {0.3, 0.9, 2.0})
    meshes.push_back(make_box_mesh({3 - half, -5 - half, -3}, {3 + half, -5 + half, 3}));
  const std::vector<LabelledMesh> all = labelled(meshes);
  // The plate without the largest prism, with the middle one, without the smallest one.
  const std::vector<Weighted> operands{{&all[0], 1}, {&all[1], 4, true}, {&all[2], 2}, {&all[3], 1, true}};
  const auto drilled = solid::weighing_at_least(operands, 6, {});
  ASSERT_TRUE(drilled);
  const auto holes = at_least(meshes, 1);
  ASSERT_TRUE(holes);
  EXPECT_NEAR(holes->solid.volume(), 400 * 2 + 16 * 4, 1e-8);
  // 6: outside of the smallest, and at least 2 of: plate, in the middle one (2), outside of the largest.
  // In the plate outside of the largest; in the middle one outside of the smallest, at any height.
  EXPECT_NEAR(drilled->solid.volume(), (400 - 16) * 2 + (1.8 * 1.8 - 0.6 * 0.6) * 6, 1e-7);
}

// What stands in where an arrangement cannot be made. Of up to 16 cells it rounds nothing.
TEST(Arrangement, TheTreeThatStandsInForItAgrees) {
  Random random(2006);
  for (const std::size_t cells : {3, 7, 16}) {
    std::vector<Mesh> meshes;
    std::vector<Solid> solids;
    for (std::size_t i = 0; i < cells; ++i) {
      meshes.push_back(random_hull(random, 1));
      solids.push_back(Solid(labelled({meshes.back()})[0]));
    }
    const std::vector<std::uint64_t> costs(cells, 1);
    for (const std::uint64_t budget : {cells / 4, cells / 2}) {
      const Solid tree = solid::seen_within(costs, budget, [&](std::size_t i) { return solids[i]; }, {});
      const auto arranged = at_least(meshes, cells - budget);
      ASSERT_TRUE(arranged) << cells << " cells";
      EXPECT_GT(tree.volume(), 0) << cells << " cells";
      EXPECT_NEAR(arranged->solid.volume(), tree.volume(), 1e-9) << cells << " cells, budget " << budget;
    }
  }
}

/// The same points and triangles with one thread as with all.
TEST(Arrangement, DoesNotDependOnThreads) {
  Random random(2007);
  std::vector<Mesh> meshes;
  for (int i = 0; i < 12; ++i) meshes.push_back(random_hull(random, 1));
  const auto many = at_least(meshes, 5);
  ASSERT_TRUE(many);
  Mesh one;
  parallel::with_threads(1, [&] { one = at_least(meshes, 5)->solid.to_mesh().mesh; });
  const Mesh all = many->solid.to_mesh().mesh;
  EXPECT_EQ(one.vertices, all.vertices);
  EXPECT_EQ(one.triangles, all.triangles);
}

TEST(Arrangement, NothingAndEverything) {
  const std::vector<Mesh> apart{make_box_mesh({0, 0, 0}, {1, 1, 1}), make_box_mesh({2, 0, 0}, {3, 1, 1})};
  const auto none = at_least(apart, 2), both = at_least(apart, 1);
  ASSERT_TRUE(none);
  ASSERT_TRUE(both);
  EXPECT_TRUE(none->solid.empty());
  EXPECT_NEAR(both->solid.volume(), 2, 1e-11);
  const std::vector<Mesh> nested{make_box_mesh({0, 0, 0}, {3, 3, 3}), make_box_mesh({1, 1, 1}, {2, 2, 2})};
  const std::vector<LabelledMesh> all = labelled(nested);
  const auto hollow = solid::weighing_at_least(std::vector<Weighted>{{&all[0]}, {&all[1], 1, true}}, 2, {});
  ASSERT_TRUE(hollow);
  EXPECT_NEAR(hollow->solid.volume(), 26, 1e-10);
}

// A ridge of 10 m passes through a plane while it rises by a few of the lengths that solids are moved by: where it does
// between moved solids is elsewhere, and on the other side of a wall. The corner must not be put beyond that.
TEST(Arrangement, ARidgeAllButAlongAPlane) {
  constexpr std::array<std::array<std::size_t, 3>, 6> kOrders{
      {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}}};
  for (const double rise : {1e-12, 1e-11, 3e-11, 1e-10, 3e-10, 1e-9, 1e-8}) {
    Mesh prism;
    prism.vertices = {{0, 0, -rise / 2}, {0, -3, -4}, {0, 3, -4}, {10, 0, rise / 2}, {10, -3, -4}, {10, 3, -4}};
    prism.triangles = {{0, 2, 1}, {3, 4, 5}, {0, 1, 4}, {0, 4, 3}, {1, 2, 5}, {1, 5, 4}, {2, 0, 3}, {2, 3, 5}};
    const Mesh below = make_box_mesh({-20, -20, -20}, {20, 20, 0});
    for (double wall = 4.5; wall < 5.5; wall += 0.02) {
      const std::array<Mesh, 3> all{prism, below, make_box_mesh({-1, -15, -19}, {wall, 15, 12})};
      for (const auto& [a, b, c] : kOrders) {
        const auto common = at_least({all[a], all[b], all[c]}, 3);
        ASSERT_TRUE(common);
        const LabelledMesh result = common->solid.to_mesh();
        const Box box = bounding_box(result.mesh);
        EXPECT_LE(box.max.x(), wall) << "rise " << rise << ", order " << a << b << c;
        EXPECT_LE(box.max.z(), common->epsilon_m) << "rise " << rise << ", order " << a << b << c;
        EXPECT_NEAR(common->solid.volume(), 12 * wall, 1e-7) << "rise " << rise << ", order " << a << b << c;
      }
    }
  }
}

// Facets of hardly any width have hardly any normal: what is rounded there is larger than the normal.
TEST(Arrangement, Needles) {
  Random random(2005);
  for (const double width : {1e-6, 1e-10, 1e-13, 1e-15}) {
    for (int round = 0; round < 10; ++round) {
      std::vector<Mesh> meshes{random_hull(random, 1)};
      std::vector<Solid> solids{Solid(labelled({meshes[0]})[0])};
      for (int i = 0; i < 3; ++i) {
        const Vec3 from = random.point(-2, 2), to = random.point(-2, 2), beside = from + width * random.direction();
        meshes.push_back(solid::convex_hull(std::vector<Vec3>{from, to, beside, from + random.direction()}));
        solids.push_back(Solid(labelled({meshes.back()})[0]));
      }
      for (const std::uint64_t least : {1u, 2u}) {
        const auto arranged = at_least(meshes, least);
        ASSERT_TRUE(arranged) << "width " << width << ", round " << round;
        EXPECT_NEAR(arranged->solid.volume(), by_booleans(solids, least).volume(), 1e-9) << width << " " << round;
      }
    }
  }
}

// Facets without an area do no harm: their edges are cut, and nothing passes through them.
TEST(Arrangement, FacetsWithoutAnArea) {
  Mesh box = make_box_mesh({0, 0, 0}, {4, 4, 4});
  // One corner more, in the middle of the edge from 0 to 1, and a facet of three corners on that line.
  box.vertices.emplace_back(2, 0, 0);
  for (Triangle& t : box.triangles) {
    if (t == Triangle{0, 1, 5}) t = {8, 1, 5};
  }
  box.triangles.push_back({0, 8, 5});
  box.triangles.push_back({0, 1, 8});
  ASSERT_EQ(first_open_edge(box), "");
  for (const double from : {1.0, 2.0, 2.5, 3.0}) {
    const auto both = at_least({box, make_box_mesh({from, -1, -1}, {5, 5, 5})}, 2);
    ASSERT_TRUE(both) << from;
    EXPECT_NEAR(both->solid.volume(), 16 * (4 - from), 1e-9) << from;
  }
}

TEST(Arrangement, RefusesWhatBoundsNoSolid) {
  const Mesh box = make_box_mesh({0, 0, 0}, {1, 1, 1});
  Mesh open = box;
  open.triangles.pop_back();
  EXPECT_FALSE(at_least({open, box}, 1));
  Mesh twice = make_box_mesh({0.2, 0.2, 0.2}, {0.7, 0.7, 0.7});  // winds twice round what is in both
  append(twice, make_box_mesh({0.3, 0.3, 0.3}, {1.5, 1.5, 1.5}));
  EXPECT_FALSE(at_least({make_box_mesh({0.4, 0.4, 0.4}, {0.5, 0.5, 0.5}), twice}, 2));
}

}  // namespace
}  // namespace vantage::testing
