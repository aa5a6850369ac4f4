// The arc that holds the longitudes of a map.
#pragma once

#include <vector>

#include "geo/longitudes.h"

namespace vantage::internal::osm {

/// Finds the shortest range that holds all longitudes it is given, without keeping them.
class LongitudeSpan {
 public:
  void add(double longitude_deg);  ///< -180 to 180

  bool empty() const;
  /// The shortest range. Where the largest gap is less than a degree wide, they go round the earth: from the lowest to
  /// the highest. Of equal gaps the one at the antimeridian counts.
  geo::LongitudeRange range() const;

 private:
  static constexpr int kBins = 360;
  struct Bin {
    double low = 1000, high = -1000;  ///< none
  };
  std::vector<Bin> bins_ = std::vector<Bin>(kBins);
};

}  // namespace vantage::internal::osm
