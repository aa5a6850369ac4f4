#include "solid/outside_limits.h"

#include <vector>

#include "solid/numerics.h"

namespace vantage::internal::solid {
namespace {

bool negligible(const Solid& solid, double thickness) {
  return solid.empty() || solid.volume() <= thickness * solid.area();
}

}  // namespace

Emptiness explain_emptiness(const Solid& volume, const Regions& regions, const core::ProgressReporter& progress) {
  const double thickness = sliver_thickness(volume);
  Solid left = volume;
  std::string left_name = "the volume";
  for (const Region& region : regions.kept) {
    const Solid next = intersect(left, region.solid, progress);
    if (negligible(next, thickness)) return region.explain(region, {left, left_name, regions.origin});
    left = next;
    left_name = "what the limits before it leave of the volume";
  }
  std::vector<const Region*> keep_out;
  for (const Region& region : regions.forbidden) {
    if (!region.explain) {
      keep_out.push_back(&region);
      continue;
    }
    const Solid next = subtract(left, region.solid, progress);
    if (negligible(next, thickness)) return region.explain(region, {left, left_name, regions.origin});
    left = next;
    left_name = "what the limits before it leave of the volume";
  }
  if (keep_out.empty()) {
    return {"the limits leave only slivers as thin as rounding error", "widen the limits"};
  }
  const bool one = keep_out.size() == 1;
  if (regions.kept.size() + regions.forbidden.size() > keep_out.size()) {
    left_name = "what the other limits leave of the volume";
  }
  return {(one ? keep_out[0]->name + " covers " : std::string("the limits to stay out of cover ")) +
              Remainder{left, left_name, regions.origin}.text(),
          one ? "make it smaller" : "make them smaller"};
}

double sliver_thickness(const Solid& volume) { return numerics::kSliverEpsilons * volume.epsilon(); }

}  // namespace vantage::internal::solid
