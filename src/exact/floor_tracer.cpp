#include "exact/floor_tracer.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

#include "core/parallel.h"
#include "exact/quadrant_parts.h"
#include "exact/range_arcs.h"
#include "exact/segment_cover.h"

namespace vantage::internal::exact {
namespace {

using core::FacetPolygon;

/// In parts of an inverse depth: what is so far behind a facet is no tie with it.
constexpr double kSurelyBefore = 1e-9;

/// Keeps of a segment what is on the positive side, with `a` at its begin and `b` at its end. False where that is
/// nothing.
bool keep_positive(double a, double b, Interval& part) {
  const double crossing = a / (a - b);
  if (a < b) {
    part.begin = std::max(part.begin, crossing);
  } else {
    part.end = std::min(part.end, crossing);
  }
  return part.begin < part.end;
}

/// The part of from -> to in which every plane stays below 1, and which is in a cone of half-spaces e . x > 0: what
/// lies inside a body of planes. Empty intervals have begin >= end.
Interval inner_part(const Vec3& from, const Vec3& to, double reach, std::span<const Plane> planes,
                    std::span<const Vec3> cone) {
  Interval inner{0, 1};
  for (const Vec3& side : cone) {
    const double a = side.dot(from), b = side.dot(to);
    if (a <= 0 && b <= 0) return {1, 0};
    if (a >= 0 && b >= 0) continue;
    if (!keep_positive(a, b, inner)) return {1, 0};
  }
  for (const Plane& plane : planes) {
    const double margin = tie_margin(plane, reach), a = 1 - plane.dot(from), b = 1 - plane.dot(to);
    if (a <= margin && b <= margin) return {1, 0};
    if (a >= -margin && b >= -margin) continue;
    if (!keep_positive(a, b, inner)) return {1, 0};
  }
  return inner;
}

/// Traces one facet after another; one for each thread. Keeps references to all that it is made of.
class Tracer {
 public:
  Tracer(const Floor& floor, const BlockerSet& blockers, const DirectionTree& tree, const target::RangeRegion& range,
         const CurveSampling& sampling)
      : floor_(floor),
        blockers_(blockers),
        tree_(tree),
        range_(range),
        sampling_(sampling),
        shortest_(shortest_piece(range)),
        seen_(blockers.count(), Floor::Value::kNone) {}

  FloorSkeleton trace(std::uint32_t number);

 private:
  /// What is above the facet's plane in a part of it: a blocker that ends the volume before, or a body that the volume
  /// begins behind.
  struct Hider {
    std::span<const Plane> planes;
    std::span<const Vec3> cone;  // of a star's facet; else empty
    bool is_body;
    std::uint32_t first_plane;  // of the planes, among the blockers' or the floor's
    FacetPolygon cut;
    Box bounds;
  };
  static constexpr std::size_t kNoHider = ~std::size_t{0};

  double reach() const { return range_.radius(); }
  bool clip_to_kept();
  void gather_blockers();
  bool add_star(std::uint32_t body);
  bool add_hider(std::span<const Plane> planes, std::span<const Vec3> cone, bool is_body, std::uint32_t first_plane,
                 bool owns_ties);
  void trace_own_edges(FloorSkeleton& result);
  void trace_crossings(FloorSkeleton& result);
  void trace_edge(const Vec3& from, const Vec3& to, std::size_t other, std::vector<Skeleton::Edge>& out);
  void trace_range(FloorSkeleton& result);

  const Floor& floor_;
  const BlockerSet& blockers_;
  const DirectionTree& tree_;
  const target::RangeRegion& range_;
  const CurveSampling& sampling_;
  double shortest_;

  std::uint32_t number_ = 0;
  const Floor::Facet* facet_ = nullptr;
  FacetPolygon polygon_, part_, scratch_;
  std::vector<std::uint32_t> seen_;  // per blocker: the facet that it was last gathered for
  std::vector<std::uint32_t> found_;
  std::vector<const DirectionTree::Leaf*> leaves_;
  std::vector<Hider> hiders_;
  std::size_t hider_count_ = 0;
  IntervalSet shown_;
};

FloorSkeleton Tracer::trace(std::uint32_t number) {
  FloorSkeleton result;
  number_ = number;
  facet_ = &floor_.facets()[number];
  // All that is in range lies within its radius about the centre.
  if (floor_.planes()[facet_->plane].norm() * reach() <= 1) return result;
  polygon_ = facet_->polygon;
  hider_count_ = 0;
  if (!clip_to_kept()) return result;
  for (std::uint32_t b = 0; b < floor_.bodies().size(); ++b) {
    const Floor::Body& body = floor_.bodies()[b];
    if (b == facet_->body || body.kind == Floor::Kind::kept) continue;
    const bool is_left = body.kind == Floor::Kind::star
                             ? add_star(b)
                             : add_hider(floor_.planes_of(body), {}, true, body.first, b < facet_->body);
    if (!is_left) return result;
  }
  gather_blockers();
  for (const std::uint32_t blocker : found_) {
    if (!add_hider(blockers_.planes_of(blocker), {}, false, blockers_.first[blocker], true)) return result;
  }
  trace_own_edges(result);
  trace_crossings(result);
  trace_range(result);
  return result;
}

// Where the sides that are kept lie farther out, the facet is not the floor.
bool Tracer::clip_to_kept() {
  for (std::uint32_t b = 0; b < floor_.bodies().size(); ++b) {
    const Floor::Body& body = floor_.bodies()[b];
    if (b == facet_->body || body.kind != Floor::Kind::kept) continue;
    for (std::uint32_t k = body.first; k < body.end; ++k) {
      core::clip_facet(polygon_, floor_.planes()[k], 1, tie_margin(floor_.planes()[k], reach()), k, scratch_);
      if (polygon_.empty()) return false;
    }
  }
  return true;
}

void Tracer::gather_blockers() {
  found_.clear();
  for_each_quadrant(polygon_, part_, scratch_, [&](int quadrant, const FacetPolygon& part) {
    leaves_.clear();
    for (std::size_t i = 1; i + 1 < part.corners.size(); ++i) {
      tree_.leaves_over(
          quadrant,
          {to_octahedral(part.corners[0]), to_octahedral(part.corners[i]), to_octahedral(part.corners[i + 1])},
          leaves_);
    }
    const QuadrantLinear plane = on_quadrant(floor_.planes()[facet_->plane], quadrant);
    for (const DirectionTree::Leaf* leaf : leaves_) {
      CellCorners own = leaf->cell.at_corners(plane);
      for (double& value : own) value -= kSurelyBefore * std::abs(value);
      for (std::size_t i = 0; i < leaf->count(); ++i) {
        const std::uint32_t blocker = leaf->blockers[i];
        if (seen_[blocker] == number_) continue;
        const auto values = leaf->values_of(i);
        // Nowhere in the cell before the facet.
        if (std::ranges::any_of(values, [&](const CellCorners& value) { return below(value, own); })) continue;
        seen_[blocker] = number_;
        found_.push_back(blocker);
      }
    }
  });
  std::sort(found_.begin(), found_.end());
}

// Facet by facet of the star. False where one of them hides all of the facet.
bool Tracer::add_star(std::uint32_t body) {
  found_.clear();
  for_each_quadrant(polygon_, part_, scratch_, [&](int quadrant, const FacetPolygon& part) {
    floor_.planes_over(body, quadrant, part.corners, 0, found_);
  });
  std::sort(found_.begin(), found_.end());
  found_.erase(std::unique(found_.begin(), found_.end()), found_.end());
  const Floor::Body& star = floor_.bodies()[body];
  return std::all_of(found_.begin(), found_.end(), [&](std::uint32_t plane) {
    return add_hider({&floor_.planes()[plane], 1}, floor_.cone_of(star, plane), true, plane, body < facet_->body);
  });
}

// False where it hides all of the facet.
bool Tracer::add_hider(std::span<const Plane> planes, std::span<const Vec3> cone, bool is_body,
                       std::uint32_t first_plane, bool owns_ties) {
  if (hiders_.size() == hider_count_) hiders_.emplace_back();
  Hider& hider = hiders_[hider_count_];
  bool is_copied = false;
  for (const Vec3& side : cone) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const Vec3& corner : polygon_.corners) {
      low = std::min(low, side.dot(corner));
      high = std::max(high, side.dot(corner));
    }
    if (high <= 0) return true;
    if (low >= 0) continue;
    if (!is_copied) hider.cut = polygon_;
    is_copied = true;
    core::clip_facet(hider.cut, side, 0, 0, FacetPolygon::kHorizon, scratch_);
    if (hider.cut.empty()) return true;
  }
  for (std::size_t k = 0; k < planes.size(); ++k) {
    const double margin = tie_margin(planes[k], reach());
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const Vec3& corner : polygon_.corners) {
      const double value = is_body ? 1 - planes[k].dot(corner) : planes[k].dot(corner) - 1;
      low = std::min(low, value);
      high = std::max(high, value);
    }
    if (high <= margin) {
      if (low < -margin || !owns_ties) return true;
    } else if (low < -margin) {
      if (!is_copied) hider.cut = polygon_;
      is_copied = true;
      const auto maker = first_plane + static_cast<std::uint32_t>(k);
      core::clip_facet(hider.cut, is_body ? Vec3(-planes[k]) : planes[k], is_body ? -1 : 1, margin,
                       FacetPolygon::kHorizon - 1 - maker, scratch_);
      if (hider.cut.empty()) return true;
    }
  }
  if (!is_copied) return false;
  hider.planes = planes;
  hider.cone = cone;
  hider.is_body = is_body;
  hider.first_plane = first_plane;
  hider.bounds = Box();
  for (const Vec3& corner : hider.cut.corners) hider.bounds.extend(corner);
  ++hider_count_;
  return true;
}

// Of two facets of a body that meet the one with the lower plane reports it. Edges that sides to keep have cut are
// crossings of these.
void Tracer::trace_own_edges(FloorSkeleton& result) {
  for (std::size_t i = 0; i < polygon_.corners.size(); ++i) {
    const std::uint32_t maker = polygon_.makers[i];
    const Floor::Body& own = floor_.bodies()[facet_->body];
    if (maker < facet_->plane || maker >= own.end) continue;
    trace_edge(polygon_.corners[i], polygon_.corners[(i + 1) % polygon_.corners.size()], kNoHider, result.creases);
  }
}

// Where a blocker comes out of the facet is the rim, where another body does is a crease. Of two bodies the one with
// the lower number reports it.
void Tracer::trace_crossings(FloorSkeleton& result) {
  for (std::size_t h = 0; h < hider_count_; ++h) {
    const Hider& hider = hiders_[h];
    if (hider.is_body && hider.first_plane < facet_->plane) continue;
    const auto& corners = hider.cut.corners;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const std::uint32_t maker = FacetPolygon::kHorizon - 1 - hider.cut.makers[i];
      if (hider.cut.makers[i] >= FacetPolygon::kHorizon || maker < hider.first_plane ||
          maker >= hider.first_plane + hider.planes.size()) {
        continue;
      }
      if (!hider.is_body && !blockers_.visible[maker]) continue;
      trace_edge(corners[i], corners[(i + 1) % corners.size()], h, hider.is_body ? result.creases : result.rim);
    }
  }
}

// Adds what of from -> to is in range and not hidden by anything but `other`.
void Tracer::trace_edge(const Vec3& from, const Vec3& to, std::size_t other, std::vector<Skeleton::Edge>& out) {
  const double length = (to - from).norm();
  if (length < shortest_) return;
  shown_.assign(0, 1);
  keep_in_range(range_, from, to, shown_);
  const Vec3 low = from.cwiseMin(to), high = from.cwiseMax(to);
  for (std::size_t h = 0; h < hider_count_ && !shown_.empty(); ++h) {
    const Hider& hider = hiders_[h];
    const bool apart =
        (hider.bounds.min.array() > high.array()).any() || (hider.bounds.max.array() < low.array()).any();
    if (apart || h == other) continue;
    const Interval hidden = hider.is_body ? inner_part(from, to, reach(), hider.planes, hider.cone)
                                          : hidden_part(from, to, reach(), hider.planes);
    shown_.subtract(hidden.begin, hidden.end);
  }
  shown_.drop_shorter_than(shortest_ / length);
  for (const Interval& part : shown_.parts()) {
    out.push_back({part.begin == 0 ? from : Vec3(from + part.begin * (to - from)),
                   part.end == 1 ? to : Vec3(from + part.end * (to - from))});
  }
}

void Tracer::trace_range(FloorSkeleton& result) {
  const Plane& plane = floor_.planes()[facet_->plane];
  const double size = plane.norm(), square = range_.radius() * range_.radius();
  const Vec3 normal = plane / size;
  for (std::size_t ball = 0; ball < range_.ball_count(); ++ball) {
    const Vec3 centre(range_.centre(ball).x(), range_.centre(ball).y(), 0);
    const bool is_inside = std::all_of(polygon_.corners.begin(), polygon_.corners.end(),
                                       [&](const Vec3& c) { return (c - centre).squaredNorm() <= square; });
    const double height = 1 / size - normal.dot(centre);
    if (is_inside) continue;
    if (square - height * height <= 0) return;  // the plane misses this ball, so all of it is out of range
    SpaceCircle circle{centre + height * normal, normal.unitOrthogonal(), {}, std::sqrt(square - height * height)};
    circle.axis_2 = normal.cross(circle.axis_1);
    CircleArcs arcs(circle);
    arcs.keep(Vec3::UnitZ(), 0);
    for (std::size_t i = 0; i < polygon_.corners.size() && !arcs.empty(); ++i) {
      if (polygon_.makers[i] >= FacetPolygon::kHorizon) continue;
      const Vec3 &from = polygon_.corners[i], &to = polygon_.corners[(i + 1) % polygon_.corners.size()];
      const Vec3 inwards = normal.cross(to - from);
      if (inwards.norm() < shortest_) continue;  // its direction is rounding
      arcs.keep(inwards.normalized(), inwards.normalized().dot(from));
    }
    keep_in_balls(range_, ball, ball, arcs);
    for (std::size_t h = 0; h < hider_count_ && !arcs.empty(); ++h) {
      if (hiders_[h].is_body) {
        arcs.subtract_body(hiders_[h].planes, hiders_[h].cone);
      } else {
        arcs.subtract_blocker(hiders_[h].planes, true);
      }
    }
    add_arcs(circle, arcs, shortest_, sampling_, result.curved_rim);
  }
}

}  // namespace

FloorSkeleton trace_floor(const Floor& floor, const BlockerSet& blockers, const DirectionTree& tree,
                          const target::RangeRegion& range, const CurveSampling& sampling,
                          const core::ProgressReporter& progress) {
  std::vector<FloorSkeleton> results(floor.facets().size());
  const std::size_t grain = std::max<std::size_t>(16, results.size() / 64);
  parallel::for_ranges(results.size(), grain, [&](std::size_t begin, std::size_t end) {
    Tracer tracer(floor, blockers, tree, range, sampling);
    for (std::size_t i = begin; i < end; ++i) {
      progress.check();
      results[i] = tracer.trace(static_cast<std::uint32_t>(i));
    }
  });
  FloorSkeleton all;
  for (FloorSkeleton& one : results) {
    all.rim.insert(all.rim.end(), one.rim.begin(), one.rim.end());
    all.creases.insert(all.creases.end(), one.creases.begin(), one.creases.end());
    std::move(one.curved_rim.begin(), one.curved_rim.end(), std::back_inserter(all.curved_rim));
  }
  return all;
}

void add_rim_ends(const FloorSkeleton& floor, double reach, const CurveSampling& sampling, Skeleton& skeleton) {
  std::vector<Vec3> ends;
  for (const Skeleton::Curve& curve : floor.curved_rim) {
    ends.push_back(curve.points.front());
    ends.push_back(curve.points.back());
  }
  const double near = 2 * sampling.sagitta_m, on_curve = 1e-9 * reach;
  for (Skeleton::Curve& curve : skeleton.curved) {
    Box box;
    for (const Vec3& point : curve.points) box.extend(point);
    for (const Vec3& end : ends) {
      if ((end.array() < box.min.array() - near).any() || (end.array() > box.max.array() + near).any()) continue;
      if (std::abs(curve.normal.dot(end) - curve.height) > on_curve) continue;
      for (std::size_t i = 0; i + 1 < curve.points.size(); ++i) {
        const Vec3 along = curve.points[i + 1] - curve.points[i], to_end = end - curve.points[i];
        const double part = to_end.dot(along) / along.squaredNorm();
        if (!(part > 0) || !(part < 1) || (to_end - part * along).norm() > near) continue;
        curve.points.insert(curve.points.begin() + static_cast<std::ptrdiff_t>(i) + 1, end);
        break;
      }
    }
  }
}

}  // namespace vantage::internal::exact
