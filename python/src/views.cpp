// Where to hover and where to circle, and what positions are worth: for vantage/_views.py.
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "arrays.h"
#include "bindings.h"
#include "calls.h"
#include "flights.h"
#include "mission.h"
#include "vantage/error.h"
#include "vantage/standpoints.h"
#include "volume.h"

namespace vantage::python {

using namespace nb::literals;

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// Whether what a describer makes of the scene for one mission holds for the other.
bool share_surroundings(const Mission& a, const Mission& b) {
  const auto ground = [](const Mission& mission) {
    const auto& source = mission.as_written.ground;
    return source ? std::pair(source->plane_z_m, source->object) : std::pair(std::optional<double>(), std::string());
  };
  return a.loaded == b.loaded && ground(a) == ground(b) && sea_level_m(a) == sea_level_m(b);
}

/// Describers that share what they can.
class Describers {
 public:
  const ViewDescriber& of(const PyMission& mission) {
    for (const auto& [other, describer] : made_) {
      if (!share_surroundings(*mission, *other)) continue;
      last_.emplace(*mission, describer);
      return *last_;
    }
    return made_.emplace_back(&*mission, ViewDescriber(*mission)).second;
  }

 private:
  std::vector<std::pair<const Mission*, ViewDescriber>> made_;
  std::optional<ViewDescriber> last_;
};

void check_sizes(std::size_t missions, std::size_t others) {
  if (missions == others) return;
  throw Error(ErrorCode::array_sizes_differ, "there are not as many missions", "missions", "give one for each");
}

/// Columns of views; numbers that are not known are NaN.
struct ViewColumns {
  std::vector<double> longitude_deg, latitude_deg, above_ground_m, above_sea_m, yaw_deg, pitch_deg, distance_m, pixel_m,
      incidence_deg, obstacle_distance_m;
  std::vector<std::uint8_t> is_centred;
  std::vector<std::optional<std::string>> obstacle;

  void add(const ViewDescription& view) {
    longitude_deg.push_back(view.longitude_deg.value_or(kNaN));
    latitude_deg.push_back(view.latitude_deg.value_or(kNaN));
    above_ground_m.push_back(view.above_ground_m.value_or(kNaN));
    above_sea_m.push_back(view.above_sea_m.value_or(kNaN));
    yaw_deg.push_back(view.yaw_deg);
    pitch_deg.push_back(view.pitch_deg);
    is_centred.push_back(view.is_centred);
    distance_m.push_back(view.distance_m);
    pixel_m.push_back(view.pixel_m.value_or(kNaN));
    incidence_deg.push_back(view.incidence_deg.value_or(kNaN));
    obstacle_distance_m.push_back(view.obstacle_distance_m.value_or(kNaN));
    obstacle.push_back(view.obstacle_distance_m ? std::optional(view.obstacle) : std::nullopt);
  }

  nb::dict dict() {
    nb::dict columns;
    columns["longitude_deg"] = nb::cast(array_of(std::move(longitude_deg)));
    columns["latitude_deg"] = nb::cast(array_of(std::move(latitude_deg)));
    columns["above_ground_m"] = nb::cast(array_of(std::move(above_ground_m)));
    columns["above_sea_m"] = nb::cast(array_of(std::move(above_sea_m)));
    columns["yaw_deg"] = nb::cast(array_of(std::move(yaw_deg)));
    columns["pitch_deg"] = nb::cast(array_of(std::move(pitch_deg)));
    columns["is_centred"] = nb::cast(array_of(std::move(is_centred)));
    columns["distance_m"] = nb::cast(array_of(std::move(distance_m)));
    columns["pixel_m"] = nb::cast(array_of(std::move(pixel_m)));
    columns["incidence_deg"] = nb::cast(array_of(std::move(incidence_deg)));
    columns["obstacle_distance_m"] = nb::cast(array_of(std::move(obstacle_distance_m)));
    columns["obstacle"] = nb::cast(obstacle);
    return columns;
  }
};

/// What is seen from the positions of all missions, in the order of the missions: a row for each position.
nb::dict describe(const std::vector<PyMission>& missions, const std::vector<PointArray>& arrays, nb::object progress) {
  check_sizes(missions.size(), arrays.size());
  std::vector<std::vector<Vec3>> positions;
  for (const PointArray& array : arrays) positions.push_back(points_of(array));
  ViewColumns columns = computed(std::move(progress), 0, [&](const Progress& told) {
    ViewColumns made;
    Describers describers;
    for (std::size_t i = 0; i < missions.size(); ++i) {
      if (!told("views", static_cast<double>(i) / static_cast<double>(missions.size()))) {
        throw Error(ErrorCode::cancelled, "cancelled", "", "");
      }
      const ViewDescriber& describer = describers.of(missions[i]);
      for (const Vec3& position : positions[i]) made.add(describer.describe(position));
    }
    return made;
  });
  return columns.dict();
}

/// JSON: vantage/standpoints.h. Each mission has one volume.
std::string standpoints(const std::vector<PyMission>& missions, const std::vector<PyVolume>& volumes, double margin_m,
                        double tolerance_m, std::size_t most_boxes, int threads, nb::object progress) {
  check_sizes(missions.size(), volumes.size());
  const StandpointOptions options{margin_m, tolerance_m, most_boxes, threads};
  return computed(std::move(progress), threads, [&](const Progress& told) {
    Describers describers;
    std::vector<NamedStandpoints> found;
    for (std::size_t i = 0; i < missions.size(); ++i) {
      const PyMission& mission = missions[i];
      found.push_back({mission->target.name, find_standpoints(*mission, *volumes[i], mission.prepared(told),
                                                              describers.of(mission), options, told)});
    }
    return json_text(found);
  });
}

OrbitCentre centre_of(const std::string& word) {
  for (const OrbitCentre centre : {OrbitCentre::around_target, OrbitCentre::over_target, OrbitCentre::anywhere}) {
    if (word == name_of(centre)) return centre;
  }
  throw Error(ErrorCode::unknown_choice, "there is no centre '" + word + "'", "centre",
              "choose 'around_target', 'over_target' or 'anywhere'");
}

/// JSON (vantage/standpoints.h), and the orbits that it tells, in its order.
std::pair<std::string, std::vector<Orbit>> orbits(const std::vector<PyMission>& missions,
                                                  const std::vector<PyVolume>& volumes, double least_radius_m,
                                                  double most_radius_m, const std::string& centre, double margin_m,
                                                  double tolerance_m, bool racetracks, bool clockwise,
                                                  std::size_t most_boxes, int threads, nb::object progress) {
  check_sizes(missions.size(), volumes.size());
  const OrbitOptions options{least_radius_m, most_radius_m, centre_of(centre), margin_m, tolerance_m,
                             racetracks,     clockwise,     most_boxes,        threads};
  return computed(std::move(progress), threads, [&](const Progress& told) {
    Describers describers;
    std::vector<NamedOrbits> found;
    std::vector<Orbit> all;
    for (std::size_t i = 0; i < missions.size(); ++i) {
      const PyMission& mission = missions[i];
      found.push_back({mission->target.name, find_orbits(*mission, *volumes[i], mission.prepared(told),
                                                         describers.of(mission), options, told)});
      all.insert(all.end(), found.back().orbits.found.begin(), found.back().orbits.found.end());
    }
    return std::pair(json_text(found), std::move(all));
  });
}

}  // namespace

void bind_views(nb::module_& module) {
  nb::class_<Orbit>(module, "Orbit")
      .def(
          "flight", [](const Orbit& orbit, double chord_error_m) { return py_flight(flight_of(orbit, chord_error_m)); },
          "chord_error_m"_a);
  module.def("describe_views", &describe, "missions"_a, "positions"_a, "progress"_a = nb::none());
  module.def("find_standpoints", &standpoints, "missions"_a, "volumes"_a, "margin_m"_a, "tolerance_m"_a, "most_boxes"_a,
             "threads"_a = 0, "progress"_a = nb::none());
  module.def("find_orbits", &orbits, "missions"_a, "volumes"_a, "least_radius_m"_a, "most_radius_m"_a, "centre"_a,
             "margin_m"_a, "tolerance_m"_a, "racetracks"_a, "clockwise"_a, "most_boxes"_a, "threads"_a = 0,
             "progress"_a = nb::none());
}

}  // namespace vantage::python
