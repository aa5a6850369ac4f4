// Devices that render, and single visibility spheres. The method of spheres itself is a mission's `method`.
#include "vantage/spheres.h"

#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "arrays.h"
#include "bindings.h"
#include "calls.h"
#include "common/json.h"
#include "scene.h"
#include "volume.h"

namespace vantage::python {

using namespace nb::literals;

namespace {

PyVolume sphere(const PyScene& scene, const std::vector<double>& viewpoint, double radius_m, int cubemap,
                bool conservative, double merge, const std::string& device, int threads, nb::object progress) {
  if (viewpoint.size() != 3) {
    throw Error(ErrorCode::array_sizes_differ, "a viewpoint has three coordinates", "viewpoint", "pass (x, y, z)");
  }
  SpheresOptions options;
  options.cubemap = cubemap;
  options.sphere = conservative ? SpheresOptions::Sphere::conservative : SpheresOptions::Sphere::centers;
  options.merge = merge;
  options.device = parse_device_choice(device);
  const Vec3 at(viewpoint[0], viewpoint[1], viewpoint[2]);
  return computed(std::move(progress), threads, [&](const Progress& told) {
    return PyVolume(volume_of_mesh(visibility_sphere(scene.prepared(told), at, radius_m, options, told), "scene"));
  });
}

std::string devices(const std::string& choice) {
  const RenderDevices found = render_devices();
  const ChosenDevice chosen = choose_device(found, parse_device_choice(choice));
  return json_text(found, chosen, chosen.note);
}

}  // namespace

void bind_spheres(nb::module_& module) {
  module.def("visibility_sphere", &sphere, "scene"_a, "viewpoint"_a, "radius_m"_a, "cubemap"_a, "conservative"_a,
             "merge"_a, "device"_a, "threads"_a = 0, "progress"_a = nb::none());
  module.def("devices", &devices, "choice"_a, nb::call_guard<Released, Computing>());
}

}  // namespace vantage::python
