#include "scene/viewpoint_check.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/triangle_distance.h"
#include "core/weld.h"
#include "vantage/error.h"

namespace vantage::internal::scene {
namespace {

// From inside, the winding number of a closed surface is 1. What is left out of a building without a floor spans less
// than half of all directions from any point above it.
constexpr double kInside = 0.5;
// A deep valley spans more than half of all directions too, by its front: only what closes all around is a solid turned
// inside out.
constexpr double kInsideOut = -0.999;

using Corners = std::array<Vec3, 3>;

/// Solid angle of a triangle seen from the origin; positive where its normal points away. Source: van Oosterom and
/// Strackee, The Solid Angle of a Plane Triangle, 1983.
double solid_angle(const Corners& c) {
  const double a = c[0].norm(), b = c[1].norm(), d = c[2].norm();
  return 2 * std::atan2(c[0].dot(c[1].cross(c[2])),
                        a * b * d + c[0].dot(c[1]) * d + c[0].dot(c[2]) * b + c[1].dot(c[2]) * a);
}

/// Whether a triangle is above the origin, or may be within rounding.
bool is_above(const Corners& c) {
  const auto side = [](const Vec3& a, const Vec3& b) { return a.x() * b.y() - a.y() * b.x(); };
  const std::array<double, 3> sides = {side(c[1], c[2]), side(c[2], c[0]), side(c[0], c[1])};
  const double size = std::max({c[0].squaredNorm(), c[1].squaredNorm(), c[2].squaredNorm()});
  constexpr double kRounding = 1e-12;
  const auto [least, most] = std::minmax_element(sides.begin(), sides.end());
  if (*least<-kRounding * size&& * most> kRounding * size) return false;
  const double all = sides[0] + sides[1] + sides[2];
  const double highest = std::max({c[0].z(), c[1].z(), c[2].z()});
  if (std::abs(all) <= 4 * kRounding * size) return highest > 0;  // nearly upright
  return (sides[0] * c[0].z() + sides[1] * c[1].z() + sides[2] * c[2].z()) / all > 0;
}

std::uint32_t root_of(std::vector<std::uint32_t>& parent, std::uint32_t at) {
  while (parent[at] != at) at = parent[at] = parent[parent[at]];
  return at;
}

bool is_about(double value, double wanted) { return std::abs(value - wanted) < 1e-6; }

}  // namespace

ViewpointCheck::ViewpointCheck(const Scene& scene, const std::vector<std::uint32_t>& ground) : scene_(scene) {
  for (const SceneObject& object : scene.objects) is_ground_.push_back(object.kind == ObjectKind::ground);
  if (is_ground_.empty()) is_ground_.push_back(false);  // a scene without objects is one
  object_of_ = scene.object_of;
  object_of_.resize(scene.mesh.triangles.size(), 0);
  for (const std::uint32_t object : ground) is_ground_[object] = true;
  // Numbers of corners: those of ground, then those of all else.
  const std::vector<std::uint32_t> weld = core::first_at_position(scene.mesh.vertices);
  const std::size_t vertices = weld.size();
  std::vector<std::uint32_t> parent(2 * vertices);
  for (std::size_t i = 0; i < parent.size(); ++i) parent[i] = static_cast<std::uint32_t>(i);
  const auto corner = [&](std::size_t t, std::size_t k) {
    const std::size_t first = is_ground_[object_of_[t]] ? 0 : vertices;
    return static_cast<std::uint32_t>(first + weld[scene.mesh.triangles[t][k]]);
  };
  for (std::size_t t = 0; t < scene.mesh.triangles.size(); ++t) {
    const std::uint32_t root = root_of(parent, corner(t, 0));
    parent[root_of(parent, corner(t, 1))] = root;
    parent[root_of(parent, corner(t, 2))] = root;
  }
  constexpr std::uint32_t kNone = ~std::uint32_t{0};
  std::vector<std::uint32_t> piece(parent.size(), kNone);  // by root
  piece_of_.reserve(scene.mesh.triangles.size());
  for (std::size_t t = 0; t < scene.mesh.triangles.size(); ++t) {
    std::uint32_t& number = piece[root_of(parent, corner(t, 0))];
    if (number == kNone) {
      number = static_cast<std::uint32_t>(pieces_.size());
      pieces_.push_back({object_of_[t]});
    }
    piece_of_.push_back(number);
    pieces_[number].is_of_one &= pieces_[number].object == object_of_[t];
    for (const std::uint32_t vertex : scene.mesh.triangles[t]) pieces_[number].box.extend(scene.mesh.vertices[vertex]);
  }
}

std::optional<std::uint32_t> ViewpointCheck::solid_around(const Vec3& viewpoint) const {
  std::vector<double> winding(pieces_.size(), 0.0), of_object(is_ground_.size(), 0.0);
  bool has_above = false;
  for (std::size_t t = 0; t < piece_of_.size(); ++t) {
    Corners corners;
    for (std::size_t k = 0; k < 3; ++k) corners[k] = scene_.mesh.vertices[scene_.mesh.triangles[t][k]] - viewpoint;
    const double seen = solid_angle(corners) / (4 * std::numbers::pi);
    winding[piece_of_[t]] += seen;
    of_object[object_of_[t]] += seen;
    has_above = has_above || is_above(corners);
  }
  if (!has_above) return std::nullopt;
  std::optional<std::uint32_t> found;
  const auto find = [&](std::uint32_t object) {
    if (!found || (is_ground_[*found] && !is_ground_[object])) found = object;
  };
  for (std::uint32_t object = 0; object < of_object.size(); ++object) {
    if (of_object[object] > kInside) find(object);
  }
  // Two pieces of an object are no solid together: one round the other, which is turned inward.
  const auto is_of_cavity = [&](std::size_t piece) {
    const Piece& one = pieces_[piece];
    if (!one.is_of_one || !is_about(of_object[one.object], 0)) return false;
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
      if (pieces_[i].object != one.object || !is_about(winding[i], -winding[piece])) continue;
      const Box &round = winding[i] > 0 ? pieces_[i].box : one.box, &in = winding[i] > 0 ? one.box : pieces_[i].box;
      if ((round.min.array() < in.min.array()).all() && (round.max.array() > in.max.array()).all()) return true;
    }
    return false;
  };
  for (std::size_t i = 0; i < pieces_.size(); ++i) {
    if ((winding[i] > kInside || winding[i] < kInsideOut) && !is_of_cavity(i)) find(pieces_[i].object);
  }
  return found;
}

std::string ViewpointCheck::name_of(std::uint32_t object) const {
  return object < scene_.objects.size() ? display_name(scene_.objects[object]) : "scene";
}

void ViewpointCheck::check(const Vec3& viewpoint, const std::string& name) const {
  for (std::size_t t = 0; t < piece_of_.size(); ++t) {
    Corners corners;
    for (std::size_t k = 0; k < 3; ++k) corners[k] = scene_.mesh.vertices[scene_.mesh.triangles[t][k]] - viewpoint;
    if (core::squared_distance_to_triangle(Vec3::Zero(), corners[0], corners[1], corners[2]) >=
        kOnSurface * kOnSurface) {
      continue;
    }
    const std::uint32_t object = object_of_[t];
    throw Error(ErrorCode::viewpoint_on_surface, name + " lies on a surface", "object '" + name_of(object) + "'",
                "move it off the surface, by 1 mm or more", object);
  }
  if (const auto object = solid_around(viewpoint)) {
    throw Error(ErrorCode::viewpoint_inside_solid, name + " lies inside a solid", "object '" + name_of(*object) + "'",
                "move it into the open", *object);
  }
}

}  // namespace vantage::internal::scene
