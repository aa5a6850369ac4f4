#include "verify/ground_probe.h"
#include "verify/limit_probe.h"

namespace vantage::internal::verify {
namespace {

class AboveGroundProbe : public LimitProbe {
 public:
  explicit AboveGroundProbe(const AboveGround& band) : ground_(band) {}

  std::optional<std::string> broken_by(const JudgedPoint& point) const override {
    return ground_.broken_by(point.scene);
  }
  bool may_leave_out(const JudgedPoint& /*point*/) const override { return false; }

 private:
  GroundProbe ground_;
};

}  // namespace

template <>
std::unique_ptr<const LimitProbe> probe_of<Limit::above_ground>(const AboveGround& band, const Vec3& /*origin*/) {
  return std::make_unique<AboveGroundProbe>(band);
}

}  // namespace vantage::internal::verify
