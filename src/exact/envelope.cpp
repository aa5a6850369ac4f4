#include "exact/envelope.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "core/facet_polygon.h"
#include "core/parallel.h"
#include "exact/circle_arcs.h"
#include "exact/interval_set.h"
#include "exact/segment_cover.h"
#include "target/numerics.h"

namespace vantage::internal::exact {
namespace {

// Pieces of an edge shorter than this, in metres, are rounding. Less in small worlds.
constexpr double kShortest = 1e-9;
double shortest_piece(const target::RangeRegion& range) {
  return kShortest * std::min(1.0, range.radius() / numerics::kFullRange);
}
// Two planes of one blocker whose inverse depths differ by less than this everywhere on a facet bound it together.
constexpr double kSiblingMargin = 1e-12;
// Planes of two blockers that differ by less than this fraction may be one plane, computed twice.
constexpr double kSimilar = 1e-6;
// Directions this near are looked at together: far above rounding, far below the size of a cell.
constexpr double kBand = 1e-9;

/// A plane of a blocker that may be seen, and the blockers that may cut it.
struct Facet {
  std::uint32_t plane, blocker;
  std::uint32_t first_place, place_count;  // into FacetTable::places
};

/// Where a facet may be seen: a leaf, and the facet's plane among those of the leaf.
struct Place {
  std::uint32_t leaf, plane;
};

struct FacetTable {
  std::vector<Facet> facets;
  std::vector<Place> places;
};

struct VisiblePlane {
  std::uint32_t plane, blocker;
  Place place;
  bool operator<(const VisiblePlane& other) const {
    return plane != other.plane ? plane < other.plane : place.leaf < other.place.leaf;
  }
};

// The facet of a plane is swept from the corners where the plane touches its polygon, away from the target. For a point
// o of B(C) and a target point t every plane g of C has g . o >= 1 >= g . t, so o + s (o - t) is in B(C) too: where a
// competitor holds those corners it hides the whole facet, if it does not coincide with it.
class ContactTest {
 public:
  ContactTest(const BlockerSet& blockers, const DirectionTree& tree, double reach)
      : blockers_(blockers), tree_(tree), reach_(reach) {}

  bool hidden(std::uint32_t blocker, std::uint32_t index) {
    const Plane& plane = blockers_.planes[index];
    const double margin = touch_margin(plane, reach_);
    Vec3 middle = Vec3::Zero();
    touched_.clear();
    for (const Vec3& corner : blockers_.corners_of(blocker))
      if (std::abs(plane.dot(corner) - 1) <= margin) {
        touched_.push_back(corner);
        middle += corner;
      }
    if (touched_.empty() || middle.z() <= 0) return false;
    for (std::uint32_t competitor : tree_.leaf_at(to_octahedral(middle)).blockers)
      if (competitor != blocker && hides(competitor, plane, competitor < blocker)) return true;
    return false;
  }

 private:
  bool hides(std::uint32_t competitor, const Plane& own, bool owns_ties) const {
    for (const Plane& plane : blockers_.planes_of(competitor)) {
      const double margin = tie_margin(plane, reach_);
      for (const Vec3& corner : touched_)
        if (plane.dot(corner) - 1 < -margin) return false;
      // One plane, computed twice: it decides nothing but who owns it. Where the two are apart at the far end of the
      // range, whichever is in front there has a facet: the corners, which are near, do not say.
      const double apart = (plane - own).norm();
      if (apart <= kSimilar * own.norm() && (!owns_ties || apart * reach_ > margin)) return false;
    }
    return true;
  }

  const BlockerSet& blockers_;
  const DirectionTree& tree_;
  double reach_;
  std::vector<Vec3> touched_;
};

// Whether another blocker's surface is nowhere under plane k of the leaf. Of two that coincide the one with the lower
// index stays.
bool plane_hidden(const DirectionTree::Leaf& leaf, std::size_t own, std::uint32_t k) {
  for (std::size_t i = 0; i < leaf.count(); ++i) {
    if (i == own) continue;
    const auto values = leaf.values_of(i);
    if (!std::all_of(values.begin(), values.end(), [&](const auto& high) { return below(leaf.values[k], high); }))
      continue;
    const bool tie =
        std::any_of(values.begin(), values.end(), [&](const auto& high) { return below(high, leaf.values[k]); });
    if (!tie || leaf.blockers[i] < leaf.blockers[own]) return true;
  }
  return false;
}

FacetTable find_facets(const BlockerSet& blockers, const std::vector<const DirectionTree::Leaf*>& leaves) {
  constexpr std::size_t kLeaves = 16;  // that one thread takes at a time
  std::vector<std::vector<VisiblePlane>> found(leaves.size() / kLeaves + 1);
  parallel::for_ranges(found.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t c = begin; c < end; ++c)
      for (std::size_t l = c * kLeaves; l < std::min(leaves.size(), (c + 1) * kLeaves); ++l)
        for (std::size_t i = 0; i < leaves[l]->count(); ++i)
          for (std::uint32_t k = leaves[l]->first_plane[i]; k < leaves[l]->first_plane[i + 1]; ++k)
            if (blockers.visible[leaves[l]->planes[k]] && !plane_hidden(*leaves[l], i, k))
              found[c].push_back({leaves[l]->planes[k], leaves[l]->blockers[i], {static_cast<std::uint32_t>(l), k}});
  });
  std::vector<VisiblePlane> visible_planes;
  for (const auto& some : found) visible_planes.insert(visible_planes.end(), some.begin(), some.end());
  parallel::sort(visible_planes, std::less<>());
  FacetTable table;
  for (const VisiblePlane& s : visible_planes) {
    if (table.facets.empty() || table.facets.back().plane != s.plane)
      table.facets.push_back({s.plane, s.blocker, static_cast<std::uint32_t>(table.places.size()), 0});
    table.places.push_back(s.place);
    ++table.facets.back().place_count;
  }
  return table;
}

/// Traces the creases of one facet after another.
class FacetTracer {
 public:
  FacetTracer(const BlockerSet& blockers, const DirectionTree& tree,
              const std::vector<const DirectionTree::Leaf*>& leaves, const FacetTable& table,
              const target::RangeRegion& range, const CurveSampling& sampling)
      : blockers_(blockers),
        leaves_(leaves),
        table_(table),
        range_(range),
        sampling_(sampling),
        shortest_(shortest_piece(range)),
        contact_(blockers, tree, range.radius()) {}

  struct Result {
    std::vector<Skeleton::Edge> planar;
    std::vector<std::vector<Vec3>> curved;
    bool visible = false;
  };

  Result trace(const Facet& facet) {
    Result result;
    if (contact_.hidden(facet.blocker, facet.plane) || !make_polygon(facet)) return result;
    gather_competitors(facet);
    if (!cut_by_competitors(facet)) return result;
    trace_own_edges(result);
    trace_crossings(facet, result);
    trace_range(facet, result);
    result.visible = !result.planar.empty() || !result.curved.empty();
    return result;
  }

 private:
  static constexpr std::uint32_t kNoCompetitor = ~0u;

  const Plane& plane_of(const Facet& facet) const { return blockers_.planes[facet.plane]; }
  double reach() const { return range_.radius(); }

  // The facet of the blocker itself: where its plane is the least of the blocker's.
  bool make_polygon(const Facet& facet) {
    const Plane& plane = plane_of(facet);
    if (plane.norm() * reach() <= 1) return false;  // the plane does not come within range
    core::make_facet_square(plane, reach(), polygon_);
    core::clip_facet(polygon_, Vec3::UnitZ(), 0, 0, core::FacetPolygon::kHorizon, scratch_);
    for (std::uint32_t k = blockers_.first[facet.blocker]; k < blockers_.first[facet.blocker + 1]; ++k) {
      if (k == facet.plane) continue;
      const double margin = kSiblingMargin + 1e-15 * reach() * blockers_.planes[k].cwiseAbs().sum();
      core::clip_facet(polygon_, blockers_.planes[k], 1, margin, k, scratch_);
      if (polygon_.empty()) return false;
    }
    return true;
  }

  // The blockers that may rise over the facet's plane where the facet may be seen.
  void gather_competitors(const Facet& facet) {
    competitors_.clear();
    seen_.resize(blockers_.count(), ~0u);
    for (std::uint32_t p = facet.first_place; p < facet.first_place + facet.place_count; ++p) {
      const DirectionTree::Leaf& leaf = *leaves_[table_.places[p].leaf];
      const CellCorners& own = leaf.values[table_.places[p].plane];
      for (std::size_t i = 0; i < leaf.count(); ++i) {
        const std::uint32_t competitor = leaf.blockers[i];
        if (competitor == facet.blocker || seen_[competitor] == facet.plane) continue;
        const auto values = leaf.values_of(i);
        if (std::any_of(values.begin(), values.end(), [&](const CellCorners& v) { return below(v, own); })) continue;
        seen_[competitor] = facet.plane;
        competitors_.push_back(competitor);
      }
    }
  }

  struct Cut {  // what a competitor hides of the polygon
    std::uint32_t competitor;
    double area;
    Box bounds;
    core::FacetPolygon polygon;
  };

  // Cuts out of a copy of the facet what each competitor hides. False when one of them hides all of it. Competitors
  // that hide nothing of it are dropped, and the others sorted: what hides much ends the work on most edges at once.
  bool cut_by_competitors(const Facet& facet) {
    cut_count_ = 0;
    for (std::uint32_t competitor : competitors_) {
      if (cuts_.size() == cut_count_) cuts_.emplace_back();
      Cut& cut = cuts_[cut_count_];
      const Overlap overlap = cut_by(competitor, facet.blocker, cut.polygon);
      if (overlap == Overlap::all) return false;
      if (overlap == Overlap::none) continue;
      cut.competitor = competitor;
      cut.area = area_of(cut.polygon);
      cut.bounds = Box();
      for (const Vec3& corner : cut.polygon.corners) cut.bounds.extend(corner);
      ++cut_count_;
    }
    std::sort(cuts_.begin(), cuts_.begin() + static_cast<std::ptrdiff_t>(cut_count_), [](const Cut& a, const Cut& b) {
      return a.area != b.area ? a.area > b.area : a.competitor < b.competitor;
    });
    competitors_.clear();
    for (std::size_t c = 0; c < cut_count_; ++c) competitors_.push_back(cuts_[c].competitor);
    return true;
  }

  static double area_of(const core::FacetPolygon& polygon) {
    Vec3 sum = Vec3::Zero();
    for (std::size_t i = 1; i + 1 < polygon.corners.size(); ++i)
      sum += (polygon.corners[i] - polygon.corners[0]).cross(polygon.corners[i + 1] - polygon.corners[0]);
    return 0.5 * sum.norm();
  }

  enum class Overlap { none, part, all };  // what a competitor hides

  Overlap cut_by(std::uint32_t competitor, std::uint32_t blocker, core::FacetPolygon& cut) {
    bool copied = false;
    for (const Plane& plane : blockers_.planes_of(competitor)) {
      const double margin = tie_margin(plane, reach());
      double low = std::numeric_limits<double>::infinity(), high = -low;
      for (const Vec3& corner : polygon_.corners) {
        const double value = plane.dot(corner) - 1;
        low = std::min(low, value);
        high = std::max(high, value);
      }
      if (high <= margin) {
        const bool tie = low >= -margin;
        if (!tie || competitor > blocker) return Overlap::none;
      } else if (low < -margin) {
        if (!copied) {
          cut = polygon_;
          copied = true;
        }
        core::clip_facet(cut, plane, 1, margin, static_cast<std::uint32_t>(&plane - blockers_.planes.data()), scratch_);
        if (cut.empty()) return Overlap::none;
      }
    }
    return copied ? Overlap::part : Overlap::all;
  }

  // The creases between this facet and its siblings. Both find them; they are the same edge once snapped.
  void trace_own_edges(Result& result) {
    for (std::size_t i = 0; i < polygon_.corners.size(); ++i) {
      if (polygon_.makers[i] >= core::FacetPolygon::kHorizon) continue;
      const Vec3 &from = polygon_.corners[i], &to = polygon_.corners[(i + 1) % polygon_.corners.size()];
      trace_edge(from, to, kNoCompetitor, result);
    }
  }

  // Where a competitor's surface comes out of this facet. The blocker with the lower index reports it.
  void trace_crossings(const Facet& facet, Result& result) {
    for (std::size_t c = 0; c < cut_count_; ++c) {
      const Cut& cut = cuts_[c];
      if (cut.competitor < facet.blocker) continue;
      const auto& corners = cut.polygon.corners;
      for (std::size_t i = 0; i < corners.size(); ++i) {
        const std::uint32_t maker = cut.polygon.makers[i];
        if (maker < blockers_.first[cut.competitor] || maker >= blockers_.first[cut.competitor + 1]) continue;
        trace_edge(corners[i], corners[(i + 1) % corners.size()], cut.competitor, result);
      }
    }
  }

  // Adds what of from -> to is in range and not hidden by any competitor but `other`.
  void trace_edge(const Vec3& from, const Vec3& to, std::uint32_t other, Result& result) {
    const double length = (to - from).norm();
    if (length < shortest_) return;
    shown_.assign(0, 1);
    keep_in_range(from, to);
    const Vec3 low = from.cwiseMin(to), high = from.cwiseMax(to);
    for (std::size_t c = 0; c < cut_count_; ++c) {
      const Cut& cut = cuts_[c];
      const bool apart = (cut.bounds.min.array() > high.array()).any() || (cut.bounds.max.array() < low.array()).any();
      if (apart || cut.competitor == other) continue;
      const Interval hidden = hidden_part(from, to, reach(), blockers_.planes_of(cut.competitor));
      shown_.subtract(hidden.begin, hidden.end);
      if (shown_.empty()) return;
    }
    shown_.drop_shorter_than(shortest_ / length);
    for (const Interval& part : shown_.parts())
      result.planar.push_back({part.begin == 0 ? from : Vec3(from + part.begin * (to - from)),
                               part.end == 1 ? to : Vec3(from + part.end * (to - from))});
  }

  void keep_in_range(const Vec3& from, const Vec3& to) {
    const double square = range_.radius() * range_.radius();
    const Vec3 along = to - from;
    for (std::size_t ball = 0; ball < range_.ball_count(); ++ball) {
      const Vec3 centre(range_.centre(ball).x(), range_.centre(ball).y(), 0);
      const Vec3 a = from - centre;
      if (a.squaredNorm() <= square && (to - centre).squaredNorm() <= square) continue;
      const double p = along.squaredNorm(), q = along.dot(a), r = a.squaredNorm() - square;
      const double discriminant = q * q - p * r;
      if (discriminant <= 0) {
        shown_.assign(0, 0);
        return;
      }
      const double root = std::sqrt(discriminant);
      shown_.keep((-q - root) / p, (-q + root) / p);
    }
  }

  // The rim: where the facet leaves the range region.
  void trace_range(const Facet& facet, Result& result) {
    const Plane& plane = plane_of(facet);
    const double size = plane.norm(), square = range_.radius() * range_.radius();
    const Vec3 normal = plane / size;
    for (std::size_t ball = 0; ball < range_.ball_count(); ++ball) {
      const Vec3 centre(range_.centre(ball).x(), range_.centre(ball).y(), 0);
      const bool inside = std::all_of(polygon_.corners.begin(), polygon_.corners.end(),
                                      [&](const Vec3& c) { return (c - centre).squaredNorm() <= square; });
      if (inside || is_met_elsewhere(ball)) continue;
      const double height = 1 / size - normal.dot(centre);
      if (square - height * height <= 0) return;  // the plane misses this ball, so all of it is out of range
      SpaceCircle circle{centre + height * normal, normal.unitOrthogonal(), {}, std::sqrt(square - height * height)};
      circle.axis_2 = normal.cross(circle.axis_1);
      CircleArcs arcs(circle);
      arcs.keep(Vec3::UnitZ(), 0);
      for (std::uint32_t maker : polygon_.makers)
        if (maker < core::FacetPolygon::kHorizon) arcs.keep(blockers_.planes[maker], 1);
      keep_in_balls(range_, ball, ball, arcs);
      for (std::uint32_t competitor : competitors_) {
        if (arcs.empty()) break;
        arcs.subtract_blocker(blockers_.planes_of(competitor), competitor < facet.blocker);
      }
      add_arcs(circle, arcs, shortest_, sampling_, result.curved);
    }
  }

  // Whether all of the facet is farther from another centre: then the rim is on other spheres.
  bool is_met_elsewhere(std::size_t ball) const {
    return std::ranges::any_of(range_.neighbours(ball), [&](std::uint32_t other) {
      const auto side = range_.farther_from(ball, other);
      return std::ranges::all_of(polygon_.corners, [&](const Vec3& c) { return side.normal.dot(c) < side.height; });
    });
  }

 public:
  // On the sphere of one ball, being inside another is being on one side of the plane half way between their centres.
  static void keep_in_balls(const target::RangeRegion& range, std::size_t ball, std::size_t also, CircleArcs& arcs) {
    for (const std::uint32_t other : range.neighbours(ball)) {
      if (arcs.empty()) return;
      if (other == also) continue;
      const auto side = range.farther_from(ball, other);
      arcs.keep(side.normal, side.height);
    }
  }

  static int piece_count(const SpaceCircle& circle, const Interval& part, const CurveSampling& sampling) {
    const double by_sagitta = 2 * std::acos(std::max(0.0, 1 - sampling.sagitta_m / circle.radius));
    const double step = std::min(by_sagitta, sampling.length_m / circle.radius);
    return std::max(1, static_cast<int>(std::ceil(part.length() / step)));
  }

  static void add_arcs(const SpaceCircle& circle, CircleArcs& arcs, double shortest, const CurveSampling& sampling,
                       std::vector<std::vector<Vec3>>& out) {
    arcs.drop_shorter_than(shortest / circle.radius);
    for (const Interval& part : arcs.parts()) {
      const int pieces = piece_count(circle, part, sampling);
      std::vector<Vec3>& line = out.emplace_back();
      for (int i = 0; i <= pieces; ++i) line.push_back(circle.at(part.begin + part.length() * i / pieces));
    }
  }

 private:
  const BlockerSet& blockers_;
  const std::vector<const DirectionTree::Leaf*>& leaves_;
  const FacetTable& table_;
  const target::RangeRegion& range_;
  const CurveSampling& sampling_;
  double shortest_;

  ContactTest contact_;
  core::FacetPolygon polygon_, scratch_;
  std::vector<std::uint32_t> competitors_;
  std::vector<std::uint32_t> seen_;  // per blocker: the facet's plane that it was last gathered for
  std::vector<Cut> cuts_;
  std::size_t cut_count_ = 0;
  IntervalSet shown_;
};

// Takes out of an arc on the range sphere the pieces that the grid does without.
void drop_where_fine(const SpaceCircle& circle, const CurveSampling& sampling, const target::RangeRegion& range,
                     OctahedralGrid& grid, CircleArcs& arcs) {
  const double margin = sampling.sagitta_m / range.inner_radius();  // of a chord beside its arc
  std::vector<Interval> fine;
  for (const Interval& part : arcs.parts()) {
    const int pieces = FacetTracer::piece_count(circle, part, sampling);
    Vec3 from = circle.at(part.begin);
    for (int k = 0; k < pieces; ++k) {
      const double begin = part.begin + part.length() * k / pieces;
      const double end = k + 1 == pieces ? part.end : part.begin + part.length() * (k + 1) / pieces;
      const Vec3 to = circle.at(end);
      const bool bent = from.x() * to.x() < 0 || from.y() * to.y() < 0;  // on the map
      if (!bent && !grid.is_coarse(range, to_octahedral(from), to_octahedral(to), margin)) {
        if (fine.empty() || fine.back().end != begin)
          fine.push_back({begin, end});
        else
          fine.back().end = end;
      }
      from = to;
    }
  }
  for (const Interval& interval : fine) arcs.drop(interval.begin, interval.end);
}

// Where two balls of the range region meet, in sight.
void trace_range_creases(const BlockerSet& blockers, const DirectionTree& tree, const target::RangeRegion& range,
                         const CurveSampling& sampling, OctahedralGrid& grid, std::vector<std::vector<Vec3>>& out) {
  const double inner = range.inner_radius();
  for (std::size_t i = 0; i < range.ball_count(); ++i)
    for (const std::uint32_t j : range.neighbours(i)) {
      if (j < i) continue;
      const Eigen::Vector2d a = range.centre(i), b = range.centre(j), middle = 0.5 * (a + b),
                            along = (b - a).normalized();
      const double square = range.radius() * range.radius() - 0.25 * (b - a).squaredNorm();
      if (square <= 0) continue;
      const SpaceCircle circle{
          {middle.x(), middle.y(), 0}, {along.y(), -along.x(), 0}, Vec3::UnitZ(), std::sqrt(square)};
      CircleArcs arcs(circle);
      arcs.keep(Vec3::UnitZ(), 0);
      FacetTracer::keep_in_balls(range, i, j, arcs);
      // Chords as long as the sampling's are as deep as the tolerance. A wider bend would add more than that.
      if ((b - a).norm() < 0.5 * sampling.length_m) drop_where_fine(circle, sampling, range, grid, arcs);
      if (arcs.empty()) continue;
      // Points of the circle have along . x = height, and |x| + |y| + z from `inner` to less than twice the range.
      const double height = along.dot(middle), near = height / inner, far = 0.5 * height / range.radius();
      for (std::uint32_t blocker :
           tree.listed_between({along.x(), along.y(), 0}, std::min(near, far) - kBand, std::max(near, far) + kBand)) {
        arcs.subtract_blocker(blockers.planes_of(blocker), true);
        if (arcs.empty()) break;
      }
      FacetTracer::add_arcs(circle, arcs, shortest_piece(range), sampling, out);
    }
}

}  // namespace

Skeleton trace_envelope(const BlockerSet& blockers, const DirectionTree& tree, const target::RangeRegion& range,
                        const CurveSampling& sampling, OctahedralGrid& grid, const core::ProgressReporter& progress) {
  const std::vector<const DirectionTree::Leaf*> leaves = tree.leaves();
  const FacetTable table = find_facets(blockers, leaves);
  std::vector<FacetTracer::Result> results(table.facets.size());
  const std::size_t grain =
      std::max<std::size_t>(16, table.facets.size() / 256);  // a tracer costs a look at each blocker
  parallel::for_ranges(table.facets.size(), grain, [&](std::size_t begin, std::size_t end) {
    FacetTracer tracer(blockers, tree, leaves, table, range, sampling);
    for (std::size_t i = begin; i < end; ++i) {
      progress.check();
      results[i] = tracer.trace(table.facets[i]);
    }
  });
  Skeleton skeleton;
  std::uint32_t last = ~0u;
  for (std::size_t i = 0; i < results.size(); ++i) {
    skeleton.planar.insert(skeleton.planar.end(), results[i].planar.begin(), results[i].planar.end());
    std::move(results[i].curved.begin(), results[i].curved.end(), std::back_inserter(skeleton.curved));
    if (!results[i].visible) continue;
    ++skeleton.visible_facets;
    if (table.facets[i].blocker != last) ++skeleton.visible_blockers;
    last = table.facets[i].blocker;
  }
  trace_range_creases(blockers, tree, range, sampling, grid, skeleton.curved);
  return skeleton;
}

}  // namespace vantage::internal::exact
