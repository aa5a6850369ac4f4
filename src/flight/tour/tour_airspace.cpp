// The airspace of a scene: the exact distance of legs from its surfaces, and the limits of navigation.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "vantage/error.h"
#include "vantage/query.h"
#include "vantage/tour.h"

namespace vantage {
namespace {

/// What a leg may deviate at most is known only when it is asked for: so far beyond the clearance the scene is
/// searched.
constexpr double kMostDeviation = 2;

LegDistanceOptions options_of(double distance_m) {
  LegDistanceOptions options;
  options.cutoff_m = distance_m + kMostDeviation;
  options.without_ground = true;
  return options;
}

/// Only the ground. Nothing where the scene has none.
std::unique_ptr<LegDistances> ground_distances(const PreparedScene& scene, double tube_m) {
  LegDistanceOptions options;
  options.cutoff_m = tube_m + kMostDeviation;
  options.without_overhead = true;
  for (std::uint32_t i = 0; i < scene.objects().size(); ++i) {
    if (scene.objects()[i].kind != ObjectKind::ground) options.without_objects.push_back(i);
  }
  if (options.without_objects.size() == scene.objects().size()) return nullptr;
  return std::make_unique<LegDistances>(scene, options);
}

/// Around all positions that the limits allow, or more.
Box bounds_of(const Navigation& navigation) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Box bounds = {Vec3::Constant(-kInfinity), Vec3::Constant(kInfinity)};
  if (!navigation.keep_in.empty()) {
    Box allowed;
    for (const Zone& zone : navigation.keep_in) {
      for (const Eigen::Vector2d& corner : zone.outer) {
        allowed.extend(Vec3(corner.x(), corner.y(), zone.min_z_m));
        allowed.extend(Vec3(corner.x(), corner.y(), zone.max_z_m));
      }
    }
    bounds = allowed;
  }
  const auto cut = [&](const Box& box) {
    bounds.min = bounds.min.cwiseMax(box.min);
    bounds.max = bounds.max.cwiseMin(box.max);
  };
  for (const KeepInMesh& mesh : navigation.meshes) cut(bounding_box(mesh.mesh));
  if (navigation.altitude) {
    bounds.min.z() = std::max(bounds.min.z(), navigation.altitude->min_m);
    bounds.max.z() = std::min(bounds.max.z(), navigation.altitude->max_m);
  }
  return bounds;
}

class SceneAirspace : public Airspace {
 public:
  SceneAirspace(const PreparedScene& scene, double clearance_m, const Navigation& navigation, double tube_m)
      : distances_(scene, options_of(clearance_m + tube_m)),
        ground_(ground_distances(scene, tube_m)),
        limits_(navigation),
        clearance_(clearance_m),
        tube_(tube_m),
        has_limits_(!navigation.empty()),
        bounds_(bounds_of(navigation)) {}

  bool allows(const Leg& leg, double deviation_m) const override {
    return !is_near(distances_.nearest(leg), deviation_m) && !meets_ground(leg, deviation_m) &&
           (!has_limits_ || limits_.broken(leg, tube_ + deviation_m).empty());
  }

  std::string obstacle(const Leg& leg, double deviation_m) const override {
    const LegDistance nearest = distances_.nearest(leg);
    if (is_near(nearest, deviation_m)) return nearest.name;
    if (meets_ground(leg, deviation_m)) return "the ground";
    if (!has_limits_) return {};
    const std::vector<LegBreak> broken = limits_.broken(leg, tube_ + deviation_m);
    return broken.empty() ? std::string() : broken.front().limit;
  }

  Box bounds() const override { return bounds_; }

 private:
  bool is_near(const LegDistance& nearest, double deviation) const {
    if (deviation > kMostDeviation) return true;  // not certain
    const double least = clearance_ + tube_ + deviation;
    // Without a clearance, surfaces are still not passed through.
    return least > 0 ? nearest.distance_m < least : nearest.distance_m <= 0;
  }

  /// No clearance is kept from it, but nothing flies through it.
  bool meets_ground(const Leg& leg, double deviation) const {
    return ground_ && !(ground_->nearest(leg).distance_m > tube_ + deviation);
  }

  LegDistances distances_;
  std::unique_ptr<LegDistances> ground_;
  LegLimits limits_;
  double clearance_, tube_;
  bool has_limits_;
  Box bounds_;
};

}  // namespace

std::shared_ptr<const Airspace> make_airspace(const PreparedScene& scene, double clearance_m,
                                              const Navigation& navigation, double tube_m) {
  const auto require = [](double value, const char* what) {
    if (value >= 0 && std::isfinite(value)) return;
    throw Error(ErrorCode::value_out_of_range, std::string("the ") + what + " is not a number of at least 0",
                std::string("tour.") + what, "give metres");
  };
  require(clearance_m, "clearance");
  require(tube_m, "tube");
  return std::make_shared<SceneAirspace>(scene, clearance_m, navigation, tube_m);
}

}  // namespace vantage
