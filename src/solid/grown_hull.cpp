#include "solid/grown_hull.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "core/edges.h"
#include "core/portable_math.h"
#include "solid/convex_body.h"
#include "solid/convex_hull.h"

namespace vantage::internal::solid {
namespace {

/// The directions of the sides. Whatever they are, each side touches the grown hull, so that the polytope holds it;
/// they decide how far it reaches beyond.
class Sides {
 public:
  explicit Sides(const Mesh& hull);

  const std::vector<Vec3>& directions() const { return directions_; }
  /// The largest product of a direction with a point of the hull.
  double most(const Vec3& direction) const {
    double found = -std::numeric_limits<double>::infinity();
    for (const Vec3& vertex : hull_.vertices) found = std::max(found, direction.dot(vertex));
    return found;
  }

 private:
  void add(const Vec3& direction);
  void add_over_edges(const std::vector<Vec3>& normals);
  void add_over_corners();

  const Mesh& hull_;
  double size_ = 0;
  std::vector<Vec3> directions_;
};

Sides::Sides(const Mesh& hull) : hull_(hull) {
  std::vector<Vec3> normals;
  for (const Triangle& t : hull.triangles) {
    normals.push_back(sure_normal(hull.vertices[t[0]], hull.vertices[t[1]], hull.vertices[t[2]]).normalized());
    add(normals.back());
  }
  for (const Vec3& vertex : hull.vertices) size_ = std::max(size_, (vertex - hull.vertices[0]).norm());
  add_over_edges(normals);
  add_over_corners();
}

/// Planes that nearly coincide have no sure corners: one is enough. It reaches too far by their angle times the size.
void Sides::add(const Vec3& direction) {
  constexpr double kSame = 1 - 5e-11;  // the cosine of 0.00001 radians
  const bool is_known = std::any_of(directions_.begin(), directions_.end(),
                                    [&](const Vec3& known) { return known.dot(direction) > kSame; });
  if (!is_known) directions_.push_back(direction);
}

/// Between facets that turn by more than an eighth of a full turn.
void Sides::add_over_edges(const std::vector<Vec3>& normals) {
  constexpr double kMostTurn = std::numbers::pi / 4;
  const std::vector<core::EdgeUse> uses = core::edge_uses(hull_.triangles, hull_.vertices.size());
  core::for_each_edge(std::span(uses), [&](std::span<const core::EdgeUse> edge) {
    const Vec3 &from = normals[edge[0].triangle], &to = normals[edge[1].triangle];
    const Vec3 along = (hull_.vertices[edge[0].high] - hull_.vertices[edge[0].low]).normalized();
    // Out of the first facet, which lies to the left of its sides: of a hull as good as flat the normals do not tell.
    const Vec3 across = along.cross(from) * (edge[0].forward ? 1 : -1);
    const double turn = portable::atan2(std::max(across.dot(to), 0.0), from.dot(to));
    const int steps = static_cast<int>(std::ceil(turn / kMostTurn - 1e-9));
    for (int step = 1; step < steps; ++step) {
      const portable::SineCosine part = portable::sine_cosine(turn * step / steps);
      add((part.cosine * from + part.sine * across).normalized());
    }
  });
}

/// Round a corner all directions that point out of it must be near to one that does.
void Sides::add_over_corners() {
  constexpr double kNear = 0.927;  // the cosine of 22 degrees
  constexpr double kTouches = 1e-9;
  constexpr int kParts = 4;  // of a side of an icosahedron's facet: directions are 16 degrees apart
  static const std::vector<Vec3> kAll = make_sphere(kParts).mesh.vertices;
  std::vector<double> mosts;
  for (const Vec3& direction : directions_) mosts.push_back(most(direction));
  for (const Vec3& direction : kAll) {
    const Vec3& corner =
        *std::max_element(hull_.vertices.begin(), hull_.vertices.end(),
                          [&](const Vec3& a, const Vec3& b) { return direction.dot(a) < direction.dot(b); });
    bool is_near = false;
    for (std::size_t i = 0; i < directions_.size() && !is_near; ++i) {
      is_near = directions_[i].dot(direction) > kNear && directions_[i].dot(corner) >= mosts[i] - kTouches * size_;
    }
    if (is_near) continue;
    directions_.push_back(direction);
    mosts.push_back(direction.dot(corner));
  }
}

}  // namespace

Mesh grow_hull(std::span<const Vec3> points, double radius_m) {
  const Mesh hull = convex_hull(points);
  if (hull.empty()) return {};
  double largest = radius_m;
  for (const Vec3& vertex : hull.vertices) largest = std::max(largest, vertex.cwiseAbs().maxCoeff());
  const double radius = radius_m + 32 * std::numeric_limits<double>::epsilon() * largest;
  const Sides sides(hull);
  std::vector<HalfSpace> half_spaces;
  for (const Vec3& direction : sides.directions()) half_spaces.push_back({direction, sides.most(direction) + radius});
  Vec3 inside = Vec3::Zero();
  for (const Vec3& vertex : hull.vertices) inside += vertex / static_cast<double>(hull.vertices.size());
  Mesh body = intersect_half_spaces(half_spaces, inside);
  // Corners are rounded, and facets lie where their corners do.
  grow_to_hold(body, inside, [&](const Vec3& normal) { return sides.most(normal) + radius * normal.norm(); });
  return body;
}

}  // namespace vantage::internal::solid
