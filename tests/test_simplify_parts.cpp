// The parts of simplifying, each by itself.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "simplify/collapse.h"
#include "simplify/exact.h"
#include "simplify/facet_tree.h"
#include "simplify/inner_point.h"
#include "simplify/surface.h"
#include "support/exact_crossings.h"
#include "support/random.h"
#include "support/simplify_meshes.h"
#include "support/solids.h"
#include "vantage/geometry.h"

namespace vantage {
namespace {

using testing::exact_side;
using testing::narrowest_fold;
using testing::Random;
using testing::spiky_dome;

/// Of all facets at either end of the edge, those that go included.
TEST(SimplifyParts, APlaceMustBeInsideOfEveryFacetThatChanges) {
  namespace simplify = internal::simplify;
  Random random(24);
  const Mesh mesh = spiky_dome(random, 10, 5);
  const simplify::Surface surface(mesh, std::vector<std::uint32_t>(mesh.triangles.size(), 0));
  simplify::Patch patch;
  int inner = 0, only_outside_of_those_that_go = 0;
  for (int i = 0; i < 20000; ++i) {
    const Triangle& t =
        mesh.triangles[static_cast<std::size_t>(random.integer(0, static_cast<int>(mesh.triangles.size()) - 1))];
    if (!surface.find_patch(t[0], t[1], patch)) continue;
    const Vec3 place = (mesh.vertices[t[0]] + mesh.vertices[t[1]]) / 2 + random.uniform(0, 0.2) * random.direction();
    bool expected = true, stays = true;
    for (const Triangle& facet : mesh.triangles) {
      const bool has_from = std::find(facet.begin(), facet.end(), t[0]) != facet.end();
      const bool has_to = std::find(facet.begin(), facet.end(), t[1]) != facet.end();
      if (!has_from && !has_to) continue;
      const auto& [a, b, c] = facet;
      const bool is_inside = exact_side(mesh.vertices[a], mesh.vertices[b], mesh.vertices[c], place) >= 0;
      expected = expected && is_inside;
      stays = stays && (is_inside || (has_from && has_to));
    }
    EXPECT_EQ(simplify::is_inner(surface, patch, place), expected);
    inner += expected ? 1 : 0;
    only_outside_of_those_that_go += stays && !expected ? 1 : 0;
  }
  EXPECT_GT(inner, 50);
  EXPECT_GT(only_outside_of_those_that_go, 10);
}

/// What booleans would take for facets that lie on each other: with one outside of the patch, and round the new place.
TEST(SimplifyParts, NoFacetComesToLieOnAnother) {
  namespace simplify = internal::simplify;
  Random random(27);
  const Mesh mesh = testing::make_dome(Vec3::Zero(), 9, 4, [](double, double) { return 1.0; }).mesh;  // convex
  const simplify::Surface surface(mesh, std::vector<std::uint32_t>(mesh.triangles.size(), 0));
  simplify::Patch patch;
  int onto_others = 0, onto_each_other = 0;
  for (int i = 0; i < 20000; ++i) {
    const Triangle& t =
        mesh.triangles[static_cast<std::size_t>(random.integer(0, static_cast<int>(mesh.triangles.size()) - 1))];
    if (!surface.find_patch(t[0], t[1], patch)) continue;
    const Triangle& over =
        mesh.triangles[static_cast<std::size_t>(random.integer(0, static_cast<int>(mesh.triangles.size()) - 1))];
    // Straight below a facet, and in the plane of three neighbours of the edge's ends, just inside.
    std::vector<std::uint32_t> ring;
    surface.neighbours(t[0], ring);
    const auto any = [&] { return mesh.vertices[ring[static_cast<std::size_t>(random.integer(0, 3)) % ring.size()]]; };
    const bool is_below = random.chance(0.5);
    const auto& [a, b, c] = over;
    const std::array<Vec3, 3> of =
        is_below ? std::array{mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]} : std::array{any(), any(), any()};
    const Vec3 normal = (of[1] - of[0]).cross(of[2] - of[0]).normalized();
    if (!normal.allFinite()) continue;
    const double u = random.uniform(0, 1), v = is_below ? random.uniform(0, 1 - u) : random.uniform(-1, 1);
    const Vec3 at = of[0] + u * (of[1] - of[0]) + v * (of[2] - of[0]);
    if (!simplify::is_clean(surface, patch, at - 1e-7 * normal, 1e-10)) continue;
    for (const double gap : {1e-7, 1e-12}) {
      const Vec3 place = at - gap * normal;
      Mesh moved = mesh;
      for (const std::uint32_t v_of : {patch.from, patch.to}) moved.vertices[v_of] = place;
      const double fold = narrowest_fold(moved);
      const bool is_clean = simplify::is_clean(surface, patch, place, 1e-10);
      if (fold < 0.9e-10) {
        EXPECT_FALSE(is_clean) << place.transpose();
      } else if (fold > 1e-9 && gap == 1e-7) {
        EXPECT_TRUE(is_clean);
      }
      if (fold < 0.9e-10) ++(is_below ? onto_others : onto_each_other);
    }
  }
  EXPECT_GT(onto_others, 20);
  EXPECT_GT(onto_each_other, 5);
}

TEST(SimplifyParts, TheTreeFindsFacetsWhereverTheyHaveGone) {
  Random random(25);
  const auto draw = [&] {
    Box box;
    box.extend(random.point(0, 10));
    box.extend(box.min + random.point(0, 2));
    return box;
  };
  std::vector<Box> boxes(500);
  for (Box& box : boxes) box = draw();
  internal::simplify::FacetTree tree(boxes);
  for (int i = 0; i < 2000; ++i) {
    const auto moved = static_cast<std::uint32_t>(random.integer(0, 499));
    boxes[moved] = random.chance(0.1) ? Box{} : draw();
    tree.update(moved, boxes[moved]);
    const Box asked = draw();
    std::vector<std::uint32_t> found;
    tree.find(asked, found);
    std::sort(found.begin(), found.end());
    for (std::uint32_t f = 0; f < boxes.size(); ++f) {
      const bool meets = !boxes[f].empty() && (boxes[f].min.array() <= asked.max.array()).all() &&
                         (asked.min.array() <= boxes[f].max.array()).all();
      EXPECT_TRUE(!meets || std::binary_search(found.begin(), found.end(), f));
    }
    EXPECT_LT(found.size(), 200u);
  }
}

TEST(SimplifyParts, SidesAndMeetingsAgreeWithTheSlowSum) {
  namespace simplify = internal::simplify;
  Random random(21);
  const auto draw = [&](double size) {
    return Vec3((random.point(-3, 3)).array().round() * size + (random.chance(0.3) ? 1e-16 : 0.0));
  };
  int in_plane = 0, met = 0;
  for (int i = 0; i < 4000; ++i) {
    const double size = random.chance(0.5) ? 1 : 0.1;
    const Vec3 a = draw(size), b = draw(size), c = draw(size), s = draw(size), e = draw(size);
    const int side = exact_side(a, b, c, s);
    EXPECT_EQ(simplify::side_of({a, b, c}, s), side);
    in_plane += side == 0 ? 1 : 0;
    const int other = exact_side(a, b, c, e);
    if ((b - a).cross(c - a).norm() < 1e-9 || (side == 0 && other == 0)) continue;
    const int turns[] = {exact_side(s, e, a, b), exact_side(s, e, b, c), exact_side(s, e, c, a)};
    const bool is_left = std::all_of(turns, turns + 3, [](int turn) { return turn >= 0; });
    const bool is_right = std::all_of(turns, turns + 3, [](int turn) { return turn <= 0; });
    const bool expected = side * other <= 0 && (is_left || is_right);
    EXPECT_EQ(simplify::meet(s, e, {a, b, c}), expected);
    met += expected ? 1 : 0;
  }
  EXPECT_GT(in_plane, 100);
  EXPECT_GT(met, 100);
  // In one plane.
  const simplify::Corners upright = {Vec3(0, 1, 0), Vec3(4, 1, 0), Vec3(0, 1, 4)};
  EXPECT_TRUE(simplify::meet(Vec3(1, 1, 1), Vec3(1.5, 1, 1), upright));  // inside
  EXPECT_TRUE(simplify::meet(Vec3(-1, 1, 1), Vec3(5, 1, 1), upright));   // across
  EXPECT_TRUE(simplify::meet(Vec3(2, 1, 2), Vec3(5, 1, 5), upright));    // touches a side
  EXPECT_TRUE(simplify::meet(Vec3(-2, 1, 0), Vec3(0, 1, 0), upright));   // touches a corner
  EXPECT_FALSE(simplify::meet(Vec3(3, 1, 3), Vec3(5, 1, 5), upright));
  EXPECT_FALSE(simplify::meet(Vec3(-2, 1, 0), Vec3(-1, 1, 0), upright));  // on the line of a side
}

TEST(SimplifyParts, TheNearestInnerPointIsInsideAndNearest) {
  using internal::simplify::HalfSpace;
  Random random(22);
  int found_any = 0, none = 0;
  for (int i = 0; i < 2000; ++i) {
    std::vector<HalfSpace> half_spaces;
    const int count = random.integer(1, 14);
    for (int k = 0; k < count; ++k) half_spaces.push_back({random.direction(), random.uniform(-0.3, 1)});
    const Vec3 wanted = random.point(-5, 5);
    const auto found = internal::simplify::nearest_inner_point(half_spaces, wanted);
    const auto excess = [&](const Vec3& p) {
      double most = -1;
      for (const HalfSpace& half : half_spaces) most = std::max(most, half.normal.dot(p) - half.offset);
      return most;
    };
    // Dykstra's projections: slow, and nothing in common with what is tested.
    Vec3 p = wanted;
    std::vector<Vec3> push(half_spaces.size(), Vec3::Zero());
    for (int round = 0; round < 3000 && found; ++round) {
      for (std::size_t k = 0; k < half_spaces.size(); ++k) {
        const Vec3 before = p + push[k];
        const double out = std::max(0.0, half_spaces[k].normal.dot(before) - half_spaces[k].offset);
        p = before - out * half_spaces[k].normal;
        push[k] = before - p;
      }
    }
    if (!found) {
      ++none;
      continue;
    }
    ++found_any;
    EXPECT_LT(excess(*found), 1e-7);
    if (excess(p) > 1e-9) continue;
    EXPECT_LT((*found - p).norm(), 1e-3);
  }
  EXPECT_GT(found_any, 1000);
  EXPECT_GT(none, 20);
}

}  // namespace
}  // namespace vantage
