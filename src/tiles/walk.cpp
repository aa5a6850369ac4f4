#include "tiles/walk.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>
#include <variant>

#include "tiles/http_source.h"

namespace vantage::internal::tiles {
namespace {

// A national tileset has some million tiles; what looks at more within one radius has no end.
constexpr std::uint64_t kMostTiles = 5'000'000;
constexpr std::uint64_t kMostDocuments = 20'000;  ///< tilesets and subtrees
constexpr std::uint64_t kMostFiles = 200'000;
constexpr std::uint64_t kMostHoles = 20'000;
// What is read, each time that it is: small files that are compressed, or named thousands of times, become large.
constexpr std::uint64_t kMostRegionBytes = std::uint64_t{32} << 30U;
constexpr std::uint64_t kMostText = std::uint64_t{1} << 30U;         ///< of tilesets and subtrees, which take longest
constexpr std::uint64_t kMostRemembered = std::uint64_t{64} << 20U;  ///< memory of tilesets that may be named again
constexpr int kMostNested = 64;                                      ///< tilesets, one inside of the other
constexpr int kDeepest = 1'000;
constexpr int kMostCoarser = 3;  ///< ancestors that are tried in place of a tile that cannot be read

/// Whether no other file will be read better: then the walk ends.
bool ends_all(const Error& error) {
  if (dynamic_cast<const SourceClosed*>(&error)) return true;
  switch (error.code()) {
    case ErrorCode::cancelled:
    case ErrorCode::out_of_memory:
    case ErrorCode::system_limit:
    case ErrorCode::component_missing:
    case ErrorCode::region_invalid:
    case ErrorCode::scene_incomplete:
    case ErrorCode::internal_defect:
      return true;
    default:
      return false;
  }
}

/// Whether a URI names a tileset.json, as far as its name says.
bool is_named_json(const std::string& uri) {
  const std::string path = uri.substr(0, uri.find_first_of("?#"));
  return path.size() >= 5 && path.compare(path.size() - 5, 5, ".json") == 0;
}

}  // namespace

Walk::Walk(TileSource& source, Collector& collector, const Wanted& wanted, TilesetReport& report,
           const core::ProgressReporter& progress, const core::ReadLimits& limits)
    : source_(source),
      collector_(collector),
      reach_(wanted.reach),
      detail_m_(wanted.detail_m),
      world_(wanted.world),
      missing_(wanted.missing),
      report_(report),
      progress_(progress),
      limits_(limits),
      contents_(source, collector, progress, limits) {}

void Walk::run(const std::shared_ptr<const TilesetDocument>& document) {
  ++report_.documents;
  Visit root;
  root.trail = std::make_shared<Trail>(Trail{document, nullptr, 0, document->memory_bytes()});
  root.described = &document->root();
  root.parent = Transform::Identity();
  root.error_m = document->error_m();
  waiting_.push_back(root);
  while (!waiting_.empty()) {
    Visit next = std::move(waiting_.back());
    waiting_.pop_back();
    progress_.check();
    try {
      visit(next);
    } catch (const Error& error) {
      if (ends_all(error)) throw;
      const std::size_t first = collector_.missing.size();
      const std::string& address = next.external.empty() ? next.trail->document->address() : next.external;
      count_hole(error, source_.name(address), next.bounds);
      hold_by_coarser(first, next.coarser);
    }
  }
  report_.unreadable_properties = contents_.unreadable_properties().count;
  report_.first_unreadable = contents_.unreadable_properties().first;
  report_.features_by_texture = contents_.features_by_texture();
}

/// A file that is missing or cannot be read, with its id and the volume that it was to fill. One that did not come, of
/// a server or a disk that gives no answer, may come next time: then reading in part is for those who ask for it.
void Walk::count_hole(const Error& error, const std::string& id, const Volume& bounds) {
  if (error.code() == ErrorCode::file_unreadable && missing_ != MissingPolicy::warn) {
    throw Error(ErrorCode::scene_incomplete, "a file of the tileset did not come: " + error.problem(), error.where(),
                "try again, or take what came with 'missing: warn': then the rest hides nothing");
  }
  MissingPart part;
  part.entry.object.source_id = id;
  part.entry.what = "tile";
  part.entry.reason = error.problem();
  part.entry.instead = "the box of its tile";
  part.entry.may_be_larger = true;  // contents stick out of their tiles
  part.corners = corners_of(bounds, world_);
  part.is_held = !part.corners.empty();
  part.is_hole = true;
  collector_.missing.push_back(std::move(part));
  if (report_.holes == 0) {
    report_.first_hole = error.where().empty() ? error.problem() : error.where() + ": " + error.problem();
  }
  if (++report_.holes > kMostHoles) {
    throw Error(ErrorCode::region_invalid,
                "more than " + std::to_string(kMostHoles) +
                    " files of the tileset cannot be read; the first: " + report_.first_hole,
                source_.shown(source_.root()), "download the whole tileset");
  }
}

void Walk::fail_for_too_many(const std::string& address) const {
  throw Error(ErrorCode::region_invalid,
              report_.documents > kMostDocuments
                  ? "the region has more than " + std::to_string(kMostDocuments) + " tilesets, or there is no end"
                  : "the region has more than " + std::to_string(kMostFiles) + " files",
              source_.shown(address), "give a smaller radius, or a larger detail");
}

std::string Walk::read_file(const std::string& address) {
  const bool has_too_many_files = report_.contents + report_.without_surfaces > kMostFiles;
  if (has_too_many_files || report_.documents > kMostDocuments) fail_for_too_many(address);
  std::string bytes = source_.read(address, progress_);
  report_.bytes += bytes.size();
  if (report_.bytes + contents_.bytes_of_other_files() > kMostRegionBytes) {
    throw Error(ErrorCode::region_invalid,
                "the files of the region have more than " + std::to_string(kMostRegionBytes >> 30U) + " GiB together",
                source_.shown(address), "give a smaller radius, or a larger detail");
  }
  return bytes;
}

/// A file that says which tiles there are.
std::string Walk::read_description(const std::string& address) {
  std::string text = read_file(address);
  described_bytes_ += text.size();
  if (described_bytes_ > kMostText) {
    throw Error(
        ErrorCode::region_invalid,
        "the tilesets and subtrees of the region have more than " + std::to_string(kMostText >> 20U) + " MiB together",
        source_.shown(address), "give a smaller radius, or a larger detail");
  }
  return text;
}

/// The files from `first` on that cannot be read, where a coarser tile can hold their place.
void Walk::hold_by_coarser(std::size_t first, const std::shared_ptr<Coarser>& coarser) {
  const std::optional<std::uint32_t> object = keep_coarser(coarser);
  if (!object) return;
  for (std::size_t i = first; i < collector_.missing.size(); ++i) {
    MissingPart& part = collector_.missing[i];
    if (!part.is_hole) continue;  // what is missing in files that are read, the coarser one too
    part.is_held = false;
    part.entry.stand_in = object;
    part.entry.instead = "a coarser tile";
  }
}

/// Takes the nearest tile above that can be read, which a tile was to replace that cannot be: rather too much is hidden
/// than too little. Returns the first of its objects.
std::optional<std::uint32_t> Walk::keep_coarser(std::shared_ptr<Coarser> tile) {
  for (int i = 0; i < kMostCoarser && tile; ++i, tile = tile->above) {
    if (tile->object) return tile->object;
    if (tile->is_taken) continue;
    tile->is_taken = true;
    Visit visit;
    visit.trail = tile->trail;
    visit.coarser = tile->above;
    visit.depth = tile->depth;
    visit.refinement = tile->here.refinement;
    std::size_t unread = 0;  // no holes: nobody asked for them
    const std::size_t contents = report_.contents, triangles = collector_.triangles.size();
    read_contents(
        visit, tile->here, [](const ContentName& content) { return !is_named_json(content.uri); },
        [&](const ContentName&, const Error&) { ++unread; });
    if (unread > 0 || report_.contents == contents || collector_.triangles.size() == triangles) continue;
    tile->object = collector_.object_of[triangles];
    collector_.coarser.try_emplace(*tile->object, triangles, collector_.triangles.size());
    ++report_.coarser_kept;
    report_.largest_error_m = std::max(report_.largest_error_m, tile->here.error_m);
    return tile->object;
  }
  return std::nullopt;
}

/// Tiles without surfaces replace nothing: what they were to replace stays, unless some of them lie beyond the circle.
void Walk::keep_unreplaced(Coarser& tile) {
  if (tile.is_cut && tile.above) tile.above->is_cut = true;
  if (tile.is_cut || tile.is_taken || collector_.triangles.size() > tile.triangles) return;
  tile.is_taken = true;
  Visit visit;
  visit.trail = tile.trail;
  visit.coarser = tile.above;
  visit.depth = tile.depth;
  visit.bounds = tile.here.bounds;
  std::erase_if(tile.here.contents, [](const ContentName& content) { return is_named_json(content.uri); });
  const std::size_t missing = collector_.missing.size();
  TilesetReport before = report_;
  take(visit, tile.here, false);
  if (collector_.triangles.size() > tile.triangles || report_.holes > before.holes) return;
  collector_.missing.erase(collector_.missing.begin() + static_cast<std::ptrdiff_t>(missing), collector_.missing.end());
  before.bytes = report_.bytes;
  report_ = std::move(before);
}

void Walk::visit(Visit& visit) {
  if (visit.is_end) {
    keep_unreplaced(*visit.coarser);
    return;
  }
  if (++looked_at_ > kMostTiles) {
    throw Error(ErrorCode::region_invalid,
                "the region has more than " + std::to_string(kMostTiles) + " tiles, or the tileset has no end",
                visit.trail->document->shown(), "give a smaller radius, or a larger detail");
  }
  if (visit.depth > kDeepest) visit.trail->document->fail("its tiles are nested deeper than 1000 levels");
  if (visit.described) {
    visit_explicit(visit);
  } else if (!visit.external.empty()) {
    visit_external(visit);
  } else {
    visit_implicit(visit);
  }
}

void Walk::visit_explicit(Visit& visit) {
  const TilesetDocument& document = *visit.trail->document;
  const Tile tile = document.tile(*visit.described);
  Here here;
  here.into_world = visit.parent * tile.transform;
  here.bounds = moved(tile.bounds, here.into_world);
  here.error_m = tile.error_m.value_or(visit.error_m);
  here.refinement = tile.refinement.value_or(visit.refinement);
  if (!meets(visit, here.bounds)) return;
  if (!std::holds_alternative<Everywhere>(here.bounds)) visit.bounds = here.bounds;
  if (tile.implicit) {
    enter_tree(visit, tile, here);
    return;
  }
  here.contents = tile.contents;
  ++report_.tiles;
  if (!take(visit, here, tile.children != nullptr)) return;
  for (auto child = tile.children->rbegin(); child != tile.children->rend(); ++child) {
    Visit next;
    next.trail = visit.trail;
    next.described = &*child;
    next.parent = here.into_world;
    next.bounds = visit.bounds;
    next.refinement = here.refinement;
    next.error_m = here.error_m;
    next.coarser = here.coarser;
    next.depth = visit.depth + 1;
    waiting_.push_back(std::move(next));
  }
}

/// Whether something lies within the circle. What does not may replace some of the tile above.
bool Walk::meets(const Visit& visit, const Volume& bounds) const {
  const bool is_met = reach_.meets(bounds);
  if (!is_met && visit.coarser) visit.coarser->is_cut = true;
  return is_met;
}

/// Reads what a tile holds where it is wanted. Returns whether the tile's children are wanted, too.
bool Walk::take(const Visit& visit, Here& here, bool has_children) {
  const auto is_document = [](const ContentName& content) { return is_named_json(content.uri); };
  const bool has_own = std::any_of(here.contents.begin(), here.contents.end(),
                                   [&](const ContentName& content) { return !is_document(content); });
  // A tile without content is finer only in its children, whatever it says. Children that are added are no finer forms.
  const bool goes_on = has_children && (here.error_m > detail_m_ || !has_own || here.refinement == Refinement::add);
  const bool is_taken = !goes_on || here.refinement == Refinement::add;
  if (has_own && !goes_on) {
    report_.largest_error_m = std::max(report_.largest_error_m, here.error_m);
    if (here.error_m > detail_m_) ++report_.coarse;
  }
  here.coarser = visit.coarser;
  here.is_taken = is_taken;
  const std::size_t missing = collector_.missing.size();
  const std::uint64_t holes = report_.holes;
  read_contents(
      visit, here, [&](const ContentName& content) { return is_taken || is_document(content); },
      [&](const ContentName& content, const Error& error) {
        const Volume own = moved(content.bounds, here.into_world);
        count_hole(error, id_of(visit.trail->document->address(), content.uri),
                   std::holds_alternative<Everywhere>(own) ? visit.bounds : own);
      });
  if (report_.holes > holes) hold_by_coarser(missing, visit.coarser);
  if (has_own && !is_taken) {
    here.coarser =
        std::make_shared<Coarser>(Coarser{visit.trail, here, visit.coarser, visit.depth, collector_.triangles.size()});
    Visit end;  // it comes when all that is to replace the tile has been read
    end.trail = visit.trail;
    end.coarser = here.coarser;
    end.is_end = true;
    waiting_.push_back(std::move(end));
  }
  return goes_on;
}

/// `tell`: is told of what cannot be read.
void Walk::read_contents(const Visit& visit, const Here& here, const std::function<bool(const ContentName&)>& is_wanted,
                         const std::function<void(const ContentName&, const Error&)>& tell) {
  const TilesetDocument& document = *visit.trail->document;
  for (const ContentName& content : here.contents) {
    if (!is_wanted(content)) continue;
    if (!meets(visit, moved(content.bounds, here.into_world))) continue;
    try {
      const std::string address = source_.resolve(document.address(), content.uri);
      if (is_named_json(content.uri)) {
        wait_for(visit, here, address, here.is_taken);
      } else {
        read_content(visit, here, address);
      }
    } catch (const Error& error) {
      if (ends_all(error)) throw;
      tell(content, error);
    }
  }
}

/// What a file that a tile names is called in ids.
std::string Walk::id_of(const std::string& base, const std::string& uri) const {
  try {
    return source_.name(source_.resolve(base, uri));
  } catch (const Error&) {
    return without_query(uri);
  }
}

void Walk::read_content(const Visit& visit, const Here& here, const std::string& address) {
  const std::string bytes = read_file(address);
  if (is_tileset_text(bytes)) {
    wait_for(visit, here, address, true);
  } else {
    read_mesh(address, bytes, {here.into_world, visit.trail->document->gltf_up(), visit.bounds, world_});
  }
}

void Walk::read_mesh(const std::string& address, const std::string& bytes, const Placement& placement) {
  if (contents_.read(address, bytes, placement)) {
    ++report_.contents;
  } else {
    ++report_.without_surfaces;
  }
}

void Walk::wait_for(const Visit& visit, const Here& here, const std::string& address, bool is_taken) {
  Visit next;
  next.trail = visit.trail;
  next.external = address;
  next.is_taken = is_taken;
  next.coarser = visit.coarser;
  next.parent = here.into_world;
  next.bounds = visit.bounds;
  next.refinement = here.refinement;
  next.depth = visit.depth + 1;
  waiting_.push_back(std::move(next));
}

void Walk::visit_external(const Visit& visit) {
  const std::string& address = visit.external;
  const auto refuse = [&](const std::string& problem, const std::string& fix) {
    throw Error(ErrorCode::mesh_syntax, problem, source_.shown(address), fix);
  };
  for (const Trail* above = visit.trail.get(); above; above = above->parent.get()) {
    if (above->document->address() == address) {
      refuse("the tileset contains itself",
             "remove the tile of " + visit.trail->document->shown() + " that refers to it");
    }
  }
  if (visit.trail->depth >= kMostNested) {
    refuse("tilesets contain each other more than " + std::to_string(kMostNested) + " levels deep",
           "export the tileset again");
  }
  auto document = remembered(address);
  if (!document) {
    const std::string text = read_description(address);
    if (!is_tileset_text(text)) {
      if (!visit.is_taken) refuse("the file is no tileset, though its name says so", "name it as what it is");
      read_mesh(address, text, {visit.parent, visit.trail->document->gltf_up(), visit.bounds, world_});
      return;
    }
    core::ReadLimits limits = limits_;
    limits.json_bytes -= std::min(limits.json_bytes, visit.trail->memory_bytes);
    document = std::make_shared<TilesetDocument>(address, source_.shown(address), text, progress_, limits);
    remember(document);
  }
  ++report_.documents;
  Visit next;
  next.trail = std::make_shared<Trail>(
      Trail{document, visit.trail, visit.trail->depth + 1, visit.trail->memory_bytes + document->memory_bytes()});
  next.described = &document->root();
  next.parent = visit.parent;
  next.bounds = visit.bounds;
  next.refinement = visit.refinement;
  next.error_m = document->error_m();
  next.coarser = visit.coarser;
  next.depth = visit.depth;
  waiting_.push_back(std::move(next));
}

/// Many tiles may refer to one tileset: it is parsed once. Null for one that is not kept.
std::shared_ptr<const TilesetDocument> Walk::remembered(const std::string& address) {
  if (report_.documents > kMostDocuments) fail_for_too_many(address);
  const auto known = std::find_if(remembered_.begin(), remembered_.end(),
                                  [&](const auto& document) { return document->address() == address; });
  return known == remembered_.end() ? nullptr : *known;
}

void Walk::remember(const std::shared_ptr<const TilesetDocument>& document) {
  constexpr std::size_t kMost = 64;  // each is looked at
  if (document->memory_bytes() > kMostRemembered) return;
  remembered_.push_back(document);
  remembered_bytes_ += document->memory_bytes();
  while (remembered_bytes_ > kMostRemembered || remembered_.size() > kMost) {
    remembered_bytes_ -= remembered_.front()->memory_bytes();
    remembered_.pop_front();
  }
}

void Walk::enter_tree(const Visit& visit, const Tile& tile, const Here& here) {
  const auto tree = std::make_shared<ImplicitTree>(visit.trail->document, tile, here.error_m);
  enter_subtree(visit, tree, TileIndex{}, here.into_world, here.refinement);
}

void Walk::enter_subtree(const Visit& visit, const std::shared_ptr<const ImplicitTree>& tree, const TileIndex& root,
                         const Transform& into_world, Refinement refinement) {
  const std::string address = source_.resolve(tree->document->address(), tree->uri_of(tree->subtrees, root));
  const auto read_buffer = [&](const std::string& uri) { return read_file(source_.resolve(address, uri)); };
  auto loaded = std::make_shared<LoadedSubtree>(LoadedSubtree{tree, root, nullptr});
  const std::string bytes = read_description(address);
  ++report_.documents;
  try {
    loaded->bits = std::make_shared<Subtree>(bytes, tree->shape, read_buffer, progress_, limits_);
  } catch (const std::string& problem) {
    throw Error(ErrorCode::mesh_syntax, "not a valid subtree: " + problem, source_.shown(address),
                "export the tileset again; the file is cut off or garbled");
  }
  if (!loaded->bits->has_tile(0, 0)) {
    if (root.level == 0) return;
    throw Error(ErrorCode::mesh_syntax, "the subtree has no tile at its root, and its parent says that there is one",
                source_.shown(address), "export the tileset again");
  }
  Visit next;
  next.trail = visit.trail;
  next.subtree = loaded;
  next.index = root;
  next.coarser = visit.coarser;
  next.parent = into_world;
  next.bounds = visit.bounds;
  next.refinement = refinement;
  next.depth = visit.depth + 1;
  waiting_.push_back(std::move(next));
}

void Walk::visit_implicit(Visit& visit) {
  const ImplicitTree& tree = *visit.subtree->tree;
  const TileIndex& index = visit.index;
  const std::uint32_t level = index.level - visit.subtree->root.level;
  Here here;
  here.into_world = visit.parent;
  here.bounds = moved(tree.bounds_of(index), here.into_world);
  here.error_m = std::ldexp(tree.error_m, -static_cast<int>(index.level));
  here.refinement = visit.refinement;
  if (!meets(visit, here.bounds)) return;
  if (!std::holds_alternative<Everywhere>(here.bounds)) visit.bounds = here.bounds;
  if (level == tree.shape.levels) {  // the root of the next subtree
    enter_subtree(visit, visit.subtree->tree, index, visit.parent, visit.refinement);
    return;
  }
  ++report_.tiles;
  const std::uint64_t morton = morton_of(index, level, tree.is_octree);
  for (std::size_t i = 0; i < tree.contents.size(); ++i) {
    if (visit.subtree->bits->has_content(i, level, morton)) {
      here.contents.push_back({tree.uri_of(tree.contents[i].uri, index), Everywhere{}});
    }
  }
  std::vector<TileIndex> children = children_of(visit);
  if (!take(visit, here, !children.empty())) return;
  for (auto child = children.rbegin(); child != children.rend(); ++child) {
    Visit next = visit;
    next.index = *child;
    next.coarser = here.coarser;
    next.depth = visit.depth + 1;
    waiting_.push_back(std::move(next));
  }
}

std::vector<TileIndex> Walk::children_of(const Visit& visit) const {
  const ImplicitTree& tree = *visit.subtree->tree;
  std::vector<TileIndex> children;
  if (visit.index.level + 1 >= tree.levels) return children;
  constexpr std::uint32_t kDeepestIndex = 60;  // coordinates of tiles are numbers of 64 bits
  if (visit.index.level >= kDeepestIndex) tree.document->fail("its implicit tiles are deeper than 60 levels");
  const std::uint32_t level = visit.index.level + 1 - visit.subtree->root.level;
  for (std::uint64_t i = 0; i < tree.shape.children; ++i) {
    TileIndex child = visit.index;
    ++child.level;
    child.at = {2 * child.at[0] + (i & 1U), 2 * child.at[1] + (i >> 1U & 1U),
                tree.is_octree ? 2 * child.at[2] + (i >> 2U & 1U) : 0};
    const std::uint64_t morton = morton_of(child, level, tree.is_octree);
    const bool is_there = level < tree.shape.levels ? visit.subtree->bits->has_tile(level, morton)
                                                    : visit.subtree->bits->has_child_subtree(morton);
    if (is_there) children.push_back(child);
  }
  return children;
}

}  // namespace vantage::internal::tiles
