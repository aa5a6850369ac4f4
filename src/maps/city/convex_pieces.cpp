// Triangulated, then joined while convex: S. Hertel and K. Mehlhorn, "Fast triangulation of simple polygons" (1983).
#include <algorithm>
#include <map>
#include <utility>

#include "maps/city/footprint.h"
#include "maps/city/grid_rings.h"
#include "maps/city/triangulate.h"

namespace vantage::internal::city {
namespace {

/// Corners by index, counter-clockwise.
using Piece = std::vector<std::uint32_t>;

class Joiner {
 public:
  explicit Joiner(const Footprint& footprint) : grid_(footprint) {
    std::vector<GridRing> rings{grid_.to_grid(footprint.outer)};
    for (const Ring& hole : footprint.holes) rings.push_back(grid_.to_grid(hole));
    for (const Triangle& t : triangulate(rings)) pieces_.push_back({t[0], t[1], t[2]});
    for (const GridRing& ring : rings) points_.insert(points_.end(), ring.begin(), ring.end());
  }

  std::vector<Ring> run() {
    std::vector<std::size_t> owner(pieces_.size());  // of a triangle: the piece that it has become a part of
    for (std::size_t i = 0; i < owner.size(); ++i) owner[i] = i;
    const auto find = [&](std::size_t i) {
      while (owner[i] != i) i = owner[i] = owner[owner[i]];
      return i;
    };
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::size_t> left_of;  // of a directed edge: the triangle there
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
      for (std::size_t e = 0; e < 3; ++e) left_of[{pieces_[i][e], pieces_[i][(e + 1) % 3]}] = i;
    }
    for (const auto& [edge, triangle] : left_of) {
      const auto other = left_of.find({edge.second, edge.first});
      if (other == left_of.end() || edge.first > edge.second) continue;
      const std::size_t a = find(triangle), b = find(other->second);
      if (a == b || !join(a, b, edge.first, edge.second)) continue;
      owner[b] = a;
    }
    std::vector<Ring> result;
    for (const Piece& piece : pieces_) {
      if (!piece.empty()) result.push_back(outline_of(piece));
    }
    return result;
  }

 private:
  /// Joins `b` to `a` across the edge from `from` to `to` of `a`, where the outcome is convex.
  bool join(std::size_t a, std::size_t b, std::uint32_t from, std::uint32_t to) {
    // `a` from the edge's end round to its beginning, then `b` likewise.
    Piece joined = opened(pieces_[a], to);
    const Piece rest = opened(pieces_[b], from);
    const std::size_t seam = joined.size() - 1;
    joined.insert(joined.end(), rest.begin() + 1, rest.end() - 1);
    const auto left = [&](std::size_t i) {
      const std::size_t n = joined.size();
      return turn(points_[joined[(i + n - 1) % n]], points_[joined[i]], points_[joined[(i + 1) % n]]) >= 0;
    };
    if (!left(0) || !left(seam)) return false;
    pieces_[a] = std::move(joined);
    pieces_[b].clear();
    return true;
  }

  static Piece opened(const Piece& piece, std::uint32_t first) {
    Piece result = piece;
    std::rotate(result.begin(), std::find(result.begin(), result.end(), first), result.end());
    return result;
  }

  /// Without the corners in the middle of straight sides.
  Ring outline_of(const Piece& piece) const {
    Ring ring;
    for (std::size_t i = 0; i < piece.size(); ++i) {
      const std::size_t n = piece.size();
      const GridPoint &before = points_[piece[(i + n - 1) % n]], &at = points_[piece[i]],
                      &after = points_[piece[(i + 1) % n]];
      if (turn(before, at, after) != 0) ring.push_back(grid_.to_metres(at));
    }
    return ring;
  }

  Grid grid_;
  std::vector<GridPoint> points_;
  std::vector<Piece> pieces_;
};

}  // namespace

std::vector<Ring> convex_pieces(const Footprint& footprint) { return Joiner(footprint).run(); }

std::vector<ConvexArea> convex_areas(const std::vector<Footprint>& footprints, Outlines state) {
  Repairs repairs;
  std::vector<ConvexArea> areas;
  for (const Footprint& area : state == Outlines::rough ? clean(footprints, repairs) : footprints) {
    areas.push_back({area.outer, convex_pieces(area)});
  }
  return areas;
}

}  // namespace vantage::internal::city
