#include "app/join_volumes.h"

#include <utility>

#include "vantage/volume.h"

namespace vantage::internal::app {

Volume joined(std::vector<Volume> volumes, const Progress& progress, double work_limit) {
  return volumes.size() == 1 ? std::move(volumes[0]) : intersect_volumes(volumes, progress, work_limit);
}

Volume united(std::vector<Volume> volumes, const Progress& progress, double work_limit) {
  return volumes.size() == 1 ? std::move(volumes[0]) : unite_volumes(volumes, progress, work_limit);
}

}  // namespace vantage::internal::app
