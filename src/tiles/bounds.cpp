#include "tiles/bounds.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace vantage::internal::tiles {
namespace {

constexpr double kRadian = 180 / std::numbers::pi;
// Nothing of a city lies farther above or below the ellipsoid, in metres; on the other side of the earth all does.
constexpr double kTallestM = 20e3;

std::vector<double> volume_numbers(const Json& values, std::size_t count, const std::string& name) {
  if (!values.is_array() || values.size() != count) {
    throw "a bounding " + name + " does not hold " + std::to_string(count) + " numbers";
  }
  std::vector<double> result;
  for (const Json& value : values) {
    const double number = value.is_number() ? value.get<double>() : NAN;
    if (!std::isfinite(number)) throw "a bounding " + name + " holds something other than numbers";
    result.push_back(number);
  }
  return result;
}

}  // namespace

Volume parse_volume(const Json& described) {
  if (!described.is_object()) throw std::string("\"boundingVolume\" is not an object");
  if (const auto box = described.find("box"); box != described.end()) {
    const std::vector<double> n = volume_numbers(*box, 12, "box");
    OrientedBox result{{n[0], n[1], n[2]}, {}};
    result.half_axes << n[3], n[6], n[9], n[4], n[7], n[10], n[5], n[8], n[11];
    return result;
  }
  if (const auto region = described.find("region"); region != described.end()) {
    const std::vector<double> n = volume_numbers(*region, 6, "region");
    return EarthRegion{n[0], n[1], n[2], n[3], n[4], n[5]};
  }
  if (const auto sphere = described.find("sphere"); sphere != described.end()) {
    const std::vector<double> n = volume_numbers(*sphere, 4, "sphere");
    return Sphere{{n[0], n[1], n[2]}, std::abs(n[3])};
  }
  // Cells of S2 are on the WGS 84 ellipsoid: which of it matters to those alone who have the library.
  const auto extensions = described.find("extensions");
  if (extensions != described.end() && extensions->is_object() && extensions->contains("3DTILES_bounding_volume_S2")) {
    constexpr double kHalfTurn = std::numbers::pi;
    return EarthRegion{-kHalfTurn, -kHalfTurn / 2, kHalfTurn, kHalfTurn / 2, -kTallestM, kTallestM};
  }
  return Everywhere{};
}

Volume moved(const Volume& volume, const Transform& transform) {
  if (const auto* const box = std::get_if<OrientedBox>(&volume)) {
    return OrientedBox{transform * box->center, transform.linear() * box->half_axes};
  }
  if (const auto* const sphere = std::get_if<Sphere>(&volume)) {
    // Columns of a matrix that also shears may stretch more than each of them: their root mean square times the root of
    // three is never too small.
    const Eigen::Matrix3d squares = transform.linear().transpose() * transform.linear();
    const bool is_similar = (squares - squares(0, 0) * Eigen::Matrix3d::Identity()).norm() <= 1e-9 * squares.norm();
    const double stretch = is_similar ? std::sqrt(squares(0, 0)) * (1 + 1e-9) : transform.linear().norm();
    return Sphere{transform * sphere->center, sphere->radius * stretch};
  }
  return volume;
}

std::optional<Sphere> around(const Volume& volume) {
  if (const auto* const box = std::get_if<OrientedBox>(&volume)) {
    return Sphere{box->center, box->half_axes.colwise().norm().sum()};
  }
  if (const auto* const sphere = std::get_if<Sphere>(&volume)) return *sphere;
  if (const auto* const region = std::get_if<EarthRegion>(&volume)) {
    const double east = region->east < region->west ? region->east + 2 * std::numbers::pi : region->east;
    const geo::LonLat middle{std::remainder((region->west + east) / 2 * kRadian, 360),
                             (region->south + region->north) / 2 * kRadian};
    const double half = std::hypot((east - region->west) / 2, (region->north - region->south) / 2);
    return Sphere{geo::to_ecef({middle, (region->low + region->high) / 2}),
                  half * (geo::kEquatorM + region->high) + std::abs(region->high - region->low)};
  }
  return std::nullopt;
}

namespace {

std::vector<Vec3> box_corners(const OrientedBox& box) {
  std::vector<Vec3> corners;
  for (unsigned i = 0; i < 8; ++i) {
    const Vec3 sign((i & 1U) != 0 ? 1 : -1, (i & 2U) != 0 ? 1 : -1, (i & 4U) != 0 ? 1 : -1);
    corners.emplace_back(box.center + box.half_axes * sign);
  }
  return corners;
}

}  // namespace

std::vector<Vec3> corners_of(const Volume& volume, World world) {
  constexpr double kWidest = 0.1;  // radians
  constexpr int kSteps = 16;       // between them the ellipsoid bulges by less than 1e-3 of a region's width
  if (const auto* const box = std::get_if<OrientedBox>(&volume)) return box_corners(*box);
  if (const auto* const ball = std::get_if<Sphere>(&volume)) {
    return box_corners({ball->center, ball->radius * Eigen::Matrix3d::Identity()});
  }
  const auto* const region = std::get_if<EarthRegion>(&volume);
  if (!region || world != World::earth) return {};
  const double width = region->east - region->west + (region->east < region->west ? 2 * std::numbers::pi : 0);
  const double height = region->north - region->south;
  if (!(width >= 0 && width <= kWidest && height >= 0 && height <= kWidest && region->low <= region->high)) return {};
  if (std::abs(region->south) > std::numbers::pi / 2 || std::abs(region->north) > std::numbers::pi / 2) return {};
  const auto at = [&](double u, double v) {
    return geo::LonLat{std::remainder((region->west + u * width) * kRadian, 360),
                       (region->south + v * height) * kRadian};
  };
  const geo::TangentFrame frame(at(0.5, 0.5));
  Box box;
  for (int i = 0; i <= kSteps; ++i) {
    for (int k = 0; k <= kSteps; ++k) {
      for (const double z : {region->low, region->high}) {
        box.extend(
            frame.to_local(geo::to_ecef({at(static_cast<double>(i) / kSteps, static_cast<double>(k) / kSteps), z})));
      }
    }
  }
  const Vec3 slack = 1e-3 * (box.max - box.min);
  const Vec3 half = (box.max - box.min) / 2 + slack;
  return box_corners(
      {frame.to_earth((box.min + box.max) / 2), frame.axes.transpose() * half.asDiagonal().toDenseMatrix()});
}

Reach::Reach(geo::LonLat center, double radius_m)
    : limited_(true),
      on_earth_(true),
      radius_(radius_m),
      place_(center),
      frame_(std::make_shared<geo::TangentFrame>(center)),
      map_(std::make_shared<geo::LocalFrame>(center)) {}

Reach::Reach(const Eigen::Vector2d& center, double radius) : limited_(true), radius_(radius), center_(center) {}

bool Reach::meets(const Volume& volume) const {
  if (!limited_) return true;
  if (const auto* const box = std::get_if<OrientedBox>(&volume)) return meets(*box);
  if (const auto* const region = std::get_if<EarthRegion>(&volume)) return !on_earth_ || meets(*region);
  const auto* const sphere = std::get_if<Sphere>(&volume);
  return !sphere || meets(OrientedBox{sphere->center, sphere->radius * Eigen::Matrix3d::Identity()});
}

/// A box in the plane is a polygon whose sides are its half axes: apart from the circle if they are apart along the
/// line between the middles, or along a side's normal.
bool Reach::meets(const OrientedBox& box) const {
  OrientedBox local = box;
  if (on_earth_) {
    local = {frame_->to_local(box.center), frame_->axes * box.half_axes};
    const double up = local.half_axes.row(2).cwiseAbs().sum();
    if (local.center.z() + up < -kTallestM || local.center.z() - up > kTallestM) return false;
  }
  const Eigen::Vector2d between = local.center.head<2>() - center_;
  if (!between.allFinite() || !local.half_axes.allFinite()) return true;
  const auto is_apart = [&](const Eigen::Vector2d& direction) {
    const double length = direction.norm();
    if (!(length > 0)) return false;
    const double reach = (direction.transpose() * local.half_axes.topRows<2>()).cwiseAbs().sum();
    return std::abs(direction.dot(between)) > (reach + radius_ * length) * (1 + 1e-9);
  };
  if (is_apart(between)) return false;
  for (int i = 0; i < 3; ++i) {
    if (is_apart({-local.half_axes(1, i), local.half_axes(0, i)})) return false;
  }
  return true;
}

/// The nearest place of a region is near the one that has the nearest longitude and latitude: they differ by less than
/// half a hundredth of the distance, up to 100 km and 85 degrees.
bool Reach::meets(const EarthRegion& region) const {
  constexpr double kSlack = 1 + 5e-3, kPolar = 85;
  const double south = region.south * kRadian, north = region.north * kRadian;
  if (std::abs(place_.latitude_deg) > kPolar || !(south <= north)) return true;
  if (!(std::max(south, -90.0) <= std::min(north, 90.0))) return true;
  const double latitude = std::clamp(place_.latitude_deg, std::max(south, -90.0), std::min(north, 90.0));
  const double west = region.west * kRadian, width = std::fmod(region.east * kRadian - west + 720, 360);
  const double beyond = std::fmod(place_.longitude_deg - west + 720, 360);  // from the west side, eastwards
  const bool is_all = region.east - region.west >= 2 * std::numbers::pi - 1e-9;
  double longitude = place_.longitude_deg;
  if (!is_all && beyond > width) longitude = beyond - width < 360 - beyond ? west + width : west;
  return map_->to_local({longitude, latitude}).norm() <= radius_ * kSlack + 1;
}

}  // namespace vantage::internal::tiles
