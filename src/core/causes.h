// Lists of causes, and which facets are theirs.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "vantage/volume.h"

namespace vantage::internal::core {

/// Causes, each once. Those of one object are the same, and without an object those of one kind and name.
class CauseList {
 public:
  /// The number of the cause: a new one, unless it is there.
  std::uint32_t add(const Cause& cause);

  const std::vector<Cause>& causes() const { return causes_; }

 private:
  std::vector<Cause> causes_;
  std::map<std::tuple<CauseKind, std::optional<std::uint32_t>, std::string>, std::uint32_t> index_;
};

/// Of its box; 0 of a mesh without triangles. The origin of a volume that has no target.
Vec3 middle_of(const Mesh& mesh);

/// Measures the causes' areas and drops those that no triangle has. `cause_of`: per triangle of `mesh`, an index into
/// `causes`; numbered anew.
void compact_causes(const Mesh& mesh, std::vector<std::uint32_t>& cause_of, std::vector<Cause>& causes);

}  // namespace vantage::internal::core
