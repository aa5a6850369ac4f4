// The page with a volume, for notebooks.
#include <nanobind/stl/string.h>

#include "bindings.h"
#include "calls.h"
#include "common/viewer_page.h"
#include "mission.h"
#include "volume.h"

namespace vantage::python {

using namespace nb::literals;

void bind_viewer(nb::module_& module) {
  module.def(
      "viewer_page",
      [](const PyMission& mission, const PyVolume& volume, const std::string& page, const std::string& name,
         bool proves, nb::object progress) {
        return computed(std::move(progress), 0, [&](const Progress& told) {
          ViewerRequest request{.mission = mission.mission.get(),
                                .volume = volume.volume.get(),
                                .loaded = mission.scene->loaded(),
                                .prepared = mission.scene->prepared(told),
                                .source = mission.scene->source(),
                                .name = name,
                                .rounding_m = volume.rounding_m,
                                .proves = proves};
          return viewer_page(request, page, told);
        });
      },
      "mission"_a, "volume"_a, "page"_a, "name"_a, "proves"_a, "progress"_a = nb::none());
}

}  // namespace vantage::python
