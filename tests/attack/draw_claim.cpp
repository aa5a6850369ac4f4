// Scenes, targets and limits for meshes to be claimed for. Small ones: a mesh is to cost milliseconds.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

#include "mesh_case.h"
#include "vantage/camera.h"

namespace attack {
namespace {

using vantage::Box;
using vantage::Mesh;
using vantage::Navigation;
using vantage::Zone;

constexpr double kRange = 40, kDegree = std::numbers::pi / 180;

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

Vec3 middle_of(const MeshCase& c) { return vantage::make_target_frame(c.target).origin; }

Vec3 normal_of(const MeshCase& c) { return vantage::make_target_frame(c.target).normal; }

Box box_about(Random& random, const Vec3& middle, double least, double most) {
  const Vec3 half = random.point(least, most);
  Box box;
  box.extend(Vec3(middle - half));
  box.extend(Vec3(middle + half));
  return box;
}

Zone::Ring ring_about(Random& random, const Vec3& middle, double size, double least) {
  Zone::Ring ring;
  const int count = random.integer(3, 6);
  const double begin = random.uniform(0, 2 * std::numbers::pi);
  for (int i = 0; i < count; ++i) {
    const double turn = begin + 2 * std::numbers::pi * i / count, radius = size * random.uniform(least, 1);
    ring.emplace_back(middle.x() + radius * std::cos(turn), middle.y() + radius * std::sin(turn));
  }
  return ring;
}

Zone zone_about(Random& random, const MeshCase& c, const Vec3& middle, double size) {
  Zone zone;
  zone.name = "drawn";
  zone.outer = ring_about(random, middle, size, random.pick({0.5, 0.5, 0.02}));  // or with narrow places
  if (random.chance(0.25)) zone.holes.push_back(ring_about(random, middle, 0.2 * size, 0.5));
  if (random.chance(0.7)) {
    zone.min_z_m = middle.z() - random.uniform(0.2, 1) * size;
    zone.max_z_m = middle.z() + random.uniform(0.2, 1) * size;
  }
  if (random.chance(0.25)) {
    zone.above_ground = vantage::AboveGround{random.uniform(-2, 6), random.uniform(10, 40), vantage::Ground{}};
    if (c.ground) zone.above_ground->ground = vantage::ground_of(c.scene, *c.ground);
  }
  return zone;
}

void draw_camera(Random& random, MeshCase& c) {
  c.fov_deg = {random.uniform(15, 90), random.uniform(12, 70)};
  c.sensor.camera = vantage::pinhole_of_fov(c.fov_deg[0], c.fov_deg[1], 400, 300);
  vantage::Mount& mount = c.sensor.mount;
  const Vec3 way = middle_of(c) - draw_place(c, random);  // somebody can look from there
  const double yaw = std::atan2(way.x(), way.y()) / kDegree,
               pitch = std::atan2(way.z(), way.head<2>().norm()) / kDegree;
  if (random.chance(0.35)) {
    mount.yaw_deg = yaw + random.uniform(-5, 5);
    mount.min_pitch_deg = mount.max_pitch_deg = std::clamp(pitch + random.uniform(-5, 5), -90.0, 90.0);
  } else if (random.chance(0.5)) {
    if (random.chance(0.3)) mount.yaw_deg = yaw;
    mount.min_pitch_deg = std::clamp(pitch - random.uniform(0, 50), -90.0, 89.0);
    mount.max_pitch_deg = std::clamp(pitch + random.uniform(0, 50), mount.min_pitch_deg, 90.0);
  }
  if (random.chance(0.3)) mount.roll_deg = random.uniform(-180, 180);
}

/// What is not convex: a block without one of its corners.
Mesh bent_block(const Vec3& low, const Vec3& high) {
  const Vec3 middle = (low + high) / 2;
  Mesh mesh;
  const double x[3] = {low.x(), middle.x(), high.x()}, y[3] = {low.y(), middle.y(), high.y()};
  constexpr int kOutline[6][2] = {{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}};
  for (const double z : {low.z(), high.z()}) {
    for (const auto& [i, j] : kOutline) mesh.vertices.emplace_back(x[i], y[j], z);
  }
  constexpr std::uint32_t kTop[4][3] = {{0, 1, 2}, {0, 2, 3}, {0, 3, 5}, {3, 4, 5}};
  for (const auto& [a, b, d] : kTop) {
    mesh.triangles.push_back({a + 6, b + 6, d + 6});
    mesh.triangles.push_back({a, d, b});
  }
  for (std::uint32_t i = 0; i < 6; ++i) {
    const std::uint32_t next = (i + 1) % 6;
    mesh.triangles.push_back({i, next, next + 6});
    mesh.triangles.push_back({i, next + 6, i + 6});
  }
  return mesh;
}

void limit_heights(Random& random, MeshCase& c) {
  const double low = random.uniform(-1, 8);
  c.navigation.altitude = {low, low + random.uniform(6, 40)};
}

void limit_one_box(Random& random, MeshCase& c) {
  c.navigation.keep_in = {box_about(random, draw_place(c, random), 4, 25)};
}

void limit_boxes(Random& random, MeshCase& c) {
  for (int count = random.integer(2, 4); count > 0; --count) {
    const Vec3 middle = c.navigation.keep_in.empty() || random.chance(0.3)
                            ? draw_place(c, random)
                            : Vec3((c.navigation.keep_in.back().box().min + c.navigation.keep_in.back().box().max) / 2 +
                                   random.point(-9, 9));
    c.navigation.keep_in.push_back(box_about(random, middle, 3, 15));
  }
  if (random.chance(0.5)) c.navigation.keep_in.push_back(zone_about(random, c, draw_place(c, random), 15));
}

void limit_out_boxes(Random& random, MeshCase& c) {
  for (int count = random.integer(1, 2); count > 0; --count) {
    c.navigation.keep_out.push_back(box_about(random, draw_place(c, random), 0.5, 8));
  }
}

void limit_zone(Random& random, MeshCase& c) {
  c.navigation.keep_in = {zone_about(random, c, draw_place(c, random), random.uniform(8, 40))};
}

void limit_out_zones(Random& random, MeshCase& c) {
  for (int count = random.integer(1, 2); count > 0; --count) {
    c.navigation.keep_out.push_back(zone_about(random, c, draw_place(c, random), random.uniform(2, 15)));
    c.navigation.keep_out.back().name += std::to_string(count);
  }
}

void limit_mesh(Random& random, MeshCase& c) {
  const Box box = box_about(random, draw_place(c, random), 5, 25);
  c.navigation.meshes = {{random.chance(0.75) ? block(box.min, box.max) : bent_block(box.min, box.max), "airspace"}};
  if (random.chance(0.3)) {  // turned
    const Vec3 middle = (box.min + box.max) / 2;
    const Eigen::Matrix3d turned = random.rotation();
    for (Vec3& v : c.navigation.meshes[0].mesh.vertices) v = middle + turned * (v - middle);
  }
}

void limit_above_ground(Random& random, MeshCase& c) {
  const double low = random.uniform(0, 8);
  c.navigation.above_ground = vantage::AboveGround{low, low + random.uniform(6, 40), vantage::Ground{}};
  if (c.ground && random.chance(0.7)) c.navigation.above_ground->ground = vantage::ground_of(c.scene, *c.ground);
}

void limit_clearance(Random& random, MeshCase& c) {
  std::vector<std::uint32_t> ground;
  if (c.ground) ground.push_back(*c.ground);
  c.navigation.clearance = vantage::Clearance{random.uniform(0.3, 6), vantage::obstacles_of(c.scene, ground)};
}

void limit_min_range(Random& random, MeshCase& c) { c.sensor.min_range_m = random.magnitude(0.3, 20); }

void limit_incidence(Random& random, MeshCase& c) {
  if (c.target.is_point() && !c.target.front) return limit_min_range(random, c);
  c.sensor.incidence_deg = random.uniform(10, 85);
}

void limit_worst_pixel(Random& random, MeshCase& c) {
  if (c.target.is_point() && !c.target.front) return limit_min_range(random, c);
  draw_camera(random, c);
  c.sensor.mount = {};
  c.sensor.pixel = vantage::PixelLimit{random.uniform(0.3, 1.5) * kRange / *c.sensor.camera->focal_px,
                                       vantage::PixelLimit::Kind::worst};
}

void limit_pixel(Random& random, MeshCase& c) {
  draw_camera(random, c);
  c.sensor.pixel = vantage::PixelLimit{random.uniform(0.3, 1.2) * kRange / *c.sensor.camera->focal_px,
                                       vantage::PixelLimit::Kind::perpendicular};
}

void limit_sun(Random& random, MeshCase& c) {
  const double exclude = random.magnitude(2, 90);
  Vec3 direction = random.direction();
  if (random.chance(0.7)) {
    direction = (middle_of(c) - draw_place(c, random)).normalized();  // the target is seen before it from there
    direction = (direction + random.uniform(0, 2) * std::sin(exclude * kDegree) * random.direction()).normalized();
  }
  if (random.chance(0.8)) direction.z() = std::abs(direction.z());  // missions know no other
  c.sensor.sun = vantage::SunLimit{direction, exclude};
}

void draw_limit(Random& random, MeshCase& c) {
  struct Named {
    const char* name;
    void (*draw)(Random&, MeshCase&);
  };
  static constexpr Named kLimits[] = {{"altitude", limit_heights},
                                      {"keep_in", limit_one_box},
                                      {"several boxes", limit_boxes},
                                      {"keep_out", limit_out_boxes},
                                      {"zone", limit_zone},
                                      {"keep_out zones", limit_out_zones},
                                      {"mesh", limit_mesh},
                                      {"agl", limit_above_ground},
                                      {"clearance", limit_clearance},
                                      {"min_range", limit_min_range},
                                      {"incidence", limit_incidence},
                                      {"frame", draw_camera},
                                      {"frame", draw_camera},
                                      {"pixel", limit_worst_pixel},
                                      {"pixel face on", limit_pixel},
                                      {"sun", limit_sun},
                                      {"sun", limit_sun}};
  const Named& one = kLimits[random.integer(0, static_cast<int>(std::size(kLimits)) - 1)];
  c.kind += std::string(" | ") + one.name;
  one.draw(random, c);
}

// ---- where it stands, and how large it is ----

struct Placement {
  double unit;
  Vec3 shift;

  void move(Vec3& v) const { v = unit * v + shift; }
  void move(Box& box) const {
    move(box.min);
    move(box.max);
  }
  void move(double& z) const { z = unit * z + shift.z(); }
  void move(vantage::Ground& ground) const {
    move(ground.plane_z_m);
    if (!ground.surface) return;
    Mesh moved = *ground.surface;
    for (Vec3& v : moved.vertices) move(v);
    ground.surface = std::make_shared<const Mesh>(std::move(moved));
  }
  void move(vantage::AboveGround& above) const {
    above.min_m *= unit;
    above.max_m *= unit;
    move(above.ground);
  }
  void move(Zone& zone) const {
    zone.holes.push_back(zone.outer);
    for (Zone::Ring& ring : zone.holes) {
      for (Eigen::Vector2d& corner : ring) corner = unit * corner + shift.head<2>();
    }
    zone.outer = std::move(zone.holes.back());
    zone.holes.pop_back();
    move(zone.min_z_m);
    move(zone.max_z_m);
    if (zone.above_ground) move(*zone.above_ground);
  }
};

void move(MeshCase& c, const Placement& pose) {
  c.unit = pose.unit;
  for (Vec3& v : c.scene.mesh.vertices) pose.move(v);
  for (std::vector<Vec3>& part : c.target.parts) {
    for (Vec3& v : part) pose.move(v);
  }
  c.sensor.max_range_m *= pose.unit;
  c.sensor.min_range_m *= pose.unit;
  if (c.sensor.pixel) c.sensor.pixel->size_m *= pose.unit;
  auto& [altitude, keep_in, keep_out, meshes, above_ground, clearance] = c.navigation;
  if (altitude) {
    pose.move(altitude->min_m);
    pose.move(altitude->max_m);
  }
  for (auto* zones : {&keep_in, &keep_out}) {
    for (Zone& zone : *zones) {
      if (!zone.is_box) {
        pose.move(zone);
        continue;
      }
      Box box = zone.box();
      pose.move(box);
      zone = box;
    }
  }
  for (vantage::KeepInMesh& mesh : meshes) {
    for (Vec3& v : mesh.mesh.vertices) pose.move(v);
  }
  if (above_ground) pose.move(*above_ground);
  if (clearance) {
    Mesh moved = *clearance->obstacles;
    for (Vec3& v : moved.vertices) pose.move(v);
    clearance = vantage::Clearance{clearance->distance_m * pose.unit, std::make_shared<const Mesh>(std::move(moved))};
  }
}

}  // namespace

Vec3 draw_place(const MeshCase& c, Random& random) {
  Vec3 direction = random.direction();
  const Vec3 normal = normal_of(c);
  const bool sees_back = c.both_sides || (c.target.is_point() && !c.target.front);
  if (direction.dot(normal) < 0 && !sees_back) direction = -direction;
  if (direction.z() < 0 && std::abs(normal.z()) < 0.5 && random.chance(0.7)) direction.z() *= -1;
  const double range = std::isfinite(c.sensor.max_range_m) ? c.sensor.max_range_m : kRange * c.unit;
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
  c.sensor.max_range_m = kRange;
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
  if (random.chance(0.05)) c.rounding_m = kRange * unit * random.magnitude(1e-8, 1e-3);
  return c;
}

}  // namespace attack
