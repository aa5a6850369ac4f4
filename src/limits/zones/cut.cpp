#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include "solid/ground_band.h"
#include "solid/region_builder.h"
#include "solid/zone_rings.h"

namespace vantage::internal::solid {
namespace {

constexpr double kUnbounded = std::numeric_limits<double>::infinity();

SideCauses all_sides(std::uint32_t cause) {
  SideCauses causes;
  causes.fill(cause);
  return causes;
}

Solid make_box_of_one_cause(RegionBuilder& builder, const Box& box, const std::string& name) {
  const SideCauses causes = all_sides(builder.add_cause(name));
  return builder.make_side_labelled_box(box, causes);
}

/// The part of a zone that lies about the volume, as of boxes; but for its heights above the ground.
Solid make_zone(RegionBuilder& builder, const Zone& zone, std::uint32_t cause) {
  const std::array<std::uint32_t, 3> labels = {builder.add_source({cause, 2, zone.min_z_m}),
                                               builder.add_source({cause, 2, zone.max_z_m}),
                                               builder.add_source({cause})};
  const double low = std::max(zone.min_z_m, builder.outer().min.z()) - builder.origin().z();
  const double high = std::min(zone.max_z_m, builder.outer().max.z()) - builder.origin().z();
  const ZoneRings rings = rings_within(zone, builder.outer(), builder.origin());
  if (rings.empty() || !(low < high)) return Solid();
  return make_prism(rings, low, high, labels);
}

/// What lies between two heights, which may be infinite, above all of the ground above or below it. Empty where there
/// is no ground.
Solid make_heights(RegionBuilder& builder, const AboveGround& heights, std::uint32_t cause) {
  const Ground& ground = heights.ground;
  const auto [low, high] = builder.heights_near(heights);
  const std::uint32_t label = builder.add_source({cause});
  if (ground.surface) {
    return make_ground_band(*ground.surface, low, high, builder.outer(), builder.origin(), {label, label, label},
                            builder.progress());
  }
  Box band = builder.outer();
  band.min.z() = ground.plane_z_m + low;
  band.max.z() = ground.plane_z_m + high;
  return builder.make_side_labelled_box(band, all_sides(cause));
}

Emptiness explain_zone(const Region& region, const Remainder& left) {
  return {region.name + " does not meet " + left.text(), "move or enlarge it so that it overlaps this"};
}
Emptiness explain_zones(const Region& /*region*/, const Remainder& left) {
  return {"no zone to stay in meets " + left.text(), "move or enlarge one so that it overlaps this"};
}

void forbid(const Zone& zone, const std::string& name, RegionBuilder& builder) {
  if (zone.is_box) {
    if (!insides_meet(zone.box(), builder.bounds())) return;
    return builder.forbid({name, make_box_of_one_cause(builder, zone.box(), name)});
  }
  const std::uint32_t cause = builder.add_cause(name);
  Solid solid = make_zone(builder, zone, cause);
  if (zone.above_ground && !solid.empty()) {
    // What is below the lower height above all of the ground there, and what is above the upper one, is allowed.
    const auto& [min_m, max_m, ground] = *zone.above_ground;
    solid = subtract(solid, make_heights(builder, {-kUnbounded, min_m, ground}, cause), builder.progress());
    solid = subtract(solid, make_heights(builder, {max_m, kUnbounded, ground}, cause), builder.progress());
  }
  if (!solid.empty()) builder.forbid({name, std::move(solid)});
}

}  // namespace

template <>
void add_regions<Limit::keep_in>(const std::vector<Zone>& zones, RegionBuilder& builder) {
  for (const Zone& zone : zones) {
    if (zone.is_box && contains(zone.box(), builder.bounds())) return;
  }
  std::vector<Solid> solids;
  for (std::size_t i = 0; i < zones.size(); ++i) {
    const Zone& zone = zones[i];
    const std::string name = zone_name(zones, i);
    if (zone.is_box) {
      if (insides_meet(zone.box(), builder.bounds())) {
        solids.push_back(make_box_of_one_cause(builder, zone.box(), name));
      }
      continue;
    }
    const std::uint32_t cause = builder.add_cause(name);
    Solid solid = make_zone(builder, zone, cause);
    if (zone.above_ground && !solid.empty()) {
      solid = intersect(solid, make_heights(builder, *zone.above_ground, cause), builder.progress());
    }
    solids.push_back(std::move(solid));
  }
  const bool is_one = zones.size() == 1;
  builder.keep({is_one ? zone_name(zones, 0) : "keep_in", unite(solids, builder.progress()),
                is_one ? explain_zone : explain_zones});
}

template <>
void add_regions<Limit::keep_out>(const std::vector<Zone>& zones, RegionBuilder& builder) {
  for (std::size_t i = 0; i < zones.size(); ++i) {
    forbid(zones[i], std::string("keep_out ").append(zone_name(zones, i)), builder);
  }
}

}  // namespace vantage::internal::solid
