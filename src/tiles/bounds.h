// Bounding volumes of tiles (3D Tiles 1.1, section "Bounding volumes"), and which of them reach into a circle.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "geo/ellipsoid.h"

namespace vantage::internal::tiles {

using Json = nlohmann::json;
using Transform = Eigen::Affine3d;

/// All of space: where a tile does not say.
struct Everywhere {};
struct OrientedBox {
  Vec3 center;
  Eigen::Matrix3d half_axes;  ///< its columns
};
struct Sphere {
  Vec3 center;
  double radius = 0;
};
/// Radians, and metres above the ellipsoid. west > east: across the antimeridian.
struct EarthRegion {
  double west = 0, south = 0, east = 0, north = 0, low = 0, high = 0;
};
using Volume = std::variant<Everywhere, OrientedBox, Sphere, EarthRegion>;

/// A tile's or a content's "boundingVolume"; Everywhere for those that this version of 3D Tiles does not know. Throws
/// std::string, what is wrong.
Volume parse_volume(const Json& described);

/// Regions stay as they are: they are on the earth.
Volume moved(const Volume& volume, const Transform& transform);

/// Where a volume is: the middle and a distance that nothing of it is beyond. Nothing of Everywhere.
std::optional<Sphere> around(const Volume& volume);

/// What a tileset's coordinates are.
enum class World {
  earth,      ///< ECEF
  projected,  ///< x and y in a coordinate reference system
  nowhere     ///< metres of no known place
};

/// Corners of a box that a volume lies in, as io::hexahedron takes them. None of Everywhere, of regions that are more
/// than a tenth of the earth's radius wide (nobody could see past them), and of those on the earth where the
/// coordinates are not.
std::vector<Vec3> corners_of(const Volume& volume, World world);

/// A circle seen from above. Without one everything is in it.
class Reach {
 public:
  Reach() = default;
  /// On the earth.
  Reach(geo::LonLat center, double radius_m);
  /// In a plane, in its units.
  Reach(const Eigen::Vector2d& center, double radius);

  bool is_limited() const { return limited_; }
  /// Never wrong where it says no.
  bool meets(const Volume& volume) const;

 private:
  bool meets(const OrientedBox& box) const;
  bool meets(const EarthRegion& region) const;

  bool limited_ = false, on_earth_ = false;
  double radius_ = 0;
  Eigen::Vector2d center_ = Eigen::Vector2d::Zero();  ///< of a plane
  geo::LonLat place_;
  std::shared_ptr<const geo::TangentFrame> frame_;
  std::shared_ptr<const geo::LocalFrame> map_;
};

}  // namespace vantage::internal::tiles
