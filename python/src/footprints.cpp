// Footprints of volumes: for vantage/_slice.py.
#include <nanobind/stl/vector.h>

#include "bindings.h"
#include "calls.h"
#include "rings.h"
#include "volume.h"

namespace vantage::python {

using namespace nb::literals;

void bind_footprints(nb::module_& module) {
  module.def(
      "footprint_of_volume",
      [](const PyVolume& volume) {
        return rings_of(computed(nb::none(), 0, [&](const Progress&) { return footprint_of_mesh(volume->mesh); }));
      },
      "volume"_a);
}

}  // namespace vantage::python
