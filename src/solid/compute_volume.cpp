#include <utility>
#include <vector>

#include "core/parallel.h"
#include "solid/visible_share.h"
#include "vantage/navigation.h"

namespace vantage {

Volume compute_parts(const PreparedTarget& target, const ExactOptions& options, const Progress& progress) {
  Volume volume;
  internal::parallel::with_threads(options.threads, [&] {
    if (internal::solid::has_share(target)) {
      volume = internal::solid::share_volume(target, options, progress);
      return;
    }
    std::vector<Volume> volumes;
    for (std::size_t i = 0; i < target.part_count(); ++i) {
      volumes.push_back(compute_visibility(target.part(i), options, progress));
    }
    volume = volumes.size() == 1 ? std::move(volumes[0]) : intersect_volumes(volumes, progress, options.work_limit);
  });
  return volume;
}

Volume compute_volume(const PreparedTarget& target, const Navigation& navigation, const ExactOptions& options,
                      const Progress& progress) {
  Volume volume;
  internal::parallel::with_threads(options.threads, [&] {
    volume = cut_to_limits(compute_parts(target, options, progress), target, navigation, progress, options.work_limit);
  });
  return volume;
}

}  // namespace vantage
