#include "app/components/missing.h"
#include "app/components/spheres.h"
#include "vantage/willis.h"

namespace vantage {

namespace internal::app {

Volume spheres_volume(const PreparedTarget&, const SpheresOptions&, SpheresReport&, const StageSink&, const Progress&) {
  throw_missing("depth", "missions with method: spheres", "method");
}

}  // namespace internal::app

WillisRun run_willis_config(const WillisConfig&, const SpheresOptions&, const Progress&) {
  internal::app::throw_missing("depth", "visibility spheres", "");
}

}  // namespace vantage
