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

/// What is known of ways of which no side is left, or one there and back: they are in no ring.
void add_sideless(std::vector<Polygon>& polygons, const std::vector<MemberWay>& members) {
  for (const MemberWay& member : members) {
    if (std::strcmp(member.role, "inner") == 0) continue;
    std::vector<LonLat> line = positions(*member.way);
    const bool is_back = line.size() == 3 && line[0].longitude_deg == line[2].longitude_deg &&
                         line[0].latitude_deg == line[2].latitude_deg;
    if (line.size() == 1 || is_back) polygons.push_back({std::move(line), {}, true});
  }
}

}  // namespace

void Multipolygons::add(const osmium::Relation& relation) {
  Tags tags = to_tags(relation.tags());
  switch (kind_of(tags)) {
    case RelationKind::multipolygon:
      std::erase_if(tags.all, [](const auto& tag) { return tag.first == "type"; });
      add_area(relation, std::move(tags), members_of(relation));
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
  problem.add(Kind::broken_multipolygon, "its type is " + std::string(tags.get("type")) + ", not multipolygon");
  add_problem(problem.build(id_of(relation), tags, true), members_of(relation));
}

void Multipolygons::add_problem(Problem problem, const Members& members) {
  for (const MemberWay& member : members.there) {
    const std::vector<LonLat> line = positions(*member.way);
    problem.places.insert(problem.places.end(), line.begin(), line.end());
  }
  extract_.problems.push_back(std::move(problem));
}

std::optional<Multipolygons::Absorbed> Multipolygons::absorbed(std::int64_t way) const {
  const auto found = absorbed_.find(way);
  return found == absorbed_.end() ? std::nullopt : std::optional(found->second);
}

Multipolygons::Members Multipolygons::members_of(const osmium::Relation& relation) const {
  Members members;
  for (const osmium::RelationMember& member : relation.members()) {
    const std::string_view role = member.role();
    if (member.type() == osmium::item_type::way) add_member(members, member.ref(), member.role());
    if (member.type() != osmium::item_type::relation || (!role.empty() && role != "outer" && role != "inner")) continue;
    if (member.ref() == relation.id()) continue;
    const osmium::Relation* const nested = objects_.find_relation(member.ref());
    if (nested == nullptr) ++members.ways;
    if (nested == nullptr) continue;
    for (const osmium::RelationMember& of_nested : nested->members()) {
      if (of_nested.type() == osmium::item_type::way) add_member(members, of_nested.ref(), of_nested.role());
    }
  }
  return members;
}

void Multipolygons::add_member(Members& members, std::int64_t way, const char* role) const {
  ++members.ways;
  const KeptWay* const kept = objects_.find_way(way);
  if (kept == nullptr) return;
  members.there.push_back({kept->way, role});
  members.nodes += kept->way->nodes().size();
  members.missing_nodes += kept->missing;
  members.off_earth += kept->off_earth;
  members.any_wanted = members.any_wanted || kept->wanted;
}

void Multipolygons::add_area(const osmium::Relation& relation, Tags tags, Members members, ProblemBuilder problem) {
  const bool old_style = says_nothing(tags);
  if (old_style && !members.any_wanted) return;
  if (!selection_.holds(id_of(relation))) {
    if (!old_style) selection_.leave_out(relation);  // else its ways are counted
    return;
  }
  build_area(relation, std::move(tags), std::move(members), std::move(problem));
}

void Multipolygons::add_pieces(const osmium::Relation& relation) {
  Members members = members_of(relation);
  std::vector<Tags> pieces;
  bool is_held = false;
  for (const MemberWay& member : members.there) {
    const KeptWay& kept = *objects_.find_way(member.way->id());
    if (!kept.wanted || kept.closed) return;
    is_held = is_held || selection_.holds(ObjectId{ObjectType::way, member.way->id()});
    pieces.push_back(to_tags(member.way->tags()));
  }
  const Tags common = common_tags(pieces);
  if (!is_held || members.there.size() < members.ways || !wanted_(common)) return;
  if (assemble(relation, members.there).polygons.empty()) return;
  Tags tags = to_tags(relation.tags());
  std::erase_if(tags.all, [&](const auto& tag) { return tag.first == "type" || common.has(tag.first); });
  tags.all.insert(tags.all.end(), common.all.begin(), common.all.end());
  build_area(relation, std::move(tags), std::move(members), {});
}

void Multipolygons::build_area(const osmium::Relation& relation, Tags tags, Members members, ProblemBuilder problem) {
  const bool old_style = says_nothing(tags);
  problem.add_share(Kind::missing_members, members.ways - members.there.size(), members.ways, "ways",
                    "not in the file");
  problem.add_share(Kind::missing_nodes, members.missing_nodes, members.nodes, "nodes", "not in the file");
  problem.add_share(Kind::missing_nodes, members.off_earth, members.nodes, "nodes", "nowhere on the earth");
  if (relation.tags().get_value_by_key("type") == nullptr) {
    problem.add(Kind::broken_multipolygon, "it is a relation without a type; taken for a multipolygon");
  }
  Assembly assembly = assemble(relation, members.there);
  if (assembly.polygons.empty()) {
    problem.add(Kind::broken_multipolygon, assembly.problem);
    assembly.polygons = drawn_polygons(members.there, progress_);
    for (MemberWay& member : members.there) {
      member = {member.way, member.role, std::strcmp(member.role, "inner") != 0, false, false};
    }
  }
  for (const MemberWay& member : members.there) {
    if (!member.stray) continue;
    const std::string way = "way/" + std::to_string(member.way->id());
    problem.add(Kind::wrong_role, std::strcmp(member.role, "inner") == 0
                                      ? "its inner " + way + " lies outside of its outer ones"
                                      : "its outer " + way + " lies inside of another one, and is no hole");
  }
  if (assembly.polygons.empty()) {
    add_problem(problem.build(id_of(relation), tags, true), members);
    return;
  }
  if (members.missing_nodes + members.off_earth > 0) {
    for (Polygon& polygon : assembly.polygons) polygon = {std::move(polygon.outer), {}, true};
    if (assembly.problem.empty()) add_sideless(assembly.polygons, members.there);  // else they are among the loose
  }
  if (old_style) {
    std::vector<Tags> outer;
    for (const MemberWay& member : members.there) {
      if (member.outer) outer.push_back(to_tags(member.way->tags()));
    }
    tags = common_tags(outer);
    if (wanted_ != nullptr && !wanted_(tags)) {
      std::erase_if(outer, says_nothing);  // a ring of which one piece alone is tagged
      tags = common_tags(outer);
      if (!wanted_(tags)) return;  // its ways mean different things: each on its own
    }
  }
  for (const MemberWay& member : members.there) {
    if (member.outer && !objects_.find_way(member.way->id())->closed) add_heights(tags, to_tags(member.way->tags()));
  }
  absorb(relation, tags, old_style, members.there);
  if (!problem.empty()) extract_.problems.push_back(problem.build(id_of(relation), tags, false));
  const bool partial = members.there.size() < members.ways;
  extract_.areas.push_back({id_of(relation), std::move(tags), std::move(assembly.polygons), partial});
}

void Multipolygons::absorb(const osmium::Relation& relation, const Tags& area_tags, bool old_style,
                           const std::vector<MemberWay>& members) {
  for (const MemberWay& member : members) {
    const KeptWay* const kept = objects_.find_way(member.way->id());
    if (!kept->wanted || (!member.outer && !member.inner)) continue;
    const Tags tags = to_tags(member.way->tags());
    const bool hole = member.inner && !member.outer && !member.stray;
    if (kept->closed && hole && means_building(tags)) continue;  // a house in the courtyard
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
    const std::string_view role = member.role();
    const bool outline = role == "outline" || role == "outer" || (role.empty() && !is_part(member));
    if (!outline && role != "part" && !role.empty()) continue;
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
  const bool is_told = wanted_ != nullptr && wanted_(tags) && add_outline(relation, tags, building, problem);
  if (!problem.empty() && !is_told) add_problem(problem.build(building.id, tags, empty), members_of(relation));
  if (!empty) extract_.building_relations.push_back(std::move(building));
}

bool Multipolygons::is_part(const osmium::RelationMember& member) const {
  Tags tags;
  const bool is_way = member.type() == osmium::item_type::way;
  if (const KeptWay* const kept = is_way ? objects_.find_way(member.ref()) : nullptr) tags = to_tags(kept->way->tags());
  if (const auto* const relation = is_way ? nullptr : objects_.find_relation(member.ref())) {
    tags = to_tags(relation->tags());
  }
  return tags.has("building:part") && tags.get("building:part") != "no";
}

bool Multipolygons::add_outline(const osmium::Relation& relation, const Tags& tags, BuildingRelation& building,
                                const ProblemBuilder& problem) {
  Members members;
  for (const ObjectId id : building.outlines.empty() ? building.parts : building.outlines) {
    if (id.type == ObjectType::way) {
      add_member(members, id.id, "outer");
      continue;
    }
    const osmium::Relation& outline = *objects_.find_relation(id.id);
    if (!says_nothing(to_tags(outline.tags()))) return false;  // it is built itself
    for (const osmium::RelationMember& member : outline.members()) {
      if (member.type() == osmium::item_type::way) add_member(members, member.ref(), member.role());
    }
  }
  if (members.there.empty() || members.any_wanted) return false;
  building.outlines.push_back(building.id);
  Tags own = tags;
  std::erase_if(own.all, [](const auto& tag) { return tag.first == "type"; });
  add_area(relation, std::move(own), std::move(members), problem);
  return true;
}

}  // namespace vantage::internal::osm
