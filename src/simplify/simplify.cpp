// Edges are collapsed inwards, the one that loses least first. docs/simplify.md says why nothing is added.
#include "vantage/simplify.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <tuple>
#include <utility>

#include "core/causes.h"
#include "core/mend_welded.h"
#include "core/parallel.h"
#include "core/progress_reporter.h"
#include "core/volume_check.h"
#include "simplify/collapse.h"
#include "simplify/lost_distance.h"
#include "simplify/prepare.h"
#include "simplify/surface.h"
#include "simplify/whole_pieces.h"
#include "vantage/error.h"

namespace vantage {
namespace {

using namespace internal::simplify;
namespace core = internal::core;
namespace parallel = internal::parallel;

constexpr std::size_t kFewestFacets = 4;  // that close a mesh
constexpr std::size_t kHub = 40;  // facets at a vertex; with more, its edges are looked at when their turn comes

void check_options(const SimplifyOptions& options) {
  if (!options.facets && !options.error_m) {
    throw Error(ErrorCode::nothing_given, "it is not said how far to simplify", "facets, error_m",
                "give the number of facets, or how far what is lost may be from the result");
  }
  if (options.facets && *options.facets < kFewestFacets) {
    throw Error(ErrorCode::value_out_of_range, "a closed mesh has at least 4 facets", "facets", "give 4 or more");
  }
  if (options.error_m && !(*options.error_m >= 0 && std::isfinite(*options.error_m))) {
    throw Error(ErrorCode::value_out_of_range, "error_m is not a number of at least 0", "error_m",
                "give how far what is lost may be from the result, in metres");
  }
}

/// An edge that may be collapsed to one of its places.
struct Waiting {
  double cost = 0;
  std::uint32_t from = 0, to = 0;
  std::uint32_t rank = 0;                       ///< of its places: which
  std::uint32_t stamp = 0;                      ///< of its ends, when it was looked at
  bool operator<(const Waiting& other) const {  // the cheapest comes first out of a heap
    return std::tie(other.cost, other.from, other.to, other.rank) < std::tie(cost, from, to, rank);
  }
};

/// Where work needs memory that is used again.
struct Scratch {
  Patch patch;
  std::vector<Place> places;
};

/// Facets and gaps of this width are still ones for who writes the mesh, and for booleans, whose tolerance is a part of
/// the size of 1e-12.
double narrowest_m(const Mesh& mesh) {
  constexpr double kOfSize = 1e-11;
  const Box box = bounding_box(mesh);
  return std::max(2 * core::flat_width(mesh), kOfSize * (box.max - box.min).norm());
}

class Simplifier {
 public:
  Simplifier(const Prepared& prepared, const SimplifyOptions& options)
      : surface_(prepared.mesh, prepared.pieces.piece_of),
        pieces_(prepared.mesh, prepared.pieces),
        narrowest_m_(narrowest_m(prepared.mesh)),
        lost_(surface_.slots(), lengths(prepared.mesh, options, narrowest_m_)),
        stamps_(surface_.vertices().size(), 0),
        is_marked_(surface_.vertices().size(), 0),
        wanted_(options.facets.value_or(kFewestFacets)) {}

  void run(const core::ProgressReporter& progress);

  const Surface& surface() const { return surface_; }
  double lost_bound_m() const { return lost_.largest_m(surface_); }
  std::size_t pieces_left() const { return pieces_.left(); }
  std::size_t pieces_dropped() const { return dropped_; }

 private:
  static LostDistance::Lengths lengths(const Mesh& mesh, const SimplifyOptions& options, double flat_m) {
    const Box box = bounding_box(mesh);
    const double size = (box.max - box.min).norm();
    return {size, options.error_m ? *options.error_m / 4 : 1e-4 * size, flat_m, options.error_m};
  }

  std::optional<Waiting> look_at(std::uint32_t from, std::uint32_t to, std::uint32_t rank, Scratch& scratch) const;
  void look_at_all(const core::ProgressReporter& progress);
  void look_again_at(std::uint32_t from, std::uint32_t to, std::uint32_t rank);
  void collapse_next();
  void look_round(std::uint32_t vertex);
  bool is_hub(std::uint32_t vertex) const { return surface_.star(vertex).size() > kHub; }
  void drop_piece();

  Surface surface_;
  WholePieces pieces_;
  double narrowest_m_;
  LostDistance lost_;
  std::vector<std::uint32_t> stamps_;  ///< per vertex: how often facets at it have changed
  std::vector<char> is_marked_;        ///< per vertex
  std::size_t wanted_;
  std::priority_queue<Waiting> queue_;
  Scratch scratch_;
  std::vector<FacetBound> bounds_;
  std::vector<std::uint32_t> ring_, beyond_;
  std::size_t dropped_ = 0;
  std::size_t looked_at_ = 0;  ///< facets that there were when all edges were looked at
};

std::optional<Waiting> Simplifier::look_at(std::uint32_t from, std::uint32_t to, std::uint32_t rank,
                                           Scratch& scratch) const {
  constexpr double kLongEdges = 1e-7;  // of what costs nothing short edges go first: facets become less narrow
  if (!surface_.find_patch(from, to, scratch.patch)) return std::nullopt;
  find_places(surface_, scratch.patch, scratch.places);
  if (rank >= scratch.places.size()) return std::nullopt;
  const double length = (surface_.vertices()[from] - surface_.vertices()[to]).norm();
  const double cost = scratch.places[rank].loss_m3 + kLongEdges * length * length * length;
  return Waiting{cost, from, to, rank, stamps_[from] + stamps_[to]};
}

void Simplifier::look_again_at(std::uint32_t from, std::uint32_t to, std::uint32_t rank) {
  if (const auto waiting = look_at(std::min(from, to), std::max(from, to), rank, scratch_)) queue_.push(*waiting);
}

void Simplifier::look_at_all(const core::ProgressReporter& progress) {
  looked_at_ = surface_.count();
  std::vector<std::optional<Waiting>> found(3 * surface_.slots());
  parallel::for_ranges(surface_.slots(), 256, [&](std::size_t begin, std::size_t end) {
    Scratch scratch;
    for (std::size_t f = begin; f < end; ++f) {
      progress.check();
      if (surface_.is_gone(static_cast<std::uint32_t>(f))) continue;
      const Triangle& facet = surface_.facet(static_cast<std::uint32_t>(f));
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t from = facet[k], to = facet[(k + 1) % 3];
        if (from < to) found[3 * f + k] = look_at(from, to, 0, scratch);
      }
    }
  });
  std::vector<Waiting> waiting;
  for (const std::optional<Waiting>& one : found) {
    if (one) waiting.push_back(*one);
  }
  queue_ = std::priority_queue<Waiting>(std::less<Waiting>(), std::move(waiting));
}

/// The edges of all facets that have changed: at the vertex and at its neighbours. Of a neighbour with very many only
/// those near the vertex: the others have their old place in the queue.
void Simplifier::look_round(std::uint32_t vertex) {
  surface_.neighbours(vertex, ring_);
  ring_.push_back(vertex);
  for (const std::uint32_t v : ring_) {
    ++stamps_[v];
    is_marked_[v] = 1;
  }
  for (const std::uint32_t v : ring_) {
    surface_.neighbours(v, beyond_);
    for (const std::uint32_t w : beyond_) {
      if (is_marked_[w] ? v < w : !is_hub(v)) look_again_at(v, w, 0);
    }
  }
  for (const std::uint32_t v : ring_) is_marked_[v] = 0;
}

void Simplifier::collapse_next() {
  const Waiting next = queue_.top();
  queue_.pop();
  if (stamps_[next.from] + stamps_[next.to] != next.stamp) {
    if (is_hub(next.from) || is_hub(next.to)) look_again_at(next.from, next.to, 0);
    return;
  }
  const auto& [patch, places] = scratch_;
  if (!surface_.find_patch(next.from, next.to, scratch_.patch)) return;
  find_places(surface_, patch, scratch_.places);
  const Place place = places[next.rank];
  if (!is_inner(surface_, patch, place.at) || !is_clean(surface_, patch, place.at, narrowest_m_) ||
      !lost_.after(surface_, patch, place.at, bounds_)) {
    look_again_at(next.from, next.to, next.rank + 1);
    return;
  }
  pieces_.collapsed(surface_.piece_of(patch.facets[0]), place.loss_m3);
  surface_.collapse(patch, place.at);
  lost_.set(bounds_);
  ++stamps_[next.to];
  look_round(next.from);
}

void Simplifier::drop_piece() {
  const auto facets = pieces_.take_cheapest(surface_);
  if (!facets) return;
  const std::uint32_t piece = surface_.piece_of(facets->front());
  const Vec3 corner = surface_.corners(facets->front())[0];
  std::uint32_t nearest = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::uint32_t f = 0; f < surface_.slots(); ++f) {
    if (surface_.is_gone(f) || surface_.piece_of(f) == piece) continue;
    const double distance = (surface_.corners(f)[0] - corner).squaredNorm();
    if (distance >= least) continue;
    least = distance;
    nearest = f;
  }
  const FacetBound bound = lost_.after_drop(surface_, *facets, nearest);
  if (!lost_.is_allowed(bound)) {
    pieces_.keep_taken();
    return;
  }
  surface_.drop(*facets);
  lost_.set({bound});
  ++dropped_;
}

void Simplifier::run(const core::ProgressReporter& progress) {
  look_at_all(progress.part(0, 0.1));
  const core::ProgressReporter collapsing = progress.part(0.1, 0.9);
  const std::size_t first = surface_.count();
  while (surface_.count() > wanted_) {
    collapsing.tick(first - surface_.count(), first - wanted_);
    const std::optional<double> piece_m3 = pieces_.cheapest_m3();
    if (piece_m3 && (queue_.empty() || *piece_m3 <= queue_.top().cost)) {
      collapsing.check();  // it looks at all facets
      drop_piece();
    } else if (!queue_.empty()) {
      collapse_next();
    } else if (surface_.count() < looked_at_) {
      look_at_all(collapsing);  // what could not be collapsed round hubs before may be now
    } else {
      return;
    }
  }
}

SimplifiedVolume as_it_is(const Mesh& volume, const Prepared& prepared) {
  SimplifiedVolume result;
  result.mesh = volume;
  for (std::uint32_t t = 0; t < volume.triangles.size(); ++t) result.facet_of.push_back(t);
  result.pieces = prepared.pieces.pieces.size();
  return result;
}

SimplifiedVolume simplified(const Prepared& prepared, const SimplifyOptions& options,
                            const core::ProgressReporter& progress) {
  Simplifier simplifier(prepared, options);
  simplifier.run(progress);
  const Surface& surface = simplifier.surface();
  SimplifiedVolume result;
  result.mesh.vertices = surface.vertices();
  for (std::uint32_t f = 0; f < surface.slots(); ++f) {
    if (surface.is_gone(f)) continue;
    result.mesh.triangles.push_back(surface.facet(f));
    result.facet_of.push_back(prepared.facet_of[f]);
  }
  core::drop_unused_vertices(result.mesh);
  result.lost_bound_m = simplifier.lost_bound_m();
  result.lost_measured_m = farthest_m(prepared.mesh.vertices, result.mesh, progress);
  result.pieces = simplifier.pieces_left();
  result.pieces_dropped = simplifier.pieces_dropped();
  result.reached = !options.facets || result.mesh.triangles.size() <= *options.facets;
  return result;
}

}  // namespace

SimplifiedVolume simplify_volume(const Mesh& volume, const SimplifyOptions& options, const Progress& callback) {
  check_options(options);
  const core::ProgressReporter progress(callback);
  progress.begin("simplify");
  const Prepared prepared = prepare(volume, progress);
  const bool is_small = !options.error_m && volume.triangles.size() <= *options.facets;
  SimplifiedVolume result = is_small ? as_it_is(volume, prepared) : simplified(prepared, options, progress);
  result.facets_before = volume.triangles.size();
  result.volume_before_m3 = enclosed_volume(volume);
  result.volume_after_m3 = enclosed_volume(result.mesh);
  progress.finish();
  return result;
}

Volume with_mesh(Volume volume, SimplifiedVolume simplified) {
  if (volume.causes.empty()) {
    volume.causes = {{CauseKind::scene, "simplified"}};
    volume.cause_of.assign(volume.mesh.triangles.size(), 0);
  }
  core::check_volume(volume);
  std::vector<std::uint32_t> cause_of;
  for (const std::uint32_t facet : simplified.facet_of) {
    if (facet >= volume.cause_of.size()) {
      throw Error(ErrorCode::index_out_of_range, "the simplified mesh is not one of this volume's", "volume",
                  "pass the volume whose mesh was simplified");
    }
    cause_of.push_back(volume.cause_of[facet]);
  }
  volume.cause_of = std::move(cause_of);
  volume.polygon_of.clear();
  volume.mesh = std::move(simplified.mesh);
  core::compact_causes(volume.mesh, volume.cause_of, volume.causes);
  volume.tolerance_m += simplified.lost_bound_m;
  return volume;
}

}  // namespace vantage
