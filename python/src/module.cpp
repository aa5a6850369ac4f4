// The extension module vantage._core: the public API of vantage, as plain as it is in C++. What people call is in
// python/vantage, which stands on this.
#include <nanobind/stl/filesystem.h>

#include "bindings.h"
#include "common/resources.h"
#include "interpreter.h"
#include "vantage/version.h"

NB_MODULE(_core, module) {
  using namespace vantage::python;
  if (!is_first_interpreter()) {  // vantage/__init__.py raises it: from here it would be the cause of another error
    module.attr("refusal") =
        "vantage works in the main interpreter alone, as numpy does: instead of subinterpreters use processes, of "
        "multiprocessing.get_context(\"spawn\")";
    return;
  }
  watch_interpreter();
  // An interpreter that ends with a thread in vantage, or in a debugger, gives back nothing. Our tests turn them on.
  nanobind::set_leak_warnings(false);
  module.def(
      "warn_of_leaks", [](bool on) { nanobind::set_leak_warnings(on); }, nanobind::arg("on"));
  module.attr("version") = VANTAGE_VERSION;
  module.def("set_resource_folder", &vantage::set_resource_folder, nanobind::arg("folder"));
  bind_errors(module);
  bind_scene(module);
  bind_volume(module);
  bind_mission(module);
  bind_points(module);
  bind_judges(module);
  bind_cameras(module);
  bind_outer(module);
  bind_sections(module);
  bind_libraries(module);
}
