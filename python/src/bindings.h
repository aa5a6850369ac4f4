// What each file of the binding adds to the module.
#pragma once

#include <nanobind/nanobind.h>

namespace vantage::python {

namespace nb = nanobind;

void bind_errors(nb::module_& module);
void bind_scene(nb::module_& module);
void bind_volume(nb::module_& module);
void bind_mission(nb::module_& module);
void bind_points(nb::module_& module);
void bind_judges(nb::module_& module);
void bind_cameras(nb::module_& module);
void bind_outer(nb::module_& module);
void bind_sections(nb::module_& module);

/// What stands on other parts of vantage than the engine: libraries.cpp. Where they are not built, libraries_none.cpp.
void bind_libraries(nb::module_& module);

void bind_rays(nb::module_& module);
void bind_spheres(nb::module_& module);
void bind_fields(nb::module_& module);
void bind_picture(nb::module_& module);
void bind_viewer(nb::module_& module);
void bind_areas(nb::module_& module);
void bind_footprints(nb::module_& module);
void bind_tiles(nb::module_& module);
void bind_flights(nb::module_& module);
void bind_views(nb::module_& module);
void bind_tours(nb::module_& module);
void bind_program(nb::module_& module);

}  // namespace vantage::python
