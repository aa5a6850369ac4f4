#include "verify/limit_probe.h"

namespace vantage::internal::verify {
namespace {

class AltitudeProbe : public LimitProbe {
 public:
  explicit AltitudeProbe(const Navigation::Altitude& altitude) : altitude_(altitude) {}

  std::optional<std::string> broken_by(const JudgedPoint& point) const override {
    if (point.scene.z() < altitude_.min_m) return "altitude min";
    if (point.scene.z() > altitude_.max_m) return "altitude max";
    return std::nullopt;
  }
  bool may_leave_out(const JudgedPoint& /*point*/) const override { return false; }

 private:
  Navigation::Altitude altitude_;
};

}  // namespace

template <>
std::unique_ptr<const LimitProbe> probe_of<Limit::altitude>(const Navigation::Altitude& altitude,
                                                            const Vec3& /*origin*/) {
  return std::make_unique<AltitudeProbe>(altitude);
}

}  // namespace vantage::internal::verify
