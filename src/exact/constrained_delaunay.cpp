#include "exact/constrained_delaunay.h"

#include <CDTUtils.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace vantage::internal::exact {
namespace {

using Point = ConstrainedDelaunay::Point;

constexpr unsigned after(unsigned corner) { return corner == 2 ? 0 : corner + 1; }
constexpr unsigned before(unsigned corner) { return corner == 0 ? 2 : corner - 1; }

/// > 0 where c lies left of the way from a to b; exact in sign. Shewchuk's bound of the first stage.
double area(const Point& a, const Point& b, const Point& c) {
  constexpr double kBound = 3.3306690738754716e-16;
  const double left = (a.x() - c.x()) * (b.y() - c.y()), right = (a.y() - c.y()) * (b.x() - c.x());
  if (std::abs(left - right) > kBound * (std::abs(left) + std::abs(right))) return left - right;
  return predicates::orient2d(a.x(), a.y(), b.x(), b.y(), c.x(), c.y());
}

/// Whether d lies inside of the circle through a, b and c, which run counter-clockwise; exact, as above.
bool is_in_circle(const Point& a, const Point& b, const Point& c, const Point& d) {
  constexpr double kBound = 1.1102230246251577e-15;
  const Point u = a - d, v = b - d, w = c - d;
  const double vw = v.x() * w.y(), wv = w.x() * v.y(), wu = w.x() * u.y(), uw = u.x() * w.y(), uv = u.x() * v.y(),
               vu = v.x() * u.y();
  const double uu = u.squaredNorm(), vv = v.squaredNorm(), ww = w.squaredNorm();
  const double value = uu * (vw - wv) + vv * (wu - uw) + ww * (uv - vu);
  const double terms =
      uu * (std::abs(vw) + std::abs(wv)) + vv * (std::abs(wu) + std::abs(uw)) + ww * (std::abs(uv) + std::abs(vu));
  if (std::abs(value) > kBound * terms) return value > 0;
  return predicates::incircle(a.x(), a.y(), b.x(), b.y(), c.x(), c.y(), d.x(), d.y()) > 0;
}

/// Where a curve that fills a square of 256 x 256 cells without leaps comes to one of them (Hilbert 1891).
std::uint32_t along_curve(std::uint32_t x, std::uint32_t y) {
  std::uint32_t way = 0;
  for (std::uint32_t half = 128; half > 0; half /= 2) {
    const bool right = (x & half) != 0, top = (y & half) != 0;
    way += half * half * ((right ? 3u : 0u) ^ (top ? 1u : 0u));
    if (top) continue;
    if (right) {
      x = 255 - x;
      y = 255 - y;
    }
    std::swap(x, y);
  }
  return way;
}

}  // namespace

ConstrainedDelaunay::ConstrainedDelaunay(double snap)
    : snap_(snap), vertices_{{-60, -40}, {60, -40}, {0, 80}}, facet_of_(kOwn, 0) {
  facets_.push_back({{0, 1, 2}, {kNone, kNone, kNone}, 0});
}

void ConstrainedDelaunay::add_vertices(std::span<const Point> points) {
  const auto first = static_cast<std::uint32_t>(vertices_.size());
  vertices_.insert(vertices_.end(), points.begin(), points.end());
  facet_of_.resize(vertices_.size(), kNone);
  facets_.reserve(2 * vertices_.size());
  // Along the curve the next point is near the one before, and the search for its facet is short.
  constexpr double kCells = 127.9;
  std::vector<std::uint64_t> order;  // the way along the curve, and the vertex
  order.reserve(points.size());
  for (std::uint32_t v = first; v < vertices_.size(); ++v) {
    const Point cell = kCells * (vertices_[v] + Point::Ones());
    const std::uint64_t way = along_curve(static_cast<std::uint32_t>(cell.x()), static_cast<std::uint32_t>(cell.y()));
    order.push_back(way << 32 | v);
  }
  std::sort(order.begin(), order.end());
  for (const std::uint64_t next : order) {
    if (!failure_.empty()) return;
    insert(static_cast<std::uint32_t>(next));
  }
}

/// `first`: the side that is asked first.
ConstrainedDelaunay::Place ConstrainedDelaunay::place_in(std::uint32_t facet, const Point& point,
                                                         unsigned first) const {
  Place place;
  const Facet& f = facets_[facet];
  unsigned side = first;
  for (int i = 0; i < 3; ++i, side = after(side)) {
    const double value = area(at(f, side), at(f, after(side)), point);
    if (value < 0) {
      place.beyond = side;
      return place;
    }
    if (value > 0) continue;
    place.on = side;
    ++place.on_sides;
  }
  return place;
}

void ConstrainedDelaunay::insert(std::uint32_t vertex) {
  const Point& point = vertices_[vertex];
  std::uint32_t facet = last_;
  // Among constraints a search that asks sides in a fixed order can go round for ever (Devillers, Pion, Teillaud 2002).
  Place place = place_in(facet, point, 0);
  for (std::size_t steps = 0; place.beyond < 3 && steps <= facets_.size(); ++steps) {
    facet = facets_[facet].neighbours[place.beyond];
    if (facet == kNone) return fail("a point lies too far out");
    random_ = random_ * 747796405u + 2891336453u;
    place = place_in(facet, point, (random_ >> 16) % 3);
  }
  for (facet = place.beyond < 3 ? 0 : facet; place.beyond < 3; ++facet) {
    if (facet == facets_.size()) return fail("no facet holds a point");
    place = place_in(facet, point, 0);
    if (place.beyond == 3) break;
  }
  if (place.on_sides > 1) return fail("two points are in one place");
  if (place.on_sides == 0) {
    split_facet(facet, vertex);
  } else if (!split_side({facet, place.on}, vertex)) {
    return;
  }
  turn_sides_round(vertex);
  last_ = facet_of_[vertex];
}

/// Writes a facet, and what is round it: the facets across already name it.
void ConstrainedDelaunay::put(std::uint32_t facet, const Triangle& vertices, const Triangle& neighbours,
                              unsigned constraints) {
  facets_[facet] = {vertices, neighbours, static_cast<std::uint8_t>(constraints)};
  for (const std::uint32_t vertex : vertices) facet_of_[vertex] = facet;
}

void ConstrainedDelaunay::relink(std::uint32_t facet, std::uint32_t from, std::uint32_t to) {
  if (facet == kNone) return;
  Triangle& neighbours = facets_[facet].neighbours;
  *std::find(neighbours.begin(), neighbours.end(), from) = to;
}

void ConstrainedDelaunay::split_facet(std::uint32_t facet, std::uint32_t vertex) {
  const Facet old = facets_[facet];
  const auto [a, b, c] = old.vertices;
  const auto second = static_cast<std::uint32_t>(facets_.size()), third = second + 1;
  facets_.resize(facets_.size() + 2);
  put(facet, {a, b, vertex}, {old.neighbours[0], second, third}, old.constraints & 1u);
  put(second, {b, c, vertex}, {old.neighbours[1], third, facet}, old.constraints >> 1 & 1u);
  put(third, {c, a, vertex}, {old.neighbours[2], facet, second}, old.constraints >> 2 & 1u);
  relink(old.neighbours[1], facet, second);
  relink(old.neighbours[2], facet, third);
}

/// False where the vertex, which may lie beside the side by rounding, leaves no room for the four facets.
bool ConstrainedDelaunay::split_side(const Side& side, std::uint32_t vertex) {
  const auto [facet, i] = side;
  const Facet one = facets_[facet];
  const std::uint32_t across = one.neighbours[i];
  if (across == kNone) {
    fail("a point lies too far out");
    return false;
  }
  const Facet other = facets_[across];
  const auto k = static_cast<unsigned>(std::find(other.neighbours.begin(), other.neighbours.end(), facet) -
                                       other.neighbours.begin());
  const std::uint32_t a = one.vertices[i], b = one.vertices[after(i)], c = one.vertices[before(i)],
                      d = other.vertices[before(k)];
  for (const auto& [from, to] : {std::pair(b, c), std::pair(c, a), std::pair(a, d), std::pair(d, b)}) {
    if (area(vertices_[from], vertices_[to], vertices_[vertex]) > 0) continue;
    fail("constraints cross too near to a vertex");
    return false;
  }
  const auto bit = [](const Facet& of, unsigned which) { return of.constraints >> which & 1u; };
  const unsigned split = bit(one, i);
  const auto third = static_cast<std::uint32_t>(facets_.size()), fourth = third + 1;
  facets_.resize(facets_.size() + 2);
  put(facet, {b, c, vertex}, {one.neighbours[after(i)], third, fourth}, bit(one, after(i)) | split << 2);
  put(third, {c, a, vertex}, {one.neighbours[before(i)], across, facet}, bit(one, before(i)) | split << 1);
  put(across, {a, d, vertex}, {other.neighbours[after(k)], fourth, third}, bit(other, after(k)) | split << 2);
  put(fourth, {d, b, vertex}, {other.neighbours[before(k)], facet, across}, bit(other, before(k)) | split << 1);
  relink(one.neighbours[before(i)], facet, third);
  relink(other.neighbours[before(k)], across, fourth);
  return true;
}

/// Turns sides across from a new vertex, the last corner of each facet round it, until the circles round these are
/// empty.
void ConstrainedDelaunay::turn_sides_round(std::uint32_t vertex) {
  const std::uint32_t begin = facet_of_[vertex];
  std::uint32_t facet = begin;
  do {
    while (turn_side(facet, vertex)) {
    }
    facet = facets_[facet].neighbours[1];
  } while (facet != begin);
}

/// The facet gets a new side across from the vertex, and the facet that comes next round that the other one.
bool ConstrainedDelaunay::turn_side(std::uint32_t facet, std::uint32_t vertex) {
  const Facet one = facets_[facet];
  const std::uint32_t across = one.neighbours[0];
  if (across == kNone || (one.constraints & 1u) != 0) return false;
  const Facet other = facets_[across];
  const auto k = static_cast<unsigned>(std::find(other.neighbours.begin(), other.neighbours.end(), facet) -
                                       other.neighbours.begin());
  const std::uint32_t a = one.vertices[0], b = one.vertices[1], d = other.vertices[before(k)];
  if (!is_in_circle(vertices_[a], vertices_[b], vertices_[vertex], vertices_[d])) return false;
  const unsigned of_a = other.constraints >> after(k) & 1u, of_b = other.constraints >> before(k) & 1u;
  put(facet, {a, d, vertex}, {other.neighbours[after(k)], across, one.neighbours[2]}, of_a | (one.constraints & 4u));
  put(across, {d, b, vertex}, {other.neighbours[before(k)], one.neighbours[1], facet}, of_b | (one.constraints & 2u));
  relink(other.neighbours[after(k)], across, facet);
  relink(one.neighbours[1], facet, across);
  return true;
}

void ConstrainedDelaunay::mark(const Side& side) {
  Facet& facet = facets_[side.facet];
  facet.constraints = static_cast<std::uint8_t>(facet.constraints | 1u << side.side);
  if (facet.neighbours[side.side] == kNone) return;
  Facet& across = facets_[facet.neighbours[side.side]];
  for (unsigned k = 0; k < 3; ++k) {
    if (across.neighbours[k] == side.facet)
      across.constraints = static_cast<std::uint8_t>(across.constraints | 1u << k);
  }
}

void ConstrainedDelaunay::add_constraint(std::uint32_t from, std::uint32_t to) {
  for (std::size_t steps = 0; from != to && failure_.empty(); ++steps) {
    if (steps > vertices_.size()) return fail("a constraint does not come to its end");
    from = step(from, to);
  }
}

/// Whether the straight way from `from` to `to` passes a vertex between them no farther away than the snapping
/// distance.
bool ConstrainedDelaunay::is_on_way(std::uint32_t from, std::uint32_t to, std::uint32_t vertex) const {
  const Point way = vertices_[to] - vertices_[from], to_vertex = vertices_[vertex] - vertices_[from];
  const double length = way.squaredNorm(), along = way.dot(to_vertex);
  const double beside = way.x() * to_vertex.y() - way.y() * to_vertex.x();
  return along > 0 && along < length && beside * beside <= snap_ * snap_ * length;
}

/// 1 where a vertex lies left of that way, -1 right, 0 where it is on it.
int ConstrainedDelaunay::side_of_way(std::uint32_t from, std::uint32_t to, std::uint32_t vertex) const {
  if (is_on_way(from, to, vertex)) return 0;
  const double sign = area(vertices_[from], vertices_[to], vertices_[vertex]);
  return (sign > 0) - (sign < 0);
}

/// The first side round a vertex whose other end is `wanted`.
template <typename Wanted>
std::optional<ConstrainedDelaunay::Side> ConstrainedDelaunay::side_to(std::uint32_t from, const Wanted& wanted) const {
  const std::uint32_t begin = facet_of_[from];
  std::uint32_t facet = begin;
  do {
    const Facet& f = facets_[facet];
    const unsigned i = corner_of(f, from);
    if (wanted(f.vertices[after(i)])) return Side{facet, i};
    if (wanted(f.vertices[before(i)])) return Side{facet, before(i)};
    facet = f.neighbours[before(i)];
  } while (facet != begin && facet != kNone);
  return std::nullopt;
}

/// Makes the first side of the way, and returns where it ends.
std::uint32_t ConstrainedDelaunay::step(std::uint32_t from, std::uint32_t to) {
  // A side between the two is the way, whatever it passes.
  const auto is_end = [&](std::uint32_t v) { return v == to; };
  if (const auto side = side_to(from, is_end)) {
    mark(*side);
    return to;
  }
  if (const auto side = side_to(from, [&](std::uint32_t v) { return is_on_way(from, to, v); })) {
    mark(*side);
    const Facet& f = facets_[side->facet];
    return f.vertices[side->side] == from ? f.vertices[after(side->side)] : f.vertices[side->side];
  }
  const std::uint32_t begin = facet_of_[from];
  std::uint32_t facet = begin;
  do {
    const Facet& f = facets_[facet];
    const unsigned i = corner_of(f, from);
    const std::uint32_t right = f.vertices[after(i)], left = f.vertices[before(i)];
    if (side_of_way(from, to, right) < 0 && side_of_way(from, to, left) > 0) return cross({facet, after(i)}, from, to);
    facet = f.neighbours[before(i)];
  } while (facet != begin && facet != kNone);
  fail("there is no way from a vertex");
  return to;
}

/// The same where the way begins by crossing `side`, which runs from right to left.
std::uint32_t ConstrainedDelaunay::cross(Side side, std::uint32_t from, std::uint32_t to) {
  const auto bit = [](const Facet& of, unsigned which) { return (of.constraints >> which & 1u) != 0; };
  const auto go_on = [](std::vector<Corner>& chain, std::uint32_t beyond, bool is_constraint, std::uint32_t next) {
    chain.back().beyond = beyond;
    chain.back().is_constraint = is_constraint;
    chain.push_back({next});
  };
  cavity_.clear();
  right_.assign(1, {from});
  left_.assign(1, {from});
  {
    const Facet& f = facets_[side.facet];
    const unsigned i = before(side.side), k = after(side.side);
    go_on(right_, f.neighbours[i], bit(f, i), f.vertices[side.side]);
    go_on(left_, f.neighbours[k], bit(f, k), f.vertices[k]);
  }
  for (int where = 1; where != 0;) {
    const Facet& f = facets_[side.facet];
    if (bit(f, side.side)) return cross_constraint(side, from, to);
    const std::uint32_t across = f.neighbours[side.side];
    if (across == kNone || cavity_.size() > facets_.size()) {
      fail("a constraint leads out");
      return to;
    }
    cavity_.push_back(side.facet);
    const Facet& next = facets_[across];
    const auto k = static_cast<unsigned>(std::find(next.neighbours.begin(), next.neighbours.end(), side.facet) -
                                         next.neighbours.begin());
    const std::uint32_t corner = next.vertices[before(k)];
    where = corner == to ? 0 : side_of_way(from, to, corner);
    if (where >= 0) go_on(left_, next.neighbours[before(k)], bit(next, before(k)), corner);
    if (where <= 0) go_on(right_, next.neighbours[after(k)], bit(next, after(k)), corner);
    side = {across, where > 0 ? after(k) : before(k)};
  }
  cavity_.push_back(side.facet);
  const std::uint32_t end = left_.back().vertex;
  fill_cavity();
  return end;
}

/// The same where that side is a constraint: the new vertex is where the two cross.
std::uint32_t ConstrainedDelaunay::cross_constraint(const Side& side, std::uint32_t from, std::uint32_t to) {
  const Facet& f = facets_[side.facet];
  const Point &right = at(f, side.side), &left = at(f, after(side.side)), &begin = vertices_[from];
  const Point way = vertices_[to] - begin;
  const auto beside = [&](const Point& p) { return way.x() * (p.y() - begin.y()) - way.y() * (p.x() - begin.x()); };
  const double of_right = beside(right), of_left = beside(left);
  const Point crossing = right + of_right / (of_right - of_left) * (left - right);
  const auto vertex = static_cast<std::uint32_t>(vertices_.size());
  vertices_.push_back(crossing);
  facet_of_.push_back(kNone);
  if (!split_side(side, vertex)) return to;
  turn_sides_round(vertex);
  add_constraint(from, vertex);
  return vertex;
}

/// Puts facets left and right of the straight way from the chains' first corners to their last ones.
void ConstrainedDelaunay::fill_cavity() {
  used_ = 0;
  new_sides_.clear();
  taken_out_.resize(facets_.size(), 0);
  for (const std::uint32_t facet : cavity_) taken_out_[facet] = 1;
  const std::uint32_t left = fill(left_);
  std::reverse(right_.begin(), right_.end());  // what is said of a side moves to its other end
  for (std::size_t i = 0; i + 1 < right_.size(); ++i) {
    right_[i].beyond = right_[i + 1].beyond;
    right_[i].is_constraint = right_[i + 1].is_constraint;
  }
  const std::uint32_t right = fill(right_);
  facets_[left].neighbours[0] = right;
  facets_[right].neighbours[0] = left;
  mark({left, 0});
  for (const std::uint32_t facet : cavity_) taken_out_[facet] = 0;
  join_new_sides();
}

/// Facets between a chain and the straight line from its first to its last corner, to the left of it; returns the one
/// at that line, which is its side 0.
std::uint32_t ConstrainedDelaunay::fill(const std::vector<Corner>& chain) {
  struct Part {
    std::size_t first, last;
    Side base;
  };
  std::vector<Part> parts{{0, chain.size() - 1, {kNone, 0}}};
  const std::uint32_t result = cavity_[used_];
  while (!parts.empty()) {
    const auto [first, last, base] = parts.back();
    parts.pop_back();
    const std::uint32_t a = chain[first].vertex, b = chain[last].vertex;
    std::size_t tip = first + 1;
    for (std::size_t i = tip + 1; i < last; ++i) {
      const Point& corner = vertices_[chain[i].vertex];
      if (is_in_circle(vertices_[a], vertices_[b], vertices_[chain[tip].vertex], corner)) tip = i;
    }
    const std::uint32_t facet = cavity_[used_++];
    put(facet, {a, b, chain[tip].vertex}, {base.facet, kNone, kNone}, 0);
    if (base.facet != kNone) facets_[base.facet].neighbours[base.side] = facet;
    const auto go_on = [&](std::size_t from, std::size_t to, unsigned side) {
      if (to > from + 1) return parts.push_back({from, to, {facet, side}});
      join({facet, side}, chain[from], chain[to].vertex);
    };
    go_on(tip, last, 1);
    go_on(first, tip, 2);
  }
  return result;
}

/// A new facet's side along a chain, from `next` to `corner`.
void ConstrainedDelaunay::join(const Side& side, const Corner& corner, std::uint32_t next) {
  Facet& facet = facets_[side.facet];
  if (corner.is_constraint) facet.constraints = static_cast<std::uint8_t>(facet.constraints | 1u << side.side);
  if (corner.beyond == kNone) return;
  if (taken_out_[corner.beyond]) return new_sides_.push_back({next, corner.vertex, side});
  facet.neighbours[side.side] = corner.beyond;
  Facet& beyond = facets_[corner.beyond];
  for (unsigned k = 0; k < 3; ++k) {
    if (beyond.vertices[k] == corner.vertex) beyond.neighbours[k] = side.facet;
  }
}

/// Where a chain runs to a corner and back along the same sides, both of their facets are new.
void ConstrainedDelaunay::join_new_sides() {
  const auto ends = [](const NewSide& s) { return std::minmax(s.from, s.to); };
  std::sort(new_sides_.begin(), new_sides_.end(),
            [&](const NewSide& a, const NewSide& b) { return ends(a) < ends(b); });
  for (std::size_t i = 0; i + 1 < new_sides_.size(); i += 2) {
    const Side &one = new_sides_[i].side, &other = new_sides_[i + 1].side;
    if (ends(new_sides_[i]) != ends(new_sides_[i + 1])) return fail("a side has one facet");
    facets_[one.facet].neighbours[one.side] = other.facet;
    facets_[other.facet].neighbours[other.side] = one.facet;
  }
}

}  // namespace vantage::internal::exact
