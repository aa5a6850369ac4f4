#include "flight/tour/pairs_bound.h"
namespace vantage::internal::flight::tour {
bool has_pairs_bound() { return false; }
PairsBound pairs_bound(const Cells&, const TourSpace&, const std::vector<Vec3>&, const PairsOptions&, const core::ProgressReporter&) { return {}; }
}
