#include <utility>

#include "app/components/missing.h"
#include "app/components/solid.h"

namespace vantage::internal::app {

Volume exact_volume(const PreparedTarget& target, const ExactOptions& options, const Progress& progress) {
  if (target.part_count() > 1) throw_missing("solid", "targets of several parts", "target.parts");
  if (target.sensor().visible) throw_missing("solid", "a visible share", "sensor.visible");
  return compute_visibility(target, options, progress);
}

Volume joined(std::vector<Volume> volumes, const Progress&, double) {
  if (volumes.size() != 1) throw_missing("solid", "targets of several parts", "target.parts");
  return std::move(volumes[0]);
}

Volume united(std::vector<Volume> volumes, const Progress&, double) {
  if (volumes.size() != 1) throw_missing("solid", "several targets", "targets");
  return std::move(volumes[0]);
}

Volume within_limits(const Volume&, const PreparedTarget&, const Navigation& navigation, const Progress&, double) {
  if (!navigation.empty()) throw_missing("solid", "navigation limits", "navigation");
  throw_missing("solid", "limits of the sensor besides its range", "sensor");
}

}  // namespace vantage::internal::app
