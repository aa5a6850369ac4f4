#include "maps/osm/multipolygons.h"

#include <algorithm>
#include <cstring>
#include <string>
#include <utility>

#include "maps/osm/meaning.h"

namespace vantage::internal::osm {
namespace {

using Kind = Problem::Kind;

ObjectId id_of(const osmium::Relation& relation) { return {ObjectType::relation, relation.id()}; }

}  // namespace

void Multipolygons::add(const osmium::Relation& relation) {
  Tags tags = to_tags(relation.tags());
  switch (kind_of(tags)) {
    case RelationKind::multipolygon:
      std::erase_if(tags.all, [](const auto& tag) { return tag.first == "type"; });
      add_multipolygon(relation, std::move(tags));
      return;
    case RelationKind::building:
      add_building(relation, tags);
      return;
    case RelationKind::other:
      break;
  }
  if (!selection_.holds(id_of(relation))) {
    selection_.leave_out(relation);
    return;
  }
  ProblemBuilder problem;
  const std::string type(tags.get("type"));
  problem.add(Kind::broken_multipolygon, type.empty() ? std::string("it is a relation without a type")
                                                      : "its type is " + type + ", not multipolygon");
  extract_.problems.push_back(problem.build(id_of(relation), tags, true));
}

std::optional<Multipolygons::Absorbed> Multipolygons::absorbed(std::int64_t way) const {
  const auto found = absorbed_.find(way);
  return found == absorbed_.end() ? std::nullopt : std::optional(found->second);
}

Multipolygons::Members Multipolygons::members_of(const osmium::Relation& relation) const {
  Members members;
  for (const osmium::RelationMember& member : relation.members()) {
    if (member.type() != osmium::item_type::way) continue;
    ++members.ways;
    const KeptWay* const kept = objects_.find_way(member.ref());
    if (kept == nullptr) continue;
    members.there.push_back({kept->way, member.role()});
    members.nodes += kept->way->nodes().size();
    members.missing_nodes += kept->missing;
    members.off_earth += kept->off_earth;
    members.any_wanted = members.any_wanted || kept->wanted;
  }
  return members;
}

void Multipolygons::add_multipolygon(const osmium::Relation& relation, Tags tags) {
  Members members = members_of(relation);
  const bool old_style = says_nothing(tags);
  if (old_style && !members.any_wanted) return;
  if (!selection_.holds(id_of(relation))) {
    if (!old_style) selection_.leave_out(relation);  // else its ways are counted
    return;
  }
  ProblemBuilder problem;
  problem.add_share(Kind::missing_members, members.ways - members.there.size(), members.ways, "ways",
                    "not in the file");
  problem.add_share(Kind::missing_nodes, members.missing_nodes, members.nodes, "nodes", "not in the file");
  problem.add_share(Kind::missing_nodes, members.off_earth, members.nodes, "nodes", "nowhere on the earth");
  Assembly assembly = assemble(relation, members.there);
  if (assembly.polygons.empty()) {
    problem.add(Kind::broken_multipolygon, assembly.problem);
    extract_.problems.push_back(problem.build(id_of(relation), tags, true));  // its ways stand for themselves
    return;
  }
  if (old_style) {
    std::vector<Tags> outer;
    for (const MemberWay& member : members.there) {
      if (member.outer) outer.push_back(to_tags(member.way->tags()));
    }
    tags = common_tags(outer);
    if (wanted_ != nullptr && !wanted_(tags)) return;  // its ways mean different things: each on its own
  }
  absorb(relation, tags, old_style, members.there);
  if (!problem.empty()) extract_.problems.push_back(problem.build(id_of(relation), tags, false));
  extract_.areas.push_back({id_of(relation), std::move(tags), std::move(assembly.polygons)});
}

void Multipolygons::absorb(const osmium::Relation& relation, const Tags& area_tags, bool old_style,
                           const std::vector<MemberWay>& members) {
  for (const MemberWay& member : members) {
    const KeptWay* const kept = objects_.find_way(member.way->id());
    if (!kept->wanted || (!member.outer && !member.inner)) continue;
    const Tags tags = to_tags(member.way->tags());
    const bool hole = member.inner && !member.outer;
    // A piece of a ring bounds nothing by itself. A hole that is tagged like what it is a hole in is a hole.
    const bool absorbed = !kept->closed || (hole ? says_the_same(tags, area_tags) : repeats(tags, area_tags));
    if (absorbed) absorbed_[member.way->id()] = {id_of(relation), !old_style || hole, hole};
  }
}

void Multipolygons::add_building(const osmium::Relation& relation, const Tags& tags) {
  if (!selection_.holds(id_of(relation))) return;
  BuildingRelation building{id_of(relation), tags, {}, {}};
  std::size_t missing = 0, named = 0;
  for (const osmium::RelationMember& member : relation.members()) {
    const bool outline = std::strcmp(member.role(), "outline") == 0;
    if (!outline && std::strcmp(member.role(), "part") != 0) continue;
    if (member.type() == osmium::item_type::node) continue;
    const bool is_way = member.type() == osmium::item_type::way;
    const ObjectId id{is_way ? ObjectType::way : ObjectType::relation, member.ref()};
    if (id == building.id) continue;  // a relation that contains itself
    ++named;
    if (is_way ? objects_.find_way(id.id) == nullptr : objects_.find_relation(id.id) == nullptr) {
      ++missing;
      continue;
    }
    (outline ? building.outlines : building.parts).push_back(id);
  }
  ProblemBuilder problem;
  problem.add_share(Kind::missing_members, missing, named, "outlines and parts", "not in the file");
  const bool empty = building.outlines.empty() && building.parts.empty();
  if (empty && problem.empty()) problem.add(Kind::degenerate, "it has neither an outline nor parts");
  if (!problem.empty()) extract_.problems.push_back(problem.build(building.id, tags, empty));
  if (!empty) extract_.building_relations.push_back(std::move(building));
}

}  // namespace vantage::internal::osm
