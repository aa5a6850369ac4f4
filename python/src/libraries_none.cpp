// For a package of the engine alone: what it lacks is told by vantage/_missing.py when it is asked for.
#include <nanobind/stl/string.h>

#include "bindings.h"

namespace vantage::python {

void bind_libraries(nb::module_& module) {
  module.def(
      "__getattr__",
      [](const std::string& name) { return nb::module_::import_("vantage._missing").attr("missing")(name); },
      nb::arg("name"));
}

}  // namespace vantage::python
