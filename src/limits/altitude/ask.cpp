#include <cmath>

#include "query/line_crossings.h"
#include "query/point_limit.h"

namespace vantage::internal::query {
namespace {

class AltitudeOfPoint : public PointLimit {
 public:
  explicit AltitudeOfPoint(const Navigation::Altitude& altitude) : altitude_(altitude) {}

  void add_broken(const Vec3& point, std::vector<std::string>& broken) const override {
    if (point.z() < altitude_.min_m) broken.emplace_back("altitude min");
    if (point.z() > altitude_.max_m) broken.emplace_back("altitude max");
  }
  void add_crossings(const ViewRay& line, std::vector<double>& cuts) const override {
    Box band;
    band.min = {-INFINITY, -INFINITY, altitude_.min_m};
    band.max = {INFINITY, INFINITY, altitude_.max_m};
    add_box_crossings(band, line, cuts);
  }

 private:
  Navigation::Altitude altitude_;
};

}  // namespace

template <>
std::unique_ptr<const PointLimit> point_limit<Limit::altitude>(const Navigation::Altitude& altitude,
                                                               GroundPool& /*grounds*/) {
  return std::make_unique<AltitudeOfPoint>(altitude);
}

}  // namespace vantage::internal::query
