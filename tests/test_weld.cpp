#include <gtest/gtest.h>

#include <cmath>

#include "core/weld.h"
#include "support/solids.h"

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

}  // namespace
}  // namespace vantage::internal::core
