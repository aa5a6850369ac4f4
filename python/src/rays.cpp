// The check of volumes by rays.
#include <nanobind/stl/string.h>

#include "bindings.h"
#include "calls.h"
#include "common/json.h"
#include "mission.h"
#include "vantage/result.h"
#include "volume.h"

namespace vantage::python {

using namespace nb::literals;

namespace {

std::string verify(const PyMission& mission, const PyVolume& volume, std::size_t points, std::uint64_t seed,
                   int threads, nb::object progress) {
  VerifyOptions options;
  options.points = points;
  options.seed = seed;
  options.tolerance_m = mission->as_written.exact.tolerance_m;
  options.lift_m = volume->lift_m;
  options.rounding_m = volume.rounding_m;
  return computed(std::move(progress), threads, [&](const Progress& told) {
    return json_text(verify_volume(*mission, volume->mesh, options, told));
  });
}

}  // namespace

void bind_rays(nb::module_& module) {
  module.def("verify", &verify, "mission"_a, "volume"_a, "points"_a, "seed"_a, "threads"_a = 0,
             "progress"_a = nb::none());
}

}  // namespace vantage::python
