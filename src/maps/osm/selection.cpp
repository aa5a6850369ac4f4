#include "maps/osm/selection.h"

#include <algorithm>
#include <optional>
#include <vector>

#include "maps/osm/area_assembler.h"
#include "maps/osm/meaning.h"

namespace vantage::internal::osm {
namespace {

/// Calls `visit` with the ends of each side; once, with the same position twice, where there is but one.
template <typename Visit>
void for_sides(const osmium::Way& way, const Visit& visit) {
  std::optional<LonLat> before;
  bool alone = false;
  for (const osmium::NodeRef& node : way.nodes()) {
    if (!node.location()) continue;
    const LonLat here = to_lonlat(node.location());
    if (before) visit(*before, here);
    alone = !before;
    before = here;
  }
  if (alone) visit(*before, *before);
}

}  // namespace

Selection::Selection(const MapObjects& objects, const RegionFilter& region) : objects_(objects), region_(region) {
  if (region_.everything()) return;
  for (const KeptWay& kept : objects_.ways) {
    bool held = false;
    for_sides(*kept.way, [&](LonLat from, LonLat to) { held = held || region_.meets(from, to); });
    const bool is_whole = kept.closed && kept.missing + kept.off_earth == 0;
    const std::vector<LonLat> places = held ? std::vector<LonLat>() : positions(*kept.way);
    if (!held && places.empty()) held = true;  // it may be anywhere
    if (!held && (kept.closed || means_area(to_tags(kept.way->tags())))) held = region_.meets_box_of(places, !is_whole);
    if (held) ways_.insert(kept.way->id());
  }
  for (const osmium::Relation* const relation : objects_.relations) {
    if (meets(*relation)) relations_.insert(relation->id());
  }
  take_buildings_together();
}

/// Relations in relations are looked into as deeply as they are read. What is known of no place may be anywhere.
bool Selection::meets(const osmium::Relation& relation) const {
  std::vector<LonLat> places;
  const auto meets_way = [&](const osmium::RelationMember& member) {
    const KeptWay* const kept = member.type() == osmium::item_type::way ? objects_.find_way(member.ref()) : nullptr;
    if (kept == nullptr) return false;
    const std::vector<LonLat> line = positions(*kept->way);
    places.insert(places.end(), line.begin(), line.end());
    return !line.empty() && ways_.contains(member.ref());
  };
  for (const osmium::RelationMember& member : relation.members()) {
    if (meets_way(member)) return true;
    const bool is_nested = member.type() == osmium::item_type::relation && member.ref() != relation.id();
    const osmium::Relation* const nested = is_nested ? objects_.find_relation(member.ref()) : nullptr;
    if (nested == nullptr) continue;
    const osmium::RelationMemberList& members = nested->members();
    if (std::any_of(members.begin(), members.end(), meets_way)) return true;
  }
  return places.empty() || region_.meets_box_of(places, true);
}

void Selection::take_buildings_together() {
  for (const osmium::Relation* const relation : objects_.relations) {
    if (kind_of(to_tags(relation->tags())) != RelationKind::building) continue;
    const osmium::RelationMemberList& members = relation->members();
    const bool held = std::any_of(members.begin(), members.end(), [this](const osmium::RelationMember& member) {
      if (member.type() == osmium::item_type::way) return ways_.contains(member.ref());
      return member.type() == osmium::item_type::relation && relations_.contains(member.ref());
    });
    if (!held) continue;
    relations_.insert(relation->id());
    for (const osmium::RelationMember& member : members) {
      if (member.type() == osmium::item_type::way) ways_.insert(member.ref());
      if (member.type() == osmium::item_type::relation) relations_.insert(member.ref());
    }
  }
}

bool Selection::holds(ObjectId id) const {
  return region_.everything() || (id.type == ObjectType::way ? ways_ : relations_).contains(id.id);
}

void Selection::leave_out(const Point& point) {
  ++outside_;
  nearest_ = std::min(nearest_, region_.distance_m(point.position));
}

void Selection::leave_out(const osmium::Way& way) {
  ++outside_;
  measure(way);
}

void Selection::leave_out(const osmium::Relation& multipolygon) {
  ++outside_;
  for (const osmium::RelationMember& member : multipolygon.members()) {
    if (member.type() != osmium::item_type::way) continue;
    if (const KeptWay* const kept = objects_.find_way(member.ref())) measure(*kept->way);
  }
}

void Selection::measure(const osmium::Way& way) {
  for_sides(way, [this](LonLat from, LonLat to) { nearest_ = std::min(nearest_, region_.distance_m(from, to)); });
}

}  // namespace vantage::internal::osm
