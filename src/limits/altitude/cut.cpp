#include "solid/region_builder.h"

namespace vantage::internal::solid {

template <>
void add_regions<Limit::altitude>(const Navigation::Altitude& altitude, RegionBuilder& builder) {
  builder.keep_between("the altitude band " + metres_from_to(altitude.min_m, altitude.max_m), altitude.min_m,
                       altitude.max_m, "altitude min", "altitude max");
}

}  // namespace vantage::internal::solid
