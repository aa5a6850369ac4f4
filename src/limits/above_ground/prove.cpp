#include "prove/ground_band.h"
#include "prove/limit_proof.h"

namespace vantage::internal::prove {

template <>
ClaimProof prove_limit<Limit::above_ground>(const AboveGround& band, const Claimant& of,
                                            const core::ProgressReporter& progress) {
  return prove_above_ground("agl", of.volume, band, progress);
}

}  // namespace vantage::internal::prove
