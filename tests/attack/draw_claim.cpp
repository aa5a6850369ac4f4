// Scenes, targets and limits for meshes to be claimed for. Small ones: a mesh is to cost milliseconds.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "limit_attack.h"
#include "mesh_case.h"

namespace attack {
namespace {

using vantage::Box;
using vantage::Mesh;

void add_object(vantage::Scene& scene, const char* name, const std::vector<Vec3>& vertices,
                const std::vector<vantage::Triangle>& triangles) {
  const auto first = static_cast<std::uint32_t>(scene.mesh.vertices.size());
  const auto object = static_cast<std::uint32_t>(scene.objects.size());
  scene.objects.emplace_back().name = name;
  scene.mesh.vertices.insert(scene.mesh.vertices.end(), vertices.begin(), vertices.end());
  for (const auto& [a, b, c] : triangles) {
    scene.mesh.triangles.push_back({a + first, b + first, c + first});
    scene.object_of.push_back(object);
  }
}

void add_ground(Random& random, MeshCase& c) {
  const bool is_flat = random.chance(0.5);
  const int cells = is_flat ? 1 : random.integer(2, 3);
  const double half = random.pick({60.0, 60.0, 18.0});  // it may end within the range
  std::vector<Vec3> vertices;
  std::vector<vantage::Triangle> triangles;
  for (int i = 0; i <= cells; ++i) {
    for (int j = 0; j <= cells; ++j) {
      vertices.emplace_back(half * (2.0 * i / cells - 1), half * (2.0 * j / cells - 1),
                            is_flat ? 0 : random.uniform(-6, 0));
    }
  }
  for (int i = 0; i < cells; ++i) {
    for (int j = 0; j < cells; ++j) {
      const auto a = static_cast<std::uint32_t>(i * (cells + 1) + j), b = a + static_cast<std::uint32_t>(cells) + 1;
      triangles.push_back({a, b, b + 1});
      triangles.push_back({a, b + 1, a + 1});
    }
  }
  c.ground = static_cast<std::uint32_t>(c.scene.objects.size());
  add_object(c.scene, "ground", vertices, triangles);
}

void add_obstacles(Random& random, MeshCase& c) {
  for (int count = random.integer(0, 3); count > 0; --count) {
    const double away = random.uniform(5, 30), turn = random.uniform(0, 2 * std::numbers::pi);
    const Vec3 at(away * std::cos(turn), away * std::sin(turn), random.chance(0.7) ? 0 : random.uniform(0, 15));
    if (random.chance(0.5)) {
      const Mesh house = block(at, at + random.point(1, 9));
      add_object(c.scene, "house", house.vertices, house.triangles);
    } else {
      add_object(c.scene, "plate", {at, at + random.point(-8, 8), at + random.point(-8, 8)}, {{0, 1, 2}});
    }
  }
  if (c.scene.objects.empty()) add_object(c.scene, "far", {{55, 55, 0}, {56, 55, 0}, {55, 55, 2}}, {{0, 1, 2}});
}

/// Convex, round the origin of a plane.
std::vector<Vec3> polygon_in(Random& random, const Vec3& middle, const Vec3& normal) {
  const Vec3 along =
      (std::abs(normal.z()) < 0.9 ? Vec3::UnitZ().cross(normal) : Vec3::UnitX().cross(normal)).normalized();
  const Vec3 up = normal.cross(along);
  const int count = random.pick({3, 4, 4, 5});
  const double size = random.magnitude(0.3, 4), begin = random.uniform(0, 2 * std::numbers::pi),
               flat = random.uniform(0.4, 1);
  std::vector<Vec3> corners;
  for (int i = 0; i < count; ++i) {
    const double turn = begin + 2 * std::numbers::pi * (i + random.uniform(-0.2, 0.2)) / count;
    corners.push_back(middle + size * (std::cos(turn) * along + flat * std::sin(turn) * up));
  }
  return corners;
}

void draw_claimed_target(Random& random, MeshCase& c) {
  const double turn = random.uniform(0, 2 * std::numbers::pi);
  const Vec3 sideways(std::cos(turn), std::sin(turn), 0), middle(0, 0, random.pick({4.5, 6.0, 9.0}));
  c.target.name = "target";
  switch (random.integer(0, 7)) {
    case 0:
    case 1:
      c.kind = "roof";
      c.target.parts = {polygon_in(random, {0, 0, random.pick({0.3, 5.0})}, Vec3::UnitZ())};
      break;
    case 2:
      c.kind = "facade";
      c.target.parts = {polygon_in(random, middle, sideways)};
      c.target.front = sideways;
      break;
    case 3:
      c.kind = "tilted";
      c.target.front = (sideways + random.uniform(-0.5, 2) * Vec3::UnitZ()).normalized();
      c.target.parts = {polygon_in(random, middle, *c.target.front)};
      break;
    case 4:
      c.kind = "point";
      c.target.parts = {{middle}};
      break;
    case 5:
      c.kind = "point with a front";
      c.target.parts = {{middle}};
      c.target.front = (sideways + random.uniform(0, 2) * Vec3::UnitZ()).normalized();
      break;
    case 6: {
      c.kind = "two parts";
      const Vec3 beside = sideways.cross(Vec3::UnitZ()) * random.uniform(5, 8);
      Vec3 other = sideways;
      if (random.chance(0.5)) other = (sideways + random.uniform(0.1, 1) * random.direction()).normalized();
      c.target.parts = {polygon_in(random, middle, sideways), polygon_in(random, middle + beside, other)};
      c.target.front_by_order = true;
      break;
    }
    default:
      c.kind = "both sides";
      c.target.parts = {polygon_in(random, middle, sideways)};
      c.target.front = sideways;
      c.both_sides = true;
  }
}

Vec3 normal_of(const MeshCase& c) { return vantage::make_target_frame(c.target).normal; }

void draw_limit(Random& random, MeshCase& c) {
  std::vector<ClaimWay> ways;
  every_limit([&](auto limit) {
    for (const ClaimWay& way : facts_of<limit>().ways) ways.push_back(way);
  });
  std::sort(ways.begin(), ways.end(), [](const ClaimWay& a, const ClaimWay& b) { return a.number < b.number; });
  const ClaimWay& one = ways[static_cast<std::size_t>(random.integer(0, static_cast<int>(ways.size()) - 1))];
  c.kind += std::string(" | ") + one.name;
  one.draw(random, c);
}

// ---- where it stands, and how large it is ----

void move(MeshCase& c, const Placement& pose) {
  c.unit = pose.unit;
  pose.move(c.scene.mesh);
  for (std::vector<Vec3>& part : c.target.parts) {
    for (Vec3& v : part) pose.move(v);
  }
  c.sensor.max_range_m *= pose.unit;
  auto& pixel = c.sensor.pixel;
  if (pixel && pixel->kind == vantage::PixelLimit::Kind::perpendicular) pixel->size_m *= pose.unit;  // a range, too
  every_limit([&](auto limit) {
    const auto* value = given<limit>(c.navigation, c.sensor);
    if (value != nullptr) move<limit>(const_cast<LimitValueOf<limit>&>(*value), pose);  // it is of `c`
  });
}

}  // namespace

Vec3 middle_of(const MeshCase& c) { return vantage::make_target_frame(c.target).origin; }

Mesh block(const Vec3& low, const Vec3& high) {
  Mesh mesh;
  for (int i = 0; i < 8; ++i) {
    mesh.vertices.emplace_back(i & 1 ? high.x() : low.x(), i & 2 ? high.y() : low.y(), i & 4 ? high.z() : low.z());
  }
  constexpr std::uint32_t kSides[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                          {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  for (const auto& [a, b, c, d] : kSides) {
    mesh.triangles.push_back({a, b, c});
    mesh.triangles.push_back({a, c, d});
  }
  return mesh;
}

Box box_about(Random& random, const Vec3& middle, double least, double most) {
  const Vec3 half = random.point(least, most);
  Box box;
  box.extend(Vec3(middle - half));
  box.extend(Vec3(middle + half));
  return box;
}

Vec3 draw_place(const MeshCase& c, Random& random) {
  Vec3 direction = random.direction();
  const Vec3 normal = normal_of(c);
  const bool sees_back = c.both_sides || (c.target.is_point() && !c.target.front);
  if (direction.dot(normal) < 0 && !sees_back) direction = -direction;
  if (direction.z() < 0 && std::abs(normal.z()) < 0.5 && random.chance(0.7)) direction.z() *= -1;
  const double range = std::isfinite(c.sensor.max_range_m) ? c.sensor.max_range_m : kClaimRange * c.unit;
  const double away = random.chance(0.6) ? random.uniform(0.05, 1.02) : random.magnitude(0.01, 1);
  return middle_of(c) + away * range * direction;
}

/// A plate low over the target, which is said to have been raised above it. Before all is moved.
void draw_cover(Random& random, MeshCase& c) {
  c.kind += ", cover";
  const vantage::TargetFrame frame = vantage::make_target_frame(c.target);
  const double height = random.magnitude(1e-4, 2e-2), size = random.uniform(0.5, 5);
  const auto at = [&](double u, double v) { return frame.to_scene({u * size, v * size, height}); };
  add_object(c.scene, "cover", {at(-1, -1), at(1, -1), at(1, 1), at(-1, 1)}, {{0, 1, 2}, {0, 2, 3}});
  c.lift_m = std::min(height + random.magnitude(1e-6, 1e-3), vantage::ProveOptions::kMostLift);
}

MeshCase draw_claim(Random& random) {
  MeshCase c;
  c.sensor.max_range_m = kClaimRange;
  if (random.chance(0.6)) add_ground(random, c);
  add_obstacles(random, c);
  draw_claimed_target(random, c);
  const double unit = random.chance(0.7) ? 1 : random.pick({1e-3, 0.1, 30.0});
  if (unit == 1 && random.chance(0.05)) draw_cover(random, c);
  if (random.chance(0.93)) draw_limit(random, c);
  if (random.chance(0.15)) draw_limit(random, c);
  Vec3 shift = Vec3::Zero();
  if (random.chance(0.15)) shift = Vec3(random.pick({5e5, -3e6}), random.pick({5.4e6, 4.7e6}), 100);
  move(c, {unit, shift});
  if (random.chance(0.15)) c.shrink = random.pick({0.0, 1e-9, 1e-4});
  if (random.chance(0.05)) c.rounding_m = kClaimRange * unit * random.magnitude(1e-8, 1e-3);
  return c;
}

}  // namespace attack
