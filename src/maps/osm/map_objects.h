// What of a file is needed to build an extract: current versions, with positions, in memory.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <osmium/memory/buffer.hpp>
#include <osmium/osm/relation.hpp>
#include <osmium/osm/way.hpp>
#include <string>
#include <vector>

#include "maps/osm/extract.h"
#include "maps/osm/map_file.h"
#include "maps/osm/versions.h"

namespace vantage::internal::osm {

/// A way that is wanted, or a member of a multipolygon that may be.
struct KeptWay {
  const osmium::Way* way = nullptr;  ///< its nodes have positions; those that have none are undefined
  bool wanted = false;
  bool closed = false;        ///< its ends are the same node, in the file or not, or lie in the same place
  std::size_t missing = 0;    ///< nodes that are not in the file
  std::size_t off_earth = 0;  ///< nodes whose position is out of range
};

struct MapObjects {
  std::vector<Point> points;                       ///< wanted; not finite where a position is not on the earth
  std::vector<KeptWay> ways;                       ///< by id
  std::vector<const osmium::Relation*> relations;  ///< multipolygons that may be wanted, building relations; by id
  std::vector<const osmium::Relation*> unwanted;   ///< multipolygons whose ways alone may be wanted; by id

  std::array<double, 4> bounds_deg{};
  std::size_t nodes = 0, ways_in_file = 0, relations_in_file = 0, superseded = 0;
  bool sorted = true;
  std::string remark;  ///< read_objects

  const KeptWay* find_way(std::int64_t id) const;
  const osmium::Relation* find_relation(std::int64_t id) const;

  osmium::memory::Buffer way_buffer{1 << 16, osmium::memory::Buffer::auto_grow::yes};
  osmium::memory::Buffer relation_buffer{1 << 12, osmium::memory::Buffer::auto_grow::yes};
};

Tags to_tags(const osmium::TagList& list);
LonLat to_lonlat(osmium::Location location);  ///< of a valid location

enum class RelationKind { multipolygon, building, other };
RelationKind kind_of(const Tags& tags);

/// Reads the file twice: its relations, so that the ways are known that they are made of, then all else. What is not
/// wanted is not kept, but for the positions of nodes (24 bytes each) and the ids of ways. A member that is no object
/// of the file, but whose positions the relation has, is a way, too. Throws as read_objects.
MapObjects load_objects(const MapFile& file, const Wanted& wanted, const core::ProgressReporter& progress);

}  // namespace vantage::internal::osm
