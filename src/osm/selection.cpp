#include "osm/selection.h"

#include <algorithm>

namespace vantage::osm {

Selection::Selection(const MapObjects& objects, const RegionFilter& region) : objects_(objects), region_(region) {
  if (region_.everything()) return;
  for (const KeptWay& kept : objects_.ways) {
    const osmium::WayNodeList& nodes = kept.way->nodes();
    if (std::any_of(nodes.begin(), nodes.end(), [this](const osmium::NodeRef& node) {
          return node.location() && region_.contains(to_lonlat(node.location()));
        })) {
      ways_.insert(kept.way->id());
    }
  }
  for (const osmium::Relation* const relation : objects_.relations) {
    const osmium::RelationMemberList& members = relation->members();
    if (std::any_of(members.begin(), members.end(), [this](const osmium::RelationMember& member) {
          return member.type() == osmium::item_type::way && ways_.contains(member.ref());
        })) {
      relations_.insert(relation->id());
    }
  }
  take_buildings_together();
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
  for (const osmium::NodeRef& node : way.nodes()) {
    if (node.location()) nearest_ = std::min(nearest_, region_.distance_m(to_lonlat(node.location())));
  }
}

}  // namespace vantage::osm
