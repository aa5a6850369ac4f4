// Meshes around volumes, and how deep points lie in meshes: for vantage/_positions.py.
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <cstdint>
#include <span>
#include <tuple>
#include <utility>

#include "arrays.h"
#include "bindings.h"
#include "calls.h"
#include "mission.h"
#include "vantage/error.h"
#include "vantage/result.h"
#include "vantage/solid.h"
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

ListView<std::uint8_t> contains(const SolidIndex& index, const PointArray& array, int threads, nb::object progress) {
  const std::vector<Vec3> points = points_of(array);
  return array_of(computed(std::move(progress), threads, [&](const Progress& told) {
    constexpr std::size_t kBlock = 1 << 16;  // takes a twentieth of a second
    std::vector<std::uint8_t> inside;
    inside.reserve(points.size());
    for (std::size_t begin = 0; begin < points.size(); begin += kBlock) {
      if (!told("points in a mesh", static_cast<double>(begin) / static_cast<double>(points.size()))) {
        throw Error(ErrorCode::cancelled, "cancelled", "", "");
      }
      const std::size_t count = std::min(kBlock, points.size() - begin);
      const std::vector<std::uint8_t> block = index.contains(std::span(points).subspan(begin, count));
      inside.insert(inside.end(), block.begin(), block.end());
    }
    return inside;
  }));
}

}  // namespace

void bind_outer(nb::module_& module) {
  module.def("outer_volume", &outer, "mission"_a, "tolerance_m"_a, "limit_margin_m"_a, "threads"_a = 0,
             "progress"_a = nb::none());
  nb::class_<SolidIndex>(module, "SolidIndex")
      .def(
          "__init__", [](SolidIndex* made, const PyVolume& volume) { new (made) SolidIndex(volume->mesh); }, "volume"_a)
      .def("depths", &depths, "points"_a.noconvert(), "threads"_a = 0)
      .def("contains", &contains, "points"_a.noconvert(), "threads"_a = 0, "progress"_a = nb::none())
      .def("comes_near", &SolidIndex::comes_near, "other"_a, "within_m"_a, nb::call_guard<Released, Computing>());
}

}  // namespace vantage::python
