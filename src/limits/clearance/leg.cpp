#include "query/leg_limit.h"

namespace vantage::internal::query {
namespace {

class ClearanceOfLeg : public LegLimit {
 public:
  explicit ClearanceOfLeg(const Clearance& clearance)
      : distance_m_(clearance.distance_m), obstacles_(*clearance.obstacles) {}

  void add_breaks(const Tube& tube, std::vector<LegBreak>& breaks) const override {
    add_break(breaks, "clearance", LegBreak::Unit::metres, too_near(obstacles_, tube, distance_m_), [&](double share) {
      return distance_m_ + tube.radius - obstacles_.distance(tube.at(share) - obstacles_.origin());
    });
  }

 private:
  double distance_m_;
  LegTriangles obstacles_;
};

}  // namespace

template <>
std::unique_ptr<const LegLimit> leg_limit<Limit::clearance>(const Clearance& clearance, LegGroundPool& /*grounds*/) {
  return std::make_unique<ClearanceOfLeg>(clearance);
}

}  // namespace vantage::internal::query
