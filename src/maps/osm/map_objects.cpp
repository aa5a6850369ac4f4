#include "maps/osm/map_objects.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <limits>
#include <osmium/osm/node.hpp>
#include <osmium/osm/object_comparisons.hpp>
#include <string_view>
#include <utility>

#include "maps/osm/longitude_span.h"
#include "maps/osm/meaning.h"

namespace vantage::internal::osm {
namespace {

struct NodeEntry {
  std::int64_t id = 0;
  std::uint32_t version = 0;
  bool visible = true;
  osmium::Location location;
};

struct Entry {
  std::int64_t id = 0;
  std::uint32_t version = 0;
  bool visible = true;
};

/// A copy of an object in a buffer that still grows.
struct Kept {
  std::int64_t id = 0;
  std::uint32_t version = 0;
  std::size_t offset = 0;
  bool wanted = false;
};

/// The current versions of what was kept, one of each, by id.
template <class Table>
std::vector<Kept> current_of(std::vector<Kept> kept, const Table& versions) {
  std::erase_if(kept, [&versions](const Kept& one) { return !versions.is_current(one.id, one.version); });
  std::stable_sort(kept.begin(), kept.end(), [](const Kept& a, const Kept& b) { return a.id < b.id; });
  // The last of equal ones counts.
  const auto same = [](const Kept& a, const Kept& b) { return a.id == b.id; };
  kept.erase(kept.begin(), std::unique(kept.rbegin(), kept.rend(), same).base());
  return kept;
}

class Loader {
 public:
  Loader(const MapFile& file, const Wanted& wanted, const core::ProgressReporter& progress)
      : file_(file), wanted_(wanted), progress_(progress) {}

  MapObjects load() {
    progress_.begin("read relations");
    objects_.remark = read_objects(file_, osmium::osm_entity_bits::relation, progress_, [this](const auto& buffer) {
      bool is_kept = false;
      for (const osmium::OSMObject& object : buffer.template select<osmium::OSMObject>()) {
        if (object.type() == osmium::item_type::relation) is_kept = add(static_cast<const osmium::Relation&>(object));
        // A way here is what the relation before it says of a member.
        if (object.type() == osmium::item_type::way && is_kept) keep_given(static_cast<const osmium::Way&>(object));
      }
    });
    finish_relations();
    progress_.begin("read nodes and ways");
    read_objects(file_, osmium::osm_entity_bits::nwr, progress_, [this](const auto& buffer) {
      for (const osmium::OSMObject& object : buffer.template select<osmium::OSMObject>()) {
        check_order(object);
        if (object.type() == osmium::item_type::node) add(static_cast<const osmium::Node&>(object));
        if (object.type() == osmium::item_type::way) add(static_cast<const osmium::Way&>(object));
      }
    });
    finish_nodes();
    finish_ways();
    return std::move(objects_);
  }

 private:
  bool is_wanted(const osmium::TagList& tags) const {
    return !tags.empty() && (wanted_ == nullptr || wanted_(to_tags(tags)));
  }

  /// Returns whether its members are kept.
  bool add(const osmium::Relation& relation) {
    const std::uint32_t version = relation.version();
    relation_versions_.add({relation.id(), version, relation.visible()});
    if (!relation.visible()) return false;
    const Tags tags = to_tags(relation.tags());
    const RelationKind kind = kind_of(tags);
    bool keep = kind == RelationKind::building;
    if (kind == RelationKind::multipolygon) keep = says_nothing(tags) || is_wanted(relation.tags());
    if (kind == RelationKind::other) keep = wanted_ == nullptr ? means_building(tags) : wanted_(tags);
    if (!keep && kind != RelationKind::multipolygon) return false;
    kept_relations_.push_back({relation.id(), version, objects_.relation_buffer.committed(), keep});
    objects_.relation_buffer.add_item(relation);
    objects_.relation_buffer.commit();
    return keep;
  }

  void keep_given(const osmium::Way& way) {
    given_ways_.push_back({way.id(), 0, objects_.way_buffer.committed(), false});
    objects_.way_buffer.add_item(way);
    objects_.way_buffer.commit();
  }

  void finish_relations() {
    relation_versions_.finish();
    for (const Kept& kept : current_of(std::move(kept_relations_), relation_versions_)) {
      auto& list = kept.wanted ? objects_.relations : objects_.unwanted;
      list.push_back(&objects_.relation_buffer.get<osmium::Relation>(kept.offset));
    }
    for (const osmium::Relation* const relation : objects_.relations) {
      for (const osmium::RelationMember& member : relation->members()) {
        if (member.type() == osmium::item_type::way) member_ways_.push_back(member.ref());
      }
    }
    std::sort(member_ways_.begin(), member_ways_.end());
    member_ways_.erase(std::unique(member_ways_.begin(), member_ways_.end()), member_ways_.end());
  }

  void check_order(const osmium::OSMObject& object) {
    const auto rank = [](osmium::item_type type) { return osmium::item_type_to_nwr_index(type); };
    if (previous_type_ != osmium::item_type::undefined) {
      const bool same_type = previous_type_ == object.type();
      objects_.sorted = objects_.sorted && (same_type ? !osmium::id_order{}(object.id(), previous_id_)
                                                      : rank(previous_type_) < rank(object.type()));
    }
    previous_type_ = object.type();
    previous_id_ = object.id();
  }

  void add(const osmium::Node& node) {
    const std::uint32_t version = node.version();
    nodes_.add({node.id(), version, node.visible(), node.location()});
    if (!node.visible() || !is_wanted(node.tags())) return;
    kept_points_.push_back({node.id(), version, objects_.points.size(), true});
    constexpr double kNowhere = std::numeric_limits<double>::quiet_NaN();
    const bool on_earth = node.location().valid();
    objects_.points.push_back({{ObjectType::node, node.id()},
                               to_tags(node.tags()),
                               on_earth ? to_lonlat(node.location()) : LonLat{kNowhere, kNowhere}});
  }

  void add(const osmium::Way& way) {
    const std::uint32_t version = way.version();
    way_versions_.add({way.id(), version, way.visible()});
    if (!way.visible()) return;
    const bool wanted = is_wanted(way.tags());
    if (!wanted && !std::binary_search(member_ways_.begin(), member_ways_.end(), way.id())) return;
    kept_ways_.push_back({way.id(), version, objects_.way_buffer.committed(), wanted});
    objects_.way_buffer.add_item(way);
    objects_.way_buffer.commit();
  }

  void extend_bounds(osmium::Location location) {
    longitudes_.add(location.lon_without_check());
    south_ = std::min(south_, location.lat_without_check());
    north_ = std::max(north_, location.lat_without_check());
  }

  void finish_nodes() {
    nodes_.finish();
    for (const NodeEntry& entry : nodes_.entries()) {
      if (entry.visible && entry.location.valid()) extend_bounds(entry.location);
    }
    std::vector<Point> points;
    for (const Kept& kept : current_of(std::move(kept_points_), nodes_)) {
      points.push_back(std::move(objects_.points[kept.offset]));
    }
    objects_.points = std::move(points);
  }

  void finish_ways() {
    way_versions_.finish();
    for (const Kept& kept : current_of(std::move(kept_ways_), way_versions_)) {
      auto& way = objects_.way_buffer.get<osmium::Way>(kept.offset);
      objects_.ways.push_back(place(way, kept.wanted));
    }
    add_given_ways();
    if (!longitudes_.empty()) {
      const geo::LongitudeRange range = longitudes_.range();
      objects_.bounds_deg = {range.west, south_, range.east, north_};
    }
    objects_.nodes = nodes_.current();
    objects_.ways_in_file = way_versions_.current();
    objects_.relations_in_file = relation_versions_.current();
    objects_.superseded = nodes_.superseded() + way_versions_.superseded() + relation_versions_.superseded();
  }

  /// Members that are no objects of the file. One of several that relations give counts.
  void add_given_ways() {
    std::erase_if(given_ways_, [this](const Kept& kept) { return way_versions_.knows(kept.id); });
    const auto by_id = [](const Kept& a, const Kept& b) { return a.id < b.id; };
    std::stable_sort(given_ways_.begin(), given_ways_.end(), by_id);
    const auto same = [](const Kept& a, const Kept& b) { return a.id == b.id; };
    given_ways_.erase(std::unique(given_ways_.begin(), given_ways_.end(), same), given_ways_.end());
    if (given_ways_.empty()) return;
    for (const Kept& kept : given_ways_) {
      objects_.ways.push_back(place(objects_.way_buffer.get<osmium::Way>(kept.offset), false));
    }
    std::sort(objects_.ways.begin(), objects_.ways.end(),
              [](const KeptWay& a, const KeptWay& b) { return a.way->id() < b.way->id(); });
  }

  /// Gives the way's nodes their positions.
  KeptWay place(osmium::Way& way, bool wanted) {
    KeptWay kept{&way, wanted};
    osmium::WayNodeList& nodes = way.nodes();
    for (osmium::NodeRef& node : nodes) {
      // A node that is not in the file may have its position in the way ("locations on ways").
      const NodeEntry* const entry = nodes_.find(node.ref());
      if (entry != nullptr) node.set_location(entry->location);
      if (node.location().valid()) {
        if (entry == nullptr) extend_bounds(node.location());
        continue;
      }
      ++(node.location().is_defined() ? kept.off_earth : kept.missing);
      node.set_location(osmium::Location());
    }
    if (nodes.size() < 2) return kept;
    const bool same_node = nodes.front().ref() == nodes.back().ref();
    kept.closed = same_node || (nodes.front().location() && nodes.front().location() == nodes.back().location());
    // The node that closes a ring may be the missing one: then the next one closes it.
    if (same_node && !nodes.front().location()) {
      const auto there =
          std::find_if(nodes.begin(), nodes.end(), [](const osmium::NodeRef& node) { return node.location().valid(); });
      if (there != nodes.end()) {
        nodes.begin()->set_location(there->location());
        std::prev(nodes.end())->set_location(there->location());
      }
    }
    return kept;
  }

  const MapFile& file_;
  const Wanted& wanted_;
  const core::ProgressReporter& progress_;
  MapObjects objects_;
  Versions<NodeEntry> nodes_;
  Versions<Entry> way_versions_, relation_versions_;
  std::vector<Kept> kept_points_, kept_ways_, given_ways_, kept_relations_;
  std::vector<std::int64_t> member_ways_;  // by id
  LongitudeSpan longitudes_;
  double south_ = std::numeric_limits<double>::infinity(), north_ = -std::numeric_limits<double>::infinity();
  osmium::item_type previous_type_ = osmium::item_type::undefined;
  std::int64_t previous_id_ = 0;
};

}  // namespace

const KeptWay* MapObjects::find_way(std::int64_t id) const {
  const auto found = std::lower_bound(ways.begin(), ways.end(), id,
                                      [](const KeptWay& kept, std::int64_t wanted) { return kept.way->id() < wanted; });
  return found == ways.end() || found->way->id() != id ? nullptr : &*found;
}

const osmium::Relation* MapObjects::find_relation(std::int64_t id) const {
  const auto found =
      std::lower_bound(relations.begin(), relations.end(), id,
                       [](const osmium::Relation* relation, std::int64_t wanted) { return relation->id() < wanted; });
  return found == relations.end() || (*found)->id() != id ? nullptr : *found;
}

/// Not by libosmium's iterator: that trusts that the list has a key and a value for each tag, and goes on behind it
/// where a text holds a NUL byte. pbf_block.h refuses such a file; this holds whatever comes.
Tags to_tags(const osmium::TagList& list) {
  std::string_view rest(reinterpret_cast<const char*>(list.data()) + sizeof(osmium::TagList),
                        list.byte_size() - sizeof(osmium::TagList));
  const auto take = [&rest] {
    const std::string_view text = rest.substr(0, rest.find('\0'));
    rest.remove_prefix(std::min(rest.size(), text.size() + 1));
    return std::string(text);
  };
  Tags tags;
  while (!rest.empty()) {
    std::string key = take();
    tags.all.emplace_back(std::move(key), take());
  }
  // "abandoned:building=yes" still stands. Not so ways, which would make no blocker of what they cross.
  // https://wiki.openstreetmap.org/wiki/Lifecycle_prefix
  constexpr std::array<std::string_view, 5> kStanding = {
      "abandoned:", "disused:", "ruins:", "ruined:", "construction:"};
  for (std::size_t i = 0, count = tags.all.size(); i < count; ++i) {
    const std::string_view key = tags.all[i].first;
    const auto* const prefix =
        std::find_if(kStanding.begin(), kStanding.end(), [&](std::string_view one) { return key.starts_with(one); });
    if (prefix == kStanding.end()) continue;
    std::string plain(key.substr(prefix->size()));
    if (plain.empty() || plain == "highway" || plain == "waterway") continue;
    if (tags.has(plain) && tags.get(plain) != "no") continue;
    std::string value = tags.all[i].second;
    const auto denied = std::find(tags.all.begin(), tags.all.end(), std::pair<std::string, std::string>(plain, "no"));
    if (denied != tags.all.end()) {
      denied->second = std::move(value);
    } else {
      tags.all.emplace_back(std::move(plain), std::move(value));
    }
  }
  return tags;
}

LonLat to_lonlat(osmium::Location location) { return {location.lon(), location.lat()}; }

RelationKind kind_of(const Tags& tags) {
  const std::string_view type = tags.get("type");
  if (type == "multipolygon" || type == "boundary") return RelationKind::multipolygon;
  if (type.empty() && !says_nothing(tags)) return RelationKind::multipolygon;  // for lack of anything better
  return type == "building" ? RelationKind::building : RelationKind::other;
}

MapObjects load_objects(const MapFile& file, const Wanted& wanted, const core::ProgressReporter& progress) {
  return Loader(file, wanted, progress).load();
}

}  // namespace vantage::internal::osm
