#include "solid/region_builder.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/text.h"
#include "solid/numerics.h"

namespace vantage::internal::solid {
namespace {

/// Where the solids are moved to: booleans round to a part of the largest coordinate. A multiple of a power of two
/// larger than the volume, so that moving there and back is exact but for coordinates much smaller than the volume
/// itself.
Vec3 local_origin(const Box& bounds) {
  const double extent = std::max((bounds.max - bounds.min).maxCoeff(), 1.0);
  int exponent = 0;
  const bool is_power = std::frexp(extent, &exponent) == 0.5;
  const double grid = std::ldexp(1.0, is_power ? exponent : exponent + 1);
  return ((bounds.min + bounds.max) / (2 * grid)).array().round() * grid;
}

Emptiness explain_band(const Region& region, const Remainder& left, double min_z, double max_z) {
  const Vec3& origin = left.origin;
  const double low = left.solid.bounds().min.z() + origin.z(), high = left.solid.bounds().max.z() + origin.z();
  const std::string low_text = core::number_text(low) + " m", high_text = core::number_text(high) + " m";
  if (min_z >= high) {
    return {region.name + " lies above the volume, which reaches " + high_text,
            "let the band begin below " + high_text};
  }
  if (max_z <= low) {
    return {region.name + " lies below the volume, which begins at " + low_text, "let the band end above " + low_text};
  }
  return {region.name + " leaves nothing of the volume, which reaches from " + low_text + " to " + high_text,
          "widen the band"};
}

}  // namespace

bool contains(const Box& outer, const Box& inner) {
  return (outer.min.array() <= inner.min.array()).all() && (outer.max.array() >= inner.max.array()).all();
}

bool insides_meet(const Box& a, const Box& b) {
  return (a.min.array() < b.max.array()).all() && (b.min.array() < a.max.array()).all();
}

std::string metres_from_to(double min_m, double max_m) {
  return core::number_text(min_m) + " to " + core::number_text(max_m) + " m";
}

RegionBuilder::RegionBuilder(const std::vector<Cause>& volume_causes, const std::vector<FacetSource>& volume_sources,
                             const Box& bounds, const std::vector<Mesh>& meshes, core::ProgressReporter progress)
    : bounds_(bounds), meshes_(meshes), progress_(std::move(progress)) {
  result_.origin = local_origin(bounds);
  result_.causes = volume_causes;
  result_.sources = volume_sources;
  const Vec3 overshoot = Vec3::Constant(numerics::kOvershoot * (bounds.max - bounds.min).norm());
  outer_ = {bounds.min - overshoot, bounds.max + overshoot};
}

std::uint32_t RegionBuilder::add_cause(const std::string& name) {
  result_.causes.push_back({CauseKind::navigation, name});
  return static_cast<std::uint32_t>(result_.causes.size() - 1);
}

std::uint32_t RegionBuilder::add_source(const FacetSource& source) {
  result_.sources.push_back(source);
  return static_cast<std::uint32_t>(result_.sources.size() - 1);
}

Solid RegionBuilder::make_side_labelled_box(const Box& box, const SideCauses& causes) {
  BoxLabels labels;
  for (unsigned axis = 0; axis < 3; ++axis) {
    labels.min[axis] = add_source({causes[axis], axis, box.min[axis]});
    labels.max[axis] = add_source({causes[axis + 3], axis, box.max[axis]});
  }
  const Box near{box.min.cwiseMax(outer_.min) - result_.origin, box.max.cwiseMin(outer_.max) - result_.origin};
  // A box thinner than the last digit of a large coordinate.
  if (!(near.min.array() < near.max.array()).all()) return Solid();
  return make_box(near, labels);
}

void RegionBuilder::keep_between(const std::string& name, double min_z, double max_z, const char* min_cause,
                                 const char* max_cause) {
  Box band = outer_;
  band.min.z() = min_z;
  band.max.z() = max_z;
  if (contains(band, bounds_)) return;
  Region region{name, Solid(),
                [=](const Region& of, const Remainder& left) { return explain_band(of, left, min_z, max_z); }};
  if (insides_meet(band, bounds_)) {
    const std::uint32_t min = add_cause(min_cause), max = add_cause(max_cause);
    region.solid = make_side_labelled_box(band, {min, min, min, max, max, max});
  }
  keep(std::move(region));
}

std::pair<double, double> RegionBuilder::heights_near(const AboveGround& heights) const {
  const auto& [min_m, max_m, ground] = heights;
  const bool has_surface = ground.surface && !ground.surface->empty();
  const Box at = has_surface ? bounding_box(*ground.surface) : Box{{0, 0, ground.plane_z_m}, {0, 0, ground.plane_z_m}};
  const double size = outer_.max.z() - outer_.min.z();
  const double below = outer_.min.z() - at.max.z() - size, above = outer_.max.z() - at.min.z() + size;
  return {std::clamp(min_m, below - size, above), std::clamp(max_m, below, above + size)};
}

}  // namespace vantage::internal::solid
