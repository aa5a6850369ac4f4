#include <optional>
#include <utility>

#include "core/text.h"
#include "solid/clearance.h"
#include "solid/regions.h"

namespace vantage::internal::solid {

void add_clearance_region(const Clearance& clearance, const Mesh& volume, const std::optional<Vec3>& from,
                          Regions& regions, const core::ProgressReporter& progress) {
  regions.causes.push_back({CauseKind::navigation, "clearance"});
  regions.sources.push_back({static_cast<std::uint32_t>(regions.causes.size() - 1)});
  const auto label = static_cast<std::uint32_t>(regions.sources.size() - 1);
  Solid solid = make_clearance(clearance, volume, from, regions.origin, label, progress);
  if (solid.empty()) return;
  regions.forbidden.push_back({.name = "the clearance of " + core::number_text(clearance.distance_m) + " m",
                               .solid = std::move(solid),
                               .is_cut_alone = true});
}

}  // namespace vantage::internal::solid
