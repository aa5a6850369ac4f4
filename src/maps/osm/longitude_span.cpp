#include "maps/osm/longitude_span.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace vantage::internal::osm {

void LongitudeSpan::add(double longitude_deg) {
  const int index = std::clamp(static_cast<int>(std::floor(longitude_deg + 180)), 0, kBins - 1);
  Bin& bin = bins_[static_cast<std::size_t>(index)];
  bin.low = std::min(bin.low, longitude_deg);
  bin.high = std::max(bin.high, longitude_deg);
}

bool LongitudeSpan::empty() const {
  return std::all_of(bins_.begin(), bins_.end(), [](const Bin& bin) { return bin.low > bin.high; });
}

geo::LongitudeRange LongitudeSpan::range() const {
  std::vector<Bin> used;
  std::copy_if(bins_.begin(), bins_.end(), std::back_inserter(used),
               [](const Bin& bin) { return bin.low <= bin.high; });
  if (used.empty()) return {};
  geo::LongitudeRange range{used.front().low, used.back().high};
  double widest = std::max(1.0, 360 - range.width_deg());
  for (std::size_t i = 1; i < used.size(); ++i) {
    const double gap = used[i].low - used[i - 1].high;
    if (gap <= widest) continue;
    widest = gap;
    range = {used[i].low, used[i - 1].high};
  }
  return range;
}

}  // namespace vantage::internal::osm
