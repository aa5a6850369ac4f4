#include "app/components/spheres.h"

namespace vantage::internal::app {

Volume spheres_volume(const PreparedTarget& target, const SpheresOptions& options, SpheresReport& report,
                      const StageSink& stages, const Progress& progress) {
  return compute_visibility_spheres(target, options, &report, stages, progress);
}

}  // namespace vantage::internal::app
