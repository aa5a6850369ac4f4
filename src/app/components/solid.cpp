#include "app/components/solid.h"

#include <utility>

namespace vantage::internal::app {

Volume exact_volume(const PreparedTarget& target, const ExactOptions& options, const Progress& progress) {
  return compute_parts(target, options, progress);
}

Volume joined(std::vector<Volume> volumes, const Progress& progress, double work_limit) {
  return volumes.size() == 1 ? std::move(volumes[0]) : intersect_volumes(volumes, progress, work_limit);
}

Volume united(std::vector<Volume> volumes, const Progress& progress, double work_limit) {
  return volumes.size() == 1 ? std::move(volumes[0]) : unite_volumes(volumes, progress, work_limit);
}

Volume within_limits(const Volume& volume, const PreparedTarget& target, const Navigation& navigation,
                     const Progress& progress, double work_limit) {
  return cut_to_limits(volume, target, navigation, progress, work_limit);
}

}  // namespace vantage::internal::app
