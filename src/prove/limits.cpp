#include "prove/limits.h"

#include <string>

#include "prove/limit_checks.h"
#include "prove/limit_proof.h"
#include "vantage/error.h"

namespace vantage::internal::prove {
namespace {

/// Each limit takes the same part of the progress.
class LimitProver {
 public:
  explicit LimitProver(const core::ProgressReporter& progress) : progress_(progress) {}

  template <typename Limits>
  void count(const Limits& limits) {
    each_limit(limits, [&](auto /*limit*/, const auto& /*value*/) { ++count_; });
  }
  template <typename Limits>
  void prove(const Limits& limits, const Claimant& of) {
    each_limit(limits, [&](auto limit, const auto& value) {
      const double done = static_cast<double>(claims_.size()), all = static_cast<double>(count_);
      claims_.push_back(prove_limit<decltype(limit)::value>(value, of, progress_.part(done / all, (done + 1) / all)));
    });
  }
  std::vector<ClaimProof> take() { return std::move(claims_); }

 private:
  const core::ProgressReporter& progress_;
  std::size_t count_ = 0;
  std::vector<ClaimProof> claims_;
};

}  // namespace

void check_has_plane(const Claimant& of, Limit limit) {
  if (!of.parts.front().all_sides) return;
  throw Error(ErrorCode::direction_invalid, "a point without a front has no plane, which the limit is about",
              "sensor " + std::string(name_of(limit)), "give the target a front");
}

std::vector<ClaimProof> prove_limits(const LimitedVolume& volume, const LimitedVolume& seen,
                                     const std::vector<View>& parts, const Sensor& sensor, const Navigation& navigation,
                                     const core::ProgressReporter& progress) {
  check_limits(navigation);
  LimitProver prover(progress);
  prover.count(navigation);
  prover.count(sensor);
  prover.prove(navigation, {volume, parts, sensor});
  prover.prove(sensor, {seen, parts, sensor});
  return prover.take();
}

}  // namespace vantage::internal::prove
