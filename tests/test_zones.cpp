// Zones: polygons with heights, to stay in and to stay out of. The cut, the answers for points and the check.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <string>
#include <vector>

#include "core/triangle_tree.h"
#include "core/zone_check.h"
#include "support/internals.h"
#include "support/objects.h"
#include "support/random.h"
#include "support/solids.h"
#include "support/wording.h"
#include "support/zones.h"
#include "vantage/query.h"
#include "vantage/verify.h"
#include "vantage/volume.h"

namespace vantage {
namespace {

using testing::expect_error;
using testing::first_open_edge;
using testing::make_hemisphere;
using testing::Random;
using testing::zone_of;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
const Vec3 kUtm(580000.1, 4785000.2, 1000.3);

Zone::Ring shifted(Zone::Ring ring, const Vec3& shift) {
  for (Eigen::Vector2d& p : ring) p += shift.head<2>();
  return ring;
}

/// An L of 300 m2 between its corners [0, 0] and [20, 20].
Zone::Ring l_shape(const Vec3& shift) {
  return shifted({{0, 0}, {20, 0}, {20, 10}, {10, 10}, {10, 20}, {0, 20}}, shift);
}

std::map<std::string, double> areas_of(const Volume& volume) {
  std::map<std::string, double> areas;
  for (const Cause& cause : volume.causes) areas[cause.name] = cause.area_m2;
  return areas;
}

void expect_closed(const Volume& volume) {
  EXPECT_EQ(volume.outcome, Outcome::computed) << volume.reason;
  EXPECT_EQ(first_open_edge(volume.mesh), "");
}

TEST(Zones, CutToAPolygonThatIsNotConvex) {
  for (const Vec3& shift : {Vec3(0, 0, 0), kUtm}) {
    for (const bool is_turned : {false, true}) {
      Navigation navigation;
      Zone zone = zone_of(l_shape(shift), shift.z() + 5, shift.z() + 15, "park");
      if (is_turned) std::reverse(zone.outer.begin(), zone.outer.end());
      navigation.keep_in = {zone};
      const Volume cut = cut_to_navigation(make_hemisphere(shift, 100, 32, 8), navigation);
      expect_closed(cut);
      const MeshMeasures measures = measure(cut.mesh);
      EXPECT_NEAR(measures.volume_m3, 3000, 1e-5);
      EXPECT_EQ(measures.bounds.min, Vec3(shift + Vec3(0, 0, 5)));
      EXPECT_EQ(measures.bounds.max, Vec3(shift + Vec3(20, 20, 15)));
      EXPECT_NEAR(areas_of(cut).at("zone park"), 600 + 80 * 10, 1e-6);
      EXPECT_EQ(measures.euler, 2);
    }
  }
}

TEST(Zones, HolesAreNotOfTheZone) {
  Navigation navigation;
  Zone zone = zone_of({{-20, -20}, {20, -20}, {20, 20}, {-20, 20}}, 5, 15);
  zone.holes = {{{-10, -10}, {-5, -10}, {-5, -5}, {-10, -5}}, {{5, 5}, {5, 15}, {15, 5}}};
  navigation.keep_in = {zone};
  const Volume dome = make_hemisphere(Vec3::Zero(), 100, 32, 8);
  const Volume kept = cut_to_navigation(dome, navigation);
  expect_closed(kept);
  EXPECT_NEAR(measure(kept.mesh).volume_m3, (1600 - 25 - 50) * 10, 1e-6);
  EXPECT_EQ(measure(kept.mesh).euler, -2);  // two holes through it

  navigation = {};
  navigation.keep_out = {zone};
  const Volume rest = cut_to_navigation(dome, navigation);
  expect_closed(rest);
  EXPECT_NEAR(measure(rest.mesh).volume_m3, measure(dome.mesh).volume_m3 - (1600 - 25 - 50) * 10, 1e-6);
  const std::string cause = "keep_out zone z";
  EXPECT_GT(areas_of(rest).at(cause), 3000);
}

TEST(Zones, BoxesAndZonesToStayInAreOneUnion) {
  Navigation navigation;
  navigation.keep_in = {Box{Vec3(-10, -10, 5), Vec3(0, 0, 15)}, zone_of({{-5, -5}, {5, -5}, {5, 5}, {-5, 5}}, 5, 15)};
  const Volume cut = cut_to_navigation(make_hemisphere(Vec3::Zero(), 100, 32, 8), navigation);
  expect_closed(cut);
  EXPECT_NEAR(measure(cut.mesh).volume_m3, (100 + 100 - 25) * 10, 1e-6);
}

TEST(Zones, WithoutBoundsTheyReachAsFarAsTheVolume) {
  const Volume dome = make_hemisphere(Vec3::Zero(), 100, 32, 8);
  Navigation navigation;
  navigation.keep_out = {zone_of({{0, -200}, {200, -200}, {200, 200}, {0, 200}}, -kInfinity, kInfinity)};
  const Volume half = cut_to_navigation(dome, navigation);
  expect_closed(half);
  EXPECT_NEAR(measure(half.mesh).volume_m3, measure(dome.mesh).volume_m3 / 2, 1e-6);
  EXPECT_EQ(measure(half.mesh).bounds.max.x(), 0);
}

/// On which side of the line from a to b, in metres; negative: right.
double left_of(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Vec3& p) {
  const Eigen::Matrix<long double, 2, 1> along = b.cast<long double>() - a.cast<long double>();
  const Eigen::Vector2d from = p.head<2>() - (a.norm() < b.norm() ? a : b);
  return static_cast<double>((along.x() * from.y() - along.y() * from.x()) / along.norm());
}

// A side that ends so far away would move by the rounding of that corner, 1e-7 m.
TEST(Zones, FarCornersMoveNoSide) {
  const Volume dome = make_hemisphere(Vec3::Zero(), 30, 16, 8);
  for (const double far : {1e3, 1e6, 1e7, 1e8, 1e9}) {
    SCOPED_TRACE(far);
    const Zone::Ring ring = {{-7, -7}, {far, -0.37 * far}, {far, far}, {-0.83 * far, far}};
    Navigation navigation;
    navigation.keep_in = {zone_of(ring, -kInfinity, kInfinity)};
    const Volume within = cut_to_navigation(dome, navigation);
    expect_closed(within);
    for (const Vec3& v : within.mesh.vertices) {
      EXPECT_GT(left_of(ring[0], ring[1], v), -1e-12) << v.transpose();
      EXPECT_GT(left_of(ring[3], ring[0], v), -1e-12) << v.transpose();
    }
    navigation.keep_out = navigation.keep_in;
    navigation.keep_in.clear();
    const Volume beside = cut_to_navigation(dome, navigation);
    expect_closed(beside);
    for (const Vec3& v : beside.mesh.vertices) {
      EXPECT_LT(std::min(left_of(ring[0], ring[1], v), left_of(ring[3], ring[0], v)), 1e-12) << v.transpose();
    }
  }
}

// With a first corner so far away, at the end of a thin spike, the sign of the area about it would be that of rounding.
TEST(Zones, AFarFirstCornerTurnsNoZoneRound) {
  const Volume dome = make_hemisphere(Vec3::Zero(), 10, 16, 8);
  Random random(17);
  for (int round = 0; round < 60; ++round) {
    const double far = (round % 3 == 0 ? 1e7 : 9e8) * random.uniform(0.6, 1), towards = random.uniform(-3, 3);
    const auto at = [](double angle, double length) {
      return Eigen::Vector2d(length * std::cos(angle), length * std::sin(angle));
    };
    constexpr int kCorners = 300;
    Zone::Ring ring = {at(towards, far), at(towards + 4e-9, 5)};
    for (int i = 1; i < kCorners; ++i) {
      ring.push_back(at(towards + 2 * std::numbers::pi * i / kCorners, random.uniform(4, 5)));
    }
    ring.push_back(at(towards - 4e-9, 5));
    if (round % 2 == 1) std::reverse(ring.begin() + 1, ring.end());
    Navigation navigation;
    navigation.keep_out = {zone_of(ring, -kInfinity, kInfinity)};
    const Volume beside = cut_to_navigation(dome, navigation);
    expect_closed(beside);
    EXPECT_FALSE(testing::holds(beside.mesh, {0.1, 0.2, 1})) << "round " << round << ", far " << far;
  }
}

// Corners far away: what lies about the volume is cut out of the zone first, without new sides in it.
TEST(Zones, MayReachFarBeyondTheVolume) {
  const Volume dome = make_hemisphere(Vec3::Zero(), 100, 32, 8);
  const double whole = measure(dome.mesh).volume_m3;
  Navigation navigation;
  navigation.keep_in = {zone_of({{-3e5, -2e5}, {4e5, -1e5}, {0, 5e5}}, 0, 1e4)};
  EXPECT_NEAR(measure(cut_to_navigation(dome, navigation).mesh).volume_m3, whole, 1e-6);

  // A comb whose teeth pass beside the volume, and one through it.
  Zone comb =
      zone_of({{-3e5, -1e5}, {3e5, -1e5}, {3e5, 1e5}, {10, 1e5}, {10, -9e4}, {-10, -9e4}, {-10, 1e5}, {-3e5, 1e5}},
              -kInfinity, kInfinity);
  comb.holes = {{{20, -9e4}, {30, -9e4}, {30, 9e4}, {20, 9e4}}};
  navigation.keep_in = {comb};
  const Volume beside = cut_to_navigation(dome, navigation);
  expect_closed(beside);
  navigation.keep_in.clear();
  navigation.keep_out = {comb};
  const Volume within = cut_to_navigation(dome, navigation);
  expect_closed(within);
  EXPECT_NEAR(measure(beside.mesh).volume_m3 + measure(within.mesh).volume_m3, whole, 1e-6);
  EXPECT_EQ(measure(within.mesh).bounds.min.x(), -10);
  EXPECT_EQ(measure(within.mesh).bounds.max.x(), 30);
}

/// Corners round a middle, near and far in turn: simple, and not convex.
Zone drawn_zone(Random& random, const Vec3& middle, double reach) {
  const int count = random.integer(3, 9);
  const double begin = random.uniform(0, 6);
  const Vec3 at = middle + reach * random.point(-0.6, 0.6);
  Zone zone;
  for (int i = 0; i < count; ++i) {
    const double angle = begin + 2 * std::numbers::pi * i / count, far = reach * random.uniform(0.25, 1.2);
    zone.outer.emplace_back(at.x() + far * std::cos(angle), at.y() + far * std::sin(angle));
  }
  if (random.chance(0.5)) {
    Zone::Ring hole;
    for (const Eigen::Vector2d& p : zone.outer) hole.push_back(at.head<2>() + 0.3 * (p - at.head<2>()));
    zone.holes.push_back(hole);
  }
  zone.min_z_m = random.chance(0.3) ? -kInfinity : middle.z() + reach * random.uniform(-0.2, 0.4);
  zone.max_z_m = random.chance(0.3) ? kInfinity : middle.z() + reach * random.uniform(0.5, 1.2);
  zone.name = "drawn";
  return zone;
}

/// By the distances to the sides: nothing where a side is so near that rounding may decide.
std::optional<bool> holds(const Zone& zone, const Vec3& p, double near) {
  if (std::abs(p.z() - zone.min_z_m) < near || std::abs(p.z() - zone.max_z_m) < near) return std::nullopt;
  bool inside = p.z() > zone.min_z_m && p.z() < zone.max_z_m, odd = false;
  std::vector<Zone::Ring> rings = zone.holes;
  rings.push_back(zone.outer);
  for (const Zone::Ring& ring : rings) {
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Eigen::Vector2d a = ring[i] - p.head<2>(), b = ring[(i + 1) % ring.size()] - p.head<2>(), side = b - a;
      const double along = std::clamp(-a.dot(side) / side.squaredNorm(), 0.0, 1.0);
      if ((a + along * side).norm() < near) return std::nullopt;
      if ((a.x() > 0) != (b.x() > 0) && a.y() + side.y() * (-a.x() / side.x()) > 0) odd = !odd;
    }
  }
  return inside && odd;
}

Mesh moved(Mesh mesh, const Vec3& origin) {
  for (Vec3& v : mesh.vertices) v -= origin;
  return mesh;
}

TEST(Zones, CutAnswerAndDefinitionAgreeAtEveryScale) {
  Random random(41);
  for (const double scale : {1e-3, 1.0, 100.0, 1e4}) {
    for (const Vec3& shift : {Vec3(0, 0, 0), kUtm}) {
      const double near = 1e-6 * scale + 1e-15 * kUtm.norm() * (shift == kUtm ? 100 : 0);
      const Volume dome = make_hemisphere(shift, scale, 24, 8);
      const Mesh before = moved(dome.mesh, shift);
      const core::TriangleTree whole(before);
      int inside = 0, outside = 0;
      for (int draw = 0; draw < 12; ++draw) {
        Navigation navigation;
        const bool kept = random.chance(0.7);
        if (kept) navigation.keep_in = {drawn_zone(random, shift, scale), drawn_zone(random, shift, scale)};
        if (!kept || random.chance(0.5)) navigation.keep_out = {drawn_zone(random, shift, 0.7 * scale)};
        const Volume cut = cut_to_navigation(dome, navigation);
        if (cut.outcome == Outcome::computed) expect_closed(cut);
        const Mesh after = moved(cut.mesh, shift);
        const core::TriangleTree rest(after);
        for (int i = 0; i < 150; ++i) {
          const Vec3 p = shift + scale * Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(0.001, 1));
          bool expected = whole.winding_number(p - shift) == 1, in_any = navigation.keep_in.empty(), known = true;
          for (const Zone& zone : navigation.keep_in) {
            const auto held = holds(zone, p, near);
            known = known && held;
            in_any = in_any || held.value_or(false);
          }
          for (const Zone& zone : navigation.keep_out) {
            const auto held = holds(zone, p, near);
            known = known && held;
            expected = expected && !held.value_or(false);
          }
          if (!known) continue;
          expected = expected && in_any;
          EXPECT_EQ(rest.winding_number(p - shift), expected ? 1 : 0) << "scale " << scale << ", draw " << draw;
          ++(expected ? inside : outside);
        }
      }
      EXPECT_GT(inside, 100);
      EXPECT_GT(outside, 100);
    }
  }
}

// Nothing of what is cut lies outside of a zone to stay in, or inside of one to stay out of, but for rounding.
TEST(Zones, NothingIsPushedOutward) {
  Random random(43);
  for (const Vec3& shift : {Vec3(0, 0, 0), kUtm}) {
    const double rounding = 5 * std::numeric_limits<double>::epsilon() * (shift.norm() + 100);
    for (int draw = 0; draw < 20; ++draw) {
      Navigation navigation;
      navigation.keep_in = {drawn_zone(random, shift, 80)};
      navigation.keep_out = {drawn_zone(random, shift, 50)};
      const Volume cut = cut_to_navigation(make_hemisphere(shift, 100, 24, 8), navigation);
      for (const Vec3& v : cut.mesh.vertices) {
        EXPECT_NE(holds(navigation.keep_in[0], v, rounding + 1e-9), std::optional(false));
        EXPECT_NE(holds(navigation.keep_out[0], v, rounding + 1e-9), std::optional(true));
        EXPECT_GE(v.z(), navigation.keep_in[0].min_z_m);
        EXPECT_LE(v.z(), navigation.keep_in[0].max_z_m);
      }
    }
  }
}

TEST(Zones, SaysWhichLeavesNothing) {
  const Volume dome = make_hemisphere(Vec3::Zero(), 100, 24, 8);
  Navigation navigation;
  const auto expect_nothing = [&] {
    const Volume cut = cut_to_navigation(dome, navigation);
    EXPECT_EQ(cut.outcome, Outcome::outside_limits);
    testing::expect_wording({cut.reason, cut.hint});
  };
  navigation.keep_in = {zone_of({{500, 0}, {600, 0}, {600, 50}}, 0, 10, "park")};
  expect_nothing();
  navigation.keep_in.push_back(Box{Vec3(700, 0, 0), Vec3(710, 10, 10)});
  expect_nothing();
  navigation = {};
  navigation.keep_out = {zone_of({{-500, -500}, {500, -500}, {500, 500}, {-500, 500}}, -1, kInfinity, "city")};
  expect_nothing();
}

Scene ground() {
  Scene scene;
  scene.objects = named({"ground", "wall"});
  scene.mesh.vertices = {{-200, -200, 0}, {200, -200, 0}, {200, 200, 0}, {-200, 200, 0},
                         {10, -5, 0},     {10, 5, 0},     {10, 5, 8},    {10, -5, 8}};
  scene.mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {4, 6, 7}};
  scene.object_of = {0, 0, 1, 1};
  return scene;
}

Target square() {
  Target target;
  target.parts[0] = {{-5, -5, 0}, {5, -5, 0}, {5, 5, 0}, {-5, 5, 0}};
  return target;
}

TEST(Zones, PointsOnTheBorderAreAllowed) {
  const PreparedScene scene(ground());
  Navigation navigation;
  Zone kept = zone_of({{-20, -20}, {20, -20}, {20, 20}, {0, 40}, {-20, 20}}, 5, 30, "kept");
  kept.holes = {{{-2, -2}, {2, -2}, {2, 2}, {-2, 2}}};
  navigation.keep_in = {kept};
  navigation.keep_out = {zone_of({{4, 0}, {8, -4}, {8, 4}}, 8, 12, "out")};
  const std::vector<Vec3> points = {
      {0, 0, 10},   {2, 0, 10}, {3, 0, 10},  {20, 20, 10}, {10, 30, 10},    {0, 40, 30},
      {10, 31, 10}, {6, 0, 10}, {4, 0, 10},  {6, 2, 10},   {8, 3, 10},      {6, 0, 12},
      {10, 0, 31},  {10, 0, 4}, {0, 20, 10}, {-20, 20, 5}, {-20.5, 20, 10},
  };
  const std::vector<std::string> expected = {
      "keep_in", "", "",        "",        "", "", "keep_in", "keep_out zone out", "", "",
      "",        "", "keep_in", "keep_in", "", "", "keep_in"};
  const auto answers = query_points(PreparedTarget(scene, square(), {60}), navigation, points);
  for (std::size_t i = 0; i < points.size(); ++i) {
    std::string broken;
    for (const std::string& name : answers[i].outside_of) broken += name;
    EXPECT_EQ(broken, expected[i]) << points[i].transpose();
  }
}

// A rectangle along the axes is a box: the same answers, and the same margins to rounding.
TEST(Zones, RectanglesAnswerAsBoxes) {
  Random random(47);
  const PreparedScene scene(ground());
  const PreparedTarget target(scene, square(), {60});
  const Box in{Vec3(-30, -25, 3), Vec3(20, 35, 40)}, out{Vec3(-10, -15, 8), Vec3(5, 12, 25)};
  const auto rectangle = [](const Box& b) {
    return zone_of({{b.min.x(), b.min.y()}, {b.max.x(), b.min.y()}, {b.max.x(), b.max.y()}, {b.min.x(), b.max.y()}},
                   b.min.z(), b.max.z());
  };
  Navigation boxes, zones;
  boxes.keep_in = {in};
  boxes.keep_out = {out};
  zones.keep_in = {rectangle(in)};
  zones.keep_out = {rectangle(out)};
  std::vector<Vec3> points;
  for (int i = 0; i < 3000; ++i) {
    Vec3 p = random.in_box({Vec3(-40, -40, 0), Vec3(40, 40, 60)});
    if (random.chance(0.2)) p.x() = random.chance(0.5) ? in.max.x() : out.min.x();
    points.push_back(p);
  }
  const auto of_boxes = query_points(target, boxes, points), of_zones = query_points(target, zones, points);
  int inside = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_EQ(of_zones[i].inside, of_boxes[i].inside) << points[i].transpose();
    EXPECT_EQ(of_zones[i].outside_of.size(), of_boxes[i].outside_of.size());
    if (std::isfinite(of_boxes[i].margin_m)) {
      EXPECT_NEAR(of_zones[i].margin_m, of_boxes[i].margin_m, 1e-9);
    } else {
      EXPECT_EQ(of_zones[i].margin_m, of_boxes[i].margin_m);
    }
    inside += of_boxes[i].inside;
  }
  EXPECT_GT(inside, 300);
}

TEST(Zones, AVolumeInZonesPassesTheCheckAndAnUncutOneFails) {
  const Scene town = ground();
  const PreparedScene scene(town);
  Navigation navigation;
  Zone kept = zone_of({{-40, -30}, {30, -40}, {10, 0}, {45, 30}, {-20, 40}}, 2, 50, "kept");
  kept.holes = {{{-10, -10}, {-3, -9}, {-5, 4}}};
  navigation.keep_in = {kept};
  navigation.keep_out = {zone_of({{0, 5}, {20, 12}, {5, 30}}, -kInfinity, 20, "out")};
  const PreparedTarget target(scene, square(), {60});
  const Volume volume = compute_volume(target, navigation), uncut = compute_volume(target);
  const VerifyReport right = verify_volume(town, square(), {60}, navigation, volume.mesh);
  EXPECT_EQ(right.over_claimed, 0u) << right.worst_over_cause << right.worst_over_depth_m;
  EXPECT_EQ(right.under_claimed, 0u) << right.worst_under_point.transpose();
  EXPECT_GT(right.inside, 3000u);
  const VerifyReport wrong = verify_volume(town, square(), {60}, navigation, uncut.mesh);
  EXPECT_GT(wrong.over_claimed, 1000u);
  EXPECT_EQ(wrong.worst_over_cause, "keep_in");
  navigation.keep_in.clear();
  const std::string out = "keep_out zone out";
  EXPECT_EQ(verify_volume(town, square(), {60}, navigation, uncut.mesh).worst_over_cause, out);
  // The hole filled: a quarter of a percent of the volume.
  Navigation filled;
  kept.holes.clear();
  filled.keep_in = {kept};
  navigation = {};
  navigation.keep_in = {kept};
  navigation.keep_in[0].holes = {{{-10, -10}, {-3, -9}, {-5, 4}}};
  EXPECT_GT(verify_volume(town, square(), {60}, navigation, compute_volume(target, filled).mesh).over_claimed, 10u);
}

TEST(Zones, TheCheckRefusesWhatIsNoZone) {
  const Scene town = ground();
  const Mesh volume = make_hemisphere(Vec3::Zero(), 10, 8, 4).mesh;
  Navigation navigation;
  const auto check = [&] { verify_volume(town, square(), {60}, navigation, volume); };
  navigation.keep_in = {zone_of({{0, 0}, {1, 0}, {0, 1}}, 5, 4)};
  expect_error(check, ErrorCode::limits_reversed, "navigation.keep_in[0]");
  navigation.keep_in = {zone_of({{0, 0}, {1, 0}}, 4, 5)};
  expect_error(check, ErrorCode::zone_not_simple, "navigation.keep_in[0]");
}

/// Whether two sides have a point in common; of small whole numbers, so exact.
bool sides_meet(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c,
                const Eigen::Vector2d& d) {
  const auto left = [](const Eigen::Vector2d& p, const Eigen::Vector2d& q, const Eigen::Vector2d& r) {
    const double area = (q.x() - p.x()) * (r.y() - p.y()) - (q.y() - p.y()) * (r.x() - p.x());
    return area > 0 ? 1 : area < 0 ? -1 : 0;
  };
  const auto is_between = [&](const Eigen::Vector2d& p, const Eigen::Vector2d& q, const Eigen::Vector2d& r) {
    return left(p, q, r) == 0 && (r - p).dot(r - q) <= 0;
  };
  if (is_between(a, b, c) || is_between(a, b, d) || is_between(c, d, a) || is_between(c, d, b)) return true;
  return left(a, b, c) * left(a, b, d) < 0 && left(c, d, a) * left(c, d, b) < 0;
}

/// By its definition: each pair of sides, and each hole's first corner.
bool is_simple_by_pairs(const Zone& zone) {
  struct Side {
    Eigen::Vector2d from, to;
  };
  std::vector<Zone::Ring> rings = zone.holes;
  rings.insert(rings.begin(), zone.outer);
  std::vector<std::vector<Side>> sides;
  for (const Zone::Ring& ring : rings) {
    sides.emplace_back();
    for (std::size_t i = 0; i < ring.size(); ++i) {
      if (ring[i] == ring[(i + 1) % ring.size()]) return false;
      sides.back().push_back({ring[i], ring[(i + 1) % ring.size()]});
    }
  }
  for (std::size_t r = 0; r < sides.size(); ++r) {
    for (std::size_t s = r; s < sides.size(); ++s) {
      for (std::size_t i = 0; i < sides[r].size(); ++i) {
        for (std::size_t k = r == s ? i + 1 : 0; k < sides[s].size(); ++k) {
          const Side &a = sides[r][i], &b = sides[s][k];
          const bool a_first = r == s && k == i + 1, b_first = r == s && (k + 1) % sides[s].size() == i;
          if (!a_first && !b_first && sides_meet(a.from, a.to, b.from, b.to)) return false;
          const Side &one = a_first ? a : b, &next = a_first ? b : a;
          const Eigen::Vector2d u = one.to - one.from, v = next.to - next.from;
          if ((a_first || b_first) && u.x() * v.y() == u.y() * v.x() && u.dot(v) < 0) return false;
        }
      }
    }
  }
  const auto holds = [](const Zone::Ring& ring, const Eigen::Vector2d& p) {
    bool is_in = false;
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Eigen::Vector2d &a = ring[i], &b = ring[(i + 1) % ring.size()];
      if ((a.y() > p.y()) == (b.y() > p.y())) continue;
      if (p.x() < a.x() + (p.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x())) is_in = !is_in;
    }
    return is_in;
  };
  for (std::size_t i = 0; i < zone.holes.size(); ++i) {
    if (!holds(zone.outer, zone.holes[i][0])) return false;
    for (std::size_t k = 0; k < zone.holes.size(); ++k) {
      if (k != i && holds(zone.holes[k], zone.holes[i][0])) return false;
    }
  }
  return true;
}

TEST(Zones, AreSimpleWhereNoPairOfSidesMeets) {
  Random random(20261130);
  std::size_t simple = 0;
  for (int draw = 0; draw < 30000; ++draw) {
    const int room = random.integer(3, 14);
    const auto ring = [&](int corners) {
      Zone::Ring result;
      for (int i = 0; i < corners; ++i) result.emplace_back(random.integer(0, room), random.integer(0, room));
      return result;
    };
    const auto box = [&](int least, int most, int size) {
      const double x = random.integer(least, most), y = random.integer(least, most);
      const double w = random.integer(1, size), h = random.integer(1, size);
      Zone::Ring result = {{x, y}, {x + w, y}, {x + w, y + h}, {x, y + h}};
      if (random.chance(0.5)) std::reverse(result.begin(), result.end());
      return result;
    };
    Zone zone;
    zone.min_z_m = 0;
    zone.max_z_m = 1;
    const bool is_box = random.chance(0.6);
    zone.outer = is_box ? Zone::Ring{{-1, -1}, {15, -1}, {15, 15}, {-1, 15}} : ring(random.integer(3, 7));
    for (int i = random.integer(0, 3); i > 0; --i) {
      zone.holes.push_back(random.chance(0.6) ? box(-2, 14, 5) : ring(random.integer(3, 4)));
    }
    const bool expected = is_simple_by_pairs(zone);
    simple += expected;
    ASSERT_EQ(!core::fault_of(zone).has_value(), expected) << "draw " << draw;
  }
  EXPECT_GT(simple, 3000u);
  EXPECT_LT(simple, 27000u);
}

TEST(Zones, RefusesWhatIsNoPolygon) {
  const Volume dome = make_hemisphere(Vec3::Zero(), 10, 8, 4);
  const auto refuse = [&](const Zone::Ring& outer, const std::vector<Zone::Ring>& holes, ErrorCode code) {
    Navigation navigation;
    navigation.keep_out = {zone_of(outer, 0, 5)};
    navigation.keep_out[0].holes = holes;
    expect_error([&] { cut_to_navigation(dome, navigation); }, code, "navigation.keep_out[0]");
  };
  const Zone::Ring sound = {{0, 0}, {10, 0}, {10, 10}, {0, 10}};
  refuse({{0, 0}, {10, 10}, {10, 0}, {0, 10}}, {}, ErrorCode::zone_not_simple);                  // a bow tie
  refuse({{0, 0}, {5, 5}, {10, 10}, {10, 0}, {5, 5}, {0, 10}}, {}, ErrorCode::zone_not_simple);  // crossed in a corner
  refuse({{0, 0}, {10, 0}, {10, 10}, {5, 0}}, {}, ErrorCode::zone_not_simple);                   // touches a side
  refuse({{0, 0}, {10, 0}, {5, 0}}, {}, ErrorCode::zone_not_simple);                             // no area
  refuse({{0, 0}, {10, 0}, {10, 10}, {10, 12}, {10, 10}, {0, 10}}, {}, ErrorCode::zone_not_simple);  // a spike
  refuse({{0, 0}, {10, 0}}, {}, ErrorCode::zone_not_simple);
  refuse({{0, 0}, {10, 0}, {10, 0}, {0, 10}}, {}, ErrorCode::zone_not_simple);  // a corner twice
  refuse({{0, 0}, {10, 0}, {0, NAN}}, {}, ErrorCode::coordinate_not_finite);
  refuse({{0, 0}, {10, 0}, {0, 1e155}}, {}, ErrorCode::coordinate_too_large);
  refuse({{0, 0}, {10, 0}, {0, 2e9}}, {}, ErrorCode::coordinate_too_large);
  refuse(sound, {{{5, 5}, {15, 5}, {5, 6}}}, ErrorCode::zone_not_simple);                           // crosses
  refuse(sound, {{{20, 5}, {25, 5}, {20, 6}}}, ErrorCode::zone_not_simple);                         // outside
  refuse(sound, {{{1, 1}, {9, 1}, {9, 9}}, {{7, 2}, {8, 2}, {8, 3}}}, ErrorCode::zone_not_simple);  // in a hole
  refuse(sound, {{{0, 5}, {5, 4}, {5, 6}}}, ErrorCode::zone_not_simple);                            // touches
  Zone::Ring many;
  for (std::size_t i = 0; i <= Zone::kMostCorners; ++i) {
    const double angle = 2 * std::numbers::pi * static_cast<double>(i) / (Zone::kMostCorners + 1.0);
    many.emplace_back(std::cos(angle), std::sin(angle));
  }
  refuse(many, {}, ErrorCode::value_out_of_range);
}

TEST(Zones, RefusesHeightsThatHoldNothing) {
  const Volume dome = make_hemisphere(Vec3::Zero(), 10, 8, 4);
  const auto refuse = [&](double low, double high, ErrorCode code) {
    Navigation navigation;
    navigation.keep_in = {zone_of({{0, 0}, {10, 0}, {10, 10}}, low, high)};
    expect_error([&] { cut_to_navigation(dome, navigation); }, code, "navigation.keep_in[0]");
  };
  refuse(5, 4, ErrorCode::limits_reversed);
  refuse(5, 5, ErrorCode::limits_empty);
  refuse(NAN, 5, ErrorCode::value_out_of_range);
}

}  // namespace
}  // namespace vantage
