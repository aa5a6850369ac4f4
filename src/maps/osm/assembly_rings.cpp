#include "maps/osm/assembly_rings.h"

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <map>
#include <numeric>
#include <set>
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

struct PlaneBox {
  osmium::Location min, max;  ///< of the two coordinates apart

  explicit PlaneBox(const NodeLocations& places) : min(places.front()), max(places.front()) {
    for (const osmium::Location at : places) extend(at);
  }
  void extend(osmium::Location at) {
    min = {std::min(min.x(), at.x()), std::min(min.y(), at.y())};
    max = {std::max(max.x(), at.x()), std::max(max.y(), at.y())};
  }
  bool is_tall() const { return std::int64_t{max.y()} - min.y() > std::int64_t{max.x()} - min.x(); }
  void turn() {
    min = {min.y(), min.x()};
    max = {max.y(), max.x()};
  }
};

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

Chains::Chains(std::vector<NodeLocations> lines)
    : lines_(std::move(lines)), is_joined_(lines_.size()), is_in_ring_(lines_.size()) {
  std::set<NodeLocations> seen;
  std::map<osmium::Location, std::size_t> ends;
  for (std::size_t i = 0; i < lines_.size(); ++i) {
    const osmium::Location front = lines_[i].front(), back = lines_[i].back();
    if (front == back) continue;
    for (const osmium::Location end : {front, back}) is_ambiguous_ |= ++ends[end] > 2;
    is_joined_[i] = !seen.insert(std::min(lines_[i], {lines_[i].rbegin(), lines_[i].rend()})).second;
    if (is_joined_[i]) continue;  // another one repeats it
    for (const osmium::Location end : {front, back}) ending_[end].push_back(i);
  }
  for (std::size_t i = 0; i < lines_.size(); ++i) {
    if (is_joined_[i]) continue;
    if (lines_[i].front() != lines_[i].back()) {
      join_from(i);
    } else if (!add_ring({lines_[i].begin(), lines_[i].end() - (lines_[i].size() > 1 ? 1 : 0)})) {
      loose_.insert(loose_.end(), lines_[i].begin(), lines_[i].end() - (lines_[i].size() > 1 ? 1 : 0));
    }
  }
}

// A tree of all lines that hang together, and a ring for each line that is not in it. Every ring of these lines is a
// sum of such rings: it cannot go round a place that none of them does.
void Chains::join_from(std::size_t first) {
  constexpr std::size_t kMostPlaces = 1'000'000;  // in rings: more than drawing explains, and nobody knows which
  Tree tree;
  tree[lines_[first].front()] = Step();
  std::vector<osmium::Location> reached = {lines_[first].front()};
  std::vector<std::size_t> all, closing;
  for (std::size_t k = 0; k < reached.size(); ++k) {
    const osmium::Location from = reached[k];
    for (const std::size_t line : ending_[from]) {
      if (is_joined_[line]) continue;
      is_joined_[line] = true;
      all.push_back(line);
      const osmium::Location to = lines_[line].front() == from ? lines_[line].back() : lines_[line].front();
      if (tree.emplace(to, Step{line, from, tree.at(from).depth + 1}).second) {
        reached.push_back(to);
      } else {
        closing.push_back(line);
      }
    }
  }
  for (const std::size_t line : closing) {
    if (places_ <= kMostPlaces) close(line, tree);
  }
  for (const std::size_t line : all) {
    if (places_ <= kMostPlaces && is_in_ring_[line]) continue;
    loose_.insert(loose_.end(), lines_[line].begin(), lines_[line].end());
  }
}

/// Along the line, and back to where it begins through the tree.
void Chains::close(std::size_t line, const Tree& tree) {
  NodeLocations ring = lines_[line], rest = {ring.front()};  // from both of its ends on
  std::vector<std::size_t> used = {line};
  while (ring.back() != rest.back()) {
    const Step &one = tree.at(ring.back()), &other = tree.at(rest.back());
    NodeLocations& path = one.depth >= other.depth ? ring : rest;
    const Step& step = one.depth >= other.depth ? one : other;
    NodeLocations next = lines_[step.line];
    used.push_back(step.line);
    if (next.front() == step.from) std::reverse(next.begin(), next.end());
    path.insert(path.end(), next.begin() + 1, next.end());
  }
  ring.insert(ring.end(), rest.rbegin() + 1, rest.rend());
  ring.pop_back();
  places_ += ring.size();
  if (!add_ring(std::move(ring))) return;
  for (const std::size_t one : used) is_in_ring_[one] = true;
}

/// Not where all of its places lie on one line.
bool Chains::add_ring(NodeLocations ring) {
  const bool is_ring = has_corner(ring);
  if (is_ring) rings_.push_back(std::move(ring));
  return is_ring;
}

std::optional<RingFault> Chains::fault() const {
  if (!is_ambiguous_) return std::nullopt;
  std::vector<WoundSide> sides = sides_of(rings_, {}, false);
  for (const NodeLocations& line : lines_) {  // counted in place of inner rings
    for (std::size_t i = 1; i < line.size(); ++i) {
      sides.push_back({std::min(line[i - 1], line[i]), std::max(line[i - 1], line[i]), {0, 1}, {}});
    }
  }
  for (const WoundSide& side : wound(std::move(sides))) {
    if (side.above.outer > 0 && side.above.inner % 2 == 0) {
      return RingFault{"its outer ways make rings in more than one way", side.from};
    }
  }
  return std::nullopt;
}

std::optional<RingFault> ring_fault(const std::vector<NodeLocations>& outer, const std::vector<NodeLocations>& inner) {
  const auto fault = fault_of(wound(sides_of(outer, inner, false)));
  // One that runs along a hole of its own, there and back to it; among several it might cut one into another ring.
  if (fault && outer.size() == 1 && !fault_of(wound(sides_of(outer, inner, true)))) return std::nullopt;
  return fault;
}

RingPairs meeting_boxes(const std::vector<NodeLocations>& a, const std::vector<NodeLocations>& b,
                        const core::ProgressReporter& progress) {
  constexpr std::size_t kMostPlaces = 1'000'000;
  std::vector<PlaneBox> boxes;
  for (const auto* const rings : {&a, &b}) {
    for (const NodeLocations& ring : *rings) boxes.emplace_back(ring);
  }
  if (boxes.empty()) return {};
  PlaneBox all = boxes.front();
  for (const PlaneBox& box : boxes) {
    all.extend(box.min);
    all.extend(box.max);
  }
  if (all.is_tall()) {
    for (PlaneBox& box : boxes) box.turn();
  }
  std::vector<std::size_t> order(boxes.size()), open_a, open_b;
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t i, std::size_t j) { return boxes[i].min.x() < boxes[j].min.x(); });
  RingPairs pairs;
  std::size_t places = 0;
  for (const std::size_t i : order) {
    progress.check();
    const bool is_a = i < a.size();
    std::vector<std::size_t>& others = is_a ? open_b : open_a;
    std::erase_if(others, [&](std::size_t j) { return boxes[j].max.x() < boxes[i].min.x(); });
    for (const std::size_t j : others) {
      if (boxes[j].max.y() < boxes[i].min.y() || boxes[i].max.y() < boxes[j].min.y()) continue;
      pairs.emplace_back(is_a ? i : j, (is_a ? j : i) - a.size());
      places += b[pairs.back().second].size();
    }
    if (places > kMostPlaces) return {};
    (is_a ? open_a : open_b).push_back(i);
  }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

std::vector<NodeLocations> each_once(const std::vector<NodeLocations>& rings) {
  std::set<NodeLocations> seen;
  std::vector<NodeLocations> result;
  for (const NodeLocations& ring : rings) {
    NodeLocations from_least = ring;
    if (twice_signed_area(ring) < 0) std::reverse(from_least.begin(), from_least.end());
    std::rotate(from_least.begin(), std::min_element(from_least.begin(), from_least.end()), from_least.end());
    if (seen.insert(std::move(from_least)).second) result.push_back(ring);
  }
  return result;
}

}  // namespace vantage::internal::osm
