// What the file of a volume states besides its mesh: its provenance, tolerance, lifts and hash. docs/hashes.md says
// what they mean.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "io/mesh_source.h"
#include "vantage/volume.h"

namespace vantage::internal::io {

struct VolumeStatement {
  VolumeProvenance provenance;
  double tolerance_m = 0;
  std::vector<double> lift_m;  ///< one for each part of the target
  std::string volume_hash;     ///< of the mesh as the file holds it
};

/// Nothing for a volume without provenance. `stored`: the mesh as the file holds it.
std::optional<nlohmann::ordered_json> statement_json(const Volume& volume, const Mesh& stored);

/// The same as comments: lines that begin with `start` ("# ", "comment "), short enough for any reader.
std::string statement_comments(const Volume& volume, const Mesh& stored, const char* start);

/// What a file of any format that vantage writes states; of STL the file beside it. Nothing where it states nothing.
/// Throws Error(input) for a statement that is garbled.
std::optional<VolumeStatement> read_statement(const MeshSource& source, const core::ProgressReporter& progress);

}  // namespace vantage::internal::io
