#include "exact/envelope.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "core/parallel.h"
#include "exact/facet_table.h"
#include "exact/facet_tracer.h"
#include "exact/range_arcs.h"

namespace vantage::internal::exact {

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
