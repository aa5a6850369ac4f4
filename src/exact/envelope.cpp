#include "exact/envelope.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "exact/circle_arcs.h"
#include "exact/facet_polygon.h"
#include "exact/interval_set.h"
#include "exact/segment_cover.h"
#include "parallel/parallel.h"

namespace vantage::exact {
namespace {

// Pieces of an edge shorter than this, in metres, are rounding.
constexpr double kShortest = 1e-9;
// Two planes of one blocker whose inverse depths differ by less than this everywhere on a facet bound it together.
constexpr double kSiblingMargin = 1e-12;

/// A plane of a blocker that may be seen, and the blockers that may cut it.
struct Facet {
  std::uint32_t plane, blocker;
  std::uint32_t first_leaf, leaf_count;  // into FacetTable::leaf
};

struct FacetTable {
  std::vector<Facet> facets;
  std::vector<std::uint32_t> leaf;
};

struct Sighting {
  std::uint32_t plane, blocker, leaf;
  bool operator<(const Sighting& other) const { return plane != other.plane ? plane < other.plane : leaf < other.leaf; }
};

// A plane bounds the view only beyond the corners where it touches its polygon: where those are hidden, so is it.
std::vector<bool> hidden_planes(const BlockerSet& blockers, const DirectionTree& tree,
                                const std::vector<DirectionTree::Leaf>& leaves, const RangeRegion& range) {
  std::vector<bool> hidden(blockers.planes.size(), true);
  std::vector<bool> listed(blockers.count(), false);
  for (const auto& leaf : leaves)
    for (std::uint32_t blocker : leaf.blockers) listed[blocker] = true;
  std::vector<Vec3> touched;
  for (std::uint32_t blocker = 0; blocker < blockers.count(); ++blocker) {
    if (!listed[blocker]) continue;
    for (std::uint32_t k = blockers.first[blocker]; k < blockers.first[blocker + 1]; ++k) {
      const Plane& plane = blockers.planes[k];
      const double margin = tie_margin(plane, range.radius());
      touched.clear();
      for (const Vec3& corner : blockers.corners_of(blocker))
        if (std::abs(plane.dot(corner) - 1) <= margin) touched.push_back(corner);
      hidden[k] = !touched.empty() && tree.hides_hull(touched);
    }
  }
  return hidden;
}

// A plane may be seen in a leaf where it can reach the envelope's lower bound and can be the least of its blocker.
FacetTable find_facets(const BlockerSet& blockers, const DirectionTree& tree,
                       const std::vector<DirectionTree::Leaf>& leaves, const RangeRegion& range) {
  const std::vector<bool> hidden = hidden_planes(blockers, tree, leaves, range);
  std::vector<Sighting> sightings;
  std::vector<double> upper, lower;
  for (std::uint32_t l = 0; l < leaves.size(); ++l) {
    const ChartCell& cell = leaves[l].cell;
    for (std::uint32_t blocker : leaves[l].blockers) {
      const auto planes = blockers.planes_of(blocker);
      upper.clear(), lower.clear();
      double least_upper = std::numeric_limits<double>::infinity();
      for (const Plane& plane : planes) {
        const QuadrantLinear f = on_quadrant(plane, cell.quadrant);
        upper.push_back(cell.max_of(f)), lower.push_back(cell.min_of(f));
        least_upper = std::min(least_upper, upper.back());
      }
      for (std::size_t k = 0; k < planes.size(); ++k)
        if (!hidden[blockers.first[blocker] + k] && upper[k] >= leaves[l].bound * (1 - 1e-12) &&
            lower[k] <= least_upper * (1 + 1e-12))
          sightings.push_back({blockers.first[blocker] + std::uint32_t(k), blocker, l});
    }
  }
  parallel::sort(sightings, std::less<>());
  FacetTable table;
  for (const Sighting& s : sightings) {
    if (table.facets.empty() || table.facets.back().plane != s.plane)
      table.facets.push_back({s.plane, s.blocker, std::uint32_t(table.leaf.size()), 0});
    table.leaf.push_back(s.leaf);
    ++table.facets.back().leaf_count;
  }
  return table;
}

/// Traces the creases of one facet after another; one tracer a thread.
class FacetTracer {
 public:
  FacetTracer(const BlockerSet& blockers, const std::vector<DirectionTree::Leaf>& leaves, const FacetTable& table,
              const RangeRegion& range, const CurveSampling& sampling)
      : blockers_(blockers), leaves_(leaves), table_(table), range_(range), sampling_(sampling) {}

  struct Result {
    std::vector<Skeleton::Edge> planar;
    std::vector<std::vector<Vec3>> curved;
    bool visible = false;
  };

  Result trace(const Facet& facet) {
    Result result;
    if (!make_polygon(facet)) return result;
    gather_rivals(facet);
    if (!cut_by_rivals(facet)) return result;
    trace_own_edges(result);
    trace_crossings(facet, result);
    trace_range(facet, result);
    result.visible = !result.planar.empty() || !result.curved.empty();
    return result;
  }

 private:
  static constexpr std::uint32_t kNoRival = ~0u;

  const Plane& plane_of(const Facet& facet) const { return blockers_.planes[facet.plane]; }
  double reach() const { return range_.radius(); }

  // The facet of the blocker itself: where its plane is the least of the blocker's.
  bool make_polygon(const Facet& facet) {
    const Plane& plane = plane_of(facet);
    if (plane.norm() * reach() <= 1) return false;  // the plane does not come within range
    make_facet_square(plane, reach(), polygon_);
    clip_facet(polygon_, Vec3::UnitZ(), 0, 0, FacetPolygon::kHorizon, scratch_);
    for (std::uint32_t k = blockers_.first[facet.blocker]; k < blockers_.first[facet.blocker + 1]; ++k) {
      if (k == facet.plane) continue;
      const double margin = kSiblingMargin + 1e-15 * reach() * blockers_.planes[k].cwiseAbs().sum();
      clip_facet(polygon_, blockers_.planes[k], 1, margin, k, scratch_);
      if (polygon_.empty()) return false;
    }
    return true;
  }

  void gather_rivals(const Facet& facet) {
    rivals_.clear();
    for (std::uint32_t i = facet.first_leaf; i < facet.first_leaf + facet.leaf_count; ++i) {
      const auto& listed = leaves_[table_.leaf[i]].blockers;
      rivals_.insert(rivals_.end(), listed.begin(), listed.end());
    }
    std::sort(rivals_.begin(), rivals_.end());
    rivals_.erase(std::unique(rivals_.begin(), rivals_.end()), rivals_.end());
    std::erase(rivals_, facet.blocker);
  }

  struct Cut {  // what a rival hides of the polygon
    std::uint32_t rival;
    FacetPolygon polygon;
  };

  // Cuts out of a copy of the facet what each rival hides. False when one of them hides all of it. Rivals that come
  // nowhere near are dropped.
  bool cut_by_rivals(const Facet& facet) {
    cut_count_ = 0;
    std::size_t kept = 0;
    for (std::uint32_t rival : rivals_) {
      if (cuts_.size() == cut_count_) cuts_.emplace_back();
      cuts_[cut_count_].rival = rival;
      const Overlap overlap = cut_by(rival, facet.blocker, cuts_[cut_count_].polygon);
      if (overlap == Overlap::apart) continue;
      if (overlap == Overlap::hides_all) return false;
      rivals_[kept++] = rival;
      cut_count_ += overlap == Overlap::hides_part;
    }
    rivals_.resize(kept);
    return true;
  }

  enum class Overlap { apart, touches, hides_part, hides_all };

  Overlap cut_by(std::uint32_t rival, std::uint32_t blocker, FacetPolygon& cut) {
    bool copied = false, hides = true;
    for (std::uint32_t k = blockers_.first[rival]; k < blockers_.first[rival + 1]; ++k) {
      const Plane& plane = blockers_.planes[k];
      const double margin = tie_margin(plane, reach());
      double low = std::numeric_limits<double>::infinity(), high = -low;
      for (const Vec3& corner : polygon_.corners) {
        const double value = plane.dot(corner) - 1;
        low = std::min(low, value), high = std::max(high, value);
      }
      if (high < -margin) return Overlap::apart;
      if (high <= margin) {
        const bool tie = low >= -margin;
        hides = hides && tie && rival < blocker;
      } else if (low < -margin && hides) {
        if (!copied) cut = polygon_, copied = true;
        clip_facet(cut, plane, 1, margin, k, scratch_);
        hides = !cut.empty();
      }
    }
    if (!hides) return Overlap::touches;
    return copied ? Overlap::hides_part : Overlap::hides_all;
  }

  // The creases between this facet and its siblings. Both find them; they are the same edge once snapped.
  void trace_own_edges(Result& result) {
    for (std::size_t i = 0; i < polygon_.corners.size(); ++i) {
      if (polygon_.makers[i] >= FacetPolygon::kHorizon) continue;
      const Vec3 &from = polygon_.corners[i], &to = polygon_.corners[(i + 1) % polygon_.corners.size()];
      trace_edge(from, to, kNoRival, result);
    }
  }

  // Where a rival's surface comes out of this facet. The blocker with the lower index reports it.
  void trace_crossings(const Facet& facet, Result& result) {
    for (std::size_t c = 0; c < cut_count_; ++c) {
      const Cut& cut = cuts_[c];
      if (cut.rival < facet.blocker) continue;
      const auto& corners = cut.polygon.corners;
      for (std::size_t i = 0; i < corners.size(); ++i) {
        const std::uint32_t maker = cut.polygon.makers[i];
        if (maker < blockers_.first[cut.rival] || maker >= blockers_.first[cut.rival + 1]) continue;
        trace_edge(corners[i], corners[(i + 1) % corners.size()], cut.rival, result);
      }
    }
  }

  // Adds what of from -> to is in range and not hidden by any rival but `other`.
  void trace_edge(const Vec3& from, const Vec3& to, std::uint32_t other, Result& result) {
    const double length = (to - from).norm();
    if (length < kShortest) return;
    shown_.assign(0, 1);
    keep_in_range(from, to);
    for (std::uint32_t rival : rivals_) {
      if (rival == other) continue;
      const Interval hidden = hidden_part(from, to, reach(), blockers_.planes_of(rival));
      shown_.subtract(hidden.begin, hidden.end);
      if (shown_.empty()) return;
    }
    shown_.drop_shorter_than(kShortest / length);
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
      if (inside) continue;
      const double height = 1 / size - normal.dot(centre);
      if (square - height * height <= 0) return;  // the plane misses this ball, so all of it is out of range
      SpaceCircle circle{centre + height * normal, normal.unitOrthogonal(), {}, std::sqrt(square - height * height)};
      circle.axis_2 = normal.cross(circle.axis_1);
      CircleArcs arcs(circle);
      arcs.keep(Vec3::UnitZ(), 0);
      for (std::uint32_t maker : polygon_.makers)
        if (maker < FacetPolygon::kHorizon) arcs.keep(blockers_.planes[maker], 1);
      keep_in_other_balls(ball, arcs);
      for (std::uint32_t rival : rivals_) {
        if (arcs.empty()) break;
        arcs.subtract_blocker(blockers_.planes_of(rival), rival < facet.blocker);
      }
      add_arcs(circle, arcs, sampling_, result.curved);
    }
  }

  // On the sphere of one ball, being inside another is being on one side of the plane half way between their centres.
  void keep_in_other_balls(std::size_t ball, CircleArcs& arcs) const { keep_in_balls(range_, ball, ball, arcs); }

 public:
  static void keep_in_balls(const RangeRegion& range, std::size_t ball, std::size_t also, CircleArcs& arcs) {
    const Eigen::Vector2d own = range.centre(ball);
    for (std::size_t k = 0; k < range.ball_count() && !arcs.empty(); ++k) {
      if (k == ball || k == also) continue;
      const Eigen::Vector2d other = range.centre(k), across = other - own;
      arcs.keep({across.x(), across.y(), 0}, 0.5 * (other.squaredNorm() - own.squaredNorm()));
    }
  }

  static void add_arcs(const SpaceCircle& circle, CircleArcs& arcs, const CurveSampling& sampling,
                       std::vector<std::vector<Vec3>>& out) {
    arcs.drop_shorter_than(kShortest / circle.radius);
    const double by_sagitta = 2 * std::acos(std::max(0.0, 1 - sampling.sagitta_m / circle.radius));
    const double step = std::min(by_sagitta, sampling.length_m / circle.radius);
    for (const Interval& part : arcs.parts()) {
      const int pieces = std::max(1, int(std::ceil(part.length() / step)));
      std::vector<Vec3>& line = out.emplace_back();
      for (int i = 0; i <= pieces; ++i) line.push_back(circle.at(part.begin + part.length() * i / pieces));
    }
  }

 private:
  const BlockerSet& blockers_;
  const std::vector<DirectionTree::Leaf>& leaves_;
  const FacetTable& table_;
  const RangeRegion& range_;
  const CurveSampling& sampling_;

  FacetPolygon polygon_, scratch_;
  std::vector<std::uint32_t> rivals_;
  std::vector<Cut> cuts_;
  std::size_t cut_count_ = 0;
  IntervalSet shown_;
};

// Where two balls of the range region meet, in sight.
void trace_range_creases(const BlockerSet& blockers, const std::vector<std::uint32_t>& shown, const RangeRegion& range,
                         const CurveSampling& sampling, std::vector<std::vector<Vec3>>& out) {
  for (std::size_t i = 0; i < range.ball_count(); ++i)
    for (std::size_t j = i + 1; j < range.ball_count(); ++j) {
      const Eigen::Vector2d a = range.centre(i), b = range.centre(j), middle = 0.5 * (a + b),
                            along = (b - a).normalized();
      const double square = range.radius() * range.radius() - 0.25 * (b - a).squaredNorm();
      if (square <= 0) continue;
      const SpaceCircle circle{
          {middle.x(), middle.y(), 0}, {along.y(), -along.x(), 0}, Vec3::UnitZ(), std::sqrt(square)};
      CircleArcs arcs(circle);
      arcs.keep(Vec3::UnitZ(), 0);
      FacetTracer::keep_in_balls(range, i, j, arcs);
      for (std::uint32_t blocker : shown) {
        if (arcs.empty()) break;
        arcs.subtract_blocker(blockers.planes_of(blocker), true);
      }
      FacetTracer::add_arcs(circle, arcs, sampling, out);
    }
}

}  // namespace

Skeleton trace_envelope(const BlockerSet& blockers, const DirectionTree& tree, const RangeRegion& range,
                        const CurveSampling& sampling) {
  const std::vector<DirectionTree::Leaf> leaves = tree.leaves();
  const FacetTable table = find_facets(blockers, tree, leaves, range);
  if (getenv("VDBG")) {
    size_t r = 0;
    for (auto& f : table.facets) r += f.leaf_count;
    fprintf(stderr, "planes %zu active facets %zu leafrefs %zu\n", blockers.planes.size(), table.facets.size(), r);
  }
  std::vector<FacetTracer::Result> results(table.facets.size());
  parallel::for_ranges(table.facets.size(), 16, [&](std::size_t begin, std::size_t end) {
    FacetTracer tracer(blockers, leaves, table, range, sampling);
    for (std::size_t i = begin; i < end; ++i) results[i] = tracer.trace(table.facets[i]);
  });
  Skeleton skeleton;
  std::vector<std::uint32_t> shown;
  for (std::size_t i = 0; i < results.size(); ++i) {
    skeleton.planar.insert(skeleton.planar.end(), results[i].planar.begin(), results[i].planar.end());
    std::move(results[i].curved.begin(), results[i].curved.end(), std::back_inserter(skeleton.curved));
    if (!results[i].visible) continue;
    ++skeleton.visible_facets;
    if (shown.empty() || shown.back() != table.facets[i].blocker) shown.push_back(table.facets[i].blocker);
  }
  skeleton.visible_blockers = shown.size();
  trace_range_creases(blockers, shown, range, sampling, skeleton.curved);
  return skeleton;
}

}  // namespace vantage::exact
