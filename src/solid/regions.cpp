#include "solid/regions.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "core/causes.h"
#include "core/text.h"
#include "solid/clearance.h"
#include "solid/ground_band.h"
#include "solid/numerics.h"
#include "solid/zone_rings.h"

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

bool contains(const Box& outer, const Box& inner) {
  return (outer.min.array() <= inner.min.array()).all() && (outer.max.array() >= inner.max.array()).all();
}

bool insides_meet(const Box& a, const Box& b) {
  return (a.min.array() < b.max.array()).all() && (b.min.array() < a.max.array()).all();
}

constexpr double kUnbounded = std::numeric_limits<double>::infinity();

/// Causes of a box's six sides: at min x, y, z, then at max x, y, z.
using SideCauses = std::array<std::uint32_t, 6>;

class Builder {
 public:
  Builder(const std::vector<Cause>& volume_causes, const std::vector<FacetSource>& volume_sources, const Box& bounds,
          core::ProgressReporter progress)
      : bounds_(bounds), progress_(std::move(progress)) {
    result_.origin = local_origin(bounds);
    result_.causes = volume_causes;
    result_.sources = volume_sources;
    const Vec3 overshoot = Vec3::Constant(numerics::kOvershoot * (bounds.max - bounds.min).norm());
    outer_ = {bounds.min - overshoot, bounds.max + overshoot};
  }

  void add_altitude(const Navigation::Altitude& altitude);
  void add_above_ground(const AboveGround& limit);
  void add_kept(const std::vector<Zone>& zones);
  void add_mesh(const Mesh& mesh, const std::string& name);
  void add_keep_out(const Zone& zone, const std::string& zone_name);

  Regions take() { return std::move(result_); }

 private:
  std::uint32_t add_cause(const std::string& name) {
    result_.causes.push_back({CauseKind::navigation, name});
    return static_cast<std::uint32_t>(result_.causes.size() - 1);
  }
  std::uint32_t add_source(const FacetSource& source) {
    result_.sources.push_back(source);
    return static_cast<std::uint32_t>(result_.sources.size() - 1);
  }
  Solid make_side_labelled_box(const Box& box, const SideCauses& causes);
  void add_band(RegionKind kind, const std::string& name, const Box& band, const char* min_cause,
                const char* max_cause);
  Solid make_box_of_one_cause(const Box& box, const std::string& name);
  Solid make_zone(const Zone& zone, std::uint32_t cause);
  Solid make_heights(const AboveGround& heights, std::uint32_t cause);
  std::pair<double, double> heights_near(const AboveGround& heights) const;

  Box bounds_, outer_;
  core::ProgressReporter progress_;
  Regions result_;
};

/// The part of a box that lies about the volume; sides outside of that are moved in, but stay clear of the volume.
Solid Builder::make_side_labelled_box(const Box& box, const SideCauses& causes) {
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

Solid Builder::make_box_of_one_cause(const Box& box, const std::string& name) {
  SideCauses causes;
  causes.fill(add_cause(name));
  return make_side_labelled_box(box, causes);
}

/// "20 to 120 m"
std::string metres_from_to(double min_m, double max_m) {
  return core::number_text(min_m) + " to " + core::number_text(max_m) + " m";
}

/// `band`: of which z alone is meant.
void Builder::add_band(RegionKind kind, const std::string& name, const Box& band, const char* min_cause,
                       const char* max_cause) {
  if (contains(band, bounds_)) return;
  if (!insides_meet(band, bounds_)) {
    result_.kept.push_back({kind, name, Solid(), band});
    return;
  }
  const std::uint32_t min = add_cause(min_cause), max = add_cause(max_cause);
  result_.kept.push_back({kind, name, make_side_labelled_box(band, {min, min, min, max, max, max}), band});
}

void Builder::add_altitude(const Navigation::Altitude& altitude) {
  Box band = outer_;
  band.min.z() = altitude.min_m;
  band.max.z() = altitude.max_m;
  add_band(RegionKind::altitude, "the altitude band " + metres_from_to(altitude.min_m, altitude.max_m), band,
           "altitude min", "altitude max");
}

/// The two heights, which may be infinite, moved in to where they still lie beyond the volume on the same side, and the
/// lower one below the upper one: booleans round to a part of the largest coordinate.
std::pair<double, double> Builder::heights_near(const AboveGround& heights) const {
  const auto& [min_m, max_m, ground] = heights;
  const bool has_surface = ground.surface && !ground.surface->empty();
  const Box at = has_surface ? bounding_box(*ground.surface) : Box{{0, 0, ground.plane_z_m}, {0, 0, ground.plane_z_m}};
  const double size = outer_.max.z() - outer_.min.z();
  const double below = outer_.min.z() - at.max.z() - size, above = outer_.max.z() - at.min.z() + size;
  return {std::clamp(min_m, below - size, above), std::clamp(max_m, below, above + size)};
}

void Builder::add_above_ground(const AboveGround& limit) {
  const auto& [min_m, max_m, ground] = limit;
  const std::string name = "the band " + metres_from_to(min_m, max_m) + " above the ground";
  if (!ground.surface) {
    Box band = outer_;
    band.min.z() = ground.plane_z_m + min_m;
    band.max.z() = ground.plane_z_m + max_m;
    return add_band(RegionKind::altitude, name, band, "agl min", "agl max");
  }
  const auto label = [&](const char* cause) { return add_source({add_cause(cause)}); };
  GroundBandLabels labels;
  labels.min = label("agl min");
  labels.max = label("agl max");
  labels.edge = label("ground edge");
  const auto [low, high] = heights_near(limit);
  result_.kept.push_back({RegionKind::above_ground, name,
                          make_ground_band(*ground.surface, low, high, outer_, result_.origin, labels, progress_)});
}

/// The part of a zone that lies about the volume, as of boxes; but for its heights above the ground.
Solid Builder::make_zone(const Zone& zone, std::uint32_t cause) {
  const std::array<std::uint32_t, 3> labels = {add_source({cause, 2, zone.min_z_m}),
                                               add_source({cause, 2, zone.max_z_m}), add_source({cause})};
  const double low = std::max(zone.min_z_m, outer_.min.z()) - result_.origin.z();
  const double high = std::min(zone.max_z_m, outer_.max.z()) - result_.origin.z();
  const ZoneRings rings = rings_within(zone, outer_, result_.origin);
  if (rings.empty() || !(low < high)) return Solid();
  return make_prism(rings, low, high, labels);
}

/// What lies between two heights, which may be infinite, above all of the ground above or below it. Empty where there
/// is no ground.
Solid Builder::make_heights(const AboveGround& heights, std::uint32_t cause) {
  const Ground& ground = heights.ground;
  const auto [low, high] = heights_near(heights);
  const std::uint32_t label = add_source({cause});
  if (ground.surface)
    return make_ground_band(*ground.surface, low, high, outer_, result_.origin, {label, label, label}, progress_);
  Box band = outer_;
  band.min.z() = ground.plane_z_m + low;
  band.max.z() = ground.plane_z_m + high;
  SideCauses causes;
  causes.fill(cause);
  return make_side_labelled_box(band, causes);
}

void Builder::add_kept(const std::vector<Zone>& zones) {
  if (zones.empty()) return;
  for (const Zone& zone : zones) {
    if (zone.is_box && contains(zone.box(), bounds_)) return;
  }
  std::vector<Solid> solids;
  for (std::size_t i = 0; i < zones.size(); ++i) {
    const Zone& zone = zones[i];
    const std::string name = zone_name(zones, i);
    if (zone.is_box) {
      if (insides_meet(zone.box(), bounds_)) solids.push_back(make_box_of_one_cause(zone.box(), name));
      continue;
    }
    const std::uint32_t cause = add_cause(name);
    Solid solid = make_zone(zone, cause);
    if (zone.above_ground && !solid.empty())
      solid = intersect(solid, make_heights(*zone.above_ground, cause), progress_);
    solids.push_back(std::move(solid));
  }
  const bool is_one = zones.size() == 1;
  result_.kept.push_back({is_one ? RegionKind::zone : RegionKind::zones, is_one ? zone_name(zones, 0) : "keep_in",
                          unite(solids, progress_)});
}

void Builder::add_mesh(const Mesh& mesh, const std::string& name) {
  const std::string full_name = std::string("mesh ").append(name);
  const std::uint32_t label = add_source({add_cause(full_name)});
  std::vector<std::uint32_t> labels(mesh.triangles.size(), label);
  result_.kept.push_back({RegionKind::mesh, std::string("the ").append(full_name),
                          Solid(moved_to_origin(mesh, std::move(labels), result_.origin), name)});
}

void Builder::add_keep_out(const Zone& zone, const std::string& zone_name) {
  const std::string name = std::string("keep_out ").append(zone_name);
  if (zone.is_box) {
    if (!insides_meet(zone.box(), bounds_)) return;
    result_.forbidden.push_back({RegionKind::keep_out, name, make_box_of_one_cause(zone.box(), name)});
    return;
  }
  const std::uint32_t cause = add_cause(name);
  Solid solid = make_zone(zone, cause);
  if (zone.above_ground && !solid.empty()) {
    // What is below the lower height above all of the ground there, and what is above the upper one, is allowed.
    const auto& [min_m, max_m, ground] = *zone.above_ground;
    solid = subtract(solid, make_heights({-kUnbounded, min_m, ground}, cause), progress_);
    solid = subtract(solid, make_heights({max_m, kUnbounded, ground}, cause), progress_);
  }
  if (!solid.empty()) result_.forbidden.push_back({RegionKind::keep_out, name, std::move(solid)});
}

}  // namespace

LabelledMesh moved_to_origin(const Mesh& mesh, std::vector<std::uint32_t> labels, const Vec3& origin) {
  LabelledMesh result{mesh, std::move(labels)};
  for (Vec3& vertex : result.mesh.vertices) vertex -= origin;
  return result;
}

std::vector<std::uint32_t> FacetSourceList::add(const Volume& volume, const std::vector<std::uint32_t>& cause) {
  std::vector<std::uint32_t> labels;
  labels.reserve(volume.cause_of.size());
  for (std::size_t t = 0; t < volume.cause_of.size(); ++t) {
    const FacetSource source{.cause = cause[volume.cause_of[t]],
                             .polygon = volume.polygon_of.empty() ? kNoPolygon : volume.polygon_of[t]};
    const auto next = static_cast<std::uint32_t>(sources_.size());
    const auto [entry, is_new] = index_.try_emplace({source.cause, source.polygon}, next);
    if (is_new) sources_.push_back(source);
    labels.push_back(entry->second);
  }
  return labels;
}

void set_mesh(LabelledMesh labelled, const std::vector<FacetSource>& sources, std::vector<Cause> causes,
              Volume& volume) {
  volume.cause_of.clear();
  volume.polygon_of.clear();
  for (const std::uint32_t label : labelled.labels) {
    volume.cause_of.push_back(sources[label].cause);
    volume.polygon_of.push_back(sources[label].polygon);
  }
  volume.mesh = std::move(labelled.mesh);
  volume.causes = std::move(causes);
  core::compact_causes(volume.mesh, volume.cause_of, volume.causes);
}

// All members are named: a limit that is added does not compile here before it is cut.
Regions make_regions(const std::vector<Cause>& volume_causes, const std::vector<FacetSource>& volume_sources,
                     const Box& bounds, const Navigation& navigation, const std::vector<Mesh>& meshes,
                     const core::ProgressReporter& progress) {
  const auto& [altitude, keep_in, keep_out, keep_in_meshes, above_ground, clearance] = navigation;
  Builder builder(volume_causes, volume_sources, bounds, progress.part(0, 0));
  if (altitude) builder.add_altitude(*altitude);
  if (above_ground) builder.add_above_ground(*above_ground);
  builder.add_kept(keep_in);
  for (std::size_t i = 0; i < meshes.size(); ++i) builder.add_mesh(meshes[i], keep_in_meshes[i].name);
  for (std::size_t i = 0; i < keep_out.size(); ++i) builder.add_keep_out(keep_out[i], zone_name(keep_out, i));
  static_cast<void>(clearance);  // add_clearance_region
  return builder.take();
}

void add_clearance_region(const Clearance& clearance, const Mesh& volume, const Vec3& from, Regions& regions,
                          const core::ProgressReporter& progress) {
  regions.causes.push_back({CauseKind::navigation, "clearance"});
  regions.sources.push_back({static_cast<std::uint32_t>(regions.causes.size() - 1)});
  const auto label = static_cast<std::uint32_t>(regions.sources.size() - 1);
  Solid solid = make_clearance(clearance, volume, from, regions.origin, label, progress);
  if (solid.empty()) return;
  regions.forbidden.push_back(
      {RegionKind::clearance, "the clearance of " + core::number_text(clearance.distance_m) + " m", std::move(solid)});
}

}  // namespace vantage::internal::solid
