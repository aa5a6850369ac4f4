#include "io/antimeridian.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <utility>

#include "vantage/error.h"

namespace vantage::internal::io {
namespace {

/// Degrees east of the antimeridian: negative west of it, where longitudes are positive.
double beyond(const geo::Geodetic& at) { return std::remainder(at.place.longitude_deg - 180, 360); }

bool is_east(const GlobeCorner& corner) { return beyond(corner.at) >= 0; }

/// Where a side crosses.
struct Cut {
  GlobeCorner corner;
  bool is_eastwards = false;
};

/// The part of a ring on one side, between two points of the cut.
struct Chain {
  GlobeRing corners;
  std::size_t begin = 0, end = 0;  ///< indices of these among all cuts
};

/// One side of the polygon.
struct Side {
  std::vector<Chain> chains;
  std::vector<GlobeRing> outers, holes;  ///< that lie wholly on it
};

/// Cuts a ring that crosses into chains, from its first cut on.
void cut_ring(const GlobeRing& ring, const GlobePlace& place, std::vector<Cut>& cuts, std::array<Side, 2>& sides) {
  const std::size_t count = ring.size();
  std::size_t first = 0;
  while (is_east(ring[first]) == is_east(ring[(first + 1) % count])) ++first;
  const std::size_t first_cut = cuts.size();
  Chain chain;
  for (std::size_t k = 0; k < count; ++k) {
    const GlobeCorner &a = ring[(first + k) % count], &b = ring[(first + k + 1) % count];
    if (k > 0) chain.corners.push_back(a);
    if (is_east(a) == is_east(b)) continue;
    const std::size_t cut = cuts.size();
    cuts.push_back({at_antimeridian(a.scene, b.scene, place), is_east(b)});
    if (k > 0) {
      chain.end = cut;
      sides[is_east(a) ? 1 : 0].chains.push_back(std::move(chain));
    }
    chain = Chain{{}, cut, 0};
  }
  chain.corners.push_back(ring[first]);
  chain.end = first_cut;
  sides[is_east(ring[first]) ? 1 : 0].chains.push_back(std::move(chain));
}

/// Each cut's neighbour on the line of the cut, with the polygon's inside between them.
std::vector<std::size_t> neighbours(const std::vector<Cut>& cuts) {
  const auto at = [&](std::size_t i) -> const Vec3& { return cuts[i].corner.scene; };
  Vec3 along = Vec3::Zero();
  for (std::size_t i = 1; i < cuts.size(); ++i) {
    if ((at(i) - at(0)).squaredNorm() > along.squaredNorm()) along = at(i) - at(0);
  }
  std::vector<std::size_t> order(cuts.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t i, std::size_t j) { return at(i).dot(along) < at(j).dot(along); });
  // They take turns eastwards and westwards. A corner on the line is two in one place, in any order.
  for (std::size_t i = 1; i + 1 < order.size(); ++i) {
    const bool is_turn = cuts[order[i]].is_eastwards != cuts[order[i - 1]].is_eastwards;
    if (!is_turn && at(order[i]) == at(order[i + 1])) std::swap(order[i], order[i + 1]);
  }
  std::vector<std::size_t> partner(cuts.size());
  for (std::size_t i = 0; i + 1 < order.size(); i += 2) {
    partner[order[i]] = order[i + 1];
    partner[order[i + 1]] = order[i];
  }
  return partner;
}

void append_distinct(GlobeRing& ring, GlobeCorner corner) {
  if (ring.empty() || ring.back().scene != corner.scene) ring.push_back(std::move(corner));
}

/// Whether three corners lie on the antimeridian, and on one line: all there do of a polygon that crosses it.
bool are_along_cut(const GlobeCorner& a, const GlobeCorner& b, const GlobeCorner& c) {
  constexpr double kBesideM = 1e-7;  // what longitudes round, of 3 nm, moves a corner less
  for (const GlobeCorner* corner : {&a, &b, &c}) {
    if (beyond(corner->at) != 0) return false;
  }
  const Vec3 to = b.scene - a.scene, from = c.scene - b.scene;
  return to.cross(from).norm() <= kBesideM * std::max(to.norm(), from.norm());
}

/// Leaves out corners between others along the cut: ways along it and back hold nothing. Of a ring that holds nothing
/// else two corners are left.
GlobeRing without_ways_along_cut(GlobeRing ring) {
  const auto beside = std::find_if(ring.begin(), ring.end(), [](const GlobeCorner& at) { return beyond(at.at) != 0; });
  if (beside != ring.end()) std::rotate(ring.begin(), beside, ring.end());
  GlobeRing kept;
  for (GlobeCorner& corner : ring) {
    if (kept.size() > 1 && are_along_cut(kept[kept.size() - 2], kept.back(), corner)) kept.pop_back();
    kept.push_back(std::move(corner));
  }
  return kept;
}

/// Joins chains along the cut to rings.
void close_chains(Side& side, const std::vector<Cut>& cuts, const std::vector<std::size_t>& partner,
                  double longitude_deg) {
  std::vector<std::size_t> chain_from(cuts.size(), side.chains.size());
  for (std::size_t i = 0; i < side.chains.size(); ++i) chain_from[side.chains[i].begin] = i;
  const auto cut_corner = [&](std::size_t cut) {
    GlobeCorner corner = cuts[cut].corner;
    corner.at.place.longitude_deg = longitude_deg;
    return corner;
  };
  std::vector<bool> is_used(side.chains.size(), false);
  for (std::size_t start = 0; start < side.chains.size(); ++start) {
    GlobeRing ring;
    for (std::size_t i = start; i < side.chains.size() && !is_used[i]; i = chain_from[partner[side.chains[i].end]]) {
      is_used[i] = true;
      append_distinct(ring, cut_corner(side.chains[i].begin));
      for (const GlobeCorner& corner : side.chains[i].corners) append_distinct(ring, corner);
      append_distinct(ring, cut_corner(side.chains[i].end));
    }
    while (ring.size() > 1 && ring.back().scene == ring.front().scene) ring.pop_back();
    ring = without_ways_along_cut(std::move(ring));
    if (ring.size() >= 3) side.outers.push_back(std::move(ring));
  }
}

Vec3 ring_normal(const GlobeRing& ring) {
  Vec3 normal = Vec3::Zero();
  for (std::size_t i = 1; i + 1 < ring.size(); ++i) {
    normal += (ring[i].scene - ring[0].scene).cross(ring[i + 1].scene - ring[0].scene);
  }
  return normal;
}

/// In the plane of the ring, by the crossings of a ray.
bool is_inside(const Vec3& point, const GlobeRing& ring) {
  Eigen::Index drop = 0;
  ring_normal(ring).cwiseAbs().maxCoeff(&drop);
  const Eigen::Index u = (drop + 1) % 3, v = (drop + 2) % 3;
  bool inside = false;
  for (std::size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++) {
    const Vec3 &a = ring[i].scene, &b = ring[j].scene;
    if ((a[v] > point[v]) == (b[v] > point[v])) continue;
    if (point[u] < a[u] + (b[u] - a[u]) * (point[v] - a[v]) / (b[v] - a[v])) inside = !inside;
  }
  return inside;
}

void add_polygons(Side& side, std::vector<GlobePolygon>& parts) {
  const std::size_t first = parts.size();
  for (GlobeRing& outer : side.outers) parts.push_back({std::move(outer)});
  for (GlobeRing& hole : side.holes) {
    std::size_t owner = first;
    for (std::size_t i = first; i < parts.size(); ++i) {
      if (is_inside(hole.front().scene, parts[i].front())) owner = i;
    }
    if (owner < parts.size()) parts[owner].push_back(std::move(hole));
  }
}

void refuse_pole(const GlobeRing& ring) {
  double turn = 0;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    turn += std::remainder(ring[(i + 1) % ring.size()].at.place.longitude_deg - ring[i].at.place.longitude_deg, 360);
  }
  if (std::abs(turn) < 180) return;
  throw Error(ErrorCode::value_unsupported, "a polygon lies about a pole, and maps in longitude and latitude have none",
              "", "write a format in metres of the scene, such as PLY");
}

}  // namespace

/// Halves the side: the longitude grows along it, or falls.
GlobeCorner at_antimeridian(const Vec3& a, const Vec3& b, const GlobePlace& place) {
  constexpr int kHalvings = 60;
  const bool from_east = beyond(place(a)) >= 0;
  double low = 0, high = 1;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = (low + high) / 2;
    ((beyond(place(a + middle * (b - a))) >= 0) == from_east ? low : high) = middle;
  }
  // The end that it is at, where it is at one: so that corners on the antimeridian are not doubled.
  const Vec3 point = high == 1 ? b : low == 0 ? a : Vec3(a + low * (b - a));
  GlobeCorner corner{point, place(point)};
  corner.at.place.longitude_deg = 180;
  return corner;
}

std::vector<GlobePolygon> cut_at_antimeridian(const std::vector<std::vector<Vec3>>& rings, const GlobePlace& place) {
  GlobePolygon polygon;
  bool crosses = false;
  for (const std::vector<Vec3>& ring : rings) {
    GlobeRing& corners = polygon.emplace_back();
    for (const Vec3& corner : ring) corners.push_back({corner, place(corner)});
    for (std::size_t i = 0; i < corners.size(); ++i) {
      crosses = crosses || crosses_antimeridian(corners[i].at.place.longitude_deg,
                                                corners[(i + 1) % corners.size()].at.place.longitude_deg);
    }
  }
  if (!crosses) return {std::move(polygon)};
  std::vector<Cut> cuts;
  std::array<Side, 2> sides;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    GlobeRing& ring = polygon[i];
    if (ring.empty()) continue;
    refuse_pole(ring);
    for (GlobeCorner& corner : ring) {  // on the antimeridian itself: east of it
      if (is_east(corner) && corner.at.place.longitude_deg > 0) corner.at.place.longitude_deg = -180;
    }
    const bool east = is_east(ring.front());
    if (std::all_of(ring.begin(), ring.end(), [&](const GlobeCorner& corner) { return is_east(corner) == east; })) {
      (i == 0 ? sides[east ? 1 : 0].outers : sides[east ? 1 : 0].holes).push_back(ring);
    } else {
      cut_ring(ring, place, cuts, sides);
    }
  }
  const std::vector<std::size_t> partner = neighbours(cuts);
  close_chains(sides[0], cuts, partner, 180);
  close_chains(sides[1], cuts, partner, -180);
  std::vector<GlobePolygon> parts;
  for (Side& side : sides) add_polygons(side, parts);
  return parts;
}

}  // namespace vantage::internal::io
