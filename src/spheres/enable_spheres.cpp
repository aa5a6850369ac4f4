#include "app/providers/spheres.h"
#include "vantage/spheres.h"

namespace vantage {

void enable_spheres() {
  static constexpr internal::app::SpheresProvider kProvider{.compute_visibility_spheres = compute_visibility_spheres};
  internal::app::provide(kProvider);
}

}  // namespace vantage
