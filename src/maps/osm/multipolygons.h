// Multipolygon and building relations. https://wiki.openstreetmap.org/wiki/Relation:multipolygon
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <unordered_map>
#include <vector>

#include "maps/osm/area_assembler.h"
#include "maps/osm/extract.h"
#include "maps/osm/map_objects.h"
#include "maps/osm/problem_builder.h"
#include "maps/osm/selection.h"

namespace vantage::internal::osm {

/// Builds the areas of multipolygons, and knows which of their ways say nothing of their own.
class Multipolygons {
 public:
  Multipolygons(const MapObjects& objects, const Wanted& wanted, Selection& selection, Extract& extract,
                const core::ProgressReporter& progress)
      : objects_(objects), wanted_(wanted), selection_(selection), extract_(extract), progress_(progress) {}

  /// Adds an area, a building relation or a problem to the extract, or nothing when it is not wanted.
  void add(const osmium::Relation& relation);

  /// Of a relation that is not wanted itself: the area that its ways bound, where each is wanted and none a ring of its
  /// own, such as the building of a school.
  void add_pieces(const osmium::Relation& relation);

  /// A way that a multipolygon stands for.
  struct Absorbed {
    ObjectId by;
    bool reported = false;  ///< it should not be tagged at all
    bool hole = false;      ///< it is tagged like the multipolygon whose hole it bounds
  };
  std::optional<Absorbed> absorbed(std::int64_t way) const;

 private:
  struct Members {
    std::vector<MemberWay> there;
    std::size_t ways = 0;                                     ///< as many as the relation names, and others not read
    std::size_t unread = 0;                                   ///< of these relations that are in the file
    std::size_t nodes = 0, missing_nodes = 0, off_earth = 0;  ///< of those that are there
    bool any_wanted = false;
  };

  void add_area(const osmium::Relation& relation, Tags tags, Members members, ProblemBuilder problem = {});
  void build_area(const osmium::Relation& relation, Tags tags, Members members, ProblemBuilder problem);
  void add_building(const osmium::Relation& relation, const Tags& tags);
  /// Of a building relation that alone says that one of its outlines, or else of its parts, is a building: these, but
  /// for those that are built themselves. Returns whether there are any, with its problem told.
  bool add_outline(const osmium::Relation& relation, Tags tags, BuildingRelation& building,
                   const ProblemBuilder& problem);
  bool is_part(const osmium::RelationMember& member) const;
  bool is_built(const osmium::Relation& outline) const;  ///< as an area of its own
  /// Ways, and those of members that are multipolygons themselves. All other relations count as missing.
  Members members_of(const osmium::Relation& relation) const;
  /// With the places of members that are known.
  void add_problem(Problem problem, const Members& members);
  void add_member(Members& members, std::int64_t way, const char* role) const;
  void add_nested(Members& members, const osmium::RelationMember& nested, std::int64_t within) const;
  void absorb(const osmium::Relation& relation, const Tags& area_tags, bool old_style,
              const std::vector<MemberWay>& members);
  /// Rings of open ways that all say what they bound, and not what the area says: of an outer ring something else, in a
  /// hole a house in the courtyard.
  void add_rings_of_others(const osmium::Relation& relation, const Tags& area_tags,
                           const std::vector<MemberWay>& members);

  const MapObjects& objects_;
  const Wanted& wanted_;
  Selection& selection_;
  Extract& extract_;
  const core::ProgressReporter& progress_;
  std::unordered_map<std::int64_t, Absorbed> absorbed_;
};

}  // namespace vantage::internal::osm
