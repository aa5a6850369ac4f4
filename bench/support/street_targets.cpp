#include "support/street_targets.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "vantage/error.h"
#include "vantage/volume.h"

namespace vantage::bench {
namespace {

using Vec2 = Eigen::Vector2d;

struct Wall {
  Vec2 from, to;
};

double cross(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

/// The scene cut at a height.
std::vector<Wall> walls_at(const Mesh& mesh, double height) {
  std::vector<Wall> walls;
  for (const Triangle& t : mesh.triangles) {
    Vec2 ends[3];
    int found = 0;
    for (int i = 0; i < 3; ++i) {
      const Vec3 &a = mesh.vertices[t[i]], &b = mesh.vertices[t[(i + 1) % 3]];
      if ((a.z() < height) != (b.z() < height))
        ends[found++] = (a + (height - a.z()) / (b.z() - a.z()) * (b - a)).head<2>();
    }
    if (found == 2) walls.push_back({ends[0], ends[1]});
  }
  return walls;
}

bool meets(const Vec2& centre, const Vec2& reach, const Wall& wall) {
  const Vec2 from = wall.from - centre, to = wall.to - centre, along = to - from;
  const double divisor = cross(reach, along);
  if (divisor == 0) return false;
  const double s = cross(from, along) / divisor, u = cross(from, reach) / divisor;
  return s >= 0 && s <= 1 && u >= 0 && u <= 1;
}

double enclosed_share(const std::vector<Wall>& walls, const Vec2& centre, double within) {
  std::vector<Wall> near;
  for (const Wall& wall : walls) {
    const Vec2 low = wall.from.cwiseMin(wall.to) - centre, high = wall.from.cwiseMax(wall.to) - centre;
    if (low.maxCoeff() <= within && high.minCoeff() >= -within) near.push_back(wall);
  }
  constexpr int kDirections = 180;
  int stopped = 0;
  for (int k = 0; k < kDirections; ++k) {
    const double angle = 2 * std::numbers::pi * k / kDirections;
    const Vec2 reach = within * Vec2(std::cos(angle), std::sin(angle));
    for (const Wall& wall : near) {
      if (meets(centre, reach, wall)) {
        ++stopped;
        break;
      }
    }
  }
  return static_cast<double>(stopped) / kDirections;
}

/// Whether nothing lies over a point at `height` or more.
bool under_the_sky(const Mesh& mesh, const Vec2& p, double height) {
  for (const Triangle& t : mesh.triangles) {
    const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    if (std::max({a.z(), b.z(), c.z()}) < height) continue;
    const double ab = cross(b.head<2>() - a.head<2>(), p - a.head<2>());
    const double bc = cross(c.head<2>() - b.head<2>(), p - b.head<2>());
    const double ca = cross(a.head<2>() - c.head<2>(), p - c.head<2>());
    if ((ab >= 0 && bc >= 0 && ca >= 0) || (ab <= 0 && bc <= 0 && ca <= 0)) return false;
  }
  return true;
}

Target triangle(const Vec3& centre, double side, double turn) {
  Target target;
  for (int k = 0; k < 3; ++k) {
    const double angle = turn + 2 * std::numbers::pi * k / 3;
    target.parts[0].push_back(centre + side / std::sqrt(3) * Vec3(std::cos(angle), std::sin(angle), 0));
  }
  return target;
}

bool is_seen(const PreparedScene& prepared, const Target& target) {
  try {
    return compute_visibility(PreparedTarget(prepared, target, {50}), {0.1, 0}).outcome == Outcome::computed;
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::input) throw;
    return false;  // pierced
  }
}

}  // namespace

std::vector<StreetTarget> find_street_targets(const Scene& scene, const PreparedScene& prepared,
                                              const StreetSearch& search, std::size_t count) {
  const Box bounds = bounding_box(scene.mesh);
  const Vec3 size = bounds.max - bounds.min;
  const double ground = bounds.min.z(), eye = ground + 2;
  const std::vector<Wall> walls = walls_at(scene.mesh, eye);
  std::mt19937_64 engine(search.seed);
  const auto draw = [&] {
    return static_cast<double>(engine() >> 11) * 0x1p-53;
  };  // the same with every standard library
  std::vector<StreetTarget> found;
  for (int attempt = 0; attempt < 20000 && found.size() < count; ++attempt) {
    const double x = draw(), y = draw(), turn = 2 * std::numbers::pi * draw();
    const Vec3 centre(bounds.min.x() + (0.2 + 0.6 * x) * size.x(), bounds.min.y() + (0.2 + 0.6 * y) * size.y(), ground);
    const double enclosed = enclosed_share(walls, centre.head<2>(), search.enclosed_within);
    if (enclosed < search.enclosed || !under_the_sky(scene.mesh, centre.head<2>(), eye)) continue;
    const Target target = triangle(centre, search.side_m, turn);
    if (is_seen(prepared, target)) found.push_back({target, centre, enclosed});
  }
  return found;
}

}  // namespace vantage::bench
