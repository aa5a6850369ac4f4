// What a scene lacks, told to people: docs/scene.md, "The ledger".
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/progress_reporter.h"
#include "vantage/mission.h"

namespace vantage::internal::app {

/// Where what stands counts: within a distance of boxes. Neighbours in the list are neighbours in space, as a rule.
struct Reach {
  std::vector<Box> boxes;
  double within_m = 0;
};

/// What stands in for a guess, or for nothing, may reach so much farther than the ledger has it, metres: docs/scene.md.
constexpr double kUnsureM = 20;

/// scene_incomplete, where anything of the ledger lies within one of `reaches`, or in no known place. `paths`: boxes
/// round what must stay clear of it, sight lines or a flight, called `path` ("the sight lines"). The worst is what
/// nothing holds, then what may be larger, then what is nearest. Throws Error(cancelled).
std::optional<Warning> incomplete_warning(const Scene& scene, std::vector<Reach> reaches, std::vector<Box> paths,
                                          const std::string& path, const core::ProgressReporter& progress = {});

}  // namespace vantage::internal::app
