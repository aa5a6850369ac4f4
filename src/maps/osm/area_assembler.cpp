#if defined(__GNUC__) && !defined(__clang__)
// GCC 12 takes the user name behind libosmium's variable-sized objects for a read past their end.
#pragma GCC diagnostic ignored "-Wstringop-overread"
#endif

#include "maps/osm/area_assembler.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <osmium/area/assembler.hpp>
#include <osmium/area/detail/node_ref_segment.hpp>
#include <osmium/area/problem_reporter.hpp>
#include <osmium/builder/osm_object_builder.hpp>
#include <osmium/osm/area.hpp>
#include <set>
#include <string_view>
#include <utility>

#include "core/format.h"
#include "maps/osm/assembly_plane.h"
#include "maps/osm/assembly_rings.h"
#include "maps/osm/map_objects.h"

namespace vantage::internal::osm {
namespace {

std::string place_text(LonLat position) {
  return core::format("{:.7f}, {:.7f}", position.longitude_deg, position.latitude_deg);
}

/// Collects what the assembler complains of: how often, and where first.
class Complaints : public osmium::area::ProblemReporter {
 public:
  Complaints(ObjectId subject, const AssemblyPlane& plane) : subject_(subject), plane_(plane) {}

  /// `piece` is an id for a piece of `way`.
  void set_piece(osmium::object_id_type piece, osmium::object_id_type way) { way_of_[piece] = way; }

  void report_intersection(osmium::object_id_type way1, osmium::Location, osmium::Location, osmium::object_id_type way2,
                           osmium::Location, osmium::Location, osmium::Location where) override {
    if (crossings_++ > 0) return;
    way1 = whole(way1);
    way2 = whole(way2);
    std::string who = subject_ == ObjectId{ObjectType::way, way1} ? "it" : text({ObjectType::way, way1});
    who.append(" crosses ").append(way1 == way2 ? "itself" : text({ObjectType::way, way2}));
    first_crossing_ = who.append(" at ").append(place_text(plane_.from_plane(where)));
  }
  void report_ring_not_closed(const osmium::NodeRef& node, const osmium::Way* way) override {
    if (open_ends_++ > 0) return;
    first_open_end_ = std::string("the ring is open at ").append(place_text(plane_.from_plane(node.location())));
    if (way == nullptr) return;
    first_open_end_.append(" (").append(text(ObjectId{ObjectType::way, whole(way->id())})).append(")");
  }
  void report_duplicate_segment(const osmium::NodeRef& a, const osmium::NodeRef&) override { note_doubled(a); }
  void report_overlapping_segment(const osmium::NodeRef& a, const osmium::NodeRef&) override { note_doubled(a); }

  std::string sentence() const {
    if (crossings_ > 0) return with_count(first_crossing_, crossings_, "crossings");
    if (open_ends_ > 0) return with_count(first_open_end_, open_ends_, "open ends");
    if (doubled_ > 0)
      return std::string("no area is left between sides that are drawn twice, at ").append(first_doubled_);
    return "the rings do not bound an area";
  }

  void note_doubled(const osmium::NodeRef& node) {
    if (doubled_++ == 0) first_doubled_ = place_text(plane_.from_plane(node.location()));
  }

 private:
  osmium::object_id_type whole(osmium::object_id_type id) const {
    const auto found = way_of_.find(id);
    return found == way_of_.end() ? id : found->second;
  }
  static std::string with_count(const std::string& first, std::size_t count, const char* what) {
    if (count == 1) return first;
    return first + " (" + std::to_string(count) + " " + what + ")";
  }

  ObjectId subject_;
  const AssemblyPlane& plane_;
  std::map<osmium::object_id_type, osmium::object_id_type> way_of_;
  std::size_t crossings_ = 0, open_ends_ = 0, doubled_ = 0;
  std::string first_crossing_, first_open_end_, first_doubled_;
};

/// A ring of places in the plane, turned as is asked for.
Ring to_ring(NodeLocations places, bool counter_clockwise, const AssemblyPlane& plane) {
  if ((twice_signed_area(places) > 0) != counter_clockwise) std::reverse(places.begin(), places.end());
  Ring ring;
  for (const osmium::Location place : places) ring.push_back(plane.from_plane(place));
  return ring;
}

Ring to_ring(const osmium::NodeRefList& nodes, bool outer, const AssemblyPlane& plane) {
  NodeLocations places;
  for (const osmium::NodeRef& node : nodes) places.push_back(node.location());
  places.pop_back();  // the first one again
  return to_ring(std::move(places), outer, plane);
}

using Segment = std::pair<osmium::Location, osmium::Location>;

Segment segment(const osmium::NodeRef& a, const osmium::NodeRef& b) {
  return a.location() < b.location() ? Segment{a.location(), b.location()} : Segment{b.location(), a.location()};
}

/// Where two segments meet other than at an end of both, as the assembler has it; undefined where they do not.
osmium::Location meeting(const Segment& a, const Segment& b) {
  const auto low = [](const Segment& side) { return std::min(side.first.y(), side.second.y()); };
  const auto high = [](const Segment& side) { return std::max(side.first.y(), side.second.y()); };
  if (high(a) < low(b) || high(b) < low(a)) return osmium::Location();
  const auto whole = [](const Segment& side) {
    return osmium::area::detail::NodeRefSegment({0, side.first}, {0, side.second}, {}, nullptr);
  };
  return osmium::area::detail::calculate_intersection(whole(a), whole(b));
}

/// The sides of rings, to tell which way is part of them.
class Sides {
 public:
  void add(const osmium::NodeRefList& ring) {
    for (std::size_t i = 1; i < ring.size(); ++i) sides_.push_back(segment(ring[i - 1], ring[i]));
  }
  void finish() { std::sort(sides_.begin(), sides_.end()); }
  bool has_any_of(const osmium::NodeRefList& nodes) const {
    for (std::size_t i = 1; i < nodes.size(); ++i) {
      if (std::binary_search(sides_.begin(), sides_.end(), segment(nodes[i - 1], nodes[i]))) return true;
    }
    return false;
  }

 private:
  std::vector<Segment> sides_;
};

osmium::area::AssemblerConfig config_with(Complaints& complaints) {
  osmium::area::AssemblerConfig config;
  config.problem_reporter = &complaints;
  config.create_empty_areas = false;
  config.ignore_invalid_locations = true;  // nodes that are not in the file: counted elsewhere
  return config;
}

/// The sides of those members that are asked for.
template <typename IsWanted>
Sides sides_of(const std::vector<MemberWay>& members, const std::vector<const osmium::Way*>& projected,
               const IsWanted& is_wanted) {
  Sides sides;
  for (std::size_t i = 0; i < members.size(); ++i) {
    if (is_wanted(members[i])) sides.add(projected[i]->nodes());
  }
  sides.finish();
  return sides;
}

/// `no_holes`: sides of members that bound no hole, whatever lies round them.
std::vector<Polygon> to_polygons(const osmium::Area& area, const AssemblyPlane& plane, const Sides& no_holes = {}) {
  std::vector<Polygon> polygons;
  for (const osmium::OuterRing& outer : area.outer_rings()) {
    Polygon& polygon = polygons.emplace_back();
    polygon.outer = to_ring(outer, true, plane);
    for (const osmium::InnerRing& inner : area.inner_rings(outer)) {
      if (!no_holes.has_any_of(inner)) polygon.holes.push_back(to_ring(inner, false, plane));
    }
  }
  return polygons;
}

bool is_inner(const MemberWay& member) { return std::string_view(member.role) == "inner"; }
bool is_outer(const MemberWay& member) { return std::string_view(member.role) == "outer"; }

/// Whether those without a role are holes where they lie in others. If some have a role, they are outer ones.
bool has_no_roles(const std::vector<MemberWay>& members) {
  return std::none_of(members.begin(), members.end(), [](const auto& one) { return is_inner(one) || is_outer(one); });
}

/// `projected`: of each member its way, in the plane. Rings are nested by where they lie; a role may say otherwise.
void classify(std::vector<MemberWay>& members, const std::vector<const osmium::Way*>& projected,
              const osmium::Area& area) {
  const Sides not_inner = sides_of(members, projected, std::not_fn(is_inner));
  Sides outer_sides, inner_sides, stray_sides;
  for (const osmium::OuterRing& outer : area.outer_rings()) {
    outer_sides.add(outer);
    if (!not_inner.has_any_of(outer)) stray_sides.add(outer);
    for (const osmium::InnerRing& inner : area.inner_rings(outer)) inner_sides.add(inner);
  }
  outer_sides.finish();
  inner_sides.finish();
  stray_sides.finish();
  const bool by_place = has_no_roles(members);
  for (std::size_t i = 0; i < members.size(); ++i) {
    members[i].outer = outer_sides.has_any_of(projected[i]->nodes());
    members[i].inner = inner_sides.has_any_of(projected[i]->nodes());
    members[i].stray = is_inner(members[i]) ? !members[i].inner && stray_sides.has_any_of(projected[i]->nodes())
                                            : !by_place && members[i].inner && !members[i].outer;
  }
}

/// Those that follow each other are different.
NodeLocations places_of(const osmium::Way& way, const AssemblyPlane& plane) {
  NodeLocations places;
  for (const osmium::NodeRef& node : way.nodes()) {
    if (!node.location()) continue;
    const osmium::Location place = plane.to_plane(node.location());
    if (places.empty() || place != places.back()) places.push_back(place);
  }
  return places;
}

/// What members draw, each way once, without those that are left out.
template <typename LeftOut>
std::vector<NodeLocations> lines_of(const std::vector<MemberWay>& members, const AssemblyPlane& plane,
                                    const LeftOut& left_out) {
  std::vector<NodeLocations> lines;
  std::set<osmium::object_id_type> seen;
  for (const MemberWay& member : members) {
    if (left_out(member) || !seen.insert(member.way->id()).second) continue;
    NodeLocations line = places_of(*member.way, plane);
    if (!line.empty()) lines.push_back(std::move(line));
  }
  return lines;
}

/// Ways with their nodes where the plane has them: the ways themselves, or copies.
class ProjectedWays {
 public:
  ProjectedWays(const std::vector<const osmium::Way*>& ways, const AssemblyPlane& plane) : ways_(ways) {
    if (!plane.moves()) return;
    std::vector<std::size_t> offsets;
    for (const osmium::Way* const way : ways) {
      offsets.push_back(copies_.committed());
      copies_.add_item(*way);
      copies_.commit();
    }
    for (std::size_t i = 0; i < ways.size(); ++i) {
      auto& copy = copies_.get<osmium::Way>(offsets[i]);
      for (osmium::NodeRef& node : copy.nodes()) {
        if (node.location()) node.set_location(plane.to_plane(node.location()));
      }
      ways_[i] = &copy;
    }
  }

  const std::vector<const osmium::Way*>& ways() const { return ways_; }

 private:
  std::vector<const osmium::Way*> ways_;
  osmium::memory::Buffer copies_{1 << 10, osmium::memory::Buffer::auto_grow::yes};
};

/// The segments of ways, each way once, as the assembler takes them.
template <typename Visit>
void for_each_segment(const std::vector<const osmium::Way*>& ways, const Visit& visit) {
  std::set<osmium::object_id_type> seen;
  for (std::size_t i = 0; i < ways.size(); ++i) {
    if (!seen.insert(ways[i]->id()).second) continue;
    const osmium::NodeRef* from = nullptr;
    for (const osmium::NodeRef& node : ways[i]->nodes()) {
      if (!node.location()) continue;
      if (from != nullptr && from->location() != node.location()) visit(i, *from, node);
      from = &node;
    }
  }
}

/// What the assembler has to do, and ways that give it less to do for the same area. It erases segments that are there
/// twice one pair after the other, and looks for crossings among all that share a longitude: both take time with the
/// square of their number.
class AssemblyWork {
 public:
  explicit AssemblyWork(const std::vector<const osmium::Way*>& ways) : ways_(ways) {
    for_each_segment(ways, [this](std::size_t, const osmium::NodeRef& from, const osmium::NodeRef& to) {
      sides_.push_back(segment(from, to));
    });
    std::sort(sides_.begin(), sides_.end());
  }

  /// Where a segment that is there more than once meets another one on its way: the assembler takes such segments away
  /// before it looks for crossings. Nothing where none does.
  std::string problem_of_doubled(const AssemblyPlane& plane) const {
    std::vector<Segment> single, doubled;
    for (const Segment& side : sides_) {
      std::vector<Segment>& list = single.empty() || single.back() != side ? single : doubled;
      if (list.empty() || list.back() != side) list.push_back(side);
    }
    double steps = 0;
    for (const auto& [some, others] : {std::pair(&doubled, &single), std::pair(&single, &doubled)}) {
      for (const Segment& one : *some) {
        auto other = std::lower_bound(others->begin(), others->end(), one);
        for (; other != others->end() && other->first.x() <= one.second.x(); ++other) {
          if (++steps > kMostSteps) return kTooMany;
          const osmium::Location at = meeting(one, *other);
          if (at) return "a side that is drawn twice crosses another one at " + place_text(plane.from_plane(at));
        }
      }
    }
    return "";
  }

  /// Segments that are there an even number of times, and all but one of others, are taken away, as the assembler does.
  void take_away_doubled(Complaints& complaints) {
    const std::size_t all = sides_.size();
    std::vector<Segment> single = sides_;
    single.erase(std::unique(single.begin(), single.end()), single.end());
    const double pairs = static_cast<double>(all - single.size()) / 2;
    if (pairs * static_cast<double>(all) <= kMostSteps) return;
    std::vector<bool> is_left(single.size(), false);
    const auto number_of = [&](const Segment& side) {
      return static_cast<std::size_t>(std::lower_bound(single.begin(), single.end(), side) - single.begin());
    };
    for (const Segment& side : sides_) is_left[number_of(side)].flip();
    sides_.clear();
    for (std::size_t i = 0; i < single.size(); ++i) {
      if (is_left[i]) sides_.push_back(single[i]);
    }
    for_each_segment(ways_, [&](std::size_t way, const osmium::NodeRef& from, const osmium::NodeRef& to) {
      const std::size_t number = number_of(segment(from, to));
      if (!is_left[number]) {
        complaints.note_doubled(from);
        return;
      }
      is_left[number] = false;
      add_piece(way, from, to);
    });
    make_pieces(complaints);
  }

  /// Whether crossings are found in a fraction of a second.
  bool is_little() const {
    std::vector<std::int32_t> begins;
    begins.reserve(sides_.size());
    for (const Segment& side : sides_) begins.push_back(side.first.x());
    double steps = 0;
    for (std::size_t i = 0; i < sides_.size(); ++i) {
      const auto end = std::upper_bound(begins.begin(), begins.end(), sides_[i].second.x());
      steps += static_cast<double>(end - begins.begin()) - static_cast<double>(i);
    }
    return steps <= kMostSteps;
  }

  /// Without pieces the ways themselves.
  const std::vector<const osmium::Way*>& ways() const { return ways_; }
  /// Of each of these the number of the way that it is a piece of.
  std::size_t whole_of(std::size_t way) const { return pieces_.empty() ? way : pieces_[way].way; }

  static constexpr const char* kTooMany = "too many of its sides lie above each other to look for crossings";

 private:
  static constexpr double kMostSteps = 1e8;
  struct Piece {
    std::size_t way;
    std::vector<osmium::NodeRef> nodes;
  };

  void add_piece(std::size_t way, const osmium::NodeRef& from, const osmium::NodeRef& to) {
    const bool goes_on = !pieces_.empty() && pieces_.back().way == way && &from == last_;
    if (!goes_on) pieces_.push_back({way, {from}});
    pieces_.back().nodes.push_back(to);
    last_ = &to;
  }

  void make_pieces(Complaints& complaints) {
    osmium::object_id_type id = 0;
    for (const osmium::Way* const way : ways_) id = std::min(id, way->id());
    std::vector<std::size_t> offsets;
    for (const Piece& piece : pieces_) {
      complaints.set_piece(--id, ways_[piece.way]->id());
      {
        osmium::builder::WayBuilder builder(buffer_);
        builder.set_id(id);
        osmium::builder::WayNodeListBuilder nodes(builder);
        for (const osmium::NodeRef& node : piece.nodes) nodes.add_node_ref(node);
      }
      offsets.push_back(buffer_.commit());
    }
    ways_.clear();
    for (const std::size_t offset : offsets) ways_.push_back(&buffer_.get<osmium::Way>(offset));
  }

  std::vector<const osmium::Way*> ways_;
  std::vector<Segment> sides_;
  std::vector<Piece> pieces_;
  const osmium::NodeRef* last_ = nullptr;
  osmium::memory::Buffer buffer_{1 << 10, osmium::memory::Buffer::auto_grow::yes};
};

/// Whether rings may touch themselves or each other: places that not just two segments end at.
bool may_touch(const std::vector<const osmium::Way*>& ways) {
  std::vector<osmium::Location> ends;
  for_each_segment(ways, [&](std::size_t, const osmium::NodeRef& from, const osmium::NodeRef& to) {
    ends.push_back(from.location());
    ends.push_back(to.location());
  });
  std::sort(ends.begin(), ends.end());
  for (std::size_t i = 0; i < ends.size(); i += 2) {
    if (ends[i] != ends[i + 1] || (i > 0 && ends[i - 1] == ends[i])) return true;
  }
  return false;
}

/// What is wrong with rings that the assembler takes for sound: it goes by the even-odd rule, and segments that are
/// there twice are none.
std::optional<RingFault> fault_of(const Chains& outer, const Chains& inner) {
  for (const Chains* const chains : {&outer, &inner}) {
    const NodeLocations& loose = chains->loose();
    if (!loose.empty()) return RingFault{"its rings do not close by their roles", loose.front()};
  }
  const auto fault = outer.fault();
  return fault ? fault : ring_fault(outer.rings(), inner.rings());
}

/// A relation of these ways only: the assembler takes it that all are there. `role_of`: of each way's number.
template <typename RoleOf>
const osmium::Relation& relation_of(osmium::object_id_type id, const std::vector<const osmium::Way*>& ways,
                                    const RoleOf& role_of, osmium::memory::Buffer& buffer) {
  {
    osmium::builder::RelationBuilder builder(buffer);
    builder.set_id(id);
    osmium::builder::RelationMemberListBuilder list(builder);
    for (std::size_t i = 0; i < ways.size(); ++i) {
      list.add_member(osmium::item_type::way, ways[i]->id(), role_of(i));
    }
  }
  return buffer.get<osmium::Relation>(buffer.commit());
}

/// Puts the area of these ways into the buffer, or says what is wrong.
template <typename RoleOf>
std::string assemble_into(osmium::memory::Buffer& buffer, ObjectId subject, const std::vector<const osmium::Way*>& ways,
                          const RoleOf& role_of, const AssemblyPlane& plane) {
  Complaints complaints(subject, plane);
  AssemblyWork work(ways);
  if (std::string problem = work.problem_of_doubled(plane); !problem.empty()) return problem;
  work.take_away_doubled(complaints);
  if (!work.is_little()) return AssemblyWork::kTooMany;
  osmium::memory::Buffer relation_buffer(1 << 10, osmium::memory::Buffer::auto_grow::yes);
  const osmium::Relation& relation = relation_of(
      subject.id, work.ways(), [&](std::size_t i) { return role_of(work.whole_of(i)); }, relation_buffer);
  const osmium::area::AssemblerConfig config = config_with(complaints);
  return osmium::area::Assembler(config)(relation, work.ways(), buffer) ? "" : complaints.sentence();
}

}  // namespace

Assembly assemble(const osmium::Way& way) {
  const AssemblyPlane plane({&way});
  const ProjectedWays projected({&way}, plane);
  osmium::memory::Buffer buffer(1 << 12, osmium::memory::Buffer::auto_grow::yes);
  const auto outer = [](std::size_t) { return "outer"; };
  std::string problem = assemble_into(buffer, {ObjectType::way, way.id()}, projected.ways(), outer, plane);
  if (problem.empty() && may_touch(projected.ways())) {
    const auto fault = fault_of(Chains({places_of(way, plane)}), Chains({}));
    if (fault) problem = "it overlaps itself at " + place_text(plane.from_plane(fault->at));
  }
  if (!problem.empty()) return {{}, std::move(problem)};
  return {to_polygons(buffer.get<osmium::Area>(0), plane), ""};
}

Assembly assemble(const osmium::Relation& relation, std::vector<MemberWay>& members) {
  if (members.empty()) return {{}, "none of its members is a way"};
  std::vector<const osmium::Way*> ways;
  for (const MemberWay& member : members) ways.push_back(member.way);
  const AssemblyPlane plane(ways);
  const ProjectedWays projected(ways, plane);
  osmium::memory::Buffer buffer(1 << 12, osmium::memory::Buffer::auto_grow::yes);
  const auto role_of = [&](std::size_t i) { return members[i].role; };
  std::string problem = assemble_into(buffer, {ObjectType::relation, relation.id()}, projected.ways(), role_of, plane);
  if (!problem.empty()) return {{}, std::move(problem)};
  const auto& area = buffer.get<osmium::Area>(0);
  classify(members, projected.ways(), area);
  if (may_touch(projected.ways())) {
    const bool by_place = has_no_roles(members);
    const auto is_hole = [&](const MemberWay& member) {
      return by_place ? member.inner && !member.outer : is_inner(member);
    };
    const auto fault =
        fault_of(Chains(lines_of(members, plane, is_hole)), Chains(lines_of(members, plane, std::not_fn(is_hole))));
    if (fault) return {{}, std::string(fault->what) + " at " + place_text(plane.from_plane(fault->at))};
  }
  return {to_polygons(area, plane,
                      sides_of(members, projected.ways(), [](const MemberWay& member) { return member.stray; })),
          ""};
}

std::vector<LonLat> positions(const osmium::Way& way) {
  std::vector<LonLat> line;
  osmium::Location previous;
  for (const osmium::NodeRef& node : way.nodes()) {
    if (!node.location() || node.location() == previous) continue;
    previous = node.location();
    line.push_back(to_lonlat(previous));
  }
  return line;
}

std::vector<Polygon> raw_polygon(const osmium::Way& way, bool incomplete) {
  const AssemblyPlane plane({&way});
  NodeLocations places = places_of(way, plane);
  if (places.empty()) return {};
  const bool closed = places.size() > 1 && places.front() == places.back();
  if (closed) places.pop_back();
  if (!incomplete && has_corner(places)) return {Polygon{to_ring(std::move(places), true, plane), {}}};
  return {Polygon{to_ring(std::move(places), true, plane), {}, true}};
}

std::vector<Polygon> drawn_polygons(const std::vector<MemberWay>& members, const core::ProgressReporter& progress) {
  std::vector<const osmium::Way*> ways;
  for (const MemberWay& member : members) ways.push_back(member.way);
  const AssemblyPlane plane(ways);
  std::vector<NodeLocations> outer_lines = lines_of(members, plane, is_inner);
  std::vector<NodeLocations> inner_lines = lines_of(members, plane, std::not_fn(is_inner));
  if (outer_lines.empty()) outer_lines.swap(inner_lines);  // something stands there
  const Chains outer(std::move(outer_lines)), inner(std::move(inner_lines));
  const std::vector<NodeLocations> outer_rings = each_once(outer.rings());
  std::vector<Polygon> polygons;
  for (const NodeLocations& ring : outer_rings) polygons.push_back({to_ring(ring, true, plane), {}});
  std::vector<bool> is_hole(inner.rings().size());
  for (const auto& [ring, hole] : meeting_boxes(outer_rings, inner.rings(), progress)) {
    polygons[ring].holes.push_back(to_ring(inner.rings()[hole], false, plane));
    is_hole[hole] = true;
  }
  for (std::size_t i = 0; i < is_hole.size(); ++i) {
    if (!is_hole[i]) polygons.push_back({to_ring(inner.rings()[i], true, plane), {}});  // far from what it opens
  }
  NodeLocations loose = outer.loose();
  if (!loose.empty()) polygons.push_back({to_ring(std::move(loose), true, plane), {}, true});
  return polygons;
}

}  // namespace vantage::internal::osm
