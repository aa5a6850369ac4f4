// The creases of one facet: its edges in sight, where other blockers come out of it, and where it leaves the range.
#pragma once

#include <cstdint>
#include <vector>

#include "core/facet_polygon.h"
#include "exact/contact_test.h"
#include "exact/envelope.h"
#include "exact/facet_table.h"
#include "exact/interval_set.h"

namespace vantage::internal::exact {

/// Traces one facet after another; one for each thread. Keeps references to all that it is made of.
class FacetTracer {
 public:
  FacetTracer(const BlockerSet& blockers, const DirectionTree& tree,
              const std::vector<const DirectionTree::Leaf*>& leaves, const FacetTable& table,
              const target::RangeRegion& range, const CurveSampling& sampling);

  struct Result {
    std::vector<Skeleton::Edge> planar;
    std::vector<Skeleton::Curve> curved;
    bool visible = false;
  };

  Result trace(const Facet& facet);

 private:
  static constexpr std::uint32_t kNoCompetitor = ~0u;

  struct Cut {  // what a competitor hides of the polygon
    std::uint32_t competitor;
    double area;
    Box bounds;
    core::FacetPolygon polygon;
  };
  enum class Overlap { none, part, all };  // what a competitor hides

  const Plane& plane_of(const Facet& facet) const { return blockers_.planes[facet.plane]; }
  double reach() const { return range_.radius(); }
  bool make_polygon(const Facet& facet);
  void gather_competitors(const Facet& facet);
  bool cut_by_competitors(const Facet& facet);
  Overlap cut_by(std::uint32_t competitor, std::uint32_t blocker, core::FacetPolygon& cut);
  void trace_own_edges(Result& result);
  void trace_crossings(const Facet& facet, Result& result);
  void trace_edge(const Vec3& from, const Vec3& to, std::uint32_t other, Result& result);
  void trace_range(const Facet& facet, Result& result);
  bool is_met_elsewhere(std::size_t ball) const;

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
  std::uint32_t cut_count_ = 0;
  std::uint32_t hid_last_ = kNoCompetitor;  // the cut that hid all of an edge of this facet, or none
  IntervalSet shown_;
};

}  // namespace vantage::internal::exact
