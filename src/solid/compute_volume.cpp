#include <vector>

#include "core/parallel.h"
#include "vantage/navigation.h"

namespace vantage {

Volume compute_volume(const PreparedTarget& target, const Navigation& navigation, const ExactOptions& options,
                      const Progress& progress) {
  Volume volume;
  internal::parallel::with_threads(options.threads, [&] {
    std::vector<Volume> volumes;
    for (std::size_t i = 0; i < target.part_count(); ++i) {
      volumes.push_back(compute_visibility(target.part(i), options, progress));
    }
    volume = volumes.size() == 1 ? std::move(volumes[0]) : intersect_volumes(volumes, progress);
    volume = cut_to_limits(volume, target, navigation, progress);
  });
  return volume;
}

}  // namespace vantage
