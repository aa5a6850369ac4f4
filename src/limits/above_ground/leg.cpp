#include "query/leg_limit.h"

namespace vantage::internal::query {
namespace {

class HeightOfLeg : public LegLimit {
 public:
  HeightOfLeg(const AboveGround& band, LegGroundPool& grounds)
      : low_(band.min_m), high_(band.max_m), ground_(grounds.of(band.ground)) {}

  void add_breaks(const Tube& tube, std::vector<LegBreak>& breaks) const override {
    constexpr auto kMetres = LegBreak::Unit::metres;
    add_break(breaks, "ground edge", kMetres, ground_->beside(tube),
              [&](double share) { return ground_->plan_distance(tube.at(share)) + tube.radius; });
    add_break(breaks, "agl min", kMetres, ground_->below(tube, low_), [&](double share) {
      const auto heights = ground_->heights(tube.at(share));
      return heights ? low_ - heights->above_highest + tube.radius : 0;
    });
    add_break(breaks, "agl max", kMetres, ground_->over(tube, high_), [&](double share) {
      const auto heights = ground_->heights(tube.at(share));
      return heights ? heights->above_lowest - high_ + tube.radius : 0;
    });
  }

 private:
  double low_, high_;
  std::shared_ptr<const LegGround> ground_;
};

}  // namespace

template <>
std::unique_ptr<const LegLimit> leg_limit<Limit::above_ground>(const AboveGround& band, LegGroundPool& grounds) {
  return std::make_unique<HeightOfLeg>(band, grounds);
}

}  // namespace vantage::internal::query
