// How much of a target is seen from each voxel of a box.
#include <nanobind/stl/array.h>
#include <nanobind/stl/string.h>

#include <array>
#include <limits>

#include "arrays.h"
#include "bindings.h"
#include "calls.h"
#include "mission.h"
#include "vantage/fraction.h"
#include "vantage/query.h"

namespace vantage::python {

using namespace nb::literals;

namespace {

VoxelGrid grid_of(const std::array<double, 3>& low, double step_m, const std::array<std::size_t, 3>& count) {
  return {Vec3(low[0], low[1], low[2]), step_m, count};
}

/// The one target of a mission.
PreparedTarget target_of(const PyMission& mission, const Progress& progress) {
  const auto views = prepare_views(*mission, mission.prepared(progress));
  if (views.size() != 1 || views.front().size() != 1) {
    throw Error(ErrorCode::not_applicable, "the share seen is that of one target, and the mission has several",
                "target", "ask for each of the targets");
  }
  return views.front().front();
}

/// An array of its own, which Python may change.
nb::ndarray<nb::numpy, double, nb::ndim<1>> writable(std::vector<double> values) {
  auto* kept = new std::vector<double>(std::move(values));
  const nb::capsule owner(kept, [](void* pointer) noexcept { delete static_cast<std::vector<double>*>(pointer); });
  return {kept->data(), {kept->size()}, owner};
}

std::vector<double> centres(const VoxelGrid& grid, int axis) {
  std::vector<double> places;
  for (std::size_t i = 0; i < grid.count[axis]; ++i) places.push_back(grid.centre(axis, i));
  return places;
}

nb::dict columns(const VoxelGrid& grid, FractionField field) {
  nb::dict result;
  result["x"] = nb::cast(array_of(centres(grid, 0)));
  result["y"] = nb::cast(array_of(centres(grid, 1)));
  result["z"] = nb::cast(array_of(centres(grid, 2)));
  result["shares"] = nb::cast(writable(std::move(field.shares)));
  result["evaluated"] = field.evaluated;
  return result;
}

nb::dict exact(const PyMission& mission, const std::array<double, 3>& low, double step_m,
               const std::array<std::size_t, 3>& count, const std::string& measure, double max_range_m, int threads,
               nb::object progress) {
  const auto by = fraction_measure(measure);
  if (!by) {
    throw Error(ErrorCode::unknown_choice, "there is no measure '" + measure + "'", "measure",
                "choose 'area', 'solid_angle' or 'pixels'");
  }
  const VoxelGrid grid = grid_of(low, step_m, count);
  check_grid(grid);
  return columns(grid, computed(std::move(progress), threads, [&](const Progress& told) {
                   PointQuery query(target_of(mission, told));
                   return query.fraction_field(grid, {*by, max_range_m}, told);
                 }));
}

nb::dict sampled(const PyMission& mission, const std::array<double, 3>& low, double step_m,
                 const std::array<std::size_t, 3>& count, std::size_t samples, int cubemap, const std::string& device,
                 double max_range_m, int threads, nb::object progress) {
  const VoxelGrid grid = grid_of(low, step_m, count);
  check_grid(grid);
  SampleOptions options;
  options.samples = samples;
  options.cubemap = cubemap;
  options.device = parse_device_choice(device);
  options.max_range_m = max_range_m;
  SampledField found = computed(std::move(progress), threads, [&](const Progress& told) {
    return estimate_fraction_field(target_of(mission, told), grid, options, told);
  });
  nb::dict result = columns(grid, std::move(found.field));
  result["device"] = found.device.name;
  result["device_note"] = found.device_note;
  return result;
}

PointView samples(const PyMission& mission, std::size_t count, nb::object progress) {
  auto places = std::make_shared<const std::vector<Vec3>>(computed(
      std::move(progress), 0, [&](const Progress& told) { return target_samples(target_of(mission, told), count); }));
  return points_view(*places, places);
}

}  // namespace

void bind_fields(nb::module_& module) {
  module.def("fraction_field", &exact, "mission"_a, "low"_a, "step_m"_a, "count"_a, "measure"_a, "max_range_m"_a,
             "threads"_a = 0, "progress"_a = nb::none());
  module.def("sampled_field", &sampled, "mission"_a, "low"_a, "step_m"_a, "count"_a, "samples"_a, "cubemap"_a,
             "device"_a, "max_range_m"_a, "threads"_a = 0, "progress"_a = nb::none());
  module.def("target_samples", &samples, "mission"_a, "count"_a, "progress"_a = nb::none());
}

}  // namespace vantage::python
