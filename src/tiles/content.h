// Contents of tiles: glTF and GLB, b3dm, i3dm and cmpt (3D Tiles 1.0 and 1.1).
#pragma once

#include <string>
#include <string_view>

#include "tiles/collector.h"
#include "tiles/document.h"
#include "tiles/tile_source.h"

namespace vantage::internal::tiles {

/// Where a content lies.
struct Placement {
  Transform into_world;        ///< of the tile
  GltfUp gltf_up = GltfUp::y;  ///< of its glTF
};

class ContentReader {
 public:
  ContentReader(TileSource& source, Collector& collector, const core::ProgressReporter& progress,
                const core::ReadLimits& limits)
      : source_(source), collector_(collector), progress_(progress), limits_(limits) {}

  /// Adds the surfaces of a content to the collector. Returns whether there are any: a cloud of points has none.
  /// Throws Error(input).
  bool read(const std::string& address, const std::string& bytes, const Placement& placement);

 private:
  struct Parts;

  bool read_part(const std::string& address, std::string_view bytes, const Placement& placement, int depth);
  bool read_composite(const std::string& address, std::string_view bytes, const Placement& placement, int depth);
  bool read_batched(const std::string& address, std::string_view bytes, const Placement& placement);
  bool read_instanced(const std::string& address, std::string_view bytes, const Placement& placement);
  bool read_gltf(const std::string& address, std::string_view bytes, const Placement& placement);
  Parts split(const std::string& address, std::string_view bytes, std::size_t header) const;
  [[noreturn]] void fail(const std::string& address, const std::string& problem) const;

  TileSource& source_;
  Collector& collector_;
  const core::ProgressReporter& progress_;
  const core::ReadLimits& limits_;
};

}  // namespace vantage::internal::tiles
