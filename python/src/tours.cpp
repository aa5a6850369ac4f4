// Tours: for vantage/_tour.py.
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "arrays.h"
#include "bindings.h"
#include "calls.h"
#include "common/output.h"
#include "common/time_text.h"
#include "flights.h"
#include "mission.h"
#include "vantage/flight.h"
#include "vantage/mission_tour.h"
#include "vantage/result.h"

namespace vantage::python {

using namespace nb::literals;

namespace {

struct PyTour {
  PyMission mission;
  std::shared_ptr<const MissionTour> tour;

  const MissionTour* operator->() const { return tour.get(); }
};

/// Target, first_point, last_point, begin_m, end_m, dwell_s.
using VisitRow = std::tuple<std::size_t, std::size_t, std::size_t, double, double, double>;
/// Target, kind, neighbour, obstacle.
using ProblemRow = std::tuple<std::size_t, std::string, std::optional<std::size_t>, std::string>;
/// length_m, gap, kind, ignored, time_s.
using BoundRow = std::tuple<double, double, std::string, std::vector<std::string>, double>;

PyTour plan(const PyMission& mission, bool with_bound, const std::optional<PointArray>& positions, int threads,
            nb::object progress) {
  std::vector<Vec3> views;
  if (positions) views = points_of(*positions);
  MissionTour made = computed(std::move(progress), threads, [&](const Progress& told) {
    MissionTourOptions options;
    options.threads = threads;
    options.with_bound = with_bound;
    options.prepared = mission.prepared(told);
    options.positions = views;
    return plan_mission_tour(*mission, options, told);
  });
  return {mission, std::make_shared<const MissionTour>(std::move(made))};
}

std::vector<VisitRow> visit_rows(const PyTour& of) {
  std::vector<VisitRow> rows;
  for (const TourVisit& visit : of->tour.visits) {
    rows.emplace_back(visit.target, visit.first_point, visit.last_point, visit.begin_m, visit.end_m, visit.dwell_s);
  }
  return rows;
}

std::vector<ProblemRow> problem_rows(const PyTour& of) {
  std::vector<ProblemRow> rows;
  for (const TourProblem& problem : of->tour.problems) {
    rows.emplace_back(problem.target, problem.kind == TourProblem::Kind::no_place ? "no_place" : "no_way",
                      problem.neighbour, problem.obstacle);
  }
  return rows;
}

std::optional<BoundRow> bound_row(const PyTour& of) {
  if (!of->bound) return std::nullopt;
  return BoundRow{of->bound->length_m, of->bound->gap, of->bound->kind, of->bound->ignored, of->bound->time_s};
}

std::vector<std::string> names_of(const PyTour& of) {
  std::vector<std::string> names;
  for (const MissionTourTarget& target : of->targets) names.push_back(target.name);
  return names;
}

std::string end_of(const PyTour& of) {
  switch (of->tour.end) {
    case Tour::End::done:
      return "done";
    case Tour::End::time_limit:
      return "time_limit";
    case Tour::End::cancelled:
      return "cancelled";
  }
  return "";
}

void check_output(const PyTour& of, const std::filesystem::path& file) {
  check_can_write(file);
  check_not_an_input(file, input_files(of.mission->as_written));
}

/// Two or three numbers, as DjiAircraft has them.
DjiAircraft aircraft_of(const std::vector<int>& numbers) {
  DjiAircraft aircraft;
  aircraft.drone = numbers.at(0);
  aircraft.drone_sub_type = numbers.at(1);
  if (numbers.size() > 2) aircraft.payload = numbers[2];
  return aircraft;
}

/// What plan_notes says.
std::vector<std::string> write(const PyTour& of, const std::filesystem::path& file,
                               const std::optional<std::vector<int>>& aircraft, std::optional<double> undulation_m,
                               const std::optional<std::string>& start) {
  const PlanFormat format = plan_format_of(file);
  check_output(of, file);
  const Released released;
  FlightOut plan = plan_of_tour(*of.tour, *of.mission, format);
  plan.levels.undulation_m = undulation_m;
  if (aircraft) plan.aircraft = aircraft_of(*aircraft);
  if (start) plan.start_unix_s = unix_time_of(*start, "start");
  write_flight_plan(plan, file);
  return plan_notes(plan, format);
}

void write_certificate(const PyTour& of, const std::filesystem::path& file) {
  check_output(of, file);
  const Released released;
  write_tour_certificate(*of.tour, file);
}

}  // namespace

void bind_tours(nb::module_& module) {
  nb::class_<PyTour>(module, "Tour")
      .def_prop_ro("mission", [](const PyTour& t) { return t.mission; })
      .def_prop_ro("flight", [](const PyTour& t) { return py_flight(t->tour.flight); })
      .def_prop_ro("length_m", [](const PyTour& t) { return t->tour.length_m; })
      .def_prop_ro("time_s", [](const PyTour& t) { return t->tour.time_s; })
      .def_prop_ro("vehicle", [](const PyTour& t) { return name_of(t->settings.vehicle.kind); })
      .def_prop_ro("asked_gap", [](const PyTour& t) { return t->settings.gap.value_or(kTourGap); })
      .def_prop_ro("targets", &names_of)
      .def_prop_ro("order", [](const PyTour& t) { return t->tour.order; })
      .def_prop_ro("visits", &visit_rows)
      .def_prop_ro("problems", &problem_rows)
      .def_prop_ro("bound", &bound_row)
      .def_prop_ro("home", [](const PyTour& t) { return t->home ? std::optional(list_of(*t->home)) : std::nullopt; })
      .def_prop_ro("end", &end_of)
      .def_prop_ro("notes", [](const PyTour& t) { return t->notes; })
      .def("json", [](const PyTour& t) { return json_text(*t.tour); })
      .def("write", &write, "file"_a, "aircraft"_a.none(), "undulation_m"_a.none(), "start"_a.none())
      .def("write_certificate", &write_certificate, "file"_a);
  module.def("plan_tour", &plan, "mission"_a, "with_bound"_a, "positions"_a.noconvert().none(), "threads"_a = 0,
             "progress"_a = nb::none());
}

}  // namespace vantage::python
