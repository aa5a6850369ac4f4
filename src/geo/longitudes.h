// Longitudes as places on a circle: which of the two arcs between them holds the data.
#pragma once

#include <array>
#include <vector>

namespace vantage::internal::geo {

/// From `west` eastwards to `east`, degrees in -180 to 180; west > east: across the antimeridian.
struct LongitudeRange {
  double west = 0, east = 0;

  double width_deg() const { return west <= east ? east - west : east - west + 360; }
  double middle_deg() const;  ///< in -180 to 180
  bool holds(double longitude_deg) const;
  bool meets(const LongitudeRange& other) const;
};

/// Finds the shortest range that holds all longitudes it is given, without keeping them.
class LongitudeSpan {
 public:
  void add(double longitude_deg);  ///< -180 to 180

  bool empty() const;
  /// The shortest range. Where the largest gap is less than a degree wide, they go round the earth: from the lowest to
  /// the highest. Of equal gaps the one at the antimeridian counts.
  LongitudeRange range() const;

 private:
  static constexpr int kBins = 360;
  struct Bin {
    double low = 1000, high = -1000;  ///< none
  };
  std::vector<Bin> bins_ = std::vector<Bin>(kBins);
};

}  // namespace vantage::internal::geo
