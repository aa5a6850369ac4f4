#include "solid/regions.h"

#include <array>
#include <utility>

#include "core/causes.h"
#include "core/text.h"
#include "solid/region_builder.h"

namespace vantage::internal::solid {
namespace {

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

/// Whether the volume is cut to it, or it is taken away from the volume.
constexpr bool is_kept(Limit limit) { return limit != Limit::keep_out && limit != Limit::clearance; }

}  // namespace

std::string Remainder::text() const { return name + span_text(solid, origin); }

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

Regions make_regions(const std::vector<Cause>& volume_causes, const std::vector<FacetSource>& volume_sources,
                     const Box& bounds, const Navigation& navigation, const std::vector<Mesh>& meshes,
                     const core::ProgressReporter& progress) {
  RegionBuilder builder(volume_causes, volume_sources, bounds, meshes, progress.part(0, 0));
  const auto add = [&](bool of_kept) {
    each_limit(navigation, [&](auto limit, const auto& value) {
      constexpr Limit kLimit = decltype(limit)::value;
      if constexpr (kLimit != Limit::clearance) {
        if (is_kept(kLimit) == of_kept) add_regions<kLimit>(value, builder);
      }
    });
  };
  add(true);
  add(false);
  return builder.take();
}

}  // namespace vantage::internal::solid
