// The traversal of hierarchies: what is visited, in which order, and when it ends.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include "core/walk_bvh.h"
#include "support/random.h"

namespace vantage::internal::core {
namespace {

constexpr auto kAll = [](const BvhNode&) { return true; };

Bounds cube(float x, float y, float z, float half) {
  return {{x - half, y - half, z - half}, {x + half, y + half, z + half}};
}

Bvh scattered(std::size_t count) {
  testing::Random random(41);
  std::vector<Bounds> items;
  for (std::size_t i = 0; i < count; ++i) {
    const auto at = [&] { return static_cast<float>(random.uniform(-100, 100)); };
    items.push_back(cube(at(), at(), at(), 1));
  }
  std::vector<std::uint32_t> order;
  return build_bvh(items, order);
}

double distance_from_origin(const Bounds& bounds) {
  double sum = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double away = std::max({0.0, double{bounds.min[axis]}, -double{bounds.max[axis]}});
    sum += away * away;
  }
  return std::sqrt(sum);
}

/// Every left child has children of its own, while all right ones wait: more than the stack has room of its own for.
Bvh chain(std::uint32_t depth) {
  const BvhNode leaf{cube(0, 0, 0, 1), 0, 1};
  Bvh bvh{{leaf}};
  std::uint32_t at = 0;
  for (std::uint32_t i = 0; i < depth; ++i) {
    const auto left = static_cast<std::uint32_t>(bvh.nodes.size());
    bvh.nodes[at] = {leaf.bounds, left, 0};
    bvh.nodes.insert(bvh.nodes.end(), 2, leaf);
    at = left;
  }
  return bvh;
}

TEST(WalkBvh, VisitsEveryItemOnceInOrder) {
  for (const std::size_t count : {0, 1, 4, 5, 1000}) {
    const Bvh bvh = scattered(count);
    std::vector<std::uint32_t> expected(count), visited;
    std::iota(expected.begin(), expected.end(), 0u);
    EXPECT_TRUE(walk_bvh(bvh, kAll, [&](std::uint32_t item) { visited.push_back(item); }));
    EXPECT_EQ(visited, expected);
    for (const bool nearest : {false, true}) {
      visited.clear();
      const auto visit = [&](std::uint32_t item) { visited.push_back(item); };
      const double reach = std::numeric_limits<double>::infinity();
      EXPECT_TRUE(nearest ? walk_nearest_first(bvh, distance_from_origin, reach, kAll, visit)
                          : walk_nearer_first(bvh, distance_from_origin, kAll, visit));
      std::sort(visited.begin(), visited.end());
      EXPECT_EQ(visited, expected);
    }
  }
}

TEST(WalkBvh, LeavesOutWhatIsNotEntered) {
  const Bvh bvh = scattered(1000);
  std::size_t entered = 0, items = 0;
  const auto is_above = [&](const BvhNode& node) {
    ++entered;
    return node.bounds.min[2] > 0;
  };
  walk_bvh(bvh, is_above, [&](std::uint32_t) { ++items; });
  EXPECT_EQ(entered, 1U) << "nothing below the root was looked at";
  EXPECT_EQ(items, 0U);
}

TEST(WalkBvh, EndsWhereTheVisitorSaysSo) {
  const Bvh bvh = scattered(1000);
  std::size_t items = 0;
  EXPECT_FALSE(walk_bvh(bvh, kAll, [&](std::uint32_t) { return ++items < 7; }));
  EXPECT_EQ(items, 7U);
}

TEST(WalkBvh, TakesTheNearestNodeOfAllWithinReach) {
  const Bvh bvh = scattered(1000);
  constexpr double kReach = 60;
  double last = 0;
  std::size_t entered = 0, within = 0;
  const auto enter = [&](const BvhNode& node, double distance) {
    EXPECT_EQ(distance, distance_from_origin(node.bounds));
    EXPECT_GE(distance, last);
    last = distance;
    ++entered;
    return true;
  };
  walk_nearest_first(bvh, distance_from_origin, kReach, enter, [](std::uint32_t) {});
  for (const BvhNode& node : bvh.nodes) within += distance_from_origin(node.bounds) <= kReach;
  EXPECT_EQ(entered, within);
  EXPECT_LT(within, bvh.nodes.size());
}

TEST(WalkBvh, TakesTheNearerChildFirst) {
  const Bvh bvh = scattered(1000);
  std::vector<const BvhNode*> entered;
  const auto enter = [&](const BvhNode& node, double) {
    entered.push_back(&node);
    return true;
  };
  walk_nearer_first(bvh, distance_from_origin, enter, [](std::uint32_t) {});
  ASSERT_EQ(entered.size(), bvh.nodes.size());
  for (std::size_t i = 0; i < entered.size(); ++i) {
    if (entered[i]->leaf()) continue;
    const BvhNode &left = bvh.nodes[entered[i]->first], &right = bvh.nodes[entered[i]->first + 1];
    const bool left_first = distance_from_origin(left.bounds) <= distance_from_origin(right.bounds);
    EXPECT_EQ(entered[i + 1], left_first ? &left : &right);
  }
}

TEST(WalkBvh, OfAnyDepth) {
  constexpr std::uint32_t kDepth = 1000;
  const Bvh bvh = chain(kDepth);
  std::size_t left_first = 0, nearer_first = 0;
  walk_bvh(bvh, kAll, [&](std::uint32_t) { ++left_first; });
  walk_nearer_first(bvh, distance_from_origin, kAll, [&](std::uint32_t) { ++nearer_first; });
  EXPECT_EQ(left_first, kDepth + 1);
  EXPECT_EQ(nearer_first, kDepth + 1);
}

}  // namespace
}  // namespace vantage::internal::core
