#include "solid/outside_limits.h"

#include <array>
#include <vector>

#include "core/text.h"
#include "solid/numerics.h"

namespace vantage::internal::solid {
namespace {

bool negligible(const Solid& solid, double thickness) {
  return solid.empty() || solid.volume() <= thickness * solid.area();
}

/// ", which spans x -9 to 11, y -8 to 12, z 3 to 13 m".
std::string span_text(const Solid& solid, const Vec3& origin) {
  constexpr std::array kAxes = {"x ", ", y ", ", z "};
  const Box local = solid.bounds();
  std::string text(", which spans ");
  for (unsigned axis = 0; axis < 3; ++axis) {
    text.append(kAxes[axis]).append(core::number_text(local.min[axis] + origin[axis]));
    text.append(" to ").append(core::number_text(local.max[axis] + origin[axis]));
  }
  return text.append(" m");
}

Emptiness explain_altitude(const Region& band, const Solid& volume, const Vec3& origin) {
  const double low = volume.bounds().min.z() + origin.z(), high = volume.bounds().max.z() + origin.z();
  const std::string low_text = core::number_text(low) + " m", high_text = core::number_text(high) + " m";
  if (band.box.min.z() >= high) {
    return {band.name + " lies above the volume, which reaches " + high_text, "let the band begin below " + high_text};
  }
  if (band.box.max.z() <= low) {
    return {band.name + " lies below the volume, which begins at " + low_text, "let the band end above " + low_text};
  }
  return {band.name + " leaves nothing of the volume, which reaches from " + low_text + " to " + high_text,
          "widen the band"};
}

/// `left` is what earlier limits leave of the volume, and not empty.
Emptiness explain_region(const Region& region, const Solid& left, const std::string& left_name, const Vec3& origin) {
  switch (region.kind) {
    case RegionKind::altitude:
      return explain_altitude(region, left, origin);
    case RegionKind::above_ground:
      return {region.name + (region.solid.empty() ? " is empty: there is no ground under " : " does not meet ") +
                  left_name + span_text(left, origin),
              region.solid.empty() ? "enlarge the scene, or give the ground's z: 'navigation.ground: 0'"
                                   : "widen the band"};
    case RegionKind::zone:
      return {region.name + " does not meet " + left_name + span_text(left, origin),
              "move or enlarge it so that it overlaps this"};
    case RegionKind::zones:
      return {"no zone to stay in meets " + left_name + span_text(left, origin),
              "move or enlarge one so that it overlaps this"};
    case RegionKind::mesh:
      return {region.name + " does not meet " + left_name + span_text(left, origin),
              "check its place and its axes: the scene frame, metres, z up"};
    case RegionKind::sensor:
      return {"the sensor's limit '" + region.name + "' leaves nothing of " + left_name + span_text(left, origin) +
                  (region.explanation.empty() ? "" : "; " + region.explanation),
              "relax it, or the limits that it goes with"};
    case RegionKind::keep_out:
    case RegionKind::clearance:
      break;
  }
  return {};
}

}  // namespace

Emptiness explain_emptiness(const Solid& volume, const Regions& regions, const core::ProgressReporter& progress) {
  const double thickness = sliver_thickness(volume);
  Solid left = volume;
  std::string left_name = "the volume";
  for (const Region& region : regions.kept) {
    const Solid next = intersect(left, region.solid, progress);
    if (negligible(next, thickness)) return explain_region(region, left, left_name, regions.origin);
    left = next;
    left_name = "what the limits before it leave of the volume";
  }
  std::vector<const Region*> keep_out;
  for (const Region& region : regions.forbidden) {
    if (region.kind != RegionKind::sensor) {
      keep_out.push_back(&region);
      continue;
    }
    const Solid next = subtract(left, region.solid, progress);
    if (negligible(next, thickness)) return explain_region(region, left, left_name, regions.origin);
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
  return {(one ? keep_out[0]->name + " covers " : std::string("the limits to stay out of cover ")) + left_name +
              span_text(left, regions.origin),
          one ? "make it smaller" : "make them smaller"};
}

double sliver_thickness(const Solid& volume) { return numerics::kSliverEpsilons * volume.epsilon(); }

}  // namespace vantage::internal::solid
