// The grid of multipolygon cases of osmcode/osm-testdata (public domain): each with its expected geometry and tags, or
// "INVALID". A case may have several variants: "default" is what a strict reader gives, "location" what one gives that
// joins ways where their ends lie in one place though they are different nodes, "fix" (or "fixed") what one gives that
// repairs.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "maps/osm/assembly_rings.h"
#include "support/osm_maps.h"
#include "support/random.h"
#include "support/shared_data.h"
#include "support/wording.h"

namespace vantage::internal::osm {
namespace {

using testing::osm_node;
using testing::osm_relation;
using testing::osm_way;
using testing::read_bytes;

/// Rings as text from their smallest corner on, rings and polygons in a fixed order. Every ring is turned
/// counter-clockwise: which way round a ring is written in the expected text means nothing.
using Positions = std::vector<std::pair<long, long>>;  // 1e-7 degrees

/// Without positions in the middle of a straight side: the expected texts leave some of them out.
Positions corners(const Positions& ring) {
  Positions kept;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const auto [ax, ay] = ring[(i + ring.size() - 1) % ring.size()];
    const auto [bx, by] = ring[i];
    const auto [cx, cy] = ring[(i + 1) % ring.size()];
    if ((bx - ax) * (cy - by) != (by - ay) * (cx - bx)) kept.push_back(ring[i]);
  }
  return kept;
}

std::string canonical(Positions ring) {
  ring = corners(ring);
  double doubled = 0;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const auto [ax, ay] = ring[i];
    const auto [bx, by] = ring[(i + 1) % ring.size()];
    doubled += static_cast<double>(ax) * static_cast<double>(by) - static_cast<double>(bx) * static_cast<double>(ay);
  }
  if (doubled < 0) std::reverse(ring.begin(), ring.end());
  // A corner may come twice where a ring touches itself: of all turns, the smallest.
  Positions smallest = ring;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    std::rotate(ring.begin(), ring.begin() + 1, ring.end());
    smallest = std::min(smallest, ring);
  }
  std::string text;
  for (const auto& [x, y] : smallest) text.append(std::to_string(x)).append(" ").append(std::to_string(y)).append(",");
  return text;
}

std::string canonical(const std::vector<std::vector<Positions>>& polygons) {
  std::multiset<std::string> texts;
  for (const std::vector<Positions>& rings : polygons) {
    std::multiset<std::string> holes;
    for (std::size_t i = 1; i < rings.size(); ++i) holes.insert(canonical(rings[i]));
    std::string text = canonical(rings.at(0));
    for (const std::string& hole : holes) text += " hole " + hole;
    texts.insert(text);
  }
  std::string all;
  for (const std::string& text : texts) all += text + "\n";
  return all;
}

/// "MULTIPOLYGON(((7.01 1.01,...),(...)),((...)))"
std::string canonical_wkt(const std::string& wkt) {
  std::vector<std::vector<Positions>> polygons;
  int depth = 0;
  std::string number;
  std::vector<long> pair;
  const auto finish_number = [&] {
    if (!number.empty()) pair.push_back(std::lround(std::stod(number) * 1e7));
    number.clear();
  };
  const auto finish_pair = [&] {
    finish_number();
    if (pair.size() == 2) polygons.back().back().emplace_back(pair[0], pair[1]);
    pair.clear();
  };
  for (const char c : wkt.substr(wkt.find('('))) {
    if (c == '(') {
      ++depth;
      if (depth == 2) polygons.emplace_back();
      if (depth == 3) polygons.back().emplace_back();
    } else if (c == ')') {
      finish_pair();
      if (depth == 3) polygons.back().back().pop_back();  // the first position again
      --depth;
    } else if (c == ',') {
      finish_pair();
    } else if (c == ' ') {
      finish_number();
    } else {
      number += c;
    }
  }
  return canonical(polygons);
}

Positions to_positions(const Ring& ring) {
  Positions positions;
  for (const LonLat at : ring) {
    positions.emplace_back(std::lround(at.longitude_deg * 1e7), std::lround(at.latitude_deg * 1e7));
  }
  return positions;
}

std::string canonical_area(const Area& area) {
  std::vector<std::vector<Positions>> polygons;
  for (const Polygon& polygon : area.polygons) {
    EXPECT_GT(testing::doubled_area(polygon.outer), 0) << text(area.id);
    auto& rings = polygons.emplace_back();
    rings.push_back(to_positions(polygon.outer));
    for (const Ring& hole : polygon.holes) {
      EXPECT_LT(testing::doubled_area(hole), 0) << text(area.id);
      rings.push_back(to_positions(hole));
    }
  }
  return canonical(polygons);
}

using TagMap = std::map<std::string, std::string>;

/// The ways of case 768, a relation that is INVALID, are each tagged area=yes and valid: areas of their own. In cases
/// 924 and 925 the pieces of a hole in a wood are tagged as water. The expected result leaves ways out that are members
/// of any relation, and so does not list them.
constexpr std::int64_t kWaysOfTheirOwn[] = {768800, 768801, 924801, 925801};

/// Whether the extract's areas are those of the variant: objects, geometry, tags. What is INVALID must be a problem.
bool matches(const Extract& extract, const nlohmann::json& variant) {
  std::size_t expected_areas = 0;
  for (const nlohmann::json& expected : variant) {
    const ObjectType type = expected["from_type"] == "way" ? ObjectType::way : ObjectType::relation;
    const ObjectId id{type, expected["from_id"].get<std::int64_t>()};
    const Area* const area = testing::find_object(extract.areas, id);
    if (expected["wkt"] == "INVALID") {
      const Problem* const problem = testing::find_problem(extract, id);
      if (area != nullptr || problem == nullptr || problem->what.empty()) return false;
      continue;
    }
    ++expected_areas;
    if (area == nullptr || canonical_area(*area) != canonical_wkt(expected["wkt"])) return false;
    if (TagMap(area->tags.all.begin(), area->tags.all.end()) != expected["tags"].get<TagMap>()) return false;
  }
  for (const std::int64_t way : kWaysOfTheirOwn) {
    if (testing::find_object(extract.areas, testing::way_id(way)) != nullptr) ++expected_areas;
  }
  return extract.areas.size() == expected_areas;
}

std::vector<std::filesystem::path> cases() {
  std::vector<std::filesystem::path> folders;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(testing::shared_data("osm-grid"))) {
    if (entry.path().filename() == "data.osm") folders.push_back(entry.path().parent_path());
  }
  std::sort(folders.begin(), folders.end());
  return folders;
}

TEST(OsmGrid, EveryMultipolygonIsAsExpected) {
  VANTAGE_REQUIRE_SHARED("osm-grid");
  std::map<std::string, std::size_t> by_variant;
  for (const std::filesystem::path& folder : cases()) {
    SCOPED_TRACE(folder.filename().string());
    const nlohmann::json test = nlohmann::json::parse(read_bytes(folder / "test.json"));
    Extract extract = read_extract(folder / "data.osm");
    // What cannot be assembled is taken as it is drawn, which no list of areas has.
    std::erase_if(extract.areas, [&](const Area& area) {
      const Problem* const problem = testing::find_problem(extract, area.id);
      return area.id.type == ObjectType::relation && problem != nullptr &&
             problem->kind == Problem::Kind::broken_multipolygon;
    });
    const bool is_by_role = std::any_of(extract.problems.begin(), extract.problems.end(), [](const Problem& problem) {
      return problem.what.find("no hole") != std::string::npos ||
             problem.what.find("outer rings overlap") != std::string::npos;
    });
    if (is_by_role) {  // outer rings inside or across each other, of which the test takes some for holes
      ++by_variant["by_role"];
      continue;
    }
    if (!test.contains("areas")) {
      ++by_variant["no areas"];
      EXPECT_EQ(extract.areas.size(), 0u);
      continue;
    }
    std::string matched;
    for (const char* const name : {"default", "location", "fix", "fixed"}) {
      const auto variant = test["areas"].find(name);
      if (matched.empty() && variant != test["areas"].end() && matches(extract, *variant)) matched = name;
    }
    EXPECT_FALSE(matched.empty()) << test["description"] << "\n"
                                  << testing::describe(extract) << "\nexpected " << test["areas"].dump();
    ++by_variant[matched.empty() ? "none" : matched];
  }
  std::size_t total = 0;
  std::string counts;
  for (const auto& [name, count] : by_variant) {
    total += count;
    counts += name + ": " + std::to_string(count) + ", ";
  }
  EXPECT_EQ(total, cases().size());
  EXPECT_GE(by_variant["default"] + by_variant["location"] + by_variant["fix"] + by_variant["fixed"], 95u);
  EXPECT_EQ(by_variant["by_role"], 7u);
  RecordProperty("variants", counts);
  std::cout << counts << total << " cases\n";
}

/// "110800 LINESTRING(1.02 1.12,1.07 1.13)" or "121800 NULL", a way each.
TEST(OsmGrid, EveryWayIsTheLineItShouldBe) {
  VANTAGE_REQUIRE_SHARED("osm-grid");
  std::size_t lines = 0, nulls = 0;
  for (const std::filesystem::path& folder : cases()) {
    if (folder.parent_path().filename() != "1") continue;  // elsewhere ways are borders of areas
    SCOPED_TRACE(folder.filename().string());
    const Extract extract = read_extract(folder / "data.osm");
    std::istringstream ways(read_bytes(folder / "ways.wkt"));
    std::size_t expected_lines = 0;
    for (std::string text; std::getline(ways, text);) {
      const ObjectId id = testing::way_id(std::stol(text));
      if (text.find("NULL") != std::string::npos) {
        ++nulls;
        const Problem* const problem = testing::find_problem(extract, id);
        ASSERT_NE(problem, nullptr) << text;
        EXPECT_EQ(problem->kind, Problem::Kind::degenerate);
        EXPECT_TRUE(problem->lost);
        continue;
      }
      ++expected_lines;
      const Line* const line = testing::find_object(extract.lines, id);
      ASSERT_NE(line, nullptr) << text;
      std::string ours;
      for (const LonLat at : line->points) {
        std::ostringstream pair;
        pair << at.longitude_deg << " " << at.latitude_deg;
        ours.append(ours.empty() ? "" : ",").append(pair.str());
      }
      EXPECT_EQ(ours, text.substr(text.find('(') + 1, text.find(')') - text.find('(') - 1));
    }
    EXPECT_EQ(extract.lines.size(), expected_lines);
    lines += expected_lines;
  }
  EXPECT_GT(lines, 15u);
  EXPECT_GE(nulls, 3u);
}

constexpr int kCells = 6;  // of a lattice, each way

struct Rectangle {
  int west, south, east, north;

  bool holds(int x, int y) const { return west <= x && x < east && south <= y && y < north; }
  /// With a corner at every point of the lattice, so that rings meet in their corners only.
  NodeLocations ring(bool clockwise) const {
    NodeLocations places;
    for (int x = west; x < east; ++x) places.emplace_back(x, south);
    for (int y = south; y < north; ++y) places.emplace_back(east, y);
    for (int x = east; x > west; --x) places.emplace_back(x, north);
    for (int y = north; y > south; --y) places.emplace_back(west, y);
    if (clockwise) std::reverse(places.begin(), places.end());
    return places;
  }
};

/// Cell by cell, and side by side between cells.
bool has_fault(const std::vector<Rectangle>& outer, const std::vector<Rectangle>& inner) {
  const auto count = [](const std::vector<Rectangle>& all, int x, int y) {
    return std::count_if(all.begin(), all.end(), [&](const Rectangle& one) { return one.holds(x, y); });
  };
  bool fault = false;
  for (int x = -1; x <= kCells; ++x) {
    for (int y = -1; y <= kCells; ++y) {
      const auto depth = count(outer, x, y) - count(inner, x, y);
      fault = fault || depth < 0 || depth > 1;
      for (const auto& [east, north] : {std::pair{1, 0}, {0, 1}}) {
        const bool outer_side = count(outer, x, y) != count(outer, x + east, y + north);
        fault = fault || (outer_side && count(inner, x, y) != count(inner, x + east, y + north));
      }
    }
  }
  return fault;
}

TEST(RingFault, IsSeenWhereverRingsMeet) {
  testing::Random random(3);
  int faults = 0;
  for (int round = 0; round < 4000; ++round) {
    std::vector<Rectangle> outer, inner;
    std::vector<NodeLocations> outer_rings, inner_rings;
    for (int i = random.integer(1, 5); i > 0; --i) {
      const int west = random.integer(0, kCells - 1), south = random.integer(0, kCells - 1);
      const Rectangle one{west, south, random.integer(west + 1, kCells), random.integer(south + 1, kCells)};
      const bool is_inner = !outer.empty() && random.chance(0.4);
      (is_inner ? inner : outer).push_back(one);
      (is_inner ? inner_rings : outer_rings).push_back(one.ring(random.chance(0.5)));
    }
    const bool fault = has_fault(outer, inner);
    faults += fault;
    ASSERT_EQ(ring_fault(outer_rings, inner_rings).has_value(), fault) << "round " << round;
  }
  EXPECT_GT(faults, 400);
  EXPECT_LT(faults, 3600);
}

TEST(RingFault, OfARingThatTouchesItselfIsWhatItGoesRoundTwice) {
  const auto fault = [](const std::vector<std::array<int, 2>>& places) {
    NodeLocations ring;
    for (const auto& [x, y] : places) ring.emplace_back(x, y);
    return ring_fault({ring}, {}).has_value();
  };
  EXPECT_FALSE(fault({{0, 0}, {5, 5}, {9, 9}, {9, 0}, {5, 5}, {0, 9}}));
  EXPECT_FALSE(fault({{0, 0}, {9, 0}, {9, 9}, {0, 9}, {0, 0}, {2, 2}, {2, 7}, {7, 7}, {7, 2}, {2, 2}})) << "a hole";
  EXPECT_TRUE(fault({{0, 0}, {9, 0}, {9, 9}, {0, 9}, {0, 0}, {2, 2}, {7, 2}, {7, 7}, {2, 7}, {2, 2}}));
  EXPECT_TRUE(fault({{0, 0}, {9, 0}, {9, 9}, {0, 9}, {0, 0}, {9, 0}, {9, 9}, {0, 9}}));
}

TEST(Chains, CloseARingWhereTheyComeBack) {
  const NodeLocations a = {{0, 0}, {1, 1}}, b = {{1, 1}, {0, 2}, {0, 0}};
  const NodeLocations c = {{1, 1}, {3, 1}, {3, 2}}, d = {{3, 2}, {1, 1}};
  const Chains two({a, c, b, d});
  ASSERT_EQ(two.rings().size(), 2u);
  EXPECT_EQ(two.rings()[0].size() + two.rings()[1].size(), 6u);
  EXPECT_TRUE(two.loose().empty());
  EXPECT_FALSE(two.fault());
  EXPECT_EQ(Chains({a, b, c}).loose().size(), 3u);
  EXPECT_EQ(Chains({a, a, b, b}).rings().size(), 1u);
  EXPECT_TRUE(Chains({a, a, b, b}).fault());
}

// A side of two rings that both draw, in pieces.
TEST(Chains, ASideOfTwoRingsIsNoFault) {
  const NodeLocations left = {{4, 0}, {0, 0}, {0, 4}, {4, 4}}, right = {{4, 0}, {8, 0}, {8, 4}, {4, 4}};
  const NodeLocations side = {{4, 0}, {4, 4}};
  const Chains both({side, left, right, side});
  EXPECT_EQ(both.rings().size(), 2u);
  EXPECT_FALSE(both.fault());
  EXPECT_TRUE(both.loose().empty());
}

/// `pieces`: of outer rings; nodes by their numbers, (x, y) is 10 x + y + 1. Small squares elsewhere are sound.
Extract pieces_extract(const std::vector<std::vector<long>>& pieces) {
  std::string nodes, ways = osm_way(1, testing::osm_ring(1001));
  std::vector<std::string> members = {"way 1 outer"};
  for (long x = 0; x < 10; ++x) {
    for (long y = 0; y < 10; ++y) {
      nodes += osm_node(10 * x + y + 1, 11 + 1e-4 * static_cast<double>(x), 48 + 1e-4 * static_cast<double>(y));
    }
  }
  nodes += testing::osm_square(1001, 11.01, 48, 1e-4);
  for (const std::vector<long>& piece : pieces) {
    const long way = static_cast<long>(members.size()) + 1;
    ways += osm_way(way, piece);
    members.push_back("way " + std::to_string(way) + " outer");
  }
  return testing::extract_of(
      nodes + ways +
      osm_relation(1, members, testing::osm_tag("type", "multipolygon") + testing::osm_tag("building", "yes")));
}

bool holds(const Area& area, double x, double y) {
  return std::any_of(area.polygons.begin(), area.polygons.end(), [&](const Polygon& polygon) {
    bool inside = false;
    for (std::size_t i = 0; i < polygon.outer.size(); ++i) {
      const LonLat a = polygon.outer[i], b = polygon.outer[(i + 1) % polygon.outer.size()];
      const double east = 11 + 1e-4 * x, north = 48 + 1e-4 * y;
      if ((a.latitude_deg > north) == (b.latitude_deg > north)) continue;
      const double part = (north - a.latitude_deg) / (b.latitude_deg - a.latitude_deg);
      if (east < a.longitude_deg + part * (b.longitude_deg - a.longitude_deg)) inside = !inside;
    }
    return inside;
  });
}

// Two squares that overlap, in pieces from one crossing to the other: which of them join is not said.
TEST(OuterPieces, HoldWhatAnyRingOfThemGoesRoundInWhicheverOrder) {
  const std::vector<std::vector<long>> pieces = {{43, 41, 1, 5, 25}, {43, 45, 25}, {43, 23, 25}, {43, 63, 67, 27, 25}};
  std::vector<std::size_t> order = {0, 1, 2, 3};
  do {
    std::vector<std::vector<long>> ordered;
    for (const std::size_t i : order) ordered.push_back(pieces[i]);
    const Extract extract = pieces_extract(ordered);
    ASSERT_EQ(extract.areas.size(), 1u);
    EXPECT_NE(testing::find_problem(extract, testing::relation_id(1)), nullptr);
    for (const auto& [x, y] : {std::pair{1.0, 1.0}, {3.0, 3.5}, {3.5, 2.5}, {5.0, 5.0}}) {
      EXPECT_TRUE(holds(extract.areas[0], x, y)) << x << " " << y << " first " << order[0];
    }
  } while (std::next_permutation(order.begin(), order.end()));
}

TEST(OuterPieces, OfARingThatIsThereTwiceCutElsewhereHoldIt) {
  const Extract extract = pieces_extract({{1, 41}, {45, 41, 1}, {1, 5, 45}, {45, 41}, {1, 5, 45}});
  ASSERT_EQ(extract.areas.size(), 1u);
  EXPECT_TRUE(holds(extract.areas[0], 2, 2));
  const Problem* const problem = testing::find_problem(extract, testing::relation_id(1));
  ASSERT_NE(problem, nullptr);
  testing::expect_wording(problem->what);
}

// The assembler takes sides that are there twice away before it looks for crossings.
TEST(DoubledSides, HideNoCrossing) {
  const auto extract_of_way = [](const std::vector<long>& nodes) {
    return testing::extract_of(osm_node(1, 11, 48) + osm_node(2, 11.0002, 48) + osm_node(3, 11, 48.0001) +
                               osm_node(4, 11.0001, 48.0002) + osm_way(1, nodes, testing::osm_tag("building", "yes")));
  };
  const Extract crossing = extract_of_way({3, 4, 1, 2, 3, 4, 1, 3});
  ASSERT_EQ(crossing.areas.size(), 1u);
  EXPECT_EQ(crossing.areas[0].polygons[0].outer.size(), 7u);
  const Problem* const problem = testing::find_problem(crossing, testing::way_id(1));
  ASSERT_NE(problem, nullptr);
  testing::expect_wording(problem->what);
  EXPECT_EQ(testing::find_problem(extract_of_way({1, 2, 4, 2, 3, 1}), testing::way_id(1)), nullptr) << "a spur";
}

}  // namespace
}  // namespace vantage::internal::osm
