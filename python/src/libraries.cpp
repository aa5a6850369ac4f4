// What stands on all parts of vantage.
#include "bindings.h"
#include "vantage/city.h"
#include "vantage/spheres.h"

namespace vantage::python {

void bind_libraries(nb::module_& module) {
  enable_maps();
  enable_spheres();
  bind_rays(module);
  bind_spheres(module);
  bind_fields(module);
  bind_picture(module);
  bind_viewer(module);
  bind_areas(module);
  bind_footprints(module);
  bind_tiles(module);
  bind_flights(module);
  bind_views(module);
  bind_tours(module);
  bind_program(module);
}

}  // namespace vantage::python
