// Whether all of a target is seen from facets.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/progress_reporter.h"
#include "prove/scene_tree.h"
#include "prove/view.h"

namespace vantage::internal::prove {

/// A facet for which no plane separates what lies between it and the target from a triangle.
struct OpenFacet {
  std::uint32_t facet = 0;  ///< its number among those that were given
  std::uint32_t piece = 0;  ///< of SceneTree::pieces: the first one that was met
};

struct SightProof {
  std::vector<OpenFacet> open;  ///< by facet; a few of the pieces of each
  std::size_t separations = 0;
  std::vector<std::uint32_t> order;  ///< where it is recorded: the facets' numbers, so that patches are ranges of them
  std::vector<std::int64_t> steps;   ///< where it is recorded: CertificatePart::steps
};

/// What a proof of sight tells besides. To be recorded, the tree must be that of all_obstacles_in_front.
struct SightTelling {
  bool is_recorded = false;
  /// Not 0: all of the pieces that a facet is open for, until it is more than so many in all; then some of them.
  std::size_t most_pieces = 0;
};

/// `vertices`, `facets`: of the shrunk volume, about View::origin; the facets whose plane does not hold that. The hull
/// of a facet and the target is free where a plane is found between it and each obstacle; hulls of many facets at once
/// are tried first.
SightProof prove_sight(const std::vector<Vec3>& vertices, const std::vector<Triangle>& facets, const View& view,
                       const Scene& scene, const SceneTree& obstacles, const SightTelling& telling,
                       const core::ProgressReporter& progress);

/// A point of a facet and one of the target between which the obstacle lies for sure.
struct Blocked {
  Vec3 viewpoint = Vec3::Zero(), target_point = Vec3::Zero();  ///< about View::origin
  double depth_m = 0;                                          ///< towards the origin so far it is the same
};
std::optional<Blocked> find_blocked(const std::array<Vec3, 3>& facet, const View& view, const Piece& obstacle);

}  // namespace vantage::internal::prove
