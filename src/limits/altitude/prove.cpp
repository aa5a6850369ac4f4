#include <limits>

#include "prove/limit_proof.h"
#include "prove/within_box.h"

namespace vantage::internal::prove {

template <>
ClaimProof prove_limit<Limit::altitude>(const Navigation::Altitude& altitude, const Claimant& of,
                                        const core::ProgressReporter& /*progress*/) {
  constexpr double kAll = std::numeric_limits<double>::infinity();
  return prove_within_box("altitude", of.volume, {{-kAll, -kAll, altitude.min_m}, {kAll, kAll, altitude.max_m}});
}

}  // namespace vantage::internal::prove
