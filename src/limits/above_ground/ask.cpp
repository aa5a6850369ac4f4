#include "query/line_crossings.h"
#include "query/point_limit.h"

namespace vantage::internal::query {
namespace {

class HeightOfPoint : public PointLimit {
 public:
  HeightOfPoint(const AboveGround& band, GroundPool& grounds) : band_(band), ground_(grounds.of(band.ground)) {}

  void add_broken(const Vec3& point, std::vector<std::string>& broken) const override {
    const auto ground = ground_->at(point.x(), point.y());
    if (!ground) {
      broken.emplace_back("ground edge");
      return;
    }
    if (point.z() < ground->highest_m + band_.min_m) broken.emplace_back("agl min");
    if (point.z() > ground->lowest_m + band_.max_m) broken.emplace_back("agl max");
  }
  void add_crossings(const ViewRay& line, std::vector<double>& cuts) const override {
    add_band_crossings(band_, *ground_, line, cuts);
  }

 private:
  AboveGround band_;
  std::shared_ptr<const GroundHeights> ground_;
};

}  // namespace

template <>
std::unique_ptr<const PointLimit> point_limit<Limit::above_ground>(const AboveGround& band, GroundPool& grounds) {
  return std::make_unique<HeightOfPoint>(band, grounds);
}

}  // namespace vantage::internal::query
