// `python -m vantage`: the program itself is compiled into the module.
#include "cli/program.h"

#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <string>
#include <vector>

#include "bindings.h"
#include "interpreter.h"

namespace vantage::python {

void bind_program(nb::module_& module) {
  module.def(
      "run_program",
      [](const std::vector<std::string>& arguments) { return cli::run_program(arguments, cli::Host::python); },
      nb::arg("arguments"), nb::call_guard<Released>());
}

}  // namespace vantage::python
