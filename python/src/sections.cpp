// Points in volumes, level sections and footprints, and where these lie on the earth: for vantage/_slice.py.
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <utility>

#include "arrays.h"
#include "bindings.h"
#include "calls.h"
#include "scene.h"
#include "vantage/georeference.h"
#include "vantage/solid.h"
#include "volume.h"

namespace vantage::python {

using namespace nb::literals;

namespace {

using PlanArray = nb::ndarray<const double, nb::shape<-1, 2>, nb::c_contig, nb::device::cpu>;
using PlanView = View<double, nb::shape<-1, 2>>;
/// The rings of each polygon, the outer one first.
using Rings = std::vector<std::vector<PlanView>>;

PlanView plan_view(std::vector<Eigen::Vector2d> points) {
  auto kept = std::make_shared<const std::vector<Eigen::Vector2d>>(std::move(points));
  return view_of<PlanView>(kept->empty() ? nullptr : kept->front().data(), {kept->size(), 2}, kept);
}

std::vector<Eigen::Vector2d> plan_points(const PlanArray& array) {
  std::vector<Eigen::Vector2d> points(array.shape(0));
  std::copy_n(array.data(), 2 * points.size(), points.empty() ? nullptr : points.front().data());
  return points;
}

Rings rings_of(std::vector<PlanPolygon> polygons) {
  Rings rings;
  for (PlanPolygon& polygon : polygons) {
    std::vector<PlanView>& of_polygon = rings.emplace_back();
    of_polygon.push_back(plan_view(std::move(polygon.outer)));
    for (PlanPolygon::Ring& hole : polygon.holes) of_polygon.push_back(plan_view(std::move(hole)));
  }
  return rings;
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
      "footprint_of_volume",
      [](const PyVolume& volume) {
        return rings_of(computed(nb::none(), 0, [&](const Progress&) { return footprint_of_mesh(volume->mesh); }));
      },
      "volume"_a);
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
