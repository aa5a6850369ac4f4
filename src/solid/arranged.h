// Solids out of one arrangement of many, without a tree of booleans.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/progress_reporter.h"
#include "solid/csg.h"

namespace vantage::internal::solid {

/// A closed mesh, and what each point in it counts (or outside of it).
struct Weighted {
  const LabelledMesh* labelled = nullptr;
  std::uint64_t weight = 1;
  bool is_complement = false;
};

struct Arranged {
  Solid solid;           ///< a facet has the label of the one that it is a part of
  double epsilon_m = 0;  ///< as Solid::epsilon(): how far from their surfaces its corners may be
};

/// The points whose weights are at least `least` together; what lies in one plane and has one label is joined. nullopt
/// where an arrangement cannot be made: then booleans have to. See arrangement/arrangement.h.
std::optional<Arranged> weighing_at_least(std::span<const Weighted> operands, std::uint64_t least,
                                          const core::ProgressReporter& progress);

/// What all of the meshes hold: by arrangements of a few at a time, the first one first, and where one cannot be made
/// by booleans, which `fallbacks` counts. There must be one mesh.
Arranged intersection_of(std::vector<LabelledMesh> meshes, std::size_t& fallbacks,
                         const core::ProgressReporter& progress);

}  // namespace vantage::internal::solid
