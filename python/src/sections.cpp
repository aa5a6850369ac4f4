// Points in volumes, level sections, and where these lie on the earth: for vantage/_slice.py.
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>

#include "arrays.h"
#include "bindings.h"
#include "calls.h"
#include "places.h"
#include "rings.h"
#include "scene.h"
#include "vantage/earth.h"
#include "vantage/ground.h"
#include "vantage/solid.h"
#include "volume.h"

namespace vantage::python {

using namespace nb::literals;

namespace {

using SpaceArray = nb::ndarray<const double, nb::shape<-1, 3>, nb::c_contig, nb::device::cpu>;
using PlanArray = nb::ndarray<const double, nb::shape<-1, 2>, nb::c_contig, nb::device::cpu>;

std::vector<Eigen::Vector2d> plan_points(const PlanArray& array) {
  std::vector<Eigen::Vector2d> points(array.shape(0));
  std::copy_n(array.data(), 2 * points.size(), points.empty() ? nullptr : points.front().data());
  return points;
}

std::vector<Vec3> space_points(const SpaceArray& array) {
  std::vector<Vec3> points(array.shape(0));
  std::copy_n(array.data(), 3 * points.size(), points.empty() ? nullptr : points.front().data());
  return points;
}

auto owned_points(std::vector<Vec3> points) {
  auto kept = std::make_shared<const std::vector<Vec3>>(std::move(points));
  return points_view(*kept, kept);
}

}  // namespace

void bind_sections(nb::module_& module) {
  module.def(
      "slice_volume",
      [](const PyVolume& volume, double z_m) {
        return rings_of(computed(nb::none(), 0, [&](const Progress&) { return slice_mesh(volume->mesh, z_m); }));
      },
      "volume"_a, "z_m"_a);
  module.def(
      "is_map", [](const PlaceRow& place) { return is_map(place_of(place)); }, "place"_a);
  module.def(
      "plan_to_crs",
      [](const PlaceRow& place, const std::string& crs, const PlanArray& array) {
        return plan_view(positions_in_crs(place_of(place), crs, plan_points(array)));
      },
      "place"_a, "crs"_a, "points"_a.noconvert());
  module.def(
      "to_crs",
      [](const PlaceRow& place, const std::string& crs, const SpaceArray& array) {
        return owned_points(positions_in_crs(place_of(place), crs, space_points(array)));
      },
      "place"_a, "crs"_a, "points"_a.noconvert());
  module.def(
      "plan_from_crs",
      [](const PlaceRow& place, const std::string& crs, const PlanArray& array) {
        return plan_view(scene_positions(place_of(place), crs, plan_points(array)));
      },
      "place"_a, "crs"_a, "points"_a.noconvert());
  module.def(
      "from_crs",
      [](const PlaceRow& place, const std::string& crs, const SpaceArray& array) {
        return owned_points(scene_positions(place_of(place), crs, space_points(array)));
      },
      "place"_a, "crs"_a, "points"_a.noconvert());
  module.def(
      "from_crs_on_ground",
      [](const PyScene& scene, const std::string& crs, const PlanArray& array) {
        std::optional<GroundLevels> levels;  // a map does not ask for it
        const auto highest = [&](const Eigen::Vector2d& at) -> std::optional<double> {
          if (!levels) {
            const std::optional<Ground> ground = ground_of(scene.scene());
            if (!ground) return std::nullopt;
            levels.emplace(*ground);
          }
          const auto there = levels->at(at.x(), at.y());
          return there ? std::optional(there->highest_m) : std::nullopt;
        };
        return plan_view(scene_positions(place_of(scene.scene()), crs, plan_points(array), highest));
      },
      "scene"_a, "crs"_a, "points"_a.noconvert());
  module.def(
      "vertical_unit_m", [](const std::string& crs) { return vertical_unit_m(crs); }, "crs"_a);
}

}  // namespace vantage::python
