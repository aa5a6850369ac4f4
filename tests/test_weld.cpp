#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <vector>

#include "core/mend_welded.h"
#include "core/pieces.h"
#include "core/triangle_tree.h"
#include "core/weld.h"
#include "support/random.h"
#include "support/solids.h"
#include "vantage/volume.h"

namespace vantage::internal::core {
namespace {

/// Every triangle with corners of its own, as in STL.
Mesh soup_of(const Mesh& mesh) {
  Mesh soup;
  for (const Triangle& t : mesh.triangles) {
    const auto first = static_cast<std::uint32_t>(soup.vertices.size());
    for (const std::uint32_t corner : t) soup.vertices.push_back(mesh.vertices[corner]);
    soup.triangles.push_back({first, first + 1, first + 2});
  }
  return soup;
}

TEST(Weld, JoinsWhatLiesInOnePlace) {
  const Mesh box = testing::make_box_mesh(Vec3(580000.1, 4785000.2, 0), Vec3(580010.1, 4785020.2, 30));
  const Mesh soup = soup_of(box);
  ASSERT_EQ(soup.vertices.size(), 36u);
  EXPECT_NE(testing::first_open_edge(soup), "");
  const Mesh joined = welded(soup);
  EXPECT_EQ(joined.vertices.size(), 8u);
  EXPECT_EQ(testing::first_open_edge(joined), "");
  ASSERT_EQ(joined.triangles.size(), soup.triangles.size());  // each where it was, its corners in the same turn
  for (std::size_t t = 0; t < soup.triangles.size(); ++t) {
    for (int i = 0; i < 3; ++i) {
      EXPECT_EQ(joined.vertices[joined.triangles[t][i]], soup.vertices[soup.triangles[t][i]]);
    }
  }
}

TEST(Weld, TellsNeighbouringDoublesApart) {
  const double next = std::nextafter(1.0, 2.0);
  const Mesh joined = welded({{{1, 0, 0}, {next, 0, 0}, {0, 1, 0}, {1, -0.0, 0}}, {{0, 1, 2}, {3, 1, 2}}});
  EXPECT_EQ(joined.vertices, (std::vector<Vec3>{{0, 1, 0}, {1, 0, 0}, {next, 0, 0}}));  // in order; -0 is 0
  EXPECT_EQ(joined.triangles, (std::vector<Triangle>{{1, 2, 0}, {1, 2, 0}}));
}

TEST(Weld, DropsTrianglesWithTwoCornersInOnePlace) {
  const Mesh joined = welded({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 0, 0}}, {{0, 1, 2}, {1, 2, 3}, {0, 1, 1}}});
  EXPECT_EQ(joined.triangles.size(), 1u);
  EXPECT_TRUE(welded(Mesh()).empty());
}

/// The boundary of some cubes of a grid, one vertex for each place: many edges have four triangles.
Mesh surface_of_cubes(const std::set<std::array<int, 3>>& cubes, const Vec3& origin) {
  Mesh mesh;
  std::map<std::array<int, 3>, std::uint32_t> known;
  const auto vertex = [&](const std::array<int, 3>& at) {
    const auto [entry, is_new] = known.try_emplace(at, static_cast<std::uint32_t>(mesh.vertices.size()));
    if (is_new) mesh.vertices.push_back(origin + Vec3(at[0], at[1], at[2]));
    return entry->second;
  };
  for (const std::array<int, 3>& cube : cubes) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (const int side : {0, 1}) {
        std::array<int, 3> beyond = cube, at = cube;
        beyond[axis] += 2 * side - 1;
        if (cubes.contains(beyond)) continue;
        at[axis] += side;
        std::array<std::array<int, 3>, 4> corners = {at, at, at, at};
        corners[1][(axis + 1) % 3] += 1;
        corners[2][(axis + 1) % 3] += 1;
        corners[2][(axis + 2) % 3] += 1;
        corners[3][(axis + 2) % 3] += 1;
        if (side == 0) std::swap(corners[1], corners[3]);
        mesh.triangles.push_back({vertex(corners[0]), vertex(corners[1]), vertex(corners[2])});
        mesh.triangles.push_back({vertex(corners[0]), vertex(corners[2]), vertex(corners[3])});
      }
    }
  }
  return mesh;
}

Mesh draw_cubes(testing::Random& random, const Vec3& origin) {
  // Where two cubes touch at an edge, and round both of its ends all hangs together, the edge has to be split.
  std::set<std::array<int, 3>> cubes = {{0, 0, 0}};
  const int size = random.integer(2, 4);
  const double share = random.uniform(0.2, 0.8);
  for (int x = 0; x < size; ++x) {
    for (int y = 0; y < size; ++y) {
      for (int z = 0; z < size; ++z) {
        if (random.chance(share)) cubes.insert({x, y, z});
      }
    }
  }
  return surface_of_cubes(cubes, origin);
}

TEST(Weld, SharedEdgesAreSplitUntilTwoTrianglesMeetAtEach) {
  testing::Random random(307);
  int shared = 0;
  for (int round = 0; round < 300; ++round) {
    const Mesh whole = draw_cubes(random, Vec3(0.1, 0.2, 0.3));
    Mesh mesh = whole;
    split_where_pieces_touch(mesh);
    shared += !measure(mesh).closed;
    const std::size_t before = mesh.triangles.size();
    const auto [part_of, is_done] = split_shared_edges(mesh);
    EXPECT_TRUE(is_done);
    ASSERT_EQ(mesh.triangles.size(), before + part_of.size());
    for (const std::uint32_t t : part_of) EXPECT_LT(t, before);
    EXPECT_EQ(testing::first_open_edge(mesh), "") << "round " << round;
    EXPECT_NEAR(enclosed_volume(mesh), enclosed_volume(whole), 1e-12);
    EXPECT_NEAR(surface_area(mesh), surface_area(whole), 1e-12);
  }
  EXPECT_GT(shared, 30);
}

TEST(Weld, SurfacesThatTouchStayApartByTheirOwners) {
  testing::Random random(311);
  for (int round = 0; round < 300; ++round) {
    Mesh apart = draw_cubes(random, Vec3::Zero());
    split_where_pieces_touch(apart);
    split_shared_edges(apart);
    const std::vector<std::uint32_t> first = first_at_position(apart.vertices);
    Mesh welded = apart;
    for (Triangle& t : welded.triangles) t = {first[t[0]], first[t[1]], first[t[2]]};
    split_where_pieces_touch(welded, apart.triangles);
    EXPECT_EQ(testing::first_open_edge(welded), "") << "round " << round;
    EXPECT_EQ(measure(welded).euler, measure(apart).euler);
    EXPECT_EQ(measure(welded).pieces, measure(apart).pieces);
  }
}

TEST(Weld, FacingFacetsAreTakenOutInPairs) {
  const std::vector<Triangle> triangles = {{0, 1, 2}, {2, 3, 1}, {2, 1, 0}, {1, 2, 0}, {4, 1, 2}, {1, 3, 2}, {0, 2, 1}};
  EXPECT_EQ(facing_facets(triangles), (std::vector<std::uint32_t>{0, 2, 3, 6, 1, 5}));
  EXPECT_TRUE(facing_facets({{0, 1, 2}, {1, 2, 0}, {2, 3, 0}}).empty());
}

// As they are found in a mesh that nobody mended: the splitting says that it is not done.
TEST(Weld, FacingFacetsAreNotSplit) {
  Mesh mesh{{{0, 0, 0}, {4, 0, 0}, {1, 3, 0}, {1, 1, 2}}, {}};
  mesh.triangles = {{0, 1, 2}, {1, 0, 2}, {0, 1, 2}, {1, 0, 2}, {0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
  LabelledMesh labelled{mesh, {1, 2, 3, 4, 5, 6, 7, 8}};
  EXPECT_FALSE(split_shared_edges(mesh).is_done);
  take_out_facing_facets(labelled);
  EXPECT_EQ(labelled.labels, (std::vector<std::uint32_t>{5, 6, 7, 8}));
  EXPECT_TRUE(split_shared_edges(labelled));
  EXPECT_EQ(testing::first_open_edge(labelled.mesh), "");
}

/// The first triangle gets a vertex on its first side, and beside it a facet without area.
void add_flat_facet(Mesh& mesh) {
  const auto [a, b, c] = mesh.triangles[0];
  const auto middle = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.push_back((mesh.vertices[a] + mesh.vertices[b]) / 2);
  mesh.triangles[0] = {middle, b, c};
  mesh.triangles.push_back({a, middle, c});
  mesh.triangles.push_back({a, b, middle});
}

// A flat facet makes the whole mesh be welded; what touches must not hang together by that.
TEST(MendWelded, WhatTouchesStaysClosedByIndex) {
  testing::Random random(313);
  for (const Vec3& origin : {Vec3(0.1, 0.2, 0.3), Vec3(-3e6 + 0.1, 4.7e6 + 0.2, 10)}) {
    for (int round = 0; round < 300; ++round) {
      LabelledMesh labelled{draw_cubes(random, origin), {}};
      if (round % 2) {
        split_where_pieces_touch(labelled.mesh);
        split_shared_edges(labelled.mesh);
      }
      const MeshMeasures before = measure(labelled.mesh);
      Mesh& mesh = labelled.mesh;
      add_flat_facet(mesh);
      labelled.labels.assign(mesh.triangles.size(), 7);
      ASSERT_TRUE(mend_for_doubles(labelled));
      EXPECT_EQ(testing::first_open_edge(mesh), "") << "round " << round;
      EXPECT_EQ(labelled.labels.size(), mesh.triangles.size());
      EXPECT_NEAR(enclosed_volume(mesh), before.volume_m3, 1e-6);
      if (round % 2) {
        EXPECT_EQ(measure(mesh).pieces, before.pieces);
      }
    }
  }
}

/// Closed: a few tetrahedra on common vertices, and pairs of facets that face each other on the same three of them.
Mesh draw_facing_facets(testing::Random& random) {
  Mesh mesh;
  const int count = random.integer(5, 7);
  for (int v = 0; v < count; ++v) mesh.vertices.push_back(random.point(0, 4));
  std::vector<std::uint32_t> drawn(mesh.vertices.size());
  std::iota(drawn.begin(), drawn.end(), 0u);
  const auto draw = [&](int corners) {
    for (int i = 0; i < corners; ++i) {
      std::swap(drawn[static_cast<std::size_t>(i)], drawn[static_cast<std::size_t>(random.integer(i, count - 1))]);
    }
  };
  for (int left = random.integer(1, 3); left > 0; --left) {
    draw(4);
    const Vec3& apex = mesh.vertices[drawn[3]];
    const Vec3 a = mesh.vertices[drawn[0]] - apex, b = mesh.vertices[drawn[1]] - apex,
               c = mesh.vertices[drawn[2]] - apex;
    if (a.dot(b.cross(c)) < 0) std::swap(drawn[0], drawn[1]);
    const std::uint32_t p = drawn[0], q = drawn[1], r = drawn[2], x = drawn[3];
    mesh.triangles.insert(mesh.triangles.end(), {{p, q, r}, {q, p, x}, {r, q, x}, {p, r, x}});
  }
  for (int left = random.integer(0, 2); left > 0; --left) {
    draw(3);
    mesh.triangles.push_back({drawn[0], drawn[1], drawn[2]});
    mesh.triangles.push_back({drawn[1], drawn[0], drawn[2]});
  }
  for (std::size_t t = mesh.triangles.size(); t > 1; --t) {
    std::swap(mesh.triangles[t - 1],
              mesh.triangles[static_cast<std::size_t>(random.integer(0, static_cast<int>(t) - 1))]);
  }
  return mesh;
}

TEST(MendWelded, FacetsThatFaceEachOtherEndTheSplitting) {
  testing::Random random(331);
  for (int round = 0; round < 6000; ++round) {
    const Mesh whole = draw_facing_facets(random);
    LabelledMesh labelled{whole, {}};
    Mesh& mesh = labelled.mesh;
    add_flat_facet(mesh);
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) labelled.labels.push_back(t);
    ASSERT_TRUE(mend_for_doubles(labelled));
    ASSERT_EQ(testing::first_open_edge(mesh), "") << "round " << round;
    ASSERT_EQ(labelled.labels.size(), mesh.triangles.size());
    ASSERT_NEAR(enclosed_volume(mesh), enclosed_volume(whole), 1e-9);
    if (round % 10 != 0) continue;
    const TriangleTree before(whole), after(mesh);
    for (int i = 0; i < 20; ++i) {
      const Vec3 p = random.point(0, 4);
      if (before.distance(p) < 1e-6) continue;
      ASSERT_EQ(after.winding_number(p), before.winding_number(p)) << "round " << round;
    }
  }
}

double narrowest(const Mesh& mesh) {
  double width = INFINITY;
  for (const auto& [a, b, c] : mesh.triangles) {
    const auto& p = mesh.vertices;
    const double longest = std::max({(p[b] - p[a]).norm(), (p[c] - p[b]).norm(), (p[a] - p[c]).norm()});
    width = std::min(width, (p[b] - p[a]).cross(p[c] - p[a]).norm() / longest);
  }
  return width;
}

// Two cubes between two layers touch at one edge, from (1, 1, 1) to (1, 1, 2), and around its ends all hangs together:
// so the edge has to be split. Beside it lie facets that are hardly wide enough.
TEST(MendWelded, NarrowFacetsAtASharedEdgeAreHalvedOnceAndKeepAnArea) {
  std::set<std::array<int, 3>> cubes = {{0, 0, 1}, {1, 1, 1}};
  for (const int z : {0, 2}) {
    for (const int x : {0, 1}) cubes.insert({{x, 0, z}, {x, 1, z}});
  }
  LabelledMesh labelled{surface_of_cubes(cubes, Vec3::Zero()), {}};
  Mesh& mesh = labelled.mesh;
  const double flat = flat_width(mesh), enclosed = enclosed_volume(mesh);
  const auto is_on_edge = [&](std::uint32_t v) {
    const Vec3& at = mesh.vertices[v];
    return at.x() == 1 && at.y() == 1 && at.z() >= 1 && at.z() <= 2;
  };
  const std::size_t count = mesh.triangles.size();
  int narrow = 0;
  for (std::size_t t = 0; t < count; ++t) {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t a = mesh.triangles[t][i], b = mesh.triangles[t][(i + 1) % 3],
                          c = mesh.triangles[t][(i + 2) % 3];
      if (!is_on_edge(a) || !is_on_edge(b)) continue;
      const Vec3 along = mesh.vertices[c] - mesh.vertices[a];
      Vec3 at(1, 1, 1.9);
      for (Eigen::Index axis = 0; axis < 2; ++axis) at[axis] += 1.5 * flat * along[axis];
      const auto middle = static_cast<std::uint32_t>(mesh.vertices.size());
      mesh.vertices.push_back(at);
      mesh.triangles[t] = {a, b, middle};
      mesh.triangles.push_back({b, c, middle});
      mesh.triangles.push_back({c, a, middle});
      ++narrow;
      break;
    }
  }
  ASSERT_EQ(narrow, 4);
  EXPECT_GT(narrowest(mesh), flat);
  // And far away a facet without area, so that there is something to mend.
  add_flat_facet(mesh);
  labelled.labels.assign(mesh.triangles.size(), 7);
  EXPECT_EQ(mend_for_doubles(labelled), flat);
  EXPECT_EQ(testing::first_open_edge(mesh), "");
  EXPECT_NEAR(enclosed_volume(mesh), enclosed, 1e-12);
  EXPECT_LT(narrowest(mesh), flat) << "nothing was halved";
  EXPECT_GT(narrowest(mesh), flat / 4);
}

// As a file in single precision has them: vertices on a coarse grid, to which middles of edges go, too.
TEST(MendWelded, WhatTouchesOnACoarseGridStaysClosedByIndex) {
  testing::Random random(317);
  const auto to_grid = [](const Vec3& vertex) { return Vec3(vertex.array().round()); };
  int shared = 0;
  for (int round = 0; round < 300; ++round) {
    LabelledMesh labelled{draw_cubes(random, Vec3::Zero()), {}};
    Mesh& mesh = labelled.mesh;
    for (Vec3& vertex : mesh.vertices)
      vertex *= 3;  // so that the middle of an edge lies between two places of the grid
    const double enclosed = enclosed_volume(mesh);
    Mesh apart = mesh;
    split_where_pieces_touch(apart);
    shared += !measure(apart).closed;
    const auto [a, b, c] = mesh.triangles[0];
    mesh.triangles.push_back({a, b, c});  // two facets on the same corners
    mesh.triangles.push_back({a, c, b});
    mesh.triangles.push_back({a, b, a});  // and one without area
    labelled.labels.assign(mesh.triangles.size(), 7);
    ASSERT_TRUE(mend_welded(labelled, 0));
    const double moved = split_on_grid(labelled, to_grid);
    EXPECT_LE(moved, 4 * 0.5);
    EXPECT_EQ(testing::first_open_edge(mesh), "") << "round " << round;
    EXPECT_EQ(labelled.labels.size(), mesh.triangles.size());
    EXPECT_GT(narrowest(mesh), 0) << "round " << round;
    for (const Vec3& vertex : mesh.vertices) ASSERT_EQ(vertex, to_grid(vertex));
    EXPECT_LE(std::abs(enclosed_volume(mesh) - enclosed), moved * surface_area(mesh));
  }
  EXPECT_GT(shared, 10);
}

}  // namespace
}  // namespace vantage::internal::core
