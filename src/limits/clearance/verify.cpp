#include "verify/limit_probe.h"
#include "verify/obstacle_probe.h"

namespace vantage::internal::verify {
namespace {

class ClearanceProbe : public LimitProbe {
 public:
  explicit ClearanceProbe(const Clearance& clearance) : obstacles_(clearance) {}

  std::optional<std::string> broken_by(const JudgedPoint& point) const override {
    if (obstacles_.is_too_near(point.scene)) return "clearance";
    return std::nullopt;
  }

  /// What is cut away reaches too far beside edges and round corners (docs/mission-file.md).
  bool may_leave_out(const JudgedPoint& point) const override {
    constexpr double kSlack = 0.16;
    return obstacles_.is_too_near(point.scene, kSlack);
  }

 private:
  ObstacleProbe obstacles_;
};

}  // namespace

template <>
std::unique_ptr<const LimitProbe> probe_of<Limit::clearance>(const Clearance& clearance, const Vec3& /*origin*/) {
  return std::make_unique<ClearanceProbe>(clearance);
}

}  // namespace vantage::internal::verify
