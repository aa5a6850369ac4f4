// Where in the scene the levels lie that heights are measured from.
#pragma once

#include <optional>
#include <string>

#include "vantage/flight.h"

namespace vantage::internal::flight::plans {

class Levels {
 public:
  Levels(const std::optional<Georeference>& georeference, const HeightLevels& given);

  /// z of the mean sea level, and of the ellipsoid. Throws Error(height_unknown), with `where` and what to give.
  double sea_level_z(const std::string& where) const;
  double ellipsoid_z(const std::string& where) const;

  bool knows_sea_level() const { return sea_level_z_m_.has_value(); }
  bool knows_ellipsoid() const { return ellipsoid_z_m_.has_value(); }

 private:
  std::string level_;  ///< that z is measured from, for messages
  std::optional<double> sea_level_z_m_, ellipsoid_z_m_;
};

}  // namespace vantage::internal::flight::plans
