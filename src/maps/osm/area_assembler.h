// Rings and polygons from ways, by libosmium's assembler.
#pragma once

#include <cstddef>
#include <osmium/memory/buffer.hpp>
#include <osmium/osm/relation.hpp>
#include <osmium/osm/way.hpp>
#include <string>
#include <vector>

#include "core/progress_reporter.h"
#include "maps/osm/extract.h"

namespace vantage::internal::osm {

/// A way that is a member of a multipolygon, and what it turned out to be.
struct MemberWay {
  const osmium::Way* way = nullptr;
  const char* role = "";  ///< as in the relation: only to word problems by, and for `stray`
  bool outer = false;     ///< it is part of an outer ring
  bool inner = false;     ///< it is part of a hole
  bool stray = false;     ///< an inner one that bounds an area of its own, or another one that bounds a hole
};

struct Assembly {
  std::vector<Polygon> polygons;  ///< empty: nothing could be assembled
  std::string problem;  ///< why not, for people: "the ring is open at 7.41, 1.11 (way/714801)"; empty when it could
};

/// Assembles a closed way. Positions that are undefined are left out; one that touches itself becomes several polygons
/// or has holes. Not one that is wound round some of its area twice: the assembler would leave that out.
Assembly assemble(const osmium::Way& way);

/// Assembles a multipolygon from the members that are there, whatever their roles, and tells which way is which. Not
/// where the assembler would leave out what lies in outer rings and in no sound hole: see ring_fault.
Assembly assemble(const osmium::Relation& relation, std::vector<MemberWay>& members);

/// The same members where they cannot be assembled: every outer ring for itself, crossing or not, those without an end
/// as one incomplete polygon, and the inner rings that are whole as holes of each outer ring whose bounds meet theirs:
/// which are sound is for others to tell. Roles count: what is not "inner" is outer. Cost: O(n log n) in the nodes.
/// Error(cancelled) when told to stop.
std::vector<Polygon> drawn_polygons(const std::vector<MemberWay>& members, const core::ProgressReporter& progress);

/// The way's positions, those that follow each other all different: of a closed way the first is repeated at the end.
std::vector<LonLat> positions(const osmium::Way& way);

/// The ring that a way draws, closed by a straight side where it is open, whether it crosses itself or not. All
/// positions on one line, or some not known (`incomplete`): an incomplete polygon. Nothing without a position.
std::vector<Polygon> raw_polygon(const osmium::Way& way, bool incomplete = false);

}  // namespace vantage::internal::osm
