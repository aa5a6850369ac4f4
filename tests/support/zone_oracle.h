// The obvious way to tell whether something enters the zone of a radio link: every triangle, on the map that makes a
// ball of the ellipsoid. Shares nothing with the library.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "vantage/geometry.h"
#include "vantage/sensor.h"

namespace vantage::testing {

class ZoneOracle {
 public:
  ZoneOracle(const Mesh& mesh, const Vec3& antenna, const RadioLink& link)
      : mesh_(mesh), antenna_(antenna), excess_(link.clear * link.clear * 0.299792458 / link.frequency_ghz / 2) {}

  /// How deep the scene comes into the zone of the position: 0 at its middle, 1 on its surface, more outside.
  double share(const Vec3& position) const {
    const Vec3 way = position - antenna_;
    const double t = way.norm(), half_length = (t + excess_) / 2;
    const Vec3 axis = t > 0 ? Vec3(way / t) : Vec3::UnitZ();
    const auto mapped = [&](const Vec3& point) -> Vec3 {
      const Vec3 x = point - antenna_ - way / 2;
      const double along = axis.dot(x);
      return along / half_length * axis + (x - along * axis) / radius(position);
    };
    double least = std::numeric_limits<double>::infinity();
    for (const Triangle& t3 : mesh_.triangles) {
      least = std::min(
          least, nearest(mapped(mesh_.vertices[t3[0]]), mapped(mesh_.vertices[t3[1]]), mapped(mesh_.vertices[t3[2]])));
    }
    return least;
  }

  /// Of the zone in its middle, metres.
  double radius(const Vec3& position) const {
    const double t = (position - antenna_).norm();
    return std::sqrt((t + excess_) * (t + excess_) - t * t) / 2;
  }

 private:
  /// Distance of the triangle from the origin.
  static double nearest(const Vec3& a, const Vec3& b, const Vec3& c) {
    const Vec3 normal = (b - a).cross(c - a);
    const double size = normal.norm();
    const auto left = [&](const Vec3& p, const Vec3& q) { return normal.dot((q - p).cross(-p)) >= 0; };
    if (size > 0 && left(a, b) && left(b, c) && left(c, a)) return std::abs(normal.dot(a)) / size;
    const auto side = [](const Vec3& p, const Vec3& q) {
      const Vec3 d = q - p;
      const double s = d.squaredNorm() > 0 ? std::clamp(-p.dot(d) / d.squaredNorm(), 0.0, 1.0) : 0;
      return (p + s * d).norm();
    };
    return std::min({side(a, b), side(b, c), side(c, a)});
  }

  const Mesh& mesh_;
  Vec3 antenna_;
  double excess_;
};

}  // namespace vantage::testing
