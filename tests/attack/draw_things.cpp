// Things about a target that touch it, nearly touch it, or line up with it.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "draw.h"

namespace attack {

void SceneDrawing::object(const char* name) {
  scene_.objects.push_back({std::string(name) + " " + std::to_string(scene_.objects.size())});
}

const Vec3& SceneDrawing::corner(int i) const {
  const int n = static_cast<int>(outline_.size());
  return outline_[static_cast<std::size_t>((i % n + n) % n)];
}

Vec3 SceneDrawing::outward(int side) const {
  const Vec3 along = corner(side + 1) - corner(side);
  const Vec3 out(along.y(), -along.x(), 0);
  return out.norm() > 0 ? out.normalized() : Vec3(Vec3::UnitX());
}

// Roughly: through the target's plane within its outline, by more than what is next to nothing.
bool SceneDrawing::pierces(const Vec3& a, const Vec3& b, const Vec3& c) const {
  const Vec3 corners[3] = {a, b, c};
  std::vector<Vec3> crossing;
  const double nothing = 1e-2;
  for (int k = 0; k < 3; ++k) {
    const Vec3 &p = corners[k], &q = corners[(k + 1) % 3];
    if (std::abs(p.z()) < nothing) crossing.push_back(p);
    if (p.z() * q.z() < 0) crossing.push_back(p + p.z() / (p.z() - q.z()) * (q - p));
  }
  if (std::max({a.z(), b.z(), c.z()}) < 2e-3 / scale_ || crossing.empty()) return false;
  // The crossing is a segment, or nearly one: outside when some side has all of it outside, or next to nothing inside.
  for (int side = 0; side < static_cast<int>(outline_.size()); ++side) {
    const Vec3 out = outward(side);
    if (std::all_of(crossing.begin(), crossing.end(),
                    [&](const Vec3& p) { return out.dot(p - corner(side)) > -1e-9 / scale_; }))
      return false;
  }
  return true;
}

void SceneDrawing::triangle(const Vec3& a, const Vec3& b, const Vec3& c) {
  if (scene_.objects.empty()) object("thing");
  if (!lets_pierce_ && pierces(a, b, c)) return;
  const auto first = static_cast<std::uint32_t>(scene_.mesh.vertices.size());
  for (const Vec3& p : {a, b, c}) scene_.mesh.vertices.push_back(p);
  scene_.mesh.triangles.push_back({first, first + 1, first + 2});
  if (random_.chance(0.2)) std::swap(scene_.mesh.triangles.back()[0], scene_.mesh.triangles.back()[1]);
  scene_.object_of.push_back(static_cast<std::uint32_t>(scene_.objects.size() - 1));
}

void SceneDrawing::polygon(const std::vector<Vec3>& p) {
  const std::size_t n = p.size();
  const std::size_t start = static_cast<std::size_t>(random_.integer(0, static_cast<int>(n) - 1));
  if (n > 3 && random_.chance(0.2)) {
    Vec3 middle = Vec3::Zero();
    for (const Vec3& q : p) middle += q / static_cast<double>(n);
    for (std::size_t k = 0; k < n; ++k) triangle(p[k], p[(k + 1) % n], middle);
    return;
  }
  for (std::size_t k = 1; k + 1 < n; ++k) triangle(p[start], p[(start + k) % n], p[(start + k + 1) % n]);
}

// Upright or leaning, on or right beside a side of the target; longer, shorter or just as long.
void SceneDrawing::walls() {
  const int sides = random_.integer(1, std::min<int>(4, static_cast<int>(outline_.size())));
  for (int k = 0; k < sides; ++k) {
    object("wall");
    const int side = random_.integer(0, static_cast<int>(outline_.size()) - 1);
    const Vec3 out = outward(side), along = corner(side + 1) - corner(side);
    const double reach = std::max(1.0, 0.3 / std::max(along.norm(), 1e-6));
    const auto end = [&] { return random_.pick({0.0, 0.0, 1e-9, -1e-9, 0.5, -0.3, 1.5}) * reach; };
    const double off = random_.chance(0.8) ? std::abs(tiny()) : tiny();
    const Vec3 a = corner(side) + off * out - end() * along, b = corner(side + 1) + off * out + end() * along;
    const double base = random_.pick({0.0, 0.0, 1.0, 1.0, 1.0, -0.5, 0.3});
    const double low = base == 1.0 ? tiny() : base;
    const double high = random_.chance(0.8) ? random_.uniform(0.05, 3) : random_.magnitude(1e-5, 0.05);
    const Vec3 lean = random_.chance(0.6) ? Vec3::Zero() : Vec3(random_.uniform(-0.2, 1) * high * out);
    const Vec3 up = Vec3(0, 0, high) + lean, down(0, 0, low);
    const Vec3 end_up = random_.chance(0.8) ? up : Vec3(up * random_.uniform(0.01, 1));
    polygon({a + down, b + down, b + end_up, a + up});
    if (random_.chance(0.2)) polygon({a + down, a + up, b + up, b + down});  // the same again, cut otherwise
  }
}

// Low walls all round, kerbs, a trench.
void SceneDrawing::parapets() {
  object("parapet");
  const double off = std::abs(tiny()) + (random_.chance(0.5) ? random_.uniform(0, 0.3) : 0);
  const double low = random_.pick({0.0, 0.0, -0.2, 1e-9 / scale_});
  const double high = random_.magnitude(1e-6, 0.3);
  const int n = static_cast<int>(outline_.size());
  for (int side = 0; side < std::min(n, 24); ++side) {
    if (random_.chance(0.15)) continue;
    const Vec3 out = outward(side);
    const Vec3 a = corner(side) + off * out, b = corner(side + 1) + off * out;
    polygon({a + Vec3(0, 0, low), b + Vec3(0, 0, low), b + Vec3(0, 0, high), a + Vec3(0, 0, high)});
  }
}

// Planes through a side or a corner of the target, with the triangle somewhere on them.
void SceneDrawing::planes_through_edges() {
  for (int k = random_.integer(2, 8); k > 0; --k) {
    object("plane");
    const int side = random_.integer(0, static_cast<int>(outline_.size()) - 1);
    const Vec3 a = corner(side), b = corner(side + 1), out = outward(side);
    const double angle = random_.chance(0.2) ? tiny() : random_.uniform(-0.5, std::numbers::pi - 0.1);
    const Vec3 steep = std::cos(angle) * out + std::sin(angle) * Vec3::UnitZ();
    const auto on_plane = [&] {
      return Vec3(a + random_.uniform(-1.5, 2.5) * (b - a) + random_.magnitude(1e-3, 4) * steep);
    };
    Vec3 p = on_plane(), q = on_plane(), r = on_plane();
    if (random_.chance(0.3)) p = a;
    if (random_.chance(0.2)) q = b;
    triangle(p, q, r + (random_.chance(0.3) ? Vec3(tiny() * Vec3::UnitZ()) : Vec3::Zero()));
  }
}

// A corner or a side of a triangle on the target's plane; triangles in it.
void SceneDrawing::touching() {
  for (int k = random_.integer(2, 10); k > 0; --k) {
    object("touching");
    const int side = random_.integer(0, static_cast<int>(outline_.size()) - 1);
    const Vec3 out = outward(side), along = corner(side + 1) - corner(side);
    const auto beside = [&] {
      const double away = random_.chance(0.5) ? std::abs(tiny()) : random_.uniform(0, 2);
      return Vec3(corner(side) + random_.uniform(-0.5, 1.5) * along + away * out + Vec3(0, 0, tiny()));
    };
    const auto high = [&] {
      return Vec3(beside() + random_.uniform(0, 1) * out + Vec3(0, 0, random_.magnitude(1e-4, 3)));
    };
    switch (random_.integer(0, 3)) {
      case 0:
        triangle(beside(), high(), high());
        break;
      case 1:
        triangle(beside(), beside(), high());
        break;
      case 2:
        triangle(corner(side), corner(side + 1), high());
        break;
      default:
        triangle(corner(side), beside(), beside());
        break;
    }
  }
}

// Surfaces that all but continue the target's plane.
void SceneDrawing::low_slopes() {
  for (int k = random_.integer(1, 4); k > 0; --k) {
    object("slope");
    const int side = random_.integer(0, static_cast<int>(outline_.size()) - 1);
    const Vec3 out = outward(side), along = corner(side + 1) - corner(side);
    const double slope = random_.sign() * random_.magnitude(1e-10, 1e-1), from = tiny();
    const Vec3 a = corner(side) + std::abs(tiny()) * out - random_.uniform(0, 1) * along;
    const Vec3 b = corner(side + 1) + std::abs(tiny()) * out + random_.uniform(0, 1) * along;
    const double wide = random_.uniform(0.1, 5);
    const Vec3 rise = wide * (out + slope * Vec3::UnitZ()), up(0, 0, from);
    polygon({a + up, a + rise + up, b + rise + up, b + up});
  }
}

void SceneDrawing::canopy() {
  object("canopy");
  const double high = random_.chance(0.8) ? random_.uniform(0.2, 4) : random_.magnitude(3e-3, 0.2);
  const double grow = random_.pick({1.0, 1.0, 0.5, 2.0, 1 + 1e-9});
  const Vec3 shift = random_.chance(0.5) ? Vec3::Zero() : Vec3(random_.uniform(-2, 2), random_.uniform(-2, 2), 0);
  const Vec3 tilt =
      random_.chance(0.5) ? Vec3::Zero() : Vec3(random_.uniform(-0.3, 0.3), random_.uniform(-0.3, 0.3), 0);
  std::vector<Vec3> corners;
  for (const Vec3& p : outline_) {
    Vec3 q = grow * p + shift;
    q.z() = std::max(high + tilt.dot(q), 0.3 * high);
    corners.push_back(q);
  }
  if (corners.size() > 12 || random_.chance(0.3)) corners.resize(3);
  polygon(corners);
  if (random_.chance(0.3)) {
    for (Vec3& p : corners) p.z() += tiny();
    polygon(corners);
  }
}

// Many triangles that share a point or a line.
void SceneDrawing::fan() {
  object("fan");
  const int pages = random_.chance(0.97) ? random_.integer(4, 40) : random_.integer(200, 1000);
  const int i = random_.integer(0, static_cast<int>(outline_.size()) - 1);
  const Vec3 sum = outward(i) + outward(i - 1);
  const Vec3 out = sum.norm() > 1e-6 ? sum.normalized() : outward(i);
  const Vec3 away = random_.chance(0.5) ? Vec3::Zero() : Vec3(random_.uniform(0, 2) * out);
  const Vec3 foot = corner(i) + away;
  Vec3 axis = Vec3::UnitZ();
  if (random_.chance(0.3)) axis = (corner(i) - corner(i - 1) + 1e-3 * out).normalized();
  if (random_.chance(0.2)) axis = (axis + 0.3 * random_.direction()).normalized();
  axis *= axis.z() < 0 ? -1 : 1;
  const double length = random_.uniform(0.2, 3);
  const bool about_line = random_.chance(0.6);
  const auto draw_rim = [&] {
    Vec3 side = random_.direction();
    side -= axis * axis.dot(side);
    if (side.dot(out) < 0 && random_.chance(0.8)) side = -side;
    return Vec3(foot + random_.uniform(0.1, 2) * side + random_.uniform(0, 1) * length * axis);
  };
  for (int k = 0; k < pages; ++k) {
    if (about_line) {
      triangle(foot, foot + length * axis, draw_rim());
    } else {
      triangle(foot + length * axis, draw_rim(), draw_rim());
    }
  }
}

void SceneDrawing::poles() {
  for (int k = random_.integer(1, 6); k > 0; --k) {
    object("pole");
    const double width = random_.chance(0.5) ? random_.magnitude(1e-4, 1e-1) : random_.magnitude(1e-9, 1e-4) / scale_;
    const int i = random_.integer(0, static_cast<int>(outline_.size()) - 1);
    Vec3 foot = corner(i) + (random_.chance(0.5) ? std::abs(tiny()) + width : random_.uniform(0.1, 2)) * outward(i);
    foot += random_.uniform(0, 1) * (corner(i + 1) - corner(i));
    foot.z() = random_.pick({0.0, -1.0, 0.1});
    const Vec3 top = foot + Vec3(0, 0, random_.uniform(0.2, 4));
    const Vec3 across = width * Vec3(std::cos(k), std::sin(k), 0), other(-across.y(), across.x(), 0);
    polygon({foot, foot + across, top + across, top});
    if (random_.chance(0.5)) polygon({foot, foot + other, top + other, top});
  }
}

void SceneDrawing::slivers() {
  for (int k = random_.integer(1, 12); k > 0; --k) {
    object("sliver");
    const Vec3 a = random_.point(-2, 2) + Vec3(0, 0, 2.2), b = random_.point(-2, 2) + Vec3(0, 0, 2.2);
    const double thin = random_.chance(0.5) ? random_.magnitude(1e-8, 1e-1) : random_.magnitude(1e-10, 1e-5) / scale_;
    triangle(a, b, a + random_.uniform(-0.1, 1.1) * (b - a) + thin * random_.direction());
  }
}

void SceneDrawing::soup() {
  const int count = random_.integer(3, 60);
  const double grid = random_.pick({0.5, 0.25, 0.1, 0.0}), low = random_.pick({0.0, 0.0, -1.0});
  const auto draw_corner = [&] {
    Vec3 p(random_.uniform(-3, 3), random_.uniform(-3, 3), random_.uniform(low, 3));
    if (grid > 0) p = (p / grid).array().round() * grid;
    return p;
  };
  for (int k = 0; k < count; ++k) {
    if (k % 5 == 0) object("soup");
    const Vec3 a = draw_corner();
    const double size = random_.pick({1.0, 1.0, 0.3});
    triangle(a, a + size * (draw_corner() - a), a + size * (draw_corner() - a));
  }
}

// A wall whose upper rim has corners that are hardly corners: neighbours that merge into one polygon.
void SceneDrawing::rims() {
  object("rim");
  const int side = random_.integer(0, static_cast<int>(outline_.size()) - 1);
  const Vec3 out = outward(side), along = Vec3(-out.y(), out.x(), 0);
  const Vec3 foot = 0.5 * (corner(side) + corner(side + 1)) + random_.uniform(0.01, 2) * out;
  const double half = random_.uniform(0.5, 3), high = random_.uniform(0.2, 3);
  const Vec3 a = foot - half * along, b = foot + half * along, up(0, 0, high);
  std::vector<Vec3> p{a, b};
  const double cut_along = std::min(std::abs(tiny()), 0.5), cut_down = std::min(std::abs(tiny()), 0.3);
  const int points = random_.integer(1, 12);
  for (int k = 0; k <= points; ++k) {
    const double t = static_cast<double>(k) / points;
    p.push_back(b + up - (1 - t) * (1 - t) * cut_down * Vec3::UnitZ() - t * t * cut_along * along);
  }
  if (random_.chance(0.5)) {
    const double rise = std::abs(tiny());
    for (int k = 1; k < points; ++k) {
      const double t = static_cast<double>(k) / points;
      p.push_back((1 - t) * p[static_cast<std::size_t>(points) + 2] + t * (a + up) +
                  4 * t * (1 - t) * rise * Vec3::UnitZ());
    }
  }
  p.push_back(a + up);
  polygon(p);
}

// What is there again: turned, shifted by next to nothing, or a part of it.
void SceneDrawing::copies() {
  const std::size_t count = scene_.mesh.triangles.size();
  if (count == 0) return soup();
  object("copy");
  const std::vector<vantage::Triangle> triangles = scene_.mesh.triangles;
  for (int k = random_.integer(2, 20); k > 0; --k) {
    const vantage::Triangle& t = triangles[static_cast<std::size_t>(random_.integer(0, static_cast<int>(count) - 1))];
    const Vec3 a = scene_.mesh.vertices[t[0]], b = scene_.mesh.vertices[t[1]], c = scene_.mesh.vertices[t[2]];
    const double u = random_.uniform(0, 1), v = random_.uniform(0, 1), off = tiny();
    switch (random_.integer(0, 3)) {
      case 0:
        triangle(b, a, c);
        break;
      case 1:
        triangle(a, a + u * (b - a), a + v * (c - a));
        break;
      case 2:
        triangle(a + off * Vec3::UnitX(), b + off * Vec3::UnitX(), c + off * Vec3::UnitX());
        break;
      default:
        triangle(a + u * (b - a), b + u * (c - b), c + v * (a - c));
        break;
    }
  }
}

}  // namespace attack
