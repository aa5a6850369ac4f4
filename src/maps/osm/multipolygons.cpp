#include "maps/osm/multipolygons.h"

#include <algorithm>
#include <cstring>
#include <map>
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

bool bounds_hole(const MemberWay& member) { return member.inner && !member.outer && !member.stray; }

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
    if (member.type() == osmium::item_type::way) add_member(members, member.ref(), member.role());
    if (member.type() == osmium::item_type::relation) add_nested(members, member, relation.id());
  }
  return members;
}

void Multipolygons::add_nested(Members& members, const osmium::RelationMember& nested, std::int64_t within) const {
  if (nested.ref() == within) return;
  const osmium::Relation* const relation = objects_.find_relation(nested.ref());
  const std::string_view role = nested.role();
  const bool is_read = role.empty() || role == "outer" || role == "inner" || role == "outline";
  if (relation == nullptr || !is_read) {
    ++members.ways;
    members.unread += relation == nullptr ? 0 : 1;
    return;
  }
  for (const osmium::RelationMember& member : relation->members()) {
    if (member.type() == osmium::item_type::way) add_member(members, member.ref(), member.role());
    if (member.type() != osmium::item_type::relation || member.ref() == within) continue;
    ++members.ways;
    ++members.unread;
  }
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
  problem.add_share(Kind::missing_members, members.ways - members.there.size() - members.unread, members.ways, "ways",
                    "not in the file");
  if (members.unread > 0) problem.add(Kind::missing_members, "relations in its relations are not read");
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
  Area area{id_of(relation), std::move(tags), std::move(assembly.polygons), members.there.size() < members.ways};
  for (const MemberWay& member : members.there) {
    if (!member.outer || objects_.find_way(member.way->id())->closed) continue;
    const Tags piece = to_tags(member.way->tags());
    add_heights(area, piece, !is_of_another(piece, area.tags));
  }
  absorb(relation, area.tags, old_style, members.there);
  add_rings_of_others(relation, area.tags, members.there);
  if (!problem.empty()) extract_.problems.push_back(problem.build(id_of(relation), area.tags, false));
  if (!old_style && has_line_round(area.tags)) {  // else its ways are lines
    for (const MemberWay& member : members.there) {
      std::vector<LonLat> points = positions(*member.way);
      if (points.size() > 1) extract_.lines.push_back({area.id, area.tags, std::move(points)});
    }
  }
  extract_.areas.push_back(std::move(area));
}

void Multipolygons::absorb(const osmium::Relation& relation, const Tags& area_tags, bool old_style,
                           const std::vector<MemberWay>& members) {
  for (const MemberWay& member : members) {
    const KeptWay* const kept = objects_.find_way(member.way->id());
    if (!kept->wanted || (!member.outer && !member.inner)) continue;
    const Tags tags = to_tags(member.way->tags());
    const bool hole = bounds_hole(member);
    if (kept->closed && hole && means_building(tags)) continue;  // a house in the courtyard
    // A piece of a ring bounds nothing by itself. A hole that is tagged like what it is a hole in is a hole.
    const bool absorbed = hole ? says_the_same(tags, area_tags) : !kept->closed || repeats(tags, area_tags);
    if (absorbed) absorbed_[member.way->id()] = {id_of(relation), !old_style || hole, hole};
  }
}

void Multipolygons::add_rings_of_others(const osmium::Relation& relation, const Tags& area_tags,
                                        const std::vector<MemberWay>& members) {
  std::vector<MemberWay> pieces;
  std::vector<std::size_t> next;  // of each piece one before it that it meets, or itself
  const auto first_of = [&next](std::size_t piece) {
    while (next[piece] != piece) piece = next[piece] = next[next[piece]];
    return piece;
  };
  std::map<std::pair<bool, osmium::Location>, std::size_t> at;
  for (const MemberWay& member : members) {
    const KeptWay& kept = *objects_.find_way(member.way->id());
    const bool is_piece = !kept.closed && kept.missing + kept.off_earth == 0 && !member.way->nodes().empty();
    const bool hole = bounds_hole(member);
    if (!is_piece || (!hole && !member.outer)) continue;
    const std::size_t piece = pieces.size();
    pieces.push_back(member);
    next.push_back(piece);
    for (const osmium::NodeRef& end : {member.way->nodes().front(), member.way->nodes().back()}) {
      const std::size_t other = first_of(at.emplace(std::pair(hole, end.location()), piece).first->second);
      const std::size_t own = first_of(piece);
      next[std::max(own, other)] = std::min(own, other);
    }
  }
  std::map<std::size_t, std::vector<MemberWay>> rings;
  for (std::size_t i = 0; i < pieces.size(); ++i) rings[first_of(i)].push_back(pieces[i]);
  for (auto& [first, ring] : rings) {
    std::vector<Tags> said;
    bool all_wanted = true, all_same = true, all_other = true;
    for (const MemberWay& piece : ring) {
      said.push_back(to_tags(piece.way->tags()));
      all_wanted = all_wanted && objects_.find_way(piece.way->id())->wanted;
      all_same = all_same && says_the_same(said.back(), area_tags);
      all_other = all_other && is_of_another(said.back(), area_tags);
    }
    if (!all_wanted || (bounds_hole(ring.front()) ? all_same : !all_other)) continue;
    Area area{{ObjectType::way, ring.front().way->id()}, common_tags(said), {}};
    for (const Tags& tags : said) add_heights(area, tags, true);
    const bool is_wanted = wanted_ == nullptr || wanted_(area.tags);
    if (!is_wanted || !means_area(area.tags)) continue;  // each on its own
    area.polygons = assemble(relation, ring).polygons;
    if (area.polygons.empty()) continue;
    for (const MemberWay& piece : ring) {
      absorbed_[piece.way->id()] = {area.id, piece.way->id() != area.id.id, false};
    }
    extract_.areas.push_back(std::move(area));
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
  Tags own = tags;
  if (!means_building(own)) own.all.emplace_back("building", "yes");  // its type says so
  const bool is_told = wanted_ != nullptr && add_outline(relation, std::move(own), building, problem);
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

bool Multipolygons::is_built(const osmium::Relation& outline) const {
  const Tags tags = to_tags(outline.tags());
  if (!says_nothing(tags)) return means_building(tags);
  const osmium::RelationMemberList& members = outline.members();
  return std::any_of(members.begin(), members.end(), [this](const osmium::RelationMember& member) {
    const bool is_outer = member.type() == osmium::item_type::way && std::strcmp(member.role(), "inner") != 0;
    const KeptWay* const kept = is_outer ? objects_.find_way(member.ref()) : nullptr;
    return kept != nullptr && kept->wanted;
  });
}

bool Multipolygons::add_outline(const osmium::Relation& relation, Tags tags, BuildingRelation& building,
                                const ProblemBuilder& problem) {
  Members members;
  for (const ObjectId id : building.outlines.empty() ? building.parts : building.outlines) {
    if (id.type == ObjectType::way) {
      const KeptWay& kept = *objects_.find_way(id.id);
      if (!kept.closed || !means_building(to_tags(kept.way->tags()))) add_member(members, id.id, "outer");
      continue;
    }
    const osmium::Relation& outline = *objects_.find_relation(id.id);
    if (is_built(outline)) continue;
    for (const osmium::RelationMember& member : outline.members()) {
      if (member.type() == osmium::item_type::way) add_member(members, member.ref(), member.role());
      if (member.type() != osmium::item_type::relation) continue;
      ++members.ways;
      ++members.unread;
    }
  }
  if (members.there.empty()) return false;
  building.outlines.insert(building.outlines.begin(), building.id);
  std::erase_if(tags.all, [](const auto& tag) { return tag.first == "type"; });
  add_area(relation, std::move(tags), std::move(members), problem);
  return true;
}

}  // namespace vantage::internal::osm
