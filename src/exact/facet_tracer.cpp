#include "exact/facet_tracer.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "exact/range_arcs.h"
#include "exact/segment_cover.h"

namespace vantage::internal::exact {
namespace {

double area_of(const core::FacetPolygon& polygon) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 1; i + 1 < polygon.corners.size(); ++i)
    sum += (polygon.corners[i] - polygon.corners[0]).cross(polygon.corners[i + 1] - polygon.corners[0]);
  return 0.5 * sum.norm();
}

}  // namespace

FacetTracer::FacetTracer(const BlockerSet& blockers, const DirectionTree& tree,
                         const std::vector<const DirectionTree::Leaf*>& leaves, const FacetTable& table,
                         const target::RangeRegion& range, const CurveSampling& sampling)
    : blockers_(blockers),
      leaves_(leaves),
      table_(table),
      range_(range),
      sampling_(sampling),
      shortest_(shortest_piece(range)),
      contact_(blockers, tree, range.radius()) {}

FacetTracer::Result FacetTracer::trace(const Facet& facet) {
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

// The facet of the blocker itself: where its plane is the least of the blocker's.
bool FacetTracer::make_polygon(const Facet& facet) {
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
void FacetTracer::gather_competitors(const Facet& facet) {
  competitors_.clear();
  seen_.resize(blockers_.count(), ~0u);
  for (std::uint32_t p = facet.first_leaf_plane; p < facet.first_leaf_plane + facet.leaf_plane_count; ++p) {
    const DirectionTree::Leaf& leaf = *leaves_[table_.leaf_planes[p].leaf];
    const CellCorners& own = leaf.values[table_.leaf_planes[p].plane];
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

// Cuts out of a copy of the facet what each competitor hides. False when one of them hides all of it. Competitors
// that hide nothing of it are dropped, and the others sorted: what hides much ends the work on most edges at once.
bool FacetTracer::cut_by_competitors(const Facet& facet) {
  cut_count_ = 0;
  hid_last_ = kNoCompetitor;
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

FacetTracer::Overlap FacetTracer::cut_by(std::uint32_t competitor, std::uint32_t blocker, core::FacetPolygon& cut) {
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
void FacetTracer::trace_own_edges(Result& result) {
  for (std::size_t i = 0; i < polygon_.corners.size(); ++i) {
    if (polygon_.makers[i] >= core::FacetPolygon::kHorizon) continue;
    const Vec3 &from = polygon_.corners[i], &to = polygon_.corners[(i + 1) % polygon_.corners.size()];
    trace_edge(from, to, kNoCompetitor, result);
  }
}

// Where a competitor's surface comes out of this facet. The blocker with the lower index reports it. A facet that a
// neighbour of its polygon hides is nowhere the nearest one alone: where it comes out in sight, the neighbour's does
// too.
void FacetTracer::trace_crossings(const Facet& facet, Result& result) {
  for (std::size_t c = 0; c < cut_count_; ++c) {
    const Cut& cut = cuts_[c];
    if (cut.competitor < facet.blocker) continue;
    const auto& corners = cut.polygon.corners;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const std::uint32_t maker = cut.polygon.makers[i];
      if (maker < blockers_.first[cut.competitor] || maker >= blockers_.first[cut.competitor + 1]) continue;
      if (!blockers_.visible[maker]) continue;
      trace_edge(corners[i], corners[(i + 1) % corners.size()], cut.competitor, result);
    }
  }
}

// Adds what of from -> to is in range and not hidden by any competitor but `other`.
void FacetTracer::trace_edge(const Vec3& from, const Vec3& to, std::uint32_t other, Result& result) {
  const double length = (to - from).norm();
  if (length < shortest_) return;
  shown_.assign(0, 1);
  keep_in_range(range_, from, to, shown_);
  const Vec3 low = from.cwiseMin(to), high = from.cwiseMax(to);
  const auto subtract = [&](std::uint32_t c) {
    const Interval hidden = hidden_part(from, to, reach(), blockers_.planes_of(cuts_[c].competitor));
    shown_.subtract(hidden.begin, hidden.end);
    if (shown_.empty()) hid_last_ = c;
    return !shown_.empty();
  };
  // What hid all of an edge most often hides all of the next one.
  if (hid_last_ != kNoCompetitor && cuts_[hid_last_].competitor != other && !subtract(hid_last_)) return;
  for (std::uint32_t c = 0; c < cut_count_; ++c) {
    const Cut& cut = cuts_[c];
    const bool apart = (cut.bounds.min.array() > high.array()).any() || (cut.bounds.max.array() < low.array()).any();
    if (apart || cut.competitor == other) continue;
    if (!subtract(c)) return;
  }
  shown_.drop_shorter_than(shortest_ / length);
  for (const Interval& part : shown_.parts()) {
    result.planar.push_back({part.begin == 0 ? from : Vec3(from + part.begin * (to - from)),
                             part.end == 1 ? to : Vec3(from + part.end * (to - from))});
  }
}

// The rim: where the facet leaves the range region.
void FacetTracer::trace_range(const Facet& facet, Result& result) {
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
bool FacetTracer::is_met_elsewhere(std::size_t ball) const {
  return std::ranges::any_of(range_.neighbours(ball), [&](std::uint32_t other) {
    const auto side = range_.farther_from(ball, other);
    return std::ranges::all_of(polygon_.corners, [&](const Vec3& c) { return side.normal.dot(c) < side.height; });
  });
}

}  // namespace vantage::internal::exact
