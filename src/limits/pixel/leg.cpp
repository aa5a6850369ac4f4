#include <algorithm>
#include <cmath>

#include "query/leg_limit_of_parts.h"

namespace vantage::internal::query {
namespace {

/// Those of this radius that touch a part's plane in its corners.
class Balls {
 public:
  explicit Balls(double radius) : radius_(radius) {}

  LegIntervals left_by(const sensor::ViewedPart& part, const Tube& tube) const {
    LegIntervals kept{{0, 1}};
    for (const Vec3& corner : part.corners) {
      const auto in_ball = ball_part(tube.leg.from, tube.leg.to, centre(part, corner), radius_ - tube.radius);
      kept = in_ball ? common(kept, {*in_ball}) : LegIntervals{};
    }
    return rest_of(kept);
  }
  double beyond(const sensor::ViewedPart& part, const Vec3& place, double radius) const {
    double worst = -INFINITY;
    for (const Vec3& corner : part.corners) worst = std::max(worst, (place - centre(part, corner)).norm());
    return worst - radius_ + radius;
  }

 private:
  Vec3 centre(const sensor::ViewedPart& part, const Vec3& corner) const { return corner + radius_ * *part.normal; }

  double radius_;
};

}  // namespace

template <>
std::unique_ptr<const LegLimit> leg_limit<Limit::pixel>(const PixelLimit& pixel,
                                                        const std::shared_ptr<const sensor::SensorView>& view) {
  const Balls balls(0.5 * pixel.size_m * *view->sensor.camera->focal_px);
  return leg_limit_of_parts(
      {.name = "pixel",
       .unit = LegBreak::Unit::metres,
       .broken = [balls](const sensor::ViewedPart& part, const Tube& tube) { return balls.left_by(part, tube); },
       .amount = [balls](const sensor::ViewedPart& part, const Vec3& place,
                         double radius) { return balls.beyond(part, place, radius); }},
      view);
}

}  // namespace vantage::internal::query
