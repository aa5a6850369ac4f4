// The extension module vantage._core: the public API of vantage, as plain as it is in C++. What people call is in
// python/vantage, which stands on this.
#include <nanobind/stl/filesystem.h>

#include "bindings.h"
#include "vantage/resources.h"
#include "vantage/version.h"

NB_MODULE(_core, module) {
  using namespace vantage::python;
  module.attr("version") = VANTAGE_VERSION;
  module.def("set_resource_folder", &vantage::set_resource_folder, nanobind::arg("folder"));
  bind_errors(module);
  bind_scene(module);
  bind_volume(module);
  bind_mission(module);
  bind_points(module);
  bind_judges(module);
  bind_spheres(module);
  bind_fields(module);
  bind_picture(module);
  bind_outer(module);
  bind_areas(module);
  bind_sections(module);
  bind_tiles(module);
  bind_program(module);
}
