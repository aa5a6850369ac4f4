// From the root of a tileset to the tiles that are wanted.
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tiles/content.h"
#include "tiles/implicit.h"
#include "vantage/error.h"
#include "vantage/tileset.h"

namespace vantage::internal::tiles {

/// Goes through a tileset and hands the contents of all tiles that are wanted to a ContentReader.
class Walk {
 public:
  struct Wanted {
    const Reach& reach;
    double detail_m;
    World world;
    MissingPolicy missing;
  };
  Walk(TileSource& source, Collector& collector, const Wanted& wanted, TilesetReport& report,
       const core::ProgressReporter& progress, const core::ReadLimits& limits);

  /// From the root of `document` on. Throws Error(input) for a tileset without end, and for want of a library.
  void run(const std::shared_ptr<const TilesetDocument>& document);

 private:
  /// The files that led to a tile.
  struct Trail {
    std::shared_ptr<const TilesetDocument> document;
    std::shared_ptr<const Trail> parent;
    int depth = 0;
    std::uint64_t memory_bytes = 0;  ///< of all these files when they are parsed
  };
  struct Coarser;
  struct LoadedSubtree {
    std::shared_ptr<const ImplicitTree> tree;
    TileIndex root;
    std::shared_ptr<const Subtree> bits;
  };
  /// A tile that waits.
  struct Visit {
    std::shared_ptr<const Trail> trail;
    const Json* described = nullptr;  ///< or else `subtree` and `index`
    std::shared_ptr<const LoadedSubtree> subtree;
    TileIndex index;
    std::string external = {};     ///< or else the address of a tileset. It is read when its turn comes: many may wait
    bool is_taken = false;         ///< .. and what to do with it where it is a mesh, whatever its name says
    Transform parent;              ///< of the tile's parent, into the world; of an implicit tile the tree's own
    Volume bounds = Everywhere{};  ///< in the world: of the tile, as far as it is known, or else of its parent
    Refinement refinement = Refinement::replace;
    double error_m = 0;  ///< of the parent
    int depth = 0;
    std::shared_ptr<Coarser> coarser = {};  ///< the nearest tile above that was passed over for finer ones
    bool is_end = false;                    ///< no tile: all that replace `coarser` have been visited
  };
  /// A visited tile in the world.
  struct Here {
    Volume bounds;
    Transform into_world;
    double error_m = 0;
    Refinement refinement = Refinement::replace;
    std::vector<ContentName> contents;
    bool is_taken = false;
    std::shared_ptr<Coarser> coarser = {};  ///< of its children
  };
  /// A tile with a content that is passed over, as its children replace it.
  struct Coarser {
    std::shared_ptr<const Trail> trail;
    Here here;
    std::shared_ptr<Coarser> above;
    int depth = 0;
    std::size_t triangles;                     ///< that there were before those that replace it
    bool is_taken = false;                     ///< after all, for want of a tile that was to replace it
    bool is_cut = false;                       ///< some of what replaces it lies beyond the circle
    std::optional<std::uint32_t> object = {};  ///< the first of its objects, where it was taken and could be read
  };

  void visit(Visit& visit);
  void visit_explicit(Visit& visit);
  void visit_implicit(Visit& visit);
  bool take(const Visit& visit, Here& here, bool has_children);
  void read_contents(const Visit& visit, const Here& here,
                     const std::function<bool(const ContentName& content)>& is_wanted,
                     const std::function<void(const ContentName& content, const Error& error)>& tell);
  std::optional<std::uint32_t> keep_coarser(std::shared_ptr<Coarser> tile);
  void keep_unreplaced(Coarser& tile);
  bool meets(const Visit& visit, const Volume& bounds) const;
  void read_content(const Visit& visit, const Here& here, const std::string& address);
  void read_mesh(const std::string& address, const std::string& bytes, const Placement& placement);
  void wait_for(const Visit& visit, const Here& here, const std::string& address, bool is_taken);
  void visit_external(const Visit& visit);
  void enter_tree(const Visit& visit, const Tile& tile, const Here& here);
  void enter_subtree(const Visit& visit, const std::shared_ptr<const ImplicitTree>& tree, const TileIndex& root,
                     const Transform& into_world, Refinement refinement);
  std::vector<TileIndex> children_of(const Visit& visit) const;
  std::string read_file(const std::string& address);
  std::string read_description(const std::string& address);
  std::shared_ptr<const TilesetDocument> remembered(const std::string& address);
  void remember(const std::shared_ptr<const TilesetDocument>& document);
  [[noreturn]] void fail_for_too_many(const std::string& address) const;
  void count_hole(const Error& error, const std::string& id, const Volume& bounds);
  std::string id_of(const std::string& base, const std::string& uri) const;
  void hold_by_coarser(std::size_t first, const std::shared_ptr<Coarser>& coarser);

  TileSource& source_;
  Collector& collector_;
  const Reach& reach_;
  double detail_m_;
  World world_;
  MissingPolicy missing_;
  TilesetReport& report_;
  const core::ProgressReporter& progress_;
  const core::ReadLimits& limits_;
  ContentReader contents_;
  std::vector<Visit> waiting_;  ///< a stack
  std::uint64_t looked_at_ = 0, described_bytes_ = 0;
  std::deque<std::shared_ptr<const TilesetDocument>> remembered_;  ///< that were read last
  std::uint64_t remembered_bytes_ = 0;
};

}  // namespace vantage::internal::tiles
