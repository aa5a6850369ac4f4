#include "maps/osm/assembly_rings.h"

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <map>
#include <numeric>
#include <set>
#include <tuple>
#include <utility>

#include "maps/osm/extract.h"

namespace vantage::internal::osm {
namespace {

/// How often outer and inner rings go round a place.
struct Winding {
  int outer = 0, inner = 0;

  Winding operator+(const Winding& other) const { return {outer + other.outer, inner + other.inner}; }
  bool operator==(const Winding&) const = default;
};

/// A side of rings, from its lesser end on: by longitude, then by latitude.
struct WoundSide {
  osmium::Location from, to;
  Winding across;  ///< what comes to the winding on the way over the side from below
  Winding above;   ///< right above it
};

/// Whether `c` lies to the left of the line from `a` to `b`. A product of differences fits 63 bits, their difference
/// may not.
bool is_left(osmium::Location a, osmium::Location b, osmium::Location c) {
  const auto dx = [&](osmium::Location p) { return std::int64_t{p.x()} - a.x(); };
  const auto dy = [&](osmium::Location p) { return std::int64_t{p.y()} - a.y(); };
  return dx(b) * dy(c) > dy(b) * dx(c);
}

/// Of two sides that do not cross, on a line from south to north through both.
bool is_below(const WoundSide& a, const WoundSide& b) {
  if (a.from == b.from) return is_left(a.from, a.to, b.to);
  return a.from < b.from ? is_left(a.from, a.to, b.from) : is_left(b.from, a.from, b.to);
}

/// Each side once, with what lies above it. Sweeps from west to east.
std::vector<WoundSide> wound(std::vector<WoundSide> sides) {
  std::sort(sides.begin(), sides.end(), [](const WoundSide& a, const WoundSide& b) {
    return a.from != b.from ? a.from < b.from : a.to != b.to && (is_below(a, b) || (!is_below(b, a) && a.to < b.to));
  });
  std::vector<WoundSide> single;
  for (const WoundSide& side : sides) {
    if (!single.empty() && single.back().from == side.from && single.back().to == side.to) {
      single.back().across = single.back().across + side.across;
    } else {
      single.push_back(side);
    }
  }
  std::erase_if(single, [](const WoundSide& side) { return side.across == Winding{}; });
  std::vector<std::size_t> by_end(single.size());
  std::iota(by_end.begin(), by_end.end(), std::size_t{0});
  std::sort(by_end.begin(), by_end.end(), [&](std::size_t i, std::size_t j) { return single[i].to < single[j].to; });
  const auto below = [&](std::size_t i, std::size_t j) { return is_below(single[i], single[j]); };
  std::multiset<std::size_t, decltype(below)> open(below);
  std::vector<decltype(open)::iterator> place(single.size());
  std::size_t ended = 0;
  for (std::size_t i = 0; i < single.size(); ++i) {
    while (single[by_end[ended]].to <= single[i].from) open.erase(place[by_end[ended++]]);
    place[i] = open.insert(i);
    const Winding under = place[i] == open.begin() ? Winding{} : single[*std::prev(place[i])].above;
    single[i].above = under + single[i].across;
  }
  return single;
}

/// The loops of a ring from each visit of a place to the next one.
std::vector<NodeLocations> loops_of(const NodeLocations& ring) {
  std::vector<NodeLocations> loops;
  NodeLocations path;
  std::map<osmium::Location, std::size_t> on_path;
  for (std::size_t i = 0; i <= ring.size(); ++i) {
    const osmium::Location at = ring[i % ring.size()];
    const auto [before, is_new] = on_path.emplace(at, path.size());
    if (is_new) {
      path.push_back(at);
      continue;
    }
    const auto begin = path.begin() + static_cast<std::ptrdiff_t>(before->second);
    loops.emplace_back(begin, path.end());
    for (auto left = begin + 1; left != path.end(); ++left) on_path.erase(*left);
    path.erase(begin + 1, path.end());
  }
  return loops;
}

int turn_of(const NodeLocations& ring) { return twice_signed_area(ring) > 0 ? 1 : -1; }

/// `left`: what lies to the left of the loop is wound round that much more often than what lies to its right.
void add_sides(std::vector<WoundSide>& sides, const NodeLocations& loop, const Winding& left) {
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const osmium::Location from = loop[i], to = loop[(i + 1) % loop.size()];
    if (from < to) {
      sides.push_back({from, to, left, {}});
    } else {
      sides.push_back({to, from, {-left.outer, -left.inner}, {}});
    }
  }
}

/// All loops counter-clockwise; with `keep_turns` those of outer rings as the whole of their ring is: a loop that runs
/// against it cuts a hole.
std::vector<WoundSide> sides_of(const std::vector<NodeLocations>& outer, const std::vector<NodeLocations>& inner,
                                bool keep_turns) {
  std::vector<WoundSide> sides;
  for (const NodeLocations& ring : outer) {
    for (const NodeLocations& loop : loops_of(ring)) add_sides(sides, loop, {turn_of(keep_turns ? ring : loop), 0});
  }
  for (const NodeLocations& ring : inner) {
    for (const NodeLocations& loop : loops_of(ring)) add_sides(sides, loop, {0, turn_of(loop)});
  }
  return sides;
}

std::optional<RingFault> fault_of(const std::vector<WoundSide>& sides) {
  for (const WoundSide& side : sides) {
    if (side.across.outer != 0 && side.across.inner != 0) {
      return RingFault{"an inner ring runs along an outer one", side.from};
    }
    const int depth = side.above.outer - side.above.inner;
    if (depth < 0) return RingFault{"an inner ring overlaps another ring", side.from};
    if (depth > 1) return RingFault{"its outer rings overlap", side.from};
  }
  return std::nullopt;
}

}  // namespace

double twice_signed_area(const NodeLocations& ring) {
  // Differences of stored coordinates are whole numbers: exact.
  const auto dx = [&](std::size_t i) { return static_cast<double>(ring[i].x()) - ring[0].x(); };
  const auto dy = [&](std::size_t i) { return static_cast<double>(ring[i].y()) - ring[0].y(); };
  double sum = 0;
  for (std::size_t i = 1; i + 1 < ring.size(); ++i) sum += dx(i) * dy(i + 1) - dy(i) * dx(i + 1);
  return sum;
}

bool has_corner(const NodeLocations& places) {
  for (std::size_t i = 2; i < places.size(); ++i) {
    // Differences of stored coordinates are whole numbers: exact.
    const auto dx = [&](std::size_t j) { return static_cast<double>(places[j].x()) - places[0].x(); };
    const auto dy = [&](std::size_t j) { return static_cast<double>(places[j].y()) - places[0].y(); };
    if (dx(1) * dy(i) != dy(1) * dx(i)) return true;
  }
  return false;
}

Chains::Chains(std::vector<NodeLocations> lines) : lines_(std::move(lines)) {
  std::map<NodeLocations, std::size_t> kinds;
  for (std::size_t i = 0; i < lines_.size(); ++i) {
    NodeLocations back(lines_[i].rbegin(), lines_[i].rend());
    kinds_.push_back(kinds.emplace(std::min(lines_[i], back), i).first->second);
    if (lines_[i].front() == lines_[i].back()) continue;
    for (const osmium::Location end : {lines_[i].front(), lines_[i].back()}) ends_.emplace(end, kinds_[i], i);
  }
  for (std::size_t i = 0; i < lines_.size(); ++i) {
    if (lines_[i].empty()) continue;  // taken
    if (lines_[i].front() != lines_[i].back()) {
      join_from(i);
      continue;
    }
    if (lines_[i].size() > 1) lines_[i].pop_back();
    add_ring(std::move(lines_[i]));
  }
}

NodeLocations Chains::take(std::size_t line, osmium::Location from) {
  NodeLocations& places = lines_[line];
  for (const osmium::Location end : {places.front(), places.back()}) ends_.erase({end, kinds_[line], line});
  if (places.front() != from) std::reverse(places.begin(), places.end());
  return std::exchange(places, {});
}

std::optional<std::size_t> Chains::next_at(osmium::Location place, std::size_t kind) const {
  const auto begin = ends_.lower_bound({place, 0, 0}), end = ends_.lower_bound({place, lines_.size(), 0});
  if (begin == end) return std::nullopt;
  return std::get<2>(std::get<1>(*begin) != kind ? *begin : *std::prev(end));
}

void Chains::join_from(std::size_t first) {
  NodeLocations path = take(first, lines_[first].front());
  std::vector<std::size_t> joints = {0, path.size() - 1};  // where lines begin and end
  std::size_t kind = kinds_[first];
  for (int end = 0; end < 2 && path.size() > 1; ++end) {  // on from its end, then from its beginning
    std::map<osmium::Location, std::size_t> known;
    for (const std::size_t joint : joints) known.emplace(path[joint], joint);
    while (const auto next = next_at(path.back(), kind)) {
      kind = kinds_[*next];
      const NodeLocations line = take(*next, path.back());
      path.insert(path.end(), line.begin() + 1, line.end());
      const auto [before, is_new] = known.emplace(path.back(), path.size() - 1);
      const std::size_t begin = before->second;
      if (is_new) {
        joints.push_back(begin);
        continue;
      }
      add_ring({path.begin() + static_cast<std::ptrdiff_t>(begin), path.end() - 1});
      for (; joints.back() > begin; joints.pop_back()) known.erase(path[joints.back()]);
      path.resize(begin + 1);
      kind = lines_.size();
    }
    std::reverse(path.begin(), path.end());
    std::reverse(joints.begin(), joints.end());
    for (std::size_t& joint : joints) joint = path.size() - 1 - joint;
    kind = lines_.size();
  }
  if (path.size() > 1) loose_.insert(loose_.end(), path.begin(), path.end());
}

void Chains::add_ring(NodeLocations ring) {
  if (has_corner(ring)) {
    rings_.push_back(std::move(ring));
  } else {
    loose_.insert(loose_.end(), ring.begin(), ring.end());
  }
}

std::optional<RingFault> ring_fault(const std::vector<NodeLocations>& outer, const std::vector<NodeLocations>& inner) {
  const auto fault = fault_of(wound(sides_of(outer, inner, false)));
  // One that runs along a hole of its own, there and back to it; among several it might cut one into another ring.
  if (fault && outer.size() == 1 && !fault_of(wound(sides_of(outer, inner, true)))) return std::nullopt;
  return fault;
}

}  // namespace vantage::internal::osm
