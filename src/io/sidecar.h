// The small file beside a mesh whose format has no room for its place on the earth, its rounding and its ledger: those
// of "city.stl" are in "city.stl.place.json".
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/atomic_file.h"
#include "io/mesh_file.h"
#include "io/mesh_source.h"
#include "vantage/georeference.h"

namespace vantage::internal::io {

/// "city.stl.place.json" for "city.stl" and "city.stl.gz".
std::filesystem::path sidecar_file(const std::filesystem::path& mesh_file);

/// What it holds.
struct Sidecar {
  std::optional<Georeference> georeference;
  std::optional<double> rounding_m;  ///< of a volume
  std::string volume = {};           ///< JSON of statement_json; empty: nothing is stated
  /// Of a scene, to be written: JSON of its entries (ledger_texts).
  std::vector<std::string> ledger_texts = {};
  std::vector<Missing> ledger = {};  ///< that were read
};

/// {"vantage": {"georeference": {…}, "rounding_m": …, "ledger": […]}}; null in place of the object when there is none.
std::string sidecar_text(const Sidecar& content);

/// Reads the file beside `mesh`; nothing when there is none. Throws Error(input) for one that cannot be read.
Sidecar read_sidecar(const MeshSource& mesh, const core::ProgressReporter& progress);

/// Adds the file beside a mesh, of a format that has no room for what it holds. Nothing where there is nothing to
/// hold, unless there is such a file from an earlier run, which would lie; that is then replaced by one that holds
/// null.
void stage_sidecar(const Sidecar& content, const std::filesystem::path& mesh_file,
                   std::vector<std::unique_ptr<AtomicFile>>& files);

}  // namespace vantage::internal::io
