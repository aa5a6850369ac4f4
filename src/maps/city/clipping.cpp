#include "maps/city/clipping.h"

#include <algorithm>
#include <clipper.hpp>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <optional>
#include <utility>

#include "maps/city/interruption.h"

namespace vantage::internal::city {
namespace {

using ClipperLib::IntPoint;
using ClipperLib::Path;
using ClipperLib::Paths;

// Crossings are rounded to the grid, which may make sides cross again; every round makes that rarer.
constexpr int kMostRounds = 20;
constexpr double kMiterLimit = 3;       // of a sharp bend in a widened line, in half widths; beyond it is cut off
constexpr std::int64_t kFinest = 4096;  // of Clipper's units in one of the grid's

/// `scale`: how many of Clipper's units one of the grid's is.
Path to_path(const GridRing& ring, std::int64_t scale = 1) {
  Path path;
  path.reserve(ring.size());
  for (const GridPoint& p : ring) path.emplace_back(p.x * scale, p.y * scale);
  return path;
}

GridRing to_ring(const Path& path, std::int64_t scale = 1) {
  const auto rounded = [&](std::int64_t v) { return (v >= 0 ? v + scale / 2 : v - scale / 2) / scale; };
  GridRing ring;
  ring.reserve(path.size());
  for (const IntPoint& p : path) ring.push_back({rounded(p.X), rounded(p.Y)});
  return ring;
}

ClipperLib::ClipType clipper_type(ClipOperation operation) {
  switch (operation) {
    case ClipOperation::unite:
      return ClipperLib::ctUnion;
    case ClipOperation::subtract:
      return ClipperLib::ctDifference;
    case ClipOperation::intersect:
      break;
  }
  return ClipperLib::ctIntersection;
}

/// Nothing where Clipper fails, which it should not.
std::optional<Paths> execute(const std::shared_ptr<ClipperLib::Clipper>& clipper, ClipOperation operation,
                             FillRule rule, std::size_t corners) {
  constexpr std::size_t kMany = 500;
  const ClipperLib::ClipType type = clipper_type(operation);
  const ClipperLib::PolyFillType fill = rule == FillRule::even_odd ? ClipperLib::pftEvenOdd : ClipperLib::pftNonZero;
  const auto run = [clipper, type, fill]() -> std::optional<Paths> {
    Paths paths;
    return clipper->Execute(type, paths, fill, fill) ? std::optional(std::move(paths)) : std::nullopt;
  };
  return corners < kMany ? run() : Interruption::run_apart(run);
}

/// Runs Clipper, and makes polygons of what comes out.
std::vector<GridPolygon> run_clipper(const std::vector<const GridRing*>& subject,
                                     const std::vector<const GridRing*>& clip, ClipOperation operation, FillRule rule,
                                     std::int64_t scale) {
  const auto clipper = std::make_shared<ClipperLib::Clipper>();
  clipper->StrictlySimple(true);
  GridRing all;  // of the subject
  std::size_t corners = 0;
  for (const GridRing* ring : subject) {
    clipper->AddPath(to_path(*ring, scale), ClipperLib::ptSubject, true);
    all.insert(all.end(), ring->begin(), ring->end());
  }
  for (const GridRing* ring : clip) {
    clipper->AddPath(to_path(*ring, scale), ClipperLib::ptClip, true);
    corners += ring->size();
  }
  const auto paths = execute(clipper, operation, rule, corners + all.size());
  if (!paths) return {{hull_of(std::move(all)), {}}};
  std::vector<GridRing> rings;
  for (const Path& path : *paths) {
    GridRing ring = tidied(to_ring(path, scale), Straight::exact);
    if (!ring.empty()) rings.push_back(std::move(ring));
  }
  return nested(rings);
}

}  // namespace

void Clipping::add(const std::vector<GridPolygon>& polygons, Rings& rings) {
  for (const GridPolygon& polygon : polygons) {
    rings.push_back(&polygon.outer);
    for (const GridRing& hole : polygon.holes) rings.push_back(&hole);
  }
}

// Clipper rounds wherever a side passes the height of a corner, so it is given finer units than those of the grid: as
// fine as its fast arithmetic allows, or kFinest.
std::vector<GridPolygon> Clipping::run(ClipOperation operation, FillRule rule) const {
  std::int64_t largest = 1;
  for (const Rings* rings : {&subject_, &clip_}) {
    for (const GridRing* ring : *rings) {
      for (const GridPoint& p : *ring) largest = std::max({largest, std::abs(p.x), std::abs(p.y)});
    }
  }
  std::int64_t scale = 1;
  while (scale < kFinest && 2 * scale * largest < ClipperLib::loRange) scale *= 2;
  return run_clipper(subject_, clip_, operation, rule, scale);
}

std::vector<GridPolygon> Clipping::run_fine(ClipOperation operation, FillRule rule) const {
  return run_clipper(subject_, clip_, operation, rule, kFinest);
}

std::vector<GridPolygon> settled(std::vector<GridPolygon> polygons) {
  for (int round = 0; round < kMostRounds; ++round) {
    const std::vector<GridRing> rings = rings_of(polygons);
    if (!meeting_of(rings).crossing) return tidied(polygons);
    Clipping clipping;
    for (const GridRing& ring : rings) clipping.add(ring);
    polygons = clipping.run_fine(ClipOperation::unite, FillRule::even_odd);
  }
  // Where pieces touch they may go on crossing by less than a unit: each for itself is simple, or its hull is.
  for (GridPolygon& polygon : polygons) {
    if (meeting_of(rings_of({polygon})).crossing) polygon = {hull_of(polygon.outer), {}};
  }
  return polygons;
}

std::vector<GridRing> widened(const GridRing& line, bool closed, double width) {
  ClipperLib::ClipperOffset offset(kMiterLimit);
  offset.AddPath(to_path(line), ClipperLib::jtMiter,
                 closed && line.size() > 2 ? ClipperLib::etClosedLine : ClipperLib::etOpenButt);
  Paths paths;
  offset.Execute(paths, width / 2);
  std::vector<GridRing> rings;
  for (const Path& path : paths) rings.push_back(to_ring(path));
  return rings;
}

}  // namespace vantage::internal::city
