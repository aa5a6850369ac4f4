#include "solid/ground_band.h"
#include "solid/region_builder.h"

namespace vantage::internal::solid {
namespace {

Emptiness explain_band_above_ground(const Region& region, const Remainder& left) {
  if (region.solid.empty()) {
    return {region.name + " is empty: there is no ground under " + left.text(),
            "enlarge the scene, or give the ground's z: 'navigation.ground: 0'"};
  }
  return {region.name + " does not meet " + left.text(), "widen the band"};
}

}  // namespace

template <>
void add_regions<Limit::above_ground>(const AboveGround& limit, RegionBuilder& builder) {
  const auto& [min_m, max_m, ground] = limit;
  const std::string name = "the band " + metres_from_to(min_m, max_m) + " above the ground";
  if (!ground.surface) {
    return builder.keep_between(name, ground.plane_z_m + min_m, ground.plane_z_m + max_m, "agl min", "agl max");
  }
  const auto label = [&](const char* cause) { return builder.add_source({builder.add_cause(cause)}); };
  GroundBandLabels labels;
  labels.min = label("agl min");
  labels.max = label("agl max");
  labels.edge = label("ground edge");
  const auto [low, high] = builder.heights_near(limit);
  builder.keep(
      {name,
       make_ground_band(*ground.surface, low, high, builder.outer(), builder.origin(), labels, builder.progress()),
       explain_band_above_ground});
}

}  // namespace vantage::internal::solid
