// Meshes around volumes, and how deep points lie in meshes: for vantage/_positions.py.
#include "vantage/outer.h"

#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <tuple>
#include <utility>

#include "arrays.h"
#include "bindings.h"
#include "calls.h"
#include "mission.h"
#include "vantage/solid_index.h"
#include "volume.h"

namespace vantage::python {

using namespace nb::literals;

namespace {

using Outer = std::tuple<PyVolume, std::size_t, std::size_t, std::vector<std::string>>;

Outer outer(const PyMission& mission, double tolerance_m, double limit_margin_m, int threads, nb::object progress) {
  OuterVolume made = computed(std::move(progress), threads, [&](const Progress& told) {
    return outer_volume(*mission, mission.run_options(told), {tolerance_m, limit_margin_m}, told);
  });
  return {PyVolume(std::move(made.volume)), made.facets, made.open_facets, std::move(made.ignored)};
}

ListView<double> depths(const SolidIndex& index, const PointArray& array, int threads) {
  const std::vector<Vec3> points = points_of(array);
  return array_of(computed(nb::none(), threads, [&](const Progress&) { return index.depths_m(points); }));
}

}  // namespace

void bind_outer(nb::module_& module) {
  module.def("outer_volume", &outer, "mission"_a, "tolerance_m"_a, "limit_margin_m"_a, "threads"_a = 0,
             "progress"_a = nb::none());
  nb::class_<SolidIndex>(module, "SolidIndex")
      .def(
          "__init__", [](SolidIndex* made, const PyVolume& volume) { new (made) SolidIndex(volume->mesh); }, "volume"_a)
      .def("depths", &depths, "points"_a.noconvert(), "threads"_a = 0)
      .def("comes_near", &SolidIndex::comes_near, "other"_a, "within_m"_a, nb::call_guard<nb::gil_scoped_release>());
}

}  // namespace vantage::python
