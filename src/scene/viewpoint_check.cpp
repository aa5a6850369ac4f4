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

std::uint32_t root_of(std::vector<std::uint32_t>& parent, std::uint32_t at) {
  while (parent[at] != at) at = parent[at] = parent[parent[at]];
  return at;
}

}  // namespace

ViewpointCheck::ViewpointCheck(const Scene& scene) : scene_(scene) {
  const std::vector<std::uint32_t> weld = core::first_at_position(scene.mesh.vertices);
  std::vector<std::uint32_t> parent = weld;
  for (const Triangle& t : scene.mesh.triangles) {
    const std::uint32_t root = root_of(parent, weld[t[0]]);
    parent[root_of(parent, weld[t[1]])] = root;
    parent[root_of(parent, weld[t[2]])] = root;
  }
  constexpr std::uint32_t kNone = ~std::uint32_t{0};
  std::vector<std::uint32_t> piece(scene.mesh.vertices.size(), kNone);  // by root
  piece_of_.reserve(scene.mesh.triangles.size());
  for (const Triangle& t : scene.mesh.triangles) {
    std::uint32_t& number = piece[root_of(parent, weld[t[0]])];
    if (number == kNone) number = static_cast<std::uint32_t>(pieces_++);
    piece_of_.push_back(number);
  }
}

ViewpointCheck::Place ViewpointCheck::look(const Vec3& viewpoint) const {
  std::vector<double> angle(pieces_, 0.0), of_object(scene_.objects.size(), 0.0);
  for (std::size_t t = 0; t < piece_of_.size(); ++t) {
    Corners corners;
    for (std::size_t k = 0; k < 3; ++k) corners[k] = scene_.mesh.vertices[scene_.mesh.triangles[t][k]] - viewpoint;
    if (core::squared_distance_to_triangle(Vec3::Zero(), corners[0], corners[1], corners[2]) <
        kOnSurface * kOnSurface) {
      return {scene_.object_of[t], {}};
    }
    const double seen = solid_angle(corners);
    angle[piece_of_[t]] += seen;
    of_object[scene_.object_of[t]] += seen;
  }
  for (std::size_t t = 0; t < piece_of_.size(); ++t) {
    const double winding = angle[piece_of_[t]] / (4 * std::numbers::pi);
    const double whole = of_object[scene_.object_of[t]] / (4 * std::numbers::pi);
    if (!(winding <= kInside && winding >= kInsideOut && whole <= kInside)) return {{}, scene_.object_of[t]};
  }
  return {};
}

void ViewpointCheck::check(const Vec3& viewpoint, const std::string& name) const {
  const auto [surface, solid] = look(viewpoint);
  if (surface) {
    throw Error(ErrorCode::viewpoint_on_surface, name + " lies on a surface",
                "object '" + display_name(scene_.objects[*surface]) + "'", "move it off the surface, by 1 mm or more",
                *surface);
  }
  if (solid) {
    throw Error(ErrorCode::viewpoint_inside_solid, name + " lies inside a solid",
                "object '" + display_name(scene_.objects[*solid]) + "'", "move it into the open", *solid);
  }
}

}  // namespace vantage::internal::scene
