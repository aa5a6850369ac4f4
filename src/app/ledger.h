// What a scene lacks, told to people: docs/scene.md, "The ledger".
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "vantage/mission.h"

namespace vantage::internal::app {

/// "relation/3576201 Oyo Hotel (building=hotel): its ring is open at 7.41, 1.11; stands in: its outline, 12 m high".
std::string ledger_text(const LedgerEntry& entry);

/// scene_incomplete, where anything of the ledger lies within `range_m` of one of `targets`, or in no known place.
/// `paths`: boxes round what must stay clear of it, sight lines or a flight, called `path` ("the sight lines"). The
/// worst is what nothing holds, then what may be larger, then what is nearest.
std::optional<Warning> incomplete_warning(const Scene& scene, const std::vector<Box>& targets, double range_m,
                                          const std::vector<Box>& paths, const std::string& path);

}  // namespace vantage::internal::app
