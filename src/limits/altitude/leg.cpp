#include "query/leg_convex.h"
#include "query/leg_limit.h"

namespace vantage::internal::query {
namespace {

/// Where some of the tube is strictly below a height, or above one.
LegIntervals below_height(const Tube& tube, double z) {
  return where_positive(z - tube.leg.from.z() + tube.radius, z - tube.leg.to.z() + tube.radius);
}
LegIntervals above_height(const Tube& tube, double z) {
  return where_positive(tube.leg.from.z() - z + tube.radius, tube.leg.to.z() - z + tube.radius);
}

class AltitudeOfLeg : public LegLimit {
 public:
  explicit AltitudeOfLeg(const Navigation::Altitude& altitude) : altitude_(altitude) {}

  void add_breaks(const Tube& tube, std::vector<LegBreak>& breaks) const override {
    const double low = altitude_.min_m, high = altitude_.max_m;
    add_break(breaks, "altitude min", LegBreak::Unit::metres, below_height(tube, low),
              [&](double share) { return low - tube.at(share).z() + tube.radius; });
    add_break(breaks, "altitude max", LegBreak::Unit::metres, above_height(tube, high),
              [&](double share) { return tube.at(share).z() - high + tube.radius; });
  }

 private:
  Navigation::Altitude altitude_;
};

}  // namespace

template <>
std::unique_ptr<const LegLimit> leg_limit<Limit::altitude>(const Navigation::Altitude& altitude,
                                                           LegGroundPool& /*grounds*/) {
  return std::make_unique<AltitudeOfLeg>(altitude);
}

}  // namespace vantage::internal::query
