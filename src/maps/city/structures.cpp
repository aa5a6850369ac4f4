#include "maps/city/structures.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <unordered_map>

#include "maps/city/interruption.h"
#include "maps/city/occluders.h"
#include "maps/city/roof_profile.h"

namespace vantage::internal::city {
namespace {

/// Side of the squares by which outlines are looked up, metres: about a block's.
constexpr double kCell = 64;
/// Of what encloses an outline that is not known or has no area, metres: a thinner one would be dropped as a sliver.
constexpr double kLeastSide = 0.25;
/// Where it is but one position: as wide as the column that stands in for a building that is drawn as a point.
constexpr double kPointSide = 20;

Ring enclosing(const Ring& positions) {
  const bool is_point =
      std::all_of(positions.begin(), positions.end(), [&](const Vec2& p) { return p == positions[0]; });
  return enclosing_rectangle(positions, is_point ? kPointSide : kLeastSide);
}

/// Whether `clean` leaves nothing of it.
bool is_thin(const Ring& ring) {
  Repairs repairs;
  return clean({{ring, {}}}, repairs).empty() && repairs.slivers > 0;
}

void set_bounds(Structure& structure) {
  structure.min = Vec2::Constant(std::numeric_limits<double>::infinity());
  structure.max = -structure.min;
  for (const Footprint& footprint : structure.footprints) {
    for (const Vec2& point : footprint.outer) {
      structure.min = structure.min.cwiseMin(point);
      structure.max = structure.max.cwiseMax(point);
    }
  }
}

Ring project(const osm::Ring& ring, const geo::LocalFrame& frame) {
  Ring projected;
  projected.reserve(ring.size());
  for (const geo::LonLat& position : ring) projected.push_back(frame.to_local(position));
  return projected;
}

/// Buildings by the squares that their bounds touch.
class OutlineGrid {
 public:
  explicit OutlineGrid(const std::vector<Structure>& structures) {
    for (std::size_t i = 0; i < structures.size(); ++i) {
      if (structures[i].is_part || structures[i].footprints.empty()) continue;
      all_.push_back(i);
      if (is_wide(structures[i])) {
        wide_.push_back(i);
      } else {
        for_cells(structures[i], [&](std::int64_t cell) { cells_[cell].push_back(i); });
      }
    }
  }

  /// Each once, in ascending order.
  std::vector<std::size_t> near(const Structure& structure) const {
    if (is_wide(structure)) return all_;
    std::vector<std::size_t> found = wide_;
    for_cells(structure, [&](std::int64_t cell) {
      const auto entry = cells_.find(cell);
      if (entry != cells_.end()) found.insert(found.end(), entry->second.begin(), entry->second.end());
    });
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end());
    return found;
  }

 private:
  /// More squares than there are buildings of its size.
  static bool is_wide(const Structure& structure) {
    constexpr double kMost = 3e3;  // metres
    return (structure.max - structure.min).maxCoeff() > kMost;
  }

  template <typename Visit>
  static void for_cells(const Structure& structure, const Visit& visit) {
    const auto index = [](double x) { return static_cast<std::int64_t>(std::floor(x / kCell)); };
    for (std::int64_t x = index(structure.min.x()); x <= index(structure.max.x()); ++x) {
      for (std::int64_t y = index(structure.min.y()); y <= index(structure.max.y()); ++y) {
        visit(x * (std::int64_t{1} << 32) + y);
      }
    }
  }

  std::unordered_map<std::int64_t, std::vector<std::size_t>> cells_;
  std::vector<std::size_t> all_, wide_;
};

bool boxes_touch(const Structure& a, const Structure& b) {
  return (a.min.array() <= b.max.array()).all() && (b.min.array() <= a.max.array()).all();
}

void join(std::vector<Structure>& structures, std::size_t part, std::size_t outline) {
  structures[part].outline = outline;
  structures[outline].parts.push_back(part);
}

void assign_by_relations(std::vector<Structure>& structures, const std::vector<osm::BuildingRelation>& relations) {
  std::map<osm::ObjectId, std::size_t> index;
  for (std::size_t i = 0; i < structures.size(); ++i) index[structures[i].source->id] = i;
  const auto find = [&](osm::ObjectId id) -> std::optional<std::size_t> {
    const auto entry = index.find(id);
    return entry == index.end() ? std::nullopt : std::optional(entry->second);
  };
  for (const osm::BuildingRelation& relation : relations) {
    std::vector<std::size_t> outlines;
    for (const osm::ObjectId id : relation.outlines) {
      const auto candidate = find(id);
      if (candidate && !structures[*candidate].is_part) outlines.push_back(*candidate);
    }
    if (outlines.empty()) continue;
    for (const osm::ObjectId id : relation.parts) {
      const auto part = find(id);
      if (!part || !structures[*part].is_part || structures[*part].outline) continue;
      std::size_t outline = outlines.back();
      double most = 0;
      for (const std::size_t one : outlines) {
        if (outlines.size() == 1 || !boxes_touch(structures[*part], structures[one])) continue;
        const double common = area_m2(intersect(structures[*part].footprints, structures[one].footprints));
        if (common <= most) continue;
        most = common;
        outline = one;
      }
      join(structures, *part, outline);
    }
  }
}

}  // namespace

std::vector<Footprint> footprints_of(const osm::Area& area, const geo::LocalFrame& frame, Repairs& repairs) {
  std::vector<Footprint> projected;
  Ring all;
  for (const osm::Polygon& polygon : area.polygons) {
    Footprint footprint{project(polygon.outer, frame), {}};
    if (!std::all_of(footprint.outer.begin(), footprint.outer.end(), [](const Vec2& p) { return p.allFinite(); })) {
      repairs.beyond = true;
      continue;
    }
    all.insert(all.end(), footprint.outer.begin(), footprint.outer.end());
    if (polygon.incomplete) {
      repairs.enclosed = true;
      footprint.outer = enclosing(footprint.outer);
    } else if (area.polygons.size() > 1 && is_thin(footprint.outer)) {
      repairs.thin = true;
      footprint.outer = enclosing(footprint.outer);
    } else {
      for (const osm::Ring& hole : polygon.holes) footprint.holes.push_back(project(hole, frame));
    }
    projected.push_back(std::move(footprint));
  }
  std::vector<Footprint> footprints = clean(projected, repairs);
  if ((!footprints.empty() && !repairs.tangled) || all.empty()) return footprints;
  repairs.enclosed = true;
  return clean({{enclosing(all), {}}}, repairs);
}

std::vector<Structure> structures_of(const std::vector<osm::Area>& areas, const geo::LocalFrame& frame) {
  std::vector<Structure> structures;
  for (const osm::Area& area : areas) {
    const std::optional<ObjectKind> kind = kind_of(area.tags, Geometry::area);
    if (kind != ObjectKind::building && kind != ObjectKind::building_part) continue;
    Structure structure;
    structure.source = &area;
    structure.is_part = kind == ObjectKind::building_part;
    structure.footprints = footprints_of(area, frame, structure.repairs);
    structure.area_m2 = area_m2(structure.footprints);
    set_bounds(structure);
    structures.push_back(std::move(structure));
  }
  return structures;
}

void assign_parts(std::vector<Structure>& structures, const std::vector<osm::BuildingRelation>& relations) {
  constexpr double kMost = 0.5;  // of a part's area must lie in its outline
  assign_by_relations(structures, relations);
  const OutlineGrid grid(structures);
  for (std::size_t i = 0; i < structures.size(); ++i) {
    Structure& part = structures[i];
    if (!part.is_part || part.footprints.empty()) continue;
    Interruption::tick();
    const std::optional<std::size_t> named = part.outline;
    for (const std::size_t candidate : grid.near(part)) {
      if (candidate == named || !boxes_touch(part, structures[candidate])) continue;
      const double common = area_m2(intersect(part.footprints, structures[candidate].footprints));
      if (common < kMost * part.area_m2) continue;
      structures[candidate].parts.push_back(i);
      if (named) continue;
      if (!part.outline || structures[candidate].area_m2 < structures[*part.outline].area_m2) part.outline = candidate;
    }
  }
}

std::vector<Footprint> uncovered(const Structure& building, const std::vector<Structure>& structures,
                                 const std::vector<std::size_t>& parts) {
  constexpr double kLeast = 1.0;       // m2: less than that, all together, comes of how the parts were drawn,
  constexpr double kLeastShare = 0.1;  // unless it is so much of the building
  std::vector<Footprint> covered;
  for (const std::size_t part : parts) {
    covered.insert(covered.end(), structures[part].footprints.begin(), structures[part].footprints.end());
  }
  std::vector<Footprint> rest = subtract(building.footprints, covered);
  return area_m2(rest) < std::min(kLeast, kLeastShare * building.area_m2) ? std::vector<Footprint>() : rest;
}

}  // namespace vantage::internal::city
