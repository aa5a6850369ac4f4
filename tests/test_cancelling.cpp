// Ctrl-C is heard within 0.2 s: for each reader its worst small file, and what follows from it.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <fstream>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "common/input.h"
#include "core/zone_check.h"
#include "support/internals.h"
#include "support/map_text.h"
#include "support/osm_maps.h"
#include "support/sanitizers.h"
#include "support/temporary_directory.h"
#include "vantage/city.h"
#include "vantage/flight.h"
#include "vantage/mission.h"
#include "vantage/mission_tour.h"
#include "vantage/scene.h"

namespace vantage::testing {
namespace {

using Clock = std::chrono::steady_clock;

/// The longest time (s) that a call works without asking whether to go on: by the clock or by the processors, the
/// shorter one, so that neither other programs nor other threads count. It is stopped after ten seconds.
double longest_deafness_s(const std::function<void(const Progress&)>& call) {
  constexpr double kEnough = 10;
  const auto begin = Clock::now();
  auto last = begin;
  std::clock_t last_work = std::clock();
  double longest = 0;
  const auto seconds = [](Clock::duration duration) { return std::chrono::duration<double>(duration).count(); };
  const auto note = [&] {
    const auto now = Clock::now();
    const std::clock_t work = std::clock();
    longest = std::max(longest, std::min(seconds(now - last), static_cast<double>(work - last_work) / CLOCKS_PER_SEC));
    last = now;
    last_work = work;
  };
  try {
    call([&](std::string_view, double) {
      note();
      return seconds(Clock::now() - begin) < kEnough;
    });
  } catch (const Error& error) {
    EXPECT_NE(error.kind(), ErrorKind::internal) << error.what();  // it may be refused for what is wrong with it
  }
  note();
  return longest;
}

constexpr double kPromised = kHasAddressSanitizer ? 2 : 0.2;  // s; what is sanitized is ten times slower

using Positions = std::vector<Eigen::Vector2d>;  // longitude and latitude

/// Two circles in turn: with an inner share of a half they are long teeth, which lie above each other.
Positions star(int corners, double inner) {
  Positions ring;
  for (int i = 0; i < corners; ++i) {
    const double angle = 2 * std::numbers::pi * i / corners, radius = 0.001 * (i % 2 == 0 ? 1 : inner);
    ring.emplace_back(11 + 1.5 * radius * std::sin(angle), 48 + radius * std::cos(angle));
  }
  return ring;
}

std::string nodes_of(const Positions& ring) {
  std::string text;
  for (std::size_t i = 0; i < ring.size(); ++i) text += osm_node(static_cast<long>(i) + 1, ring[i].x(), ring[i].y());
  return text;
}

std::vector<long> closed_ring(std::size_t corners) {
  std::vector<long> nodes;
  for (std::size_t i = 1; i <= corners; ++i) nodes.push_back(static_cast<long>(i));
  nodes.push_back(1);
  return nodes;
}

osm::Extract heard_while_reading(const std::string& objects) {
  const TemporaryDirectory directory;
  write_bytes(directory / "map.osm", osm_xml(objects));
  osm::Extract extract;
  EXPECT_LT(longest_deafness_s(
                [&](const Progress& progress) { extract = osm::read_extract(directory / "map.osm", {}, progress); }),
            kPromised);
  return extract;
}

TEST(Cancelling, ARelationOfEqualWays) {
  constexpr std::size_t kCorners = 1000;
  const Positions ring = star(kCorners, 0.9);
  const std::string building = osm_tag("type", "multipolygon") + osm_tag("building", "yes");
  for (const int count : {199, 200}) {
    std::string text = nodes_of(ring);
    std::vector<std::string> members;
    for (int way = 1; way <= count; ++way) {
      text += osm_way(way, closed_ring(kCorners));
      members.push_back("way " + std::to_string(way) + " outer");
    }
    text += osm_relation(1, members, building);
    const osm::Extract extract = heard_while_reading(text);
    const osm::Area* const area = find_object(extract.areas, relation_id(1));
    ASSERT_NE(area, nullptr);
    ASSERT_EQ(area->polygons.size(), 1u);
    EXPECT_EQ(area->polygons[0].outer.size(), kCorners);
  }
}

// Few of a large number: the pieces that are left keep what the ways were.
TEST(Cancelling, ARelationOfWaysThatAreEqualInPart) {
  constexpr std::size_t kCorners = 2000;
  const Positions ring = star(kCorners, 0.9);
  std::string text = nodes_of(ring) + osm_way(1, closed_ring(kCorners));
  std::vector<std::string> members = {"way 1 outer"};
  const auto half = [&](std::size_t from) {
    std::vector<long> nodes;
    for (std::size_t i = 0; i <= kCorners / 2; ++i) nodes.push_back(static_cast<long>((from + i) % kCorners) + 1);
    return nodes;
  };
  for (int way = 2; way <= 401; ++way) {  // each half 200 times
    text += osm_way(way, half(way % 2 == 0 ? 0 : kCorners / 2));
    members.push_back("way " + std::to_string(way) + " outer");
  }
  text += osm_relation(1, members, osm_tag("type", "multipolygon") + osm_tag("building", "yes"));
  const osm::Extract extract = extract_of(text);
  const osm::Area* const area = find_object(extract.areas, relation_id(1));
  ASSERT_NE(area, nullptr);
  ASSERT_EQ(area->polygons.size(), 1u);
  EXPECT_EQ(area->polygons[0].outer.size(), kCorners);
}

// One line is open, so that they are taken as drawn: each of the rings holds most of the others.
TEST(Cancelling, ARelationOfNestedRings) {
  constexpr int kRings = 3000;
  std::string nodes, ways;
  std::vector<std::string> members;
  for (int i = 0; i < 2 * kRings; ++i) {
    const double size = 1e-6 * (i + 2);
    nodes += osm_square(4 * i + 1, 11 - size, 48 - size, 2 * size);
    ways += osm_way(i + 1, osm_ring(4 * i + 1));
    members.push_back("way " + std::to_string(i + 1) + (i % 2 == 0 ? " inner" : " outer"));
  }
  ways += osm_way(2 * kRings + 1, {1, 5});
  members.push_back("way " + std::to_string(2 * kRings + 1) + " outer");
  const std::string building = osm_tag("type", "multipolygon") + osm_tag("building", "yes");
  const osm::Extract extract = heard_while_reading(nodes + ways + osm_relation(1, members, building));
  const osm::Area* const area = find_object(extract.areas, relation_id(1));
  ASSERT_NE(area, nullptr);
  EXPECT_GT(area->polygons.size(), static_cast<std::size_t>(kRings));
}

TEST(Cancelling, BuildingsOfManyCorners) {
  struct Case {
    int corners;
    double inner;
    const char* roof;
  };
  for (const Case& one : {Case{8000, 0.999, "onion"}, Case{8000, 0.999, "dome"}, Case{6000, 0.5, "onion"},
                          Case{6000, 0.5, "flat"}, Case{8000, 1, "flat"}, Case{3000, 0.5, "gabled"}}) {
    SCOPED_TRACE(std::string(one.roof) + " " + std::to_string(one.corners));
    const TemporaryDirectory directory;
    write_bytes(directory / "map.osm",
                osm_xml(nodes_of(star(one.corners, one.inner)) +
                        osm_way(1, closed_ring(static_cast<std::size_t>(one.corners)),
                                osm_tag("building", "yes") + osm_tag("height", "30") + osm_tag("roof:height", "10") +
                                    osm_tag("roof:shape", one.roof))));
    EXPECT_LT(longest_deafness_s(
                  [&](const Progress& progress) { build_city(directory / "map.osm", CityOptions(), progress); }),
              kPromised);
  }
}

double deafness_of_city_s(const std::string& objects) {
  const TemporaryDirectory directory;
  write_bytes(directory / "map.osm", osm_xml(objects));
  return longest_deafness_s(
      [&](const Progress& progress) { build_city(directory / "map.osm", CityOptions(), progress); });
}

// Clipper, which joins them, takes seconds and asks nobody.
TEST(Cancelling, ARelationOfSquaresAcrossEachOther) {
  constexpr int kSquares = 2000;
  std::string nodes, ways;
  std::vector<std::string> members;
  for (int i = 0; i < kSquares; ++i) {
    nodes += osm_square(4 * i + 1, 11 + 4e-7 * i, 48 + 4e-7 * (i * 7919 % kSquares), 6e-4);
    ways += osm_way(i + 1, osm_ring(4 * i + 1));
    members.push_back("way " + std::to_string(i + 1) + " outer");
  }
  const std::string building = osm_tag("type", "multipolygon") + osm_tag("building", "yes");
  EXPECT_LT(deafness_of_city_s(nodes + ways + osm_relation(1, members, building)), kPromised);
}

// One hole crosses the outline, so that all are looked at.
TEST(Cancelling, HolesInAnOutlineOfManyCorners) {
  constexpr int kCorners = 10000, kHoles = 1000;
  const Positions ring = star(kCorners, 0.9999);
  std::string nodes = nodes_of(ring), ways = osm_way(1, closed_ring(kCorners));
  std::vector<std::string> members = {"way 1 outer"};
  for (int i = 0; i < kHoles; ++i) {
    const long first = kCorners + 4 * i + 1;
    const double west = i == 0 ? 11.0014 : 11 + 2e-5 * (i % 40 - 20), south = 48 + 2e-5 * (i / 40 - 12);
    nodes += osm_square(first, west, south, i == 0 ? 3e-4 : 1e-5);
    ways += osm_way(i + 2, osm_ring(first));
    members.push_back("way " + std::to_string(i + 2) + " inner");
  }
  const std::string building = osm_tag("type", "multipolygon") + osm_tag("building", "yes");
  EXPECT_LT(deafness_of_city_s(nodes + ways + osm_relation(1, members, building)), kPromised);
}

TEST(Cancelling, TemplatesOfCityJson) {
  constexpr int kTriangles = 20000, kInstances = 400;
  std::string vertices, triangles, objects;
  for (int i = 0; i < 3 * kTriangles; ++i) {
    vertices += (i == 0 ? "[" : ",[") + shortest(0.01 * i) + "," + shortest(std::sin(i)) + ",0]";
  }
  for (int i = 0; i < kTriangles; ++i) {
    triangles += (i == 0 ? "[[" : ",[[") + std::to_string(3 * i) + "," + std::to_string(3 * i + 1) + "," +
                 std::to_string(3 * i + 2) + "]]";
  }
  for (int i = 0; i < kInstances; ++i) {
    objects +=
        (i == 0 ? "\"" : ",\"") + std::to_string(i) +
        "\":{\"type\":\"Building\",\"geometry\":[{\"type\":\"GeometryInstance\",\"template\":0,\"boundaries\":[0],"
        "\"transformationMatrix\":[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1]}]}";
  }
  const TemporaryDirectory directory;
  write_bytes(directory / "a.city.json",
              "{\"type\":\"CityJSON\",\"version\":\"2.0\",\"transform\":{\"scale\":[1,1,1],\"translate\":[0,0,0]},"
              "\"vertices\":[[0,0,0]],\"CityObjects\":{" +
                  objects + "},\"geometry-templates\":{\"vertices-templates\":[" + vertices +
                  "],\"templates\":[{\"type\":\"MultiSurface\",\"lod\":\"2\",\"boundaries\":[" + triangles + "]}]}}");
  EXPECT_LT(longest_deafness_s([&](const Progress& progress) { read_scene(directory / "a.city.json", {}, progress); }),
            kPromised);
}

/// A comb of teeth along x, which all lie above each other.
Positions comb(int corners) {
  Positions ring = {{10.999, 48.001}, {10.999, 47.999}};
  const int teeth = (corners - 2) / 2;
  for (int i = 0; i < teeth; ++i) {
    const double y = 47.999 + 0.002 * i / teeth;
    ring.emplace_back(11.001, y + 1e-9);
    ring.emplace_back(10.9991, y + 0.001 / teeth);
  }
  return ring;
}

TEST(Cancelling, ZonesOfManyCorners) {
  const TemporaryDirectory directory;
  MapText map({11, 48});
  map.box(30, 0, 40, 10, {{"building", "yes"}});
  write_bytes(directory / "city.osm", map.text());
  for (const Positions& ring : {star(19000, 0.5), comb(19000)}) {
    std::string corners;
    for (std::size_t i = 0; i <= ring.size(); ++i) {
      const Eigen::Vector2d& p = ring[i % ring.size()];
      corners += (i == 0 ? "[" : ",[") + shortest(p.x()) + "," + shortest(p.y()) + "]";
    }
    write_bytes(directory / "zone.json", "{\"type\":\"Polygon\",\"coordinates\":[[" + corners + "]]}");
    for (const std::string list : {"keep_in", "keep_out"}) {
      SCOPED_TRACE(list);
      write_bytes(directory / "mission.yaml",
                  "scene: {osm: city.osm, center: [48, 11], radius: 500}\nsensor: {max_range: 40}\n"
                  "target: {center: [48, 11], width: 5, length: 5}\nnavigation: {altitude: [3, 60], " +
                      list + ": [{file: zone.json, heights: any}]}\n");
      EXPECT_LT(longest_deafness_s([&](const Progress& progress) {
                  run_mission(resolve_mission(read_mission(directory / "mission.yaml"), progress), {}, progress);
                }),
                kPromised);
    }
  }
}

TEST(Cancelling, PlansOfManyCircles) {
  FlightPlan plan;
  plan.vehicle = PlanVehicle::multirotor;
  for (int i = 0; i < 13000; ++i) {
    PlanItem& item = plan.items.emplace_back();
    item.kind = PlanItemKind::loiter;
    item.position = {{11 + i % 100 * 1e-4, 48 + i / 100 * 1e-4}, 50, HeightDatum::scene_z};
    item.loiter_radius_m = 40;
    item.turns = 1;
  }
  LocateOptions options;
  options.georeference.emplace();
  options.georeference->latitude_deg = 48;
  options.georeference->longitude_deg = 11;
  EXPECT_LT(longest_deafness_s([&](const Progress& progress) {
              options.progress = progress;
              locate_flight(plan, options);
            }),
            kPromised);
}

TEST(Cancelling, ToursOfManyPoints) {
  const TemporaryDirectory directory;
  write_bytes(directory / "ground.obj", "v -100 -100 0\nv 100 -100 0\nv 100 100 0\nv -100 100 0\nf 1 2 3 4\n");
  std::string targets;
  for (int i = 0; i < 1500; ++i) {
    targets += "  - {name: p" + std::to_string(i) + ", point: [" + std::to_string(i % 40 * 5 - 100) + ", " +
               std::to_string(i / 40 * 5 - 95) + ", 50]}\n";
  }
  write_bytes(directory / "mission.yaml", "scene: {mesh: ground.obj}\ncombine: each\ntargets:\n" + targets +
                                              "sensor: {max_range: 20}\nnavigation: {altitude: [3, 80]}\ntour: {}\n");
  const Mission mission = resolve_mission(read_mission(directory / "mission.yaml"));
  EXPECT_LT(longest_deafness_s([&](const Progress& progress) { plan_mission_tour(mission, {}, progress); }), kPromised);
}

}  // namespace
}  // namespace vantage::testing
