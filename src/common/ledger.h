// The ledger of a scene, told to people and kept in files: docs/scene.md, "The ledger".
#pragma once

#include <string>
#include <tuple>
#include <vector>

#include "vantage/export.h"
#include "vantage/scene.h"

namespace vantage {

/// "relation/3576201 Oyo Hotel (building=hotel): its ring is open at 7.41, 1.11; stands in: its outline, 12 m high".
/// Texts of files are cut where they are very long.
VANTAGE_API std::string ledger_text(const LedgerEntry& entry);

/// The worst is the least: what nothing holds, then what may be larger.
inline auto badness(const LedgerEntry& entry) { return std::tuple(entry.stand_in.has_value(), !entry.may_be_larger); }

/// The ledger of a scene where it is kept, in a file or pickled: the lines overhead, which are not, are in it.
VANTAGE_API std::vector<LedgerEntry> written_ledger(const Scene& scene);

}  // namespace vantage
