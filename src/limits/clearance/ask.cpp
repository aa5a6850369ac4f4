#include "query/obstacle_distance.h"
#include "query/point_limit.h"

namespace vantage::internal::query {
namespace {

class ClearanceOfPoint : public PointLimit {
 public:
  explicit ClearanceOfPoint(const Clearance& clearance) : obstacles_(clearance) {}

  void add_broken(const Vec3& point, std::vector<std::string>& broken) const override {
    if (obstacles_.is_too_near(point)) broken.emplace_back("clearance");
  }
  void add_crossings(const ViewRay& line, std::vector<double>& cuts) const override {
    obstacles_.add_crossings(line.origin, line.direction, line.reach, cuts);
  }

 private:
  ObstacleDistance obstacles_;
};

}  // namespace

template <>
std::unique_ptr<const PointLimit> point_limit<Limit::clearance>(const Clearance& clearance, GroundPool& /*grounds*/) {
  return std::make_unique<ClearanceOfPoint>(clearance);
}

}  // namespace vantage::internal::query
