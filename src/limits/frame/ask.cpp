#include <utility>
#include <vector>

#include "query/point_limit.h"
#include "sensor/best_aim.h"
#include "sensor/find_aim.h"

namespace vantage::internal::query {

namespace {

class FrameOfPoint : public PointLimit {
 public:
  FrameOfPoint(const Pinhole& camera, std::shared_ptr<const sensor::SensorView> view)
      : camera_(camera), view_(std::move(view)) {}

  void add_broken(const Vec3& scene_point, std::vector<std::string>& broken) const override {
    const Vec3 point = scene_point - view_->target.origin;
    const Mount& mount = view_->sensor.mount;
    if (fits(point, mount)) return;
    const Mount free{.yaw_deg = {}, .roll_deg = mount.roll_deg};
    broken.emplace_back(fits(point, free) ? "gimbal" : "frame");
  }

  /// From a point among the corners a camera that takes them all in goes on doing so farther out.
  void add_crossings(const ViewRay& line, std::vector<double>& cuts) const override {
    const Vec3 start = line.origin - view_->target.origin;
    std::vector<Vec3> corners;
    for (const Vec3& corner : view_->target.corners) corners.push_back(corner - start);
    const sensor::AimFinder finder(corners, camera_, view_->sensor.mount, 0);
    const double distance = finder.best(line.direction).distance(line.direction);
    if (distance < line.reach) cuts.push_back(distance);
  }

 private:
  bool fits(const Vec3& point, const Mount& mount) const {
    const std::vector<Vec3>& corners = view_->target.corners;
    // Mostly an aim that is good enough is found at once, from how the target lies.
    const double distance = point.norm();
    if (distance > 0) {
      const sensor::AimFinder finder(corners, camera_, mount, 0);
      const Vec3 direction = point / distance;
      if (finder.best(direction).distance(direction) <= distance) return true;
    }
    std::vector<Vec3> seen;
    seen.reserve(corners.size());
    for (const Vec3& corner : corners) seen.push_back(corner - point);
    return sensor::find_aim(camera_, mount, seen).aim.has_value();
  }

  Pinhole camera_;
  std::shared_ptr<const sensor::SensorView> view_;
};

}  // namespace

template <>
std::unique_ptr<const PointLimit> point_limit<Limit::frame>(const Pinhole& camera,
                                                            const std::shared_ptr<const sensor::SensorView>& view) {
  return std::make_unique<FrameOfPoint>(camera, view);
}

}  // namespace vantage::internal::query
