#include "query/leg_limit_of_parts.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace vantage::internal::query {
namespace {

class LegLimitOfParts : public LegLimit {
 public:
  LegLimitOfParts(LegPartLimit limit, std::shared_ptr<const sensor::SensorView> view)
      : limit_(std::move(limit)), view_(std::move(view)) {}

  void add_breaks(const Tube& tube, std::vector<LegBreak>& breaks) const override {
    const Tube local = tube.moved(-view_->target.origin);
    const std::vector<sensor::ViewedPart>& parts = view_->target.parts;
    LegIntervals broken;
    for (const sensor::ViewedPart& part : parts) {
      const LegIntervals of_part = limit_.broken(part, local);
      broken.insert(broken.end(), of_part.begin(), of_part.end());
    }
    add_break(breaks, limit_.name, limit_.unit, joined(std::move(broken)), [&](double share) {
      double worst = -INFINITY;
      for (const sensor::ViewedPart& part : parts) {
        worst = std::max(worst, limit_.amount(part, local.at(share), local.radius));
      }
      return worst;
    });
  }

 private:
  LegPartLimit limit_;
  std::shared_ptr<const sensor::SensorView> view_;
};

}  // namespace

std::unique_ptr<const LegLimit> leg_limit_of_parts(LegPartLimit limit,
                                                   const std::shared_ptr<const sensor::SensorView>& view) {
  return std::make_unique<LegLimitOfParts>(std::move(limit), view);
}

double turn_by(double radius, double distance) {
  if (radius == 0) return 0;
  return distance > radius ? std::asin(radius / distance) * (180 / std::numbers::pi) : 90;
}

}  // namespace vantage::internal::query
