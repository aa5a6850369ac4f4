// Implicit tiling (3D Tiles 1.1, section "Implicit tiling"): quadtrees and octrees whose tiles follow from bit streams.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "tiles/document.h"

namespace vantage::internal::tiles {

/// Coordinates of a tile in the tree; z only of an octree.
struct TileIndex {
  std::uint32_t level = 0;
  std::array<std::uint64_t, 3> at = {0, 0, 0};
};

/// Which tiles of some levels below a tile exist.
class Subtree {
 public:
  /// Of how many levels, with how many children (4 or 8) and contents for a tile.
  struct Shape {
    std::uint32_t levels = 0;
    std::uint32_t children = 4;
    std::size_t contents = 0;
    std::size_t extension_contents = 0;  ///< the last of these
  };
  /// Reads what another file holds.
  using ReadFile = std::function<std::string(const std::string& uri)>;

  /// Throws std::string, what is wrong, and whatever `read_file` throws.
  Subtree(const std::string& bytes, const Shape& shape, const ReadFile& read_file,
          const core::ProgressReporter& progress, const core::ReadLimits& limits);

  /// `level`: below the subtree's root; `morton`: its number among the tiles of that level.
  bool has_tile(std::uint32_t level, std::uint64_t morton) const;
  bool has_content(std::size_t content, std::uint32_t level, std::uint64_t morton) const;
  bool has_child_subtree(std::uint64_t morton) const { return children_.has(morton); }

 private:
  /// A bit for each tile, or one for all.
  struct Bits {
    std::string bytes;
    bool all = false, is_constant = true;

    bool has(std::uint64_t index) const {
      if (is_constant) return all;
      return (static_cast<unsigned char>(bytes[index / 8]) >> (index % 8) & 1U) != 0;
    }
  };
  struct Parts;

  std::uint64_t before(std::uint32_t level) const;  ///< tiles of the levels above
  static Bits bits(const Json& described, std::uint64_t count, Parts& parts);
  void read_contents(std::uint64_t count, Parts& parts);
  std::vector<const Json*> availabilities(const Parts& parts) const;

  Shape shape_;
  Bits tiles_, children_;
  std::vector<Bits> contents_;
};

/// The tree below one tile of a tileset.json.
struct ImplicitTree {
  std::shared_ptr<const TilesetDocument> document;
  Subtree::Shape shape;      ///< of its subtrees
  std::uint32_t levels = 0;  ///< of the tree
  bool is_octree = false;
  std::string subtrees;               ///< template of their URIs
  Volume bounds;                      ///< of the root
  double error_m = 0;                 ///< likewise
  std::vector<ContentName> contents;  ///< templates

  /// Throws Error(input) for a description that is garbled.
  ImplicitTree(std::shared_ptr<const TilesetDocument> of, const Tile& root, double root_error_m);

  Volume bounds_of(const TileIndex& index) const;
  std::string uri_of(const std::string& pattern, const TileIndex& index) const;
};

/// The bits of the coordinates in turn, x first: a tile's number among all of `levels` levels below its ancestor.
std::uint64_t morton_of(const TileIndex& index, std::uint32_t levels, bool is_octree);

}  // namespace vantage::internal::tiles
