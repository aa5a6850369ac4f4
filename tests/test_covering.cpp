// The least cover, the largest clique and groups without a conflict, against all choices of few elements.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "flight/tour/covering.h"
#include "support/random.h"

namespace vantage::internal::flight::tour {
namespace {

using vantage::testing::Random;

Group members(unsigned bits) {
  Group group;
  for (std::size_t e = 0; e < 32; ++e) {
    if ((bits >> e & 1U) != 0) group.push_back(e);
  }
  return group;
}

unsigned bits_of(const Group& group) {
  unsigned bits = 0;
  for (const std::size_t e : group) bits |= 1U << e;
  return bits;
}

TEST(Covering, NoFewerSetsHoldAll) {
  Random random(411);
  for (int round = 0; round < 300; ++round) {
    const auto count = static_cast<std::size_t>(random.integer(1, 9));
    const unsigned all = (1U << count) - 1;
    std::vector<Group> sets;
    for (std::size_t e = 0; e < count; ++e) {  // each element is in a set
      sets.push_back(members(static_cast<unsigned>(random.integer(0, static_cast<int>(all))) | 1U << e));
    }
    for (int more = random.integer(0, 3); more > 0; --more) {
      sets.push_back(members(static_cast<unsigned>(random.integer(1, static_cast<int>(all)))));
    }
    int least = 99;
    for (unsigned choice = 1; choice < 1U << sets.size(); ++choice) {
      unsigned held = 0;
      for (const std::size_t s : members(choice)) held |= bits_of(sets[s]);
      if (held == all) least = std::min(least, std::popcount(choice));
    }
    const Cover cover = least_cover(count, sets);
    unsigned held = 0;
    for (const std::size_t s : cover.chosen) held |= bits_of(sets[s]);
    EXPECT_EQ(held, all);
    EXPECT_TRUE(cover.is_least);
    EXPECT_EQ(static_cast<int>(cover.chosen.size()), least) << "round " << round;
  }
}

/// Pairs, and with `larger` sets of three.
std::vector<Group> random_conflicts(Random& random, std::size_t count, bool larger) {
  std::vector<Group> conflicts;
  for (std::size_t a = 0; a < count; ++a) {
    for (std::size_t b = a + 1; b < count; ++b) {
      if (random.chance(0.4)) conflicts.push_back({a, b});
      for (std::size_t c = b + 1; c < count && larger; ++c) {
        if (random.chance(0.15)) conflicts.push_back({a, b, c});
      }
    }
  }
  return conflicts;
}

Group largest_clique(std::size_t count, const std::vector<Group>& conflicts) {
  Group best;
  for (unsigned choice = 1; choice < 1U << count; ++choice) {
    const Group group = members(choice);
    bool is_clique = true;
    for (std::size_t i = 0; i < group.size(); ++i) {
      for (std::size_t k = i + 1; k < group.size(); ++k) {
        is_clique =
            is_clique && std::find(conflicts.begin(), conflicts.end(), Group{group[i], group[k]}) != conflicts.end();
      }
    }
    if (is_clique && group.size() > best.size()) best = group;
  }
  return best;
}

TEST(Covering, NoLargerSetIsApart) {
  Random random(412);
  for (int round = 0; round < 200; ++round) {
    const auto count = static_cast<std::size_t>(random.integer(1, 9));
    const std::vector<Group> conflicts = random_conflicts(random, count, true);
    const Group apart = most_apart(count, conflicts);
    EXPECT_EQ(apart.size(), largest_clique(count, conflicts).size()) << "round " << round;
    for (std::size_t i = 0; i < apart.size(); ++i) {
      for (std::size_t k = i + 1; k < apart.size(); ++k) {
        EXPECT_NE(std::find(conflicts.begin(), conflicts.end(), Group{apart[i], apart[k]}), conflicts.end());
      }
    }
  }
}

bool has_no_conflict(const std::vector<unsigned>& groups, const std::vector<Group>& conflicts) {
  return std::none_of(conflicts.begin(), conflicts.end(), [&](const Group& one) {
    const unsigned bits = bits_of(one);
    return std::any_of(groups.begin(), groups.end(), [&](unsigned group) { return (group & bits) == bits; });
  });
}

/// By all divisions.
bool can_divide(std::size_t count, std::size_t number, const std::vector<Group>& conflicts) {
  std::vector<unsigned> groups(number, 0);
  const std::function<bool(std::size_t)> place = [&](std::size_t e) {
    if (e == count) return has_no_conflict(groups, conflicts);
    for (unsigned& group : groups) {
      group |= 1U << e;
      if (place(e + 1)) return true;
      group &= ~(1U << e);
    }
    return false;
  };
  return place(0);
}

TEST(Covering, DivisionsAreFoundWhereThereAreSome) {
  Random random(413);
  int found = 0, none = 0;
  for (int round = 0; round < 200; ++round) {
    const auto count = static_cast<std::size_t>(random.integer(2, 7)),
               number = static_cast<std::size_t>(random.integer(1, 4));
    const std::vector<Group> conflicts = random_conflicts(random, count, true);
    const Group apart = random.chance(0.5) ? largest_clique(count, conflicts) : Group();
    const auto affinity = [](std::size_t a, std::size_t b) { return static_cast<double>((a * b) % 3); };
    const Division division = divide(count, number, conflicts, apart, affinity);
    const bool can = can_divide(count, number, conflicts);
    EXPECT_EQ(division.end, can ? Division::End::found : Division::End::none) << "round " << round;
    (can ? found : none) += 1;
    if (!can) continue;
    std::vector<unsigned> groups;
    unsigned held = 0;
    for (const Group& group : division.groups) {
      EXPECT_EQ(held & bits_of(group), 0U);
      held |= bits_of(group);
      groups.push_back(bits_of(group));
    }
    EXPECT_EQ(held, (1U << count) - 1);
    EXPECT_EQ(division.groups.size(), number);
    EXPECT_TRUE(has_no_conflict(groups, conflicts));
  }
  EXPECT_GT(std::min(found, none), 40);
}

TEST(Covering, EndsWithinItsLimits) {
  std::vector<Group>
      conflicts;  // 24 elements in 8 rows: two of a row go together, no others. Nobody divides them by 11
  for (std::size_t a = 0; a < 24; ++a) {
    for (std::size_t b = a + 1; b < 24; ++b) {
      if (a % 8 != b % 8) conflicts.push_back({a, b});
    }
  }
  CoveringLimits limits;
  limits.most_nodes = 3;
  EXPECT_EQ(divide(24, 11, conflicts, {}, {}, limits).end, Division::End::cut);
  EXPECT_EQ(divide(24, 8, conflicts, {}, {}).end, Division::End::found);
  EXPECT_EQ(divide(24, 7, conflicts, most_apart(24, conflicts), {}).end, Division::End::none);
}

}  // namespace
}  // namespace vantage::internal::flight::tour
