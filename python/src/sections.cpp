// Points in volumes, level sections, and where these lie on the earth: for vantage/_slice.py.
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <utility>

#include "arrays.h"
#include "bindings.h"
#include "calls.h"
#include "rings.h"
#include "scene.h"
#include "vantage/georeference.h"
#include "vantage/solid.h"
#include "volume.h"

namespace vantage::python {

using namespace nb::literals;

namespace {

using PlanArray = nb::ndarray<const double, nb::shape<-1, 2>, nb::c_contig, nb::device::cpu>;

std::vector<Eigen::Vector2d> plan_points(const PlanArray& array) {
  std::vector<Eigen::Vector2d> points(array.shape(0));
  std::copy_n(array.data(), 2 * points.size(), points.empty() ? nullptr : points.front().data());
  return points;
}

Georeference place_at(double latitude_deg, double longitude_deg) { return {latitude_deg, longitude_deg, "", ""}; }

}  // namespace

void bind_sections(nb::module_& module) {
  module.def(
      "slice_volume",
      [](const PyVolume& volume, double z_m) {
        return rings_of(computed(nb::none(), 0, [&](const Progress&) { return slice_mesh(volume->mesh, z_m); }));
      },
      "volume"_a, "z_m"_a);
  module.def(
      "to_crs",
      [](double latitude_deg, double longitude_deg, const std::string& crs, const PlanArray& array) {
        return plan_view(positions_in_crs(place_at(latitude_deg, longitude_deg), crs, plan_points(array)));
      },
      "latitude_deg"_a, "longitude_deg"_a, "crs"_a, "points"_a.noconvert());
  module.def(
      "from_crs",
      [](double latitude_deg, double longitude_deg, const std::string& crs, const PlanArray& array) {
        return plan_view(scene_positions(place_at(latitude_deg, longitude_deg), crs, plan_points(array)));
      },
      "latitude_deg"_a, "longitude_deg"_a, "crs"_a, "points"_a.noconvert());
  module.def(
      "vertical_unit_m", [](const std::string& crs) { return vertical_unit_m(crs); }, "crs"_a);
}

}  // namespace vantage::python
