#include "prove/limits_beyond.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "prove/distance.h"
#include "vantage/each_limit.h"

namespace vantage::internal::prove {
namespace {

/// The volumes of docs/camera.md are cut to facets inside of what is allowed; so much less, in parts of the limit, is
/// asked for. A cone of 128 sides loses 3.1e-4 of its tangent.
constexpr double kConeShare = 4e-4, kBallShare = 3e-3;
constexpr double kLargest = 1e9;  // of coordinates: boxes may be larger
constexpr double kDegree = std::numbers::pi / 180;

bool all_of(const MovedPiece& piece, const std::function<bool(const Vec3&)>& holds) {
  return std::all_of(piece.corners.begin(), piece.corners.end(), holds);
}

bool is_inside(const MovedPiece& piece, const Box& box) {
  return all_of(piece,
                [&](const Vec3& at) { return (at.array() >= box.min.array() && at.array() <= box.max.array()).all(); });
}

Box grown_by(const Box& box, double by_m) { return {box.min - Vec3::Constant(by_m), box.max + Vec3::Constant(by_m)}; }

/// By one of the box's sides.
bool is_apart(const MovedPiece& piece, const Box& box) {
  for (Eigen::Index k = 0; k < 3; ++k) {
    if (all_of(piece, [&](const Vec3& at) { return at[k] > box.max[k]; })) return true;
    if (all_of(piece, [&](const Vec3& at) { return at[k] < box.min[k]; })) return true;
  }
  return false;
}

class LimitCollector {
 public:
  LimitCollector(const Navigation& navigation, const Sensor& sensor, const View& view)
      : navigation_(navigation), sensor_(sensor), view_(view) {}

  LimitsBeyond collect() {
    each_limit(navigation_, *this);
    each_limit(sensor_, *this);
    return std::move(found_);
  }

  void operator()(LimitIs<Limit::altitude> /*limit*/, const Navigation::Altitude& altitude) {
    add_band("altitude", altitude.min_m, altitude.max_m);
  }
  void operator()(LimitIs<Limit::above_ground> limit, const AboveGround& band) {
    if (band.ground.surface) return leave(limit);
    add_band("agl", band.ground.plane_z_m + band.min_m, band.ground.plane_z_m + band.max_m);
  }
  void operator()(LimitIs<Limit::keep_in> limit, const std::vector<Zone>& zones) {
    if (!are_boxes(zones)) return leave(limit);
    std::vector<Box> kept;
    for (const Zone& zone : zones) kept.push_back(grown_by(about_origin(zone.box()), -rounding_m(zone.box())));
    const bool holds_origin = (kept[0].min.array() <= 0 && kept[0].max.array() >= 0).all();
    add(WitnessKind::navigation, "keep_in", kept.size() == 1 && holds_origin, 0, [kept](const MovedPiece& piece) {
      return std::all_of(kept.begin(), kept.end(), [&](const Box& box) { return is_apart(piece, box); });
    });
  }
  void operator()(LimitIs<Limit::keep_out> limit, const std::vector<Zone>& zones) {
    if (!are_boxes(zones)) leave(limit);
    for (std::size_t i = 0; i < zones.size(); ++i) {
      if (!zones[i].is_box) continue;
      const Box box = grown_by(about_origin(zones[i].box()), rounding_m(zones[i].box()));
      add(WitnessKind::navigation, "keep_out " + zone_name(zones, i), false, 0,
          [box](const MovedPiece& piece) { return is_inside(piece, box); });
    }
  }
  void operator()(LimitIs<Limit::meshes> limit, const std::vector<KeepInMesh>& /*meshes*/) { leave(limit); }
  void operator()(LimitIs<Limit::clearance> limit, const Clearance& /*clearance*/) { leave(limit); }
  void operator()(LimitIs<Limit::frame> limit, const Pinhole& /*camera*/) { leave(limit); }
  void operator()(LimitIs<Limit::incidence> /*limit*/, double incidence_deg) { add_incidence(incidence_deg); }
  void operator()(LimitIs<Limit::pixel> /*limit*/, const PixelLimit& pixel) {
    add_pixel(pixel.size_m * *sensor_.camera->focal_px / 2);
  }
  void operator()(LimitIs<Limit::min_range> /*limit*/, double min_range_m) { add_min_range(min_range_m); }
  void operator()(LimitIs<Limit::sun> /*limit*/, const SunLimit& sun) { add_sun(sun); }

 private:
  using Breaks = std::function<bool(const MovedPiece&)>;

  void leave(Limit limit) { found_.without_argument.emplace_back(name_of(limit)); }
  static bool are_boxes(const std::vector<Zone>& zones) {
    return std::all_of(zones.begin(), zones.end(), [](const Zone& zone) { return zone.is_box; });
  }
  void add(WitnessKind kind, std::string name, bool begins_once, double tolerance, Breaks breaks) {
    found_.limits.push_back({kind, std::move(name), begins_once, tolerance, std::move(breaks)});
  }
  Box about_origin(const Box& box) const { return {box.min - view_.origin, box.max - view_.origin}; }
  /// The rounding of the coordinates of cut faces, at sides of a box.
  double rounding_m(const Box& box) const {
    double largest = view_.origin.cwiseAbs().maxCoeff();
    for (const Vec3& corner : {box.min, box.max}) {
      largest = std::max(largest, corner.cwiseAbs().cwiseMin(kLargest).maxCoeff());
    }
    return 64 * std::numeric_limits<double>::epsilon() * largest;
  }

  /// On a line from the target, what is over a height stays over it, if the target is not.
  void add_band(const std::string& name, double low, double high) {
    const double from = low - view_.origin.z(), to = high - view_.origin.z();
    add(WitnessKind::navigation, name + " min", from <= 0, 0,
        [from](const MovedPiece& piece) { return all_of(piece, [&](const Vec3& at) { return at.z() < from; }); });
    add(WitnessKind::navigation, name + " max", to >= 0, 0,
        [to](const MovedPiece& piece) { return all_of(piece, [&](const Vec3& at) { return at.z() > to; }); });
  }

  /// Beyond a plane that touches the cone at a corner, along the facet.
  void add_incidence(double incidence_deg) {
    const double slope = std::tan(incidence_deg * kDegree) * (1 - kConeShare);
    add(WitnessKind::sensor, "incidence", false, kConeShare, [slope, view = view_](const MovedPiece& piece) {
      const Vec3 across = piece.outward - view.normal.dot(piece.outward) * view.normal;
      if (!(across.norm() > 0)) return false;
      const Vec3 plane = across.normalized() - slope * view.normal;
      return std::any_of(view.whole.begin(), view.whole.end(), [&](const Vec3& corner) {
        return all_of(piece, [&](const Vec3& at) { return plane.dot(at - corner) > 0; });
      });
    });
  }
  /// Outside of a ball that touches the target's plane in a corner.
  void add_pixel(double radius) {
    add(WitnessKind::sensor, "pixel", false, kBallShare, [radius, view = view_](const MovedPiece& piece) {
      return std::any_of(view.whole.begin(), view.whole.end(), [&](const Vec3& corner) {
        return distance_from(corner + radius * view.normal, piece.corners) > (1 - kBallShare) * radius;
      });
    });
  }
  /// What is too near to some point of the target is convex.
  void add_min_range(double min_range_m) {
    const double least = (1 + kBallShare) * min_range_m;
    add(WitnessKind::sensor, "min_range", false, kBallShare, [least, view = view_](const MovedPiece& piece) {
      return all_of(piece, [&](const Vec3& at) { return distance_from_polygon(at, view.whole) < least; });
    });
  }
  /// So is what lies behind the target as seen from near the sun.
  void add_sun(const SunLimit& limit) {
    const Vec3 sun = unit(limit.direction);
    const bool is_half = limit.exclude_deg >= 90;
    const double slope = std::tan(limit.exclude_deg * kDegree) * (1 + kConeShare);
    add(WitnessKind::sensor, "sun", false, kConeShare, [=, view = view_](const MovedPiece& piece) {
      return all_of(piece, [&](const Vec3& at) {
        const auto is_near = [&](const Vec3& target_point) {
          const Vec3 way = target_point - at;
          const double along = sun.dot(way);
          return along > 0 && (is_half || (way - along * sun).norm() < slope * along);
        };
        return any_point_of(view.whole, is_near,
                            [&](const Vec3& target_point) { return (target_point - at).normalized().dot(sun); });
      });
    });
  }

  const Navigation& navigation_;
  const Sensor& sensor_;
  const View& view_;
  LimitsBeyond found_;
};

}  // namespace

LimitsBeyond limits_beyond(const Navigation& navigation, const Sensor& sensor, const View& view) {
  return LimitCollector(navigation, sensor, view).collect();
}

}  // namespace vantage::internal::prove
