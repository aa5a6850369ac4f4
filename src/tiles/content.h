// Contents of tiles: glTF and GLB, b3dm, i3dm and cmpt (3D Tiles 1.0 and 1.1).
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "io/gltf_tile.h"
#include "tiles/collector.h"
#include "tiles/document.h"
#include "tiles/tile_source.h"

namespace vantage::internal::tiles {

/// Where a content lies.
struct Placement {
  Transform into_world;          ///< of the tile
  GltfUp gltf_up = GltfUp::y;    ///< of its glTF
  Volume bounds = Everywhere{};  ///< in the world
  World world = World::earth;
};

class ContentReader {
 public:
  ContentReader(TileSource& source, Collector& collector, const core::ProgressReporter& progress,
                const core::ReadLimits& limits)
      : source_(source), collector_(collector), progress_(progress), limits_(limits) {}

  /// Bytes of other files that all contents referred to so far, each time that one was read.
  std::uint64_t bytes_of_other_files() const { return all_other_bytes_; }

  /// Of all features so far; the first is said with its file.
  const io::UnreadableProperties& unreadable_properties() const { return unreadable_properties_; }

  /// Primitives with features by texture.
  std::uint64_t features_by_texture() const { return features_by_texture_; }

  /// Adds the surfaces of a content to the collector, and what is missing there. Returns whether there are any
  /// surfaces: a cloud of points has none.
  /// Throws Error(input).
  bool read(const std::string& address, const std::string& bytes, const Placement& placement);

 private:
  struct Parts;

  bool read_part(const std::string& address, std::string_view bytes, const Placement& placement, int depth);
  bool read_composite(const std::string& address, std::string_view bytes, const Placement& placement, int depth);
  bool read_batched(const std::string& address, std::string_view bytes, const Placement& placement);
  bool read_instanced(const std::string& address, std::string_view bytes, const Placement& placement);
  const std::optional<io::TileMesh>& model(const std::string& address, const std::string& uri);
  std::string other_file(const std::string& address);
  void count_repeated(const std::string& address, std::uint64_t instances, std::uint64_t triangles);
  void read_points(const std::string& address, std::string_view bytes, const Placement& placement);
  bool read_gltf(const std::string& address, std::string_view bytes, const Placement& placement);
  std::optional<io::TileMesh> surfaces_of(const io::MeshSource& source, const io::TileContext& tile);
  void count_unreadable(const std::string& shown, io::UnreadableProperties more);
  Parts split(const std::string& address, std::string_view bytes, std::size_t header) const;
  [[noreturn]] void fail(const std::string& address, const std::string& problem) const;

  TileSource& source_;
  Collector& collector_;
  const core::ProgressReporter& progress_;
  const core::ReadLimits& limits_;
  std::uint64_t all_other_bytes_ = 0, features_by_texture_ = 0;
  io::UnreadableProperties unreadable_properties_;
  // Of the content that is being read:
  std::map<std::string, std::optional<io::TileMesh>> models_;  // other files, by address
  std::uint64_t kept_ = 0;                                     // triangles of these
  std::uint64_t other_bytes_ = 0;                              // of other files, each time that one is read
  std::uint64_t repeated_ = 0, most_repeated_ = 0;             // triangles of instances
};

}  // namespace vantage::internal::tiles
