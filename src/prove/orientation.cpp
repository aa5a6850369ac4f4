// Adaptive predicates (Shewchuk 1997), by William C. Lenthe: they come with CDT.
#include "prove/orientation.h"

#include <CDT.h>

namespace vantage::internal::prove {

int orientation(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const double sign = predicates::orient3d(a.data(), b.data(), c.data(), d.data());
  return (sign > 0) - (sign < 0);
}

}  // namespace vantage::internal::prove
