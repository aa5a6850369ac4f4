// Buildings and ground about a target, and where all of it stands in the world.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "draw.h"
#include "limit_attack.h"

namespace attack {

void SceneDrawing::box(const Vec3& low, const Vec3& high, bool open_below) {
  const auto at = [&](int i) {
    return Vec3(i & 1 ? high.x() : low.x(), i & 2 ? high.y() : low.y(), i & 4 ? high.z() : low.z());
  };
  constexpr int kSides[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  for (int side = open_below ? 1 : 0; side < 6; ++side)
    polygon({at(kSides[side][0]), at(kSides[side][1]), at(kSides[side][2]), at(kSides[side][3])});
}

// Under the target or round it: flat, sloped about a side, or with the target's outline as a hole.
void SceneDrawing::ground() {
  object("ground");
  const double w = random_.uniform(3, 12);
  const double low = random_.chance(0.5) ? 0 : -std::abs(tiny()) - (random_.chance(0.5) ? random_.uniform(0, 0.5) : 0);
  switch (random_.integer(0, 3)) {
    case 0:
      polygon({{-w, -w, low}, {w, -w, low}, {w, w, low}, {-w, w, low}});
      break;
    case 1:
      for (int i = 0; i < static_cast<int>(outline_.size()); ++i) {
        const Vec3 a = corner(i), b = corner(i + 1), far_a = (w * a).eval(), far_b = (w * b).eval();
        polygon({a, far_a, far_b, b});
      }
      break;
    case 2:
      polygon(outline_);
      break;
    default: {
      const int side = random_.integer(0, static_cast<int>(outline_.size()) - 1);
      const Vec3 out = outward(side), along(-out.y(), out.x(), 0), foot = corner(side);
      const Vec3 fall = out + random_.uniform(-0.5, 0.5) * Vec3::UnitZ();
      polygon({foot - w * along, foot - w * along + w * fall, foot + w * along + w * fall, foot + w * along});
    }
  }
}

void SceneDrawing::houses() {
  const double grid = random_.pick({0.5, 0.25, 0.0});
  Vec3 last_low(2, 2, 0), last_high(3, 3, 1);
  for (int k = random_.integer(1, 6); k > 0; --k) {
    object("house");
    Vec3 low(random_.uniform(-5, 4), random_.uniform(-5, 4), random_.pick({0.0, -0.5, 0.0}));
    Vec3 size(random_.uniform(0.3, 3), random_.uniform(0.3, 3), random_.uniform(0.2, 4));
    if (grid > 0) {
      low = (low / grid).array().round() * grid;
      size = ((size / grid).array().round() * grid).max(grid);
    }
    switch (random_.integer(0, 4)) {
      case 0:
        low = Vec3(last_high.x() + tiny(), last_low.y(), last_low.z());
        break;  // wall to wall
      case 1:
        low = Vec3(last_low.x(), last_low.y(), last_high.z());
        break;  // on the roof
      default:
        break;
    }
    const Vec3 high = low + size;
    last_low = low;
    last_high = high;
    box(low, high, random_.chance(0.3));
    if (!random_.chance(0.4)) continue;
    const double ridge = high.z() + random_.uniform(0.1, 1), x = 0.5 * (low.x() + high.x());
    const Vec3 a(x, low.y(), ridge), b(x, high.y(), ridge);
    polygon({{low.x(), low.y(), high.z()}, a, b, {low.x(), high.y(), high.z()}});
    polygon({{high.x(), low.y(), high.z()}, {high.x(), high.y(), high.z()}, b, a});
  }
}

// The target lies on top of a block, inside its outline or up to its edges.
void SceneDrawing::roof() {
  object("block");
  Vec3 low = outline_[0], high = low;
  for (const Vec3& p : outline_) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const double margin = random_.pick({0.0, 0.0, 1e-9, 0.2, 1.0});
  low -= Vec3(margin, margin, random_.uniform(0.3, 4));
  high += Vec3(margin, margin, random_.chance(0.7) ? 0 : -std::abs(tiny()));
  box(low, high, random_.chance(0.3));
  if (random_.chance(0.5)) box(low - Vec3(1, 1, 3), Vec3(high.x() + 1, high.y() + 1, low.z()), false);
}

void SceneDrawing::room() {
  object("room");
  double reach = 0;
  for (const Vec3& p : outline_) reach = std::max(reach, p.norm());
  const double x = reach * random_.uniform(1.05, 3), y = reach * random_.uniform(1.05, 3),
               high = random_.uniform(0.3, 3);
  const double low = random_.pick({0.0, -0.5, -1.0});
  const int door = random_.integer(-1, 3);
  const Vec3 p[4] = {{-x, -y, low}, {x, -y, low}, {x, y, low}, {-x, y, low}};
  const Vec3 up(0, 0, high - low);
  for (int k = 0; k < 4; ++k) {
    const Vec3 &a = p[k], &b = p[(k + 1) % 4];
    if (k != door) {
      polygon({a, b, b + up, a + up});
      continue;
    }
    const Vec3 left = a + 0.4 * (b - a), right = a + 0.6 * (b - a);
    polygon({a, left, left + up, a + up});
    polygon({right, b, b + up, right + up});
  }
  if (random_.chance(0.5)) polygon({p[0], p[3], p[2], p[1]});
  if (!random_.chance(0.6)) return;
  object("ceiling");
  const double hole = random_.pick({0.0, 0.3, 0.6});
  for (int k = 0; k < 4; ++k) {
    const Vec3 a = p[k] + up, b = p[(k + 1) % 4] + up, middle(0, 0, high);
    if (hole == 0) {
      triangle(a, b, middle);
    } else {
      polygon({a, b, middle + hole * (b - middle), middle + hole * (a - middle)});
    }
  }
}

std::string SceneDrawing::add_things() {
  static constexpr Named kKinds[] = {
      {"walls", &SceneDrawing::walls},       {"walls", &SceneDrawing::walls},
      {"parapets", &SceneDrawing::parapets}, {"planes", &SceneDrawing::planes_through_edges},
      {"touching", &SceneDrawing::touching}, {"low slopes", &SceneDrawing::low_slopes},
      {"ground", &SceneDrawing::ground},     {"canopy", &SceneDrawing::canopy},
      {"fan", &SceneDrawing::fan},           {"poles", &SceneDrawing::poles},
      {"slivers", &SceneDrawing::slivers},   {"soup", &SceneDrawing::soup},
      {"houses", &SceneDrawing::houses},     {"roof", &SceneDrawing::roof},
      {"room", &SceneDrawing::room},         {"rims", &SceneDrawing::rims},
      {"copies", &SceneDrawing::copies}};
  const Named& kind = kKinds[random_.integer(0, static_cast<int>(std::size(kKinds)) - 1)];
  lets_pierce_ = random_.chance(0.02);
  (this->*kind.draw)();
  return kind.name;
}

vantage::Scene SceneDrawing::finish() {
  if (scene_.mesh.triangles.empty()) {
    object("far");
    lets_pierce_ = true;
    triangle({5, 5, 0}, {6, 5, 0}, {5, 5, 2});
  }
  return scene_;
}

namespace {

Pose draw_pose(Random& random, double scale, std::string& kind) {
  Pose pose;
  pose.scale = scale;
  switch (random.integer(0, 5)) {
    case 0:
      break;
    case 1:  // on a wall, along the axes
      pose.rotation << 0, 0, 1, 1, 0, 0, 0, 1, 0;
      kind += ", upright";
      break;
    case 2:
      pose.rotation = Eigen::AngleAxisd(random.uniform(0, 2 * std::numbers::pi), Vec3::UnitZ()).toRotationMatrix();
      kind += ", turned";
      break;
    case 3:
    case 4:
      pose.rotation = random.rotation();
      kind += ", tilted";
      break;
    default:
      break;
  }
  if (random.chance(0.4)) {
    pose.shift = Vec3(5e5, 5e6, 100) + (random.chance(0.5) ? Vec3::Zero() : random.point(-100, 100));
    kind += ", far";
  }
  return pose;
}

void draw_limits(Random& random, const Pose& pose, Case& c) {
  CaseDraws draws{random, pose, c};
  every_navigation_limit([&](auto limit) { draw_in_case<limit>(draws); });
}

/// An antenna in the target's place, or somewhat above it. Its zone is up to a thirtieth of the range wide. Not in
/// worlds so small that no radio wave has that length.
bool draw_link(Random& random, const Pose& pose, Case& c) {
  constexpr double kLightGhzMetres = 0.299792458, kMostGhz = 3000;
  const double clear = random.uniform(0.2, 1), excess = c.range * random.magnitude(1e-7, 1e-3);
  const double frequency = kLightGhzMetres * clear * clear / (2 * excess);
  if (frequency > kMostGhz) return false;
  c.sensor.link = vantage::RadioLink{frequency, clear};
  vantage::Target& target = c.parts[0];
  const double height = random.chance(0.3) ? 0 : random.magnitude(1e-3, 3);
  target.parts[0] = {Vec3(target.parts[0][0] + height * pose.scale * (pose.rotation * Vec3::UnitZ()))};
  if (random.chance(0.6)) target.front.reset();
  if (!target.front) target.offset_m = 0;
  c.kind += ", link";
  return true;
}

void draw_sensor(Random& random, const Pose& pose, Case& c) {
  if (random.chance(0.5) && draw_link(random, pose, c)) return;
  CaseDraws draws{random, pose, c};
  every_sensor_limit([&](auto limit) { draw_in_case<limit>(draws); });
  c.kind += ", sensor";
}

/// Two convex parts along a diagonal; or the target twice, once moved.
void draw_parts(Random& random, Case& c) {
  vantage::Target& whole = c.parts[0];
  if (whole.parts[0].size() < 4) return;
  vantage::Target other = whole;
  const auto cut = static_cast<std::ptrdiff_t>(random.integer(2, static_cast<int>(whole.parts[0].size()) - 2));
  other.parts[0] = {whole.parts[0][0]};
  other.parts[0].insert(other.parts[0].end(), whole.parts[0].begin() + cut, whole.parts[0].end());
  whole.parts[0].erase(whole.parts[0].begin() + cut + 1, whole.parts[0].end());
  whole.front = other.front = c.parts[0].front;
  c.parts.push_back(other);
  c.kind += ", parts";
}

void draw_target(Random& random, const Pose& pose, const std::vector<Vec3>& outline, Case& c) {
  vantage::Target target;
  for (const Vec3& p : outline) target.parts[0].push_back(pose(p));
  target.front = pose.rotation * Vec3::UnitZ();
  if (pose.rotation.isIdentity() && random.chance(0.5)) target.front.reset();
  if (random.chance(0.05)) {
    target.front = pose.rotation * Vec3(0, 0, -1);
    c.kind += ", from below";
  }
  if (random.chance(0.3)) std::reverse(target.parts[0].begin(), target.parts[0].end());
  if (random.chance(0.15))
    target.offset_m = random.pick({1e-9, 1e-6, 1e-3 * pose.scale, 0.05 * pose.scale, 0.3 * pose.scale});
  if (random.chance(0.06)) {
    target.parts[0] = {pose(random.chance(0.3) ? Vec3(0, 0, random.uniform(0, 0.5)) : outline[0])};
    c.kind += ", point";
    if (random.chance(0.6)) target.front.reset();
    if (!target.front) target.offset_m = 0;
  }
  c.parts = {target};
}

}  // namespace

Case draw_case(std::uint64_t seed, std::size_t index) {
  Random random(seed * 0x9e3779b97f4a7c15ull + index);
  for (int k = 0; k < 3; ++k) random.next();
  Case c;
  c.seed = random.next();
  c.scale = kScales[index % std::size(kScales)];
  std::string shape;
  const std::vector<Vec3> outline = draw_outline(random, c.scale, shape);
  SceneDrawing drawing(random, c.scale, outline);
  c.kind = shape;
  for (int things = random.integer(1, 4); things > 0; --things) c.kind += " | " + drawing.add_things();
  const Pose pose = draw_pose(random, c.scale, c.kind);
  c.scene = drawing.finish();
  for (Vec3& v : c.scene.mesh.vertices) v = pose(v);
  draw_target(random, pose, outline, c);
  double reach = 0;
  for (const Vec3& p : outline) reach = std::max(reach, p.norm());
  c.range = c.scale * reach * (random.chance(0.8) ? random.magnitude(2.5, 30) : random.uniform(1.01, 2.5));
  c.tolerance = c.range * random.magnitude(2e-3, 3e-2);
  if (random.chance(0.12)) draw_limits(random, pose, c);
  if (random.chance(0.08)) draw_parts(random, c);
  if (c.parts.size() == 1 && random.chance(0.2)) draw_sensor(random, pose, c);
  return c;
}

}  // namespace attack
