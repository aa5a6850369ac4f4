// Flights, plans of ground stations, and what flights see: for vantage/_flight.py and _check.py.
#include "flights.h"

#include <nanobind/stl/array.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <tuple>

#include "arrays.h"
#include "bindings.h"
#include "calls.h"
#include "vantage/error.h"
#include "vantage/flight.h"
#include "vantage/flight_check.h"
#include "vantage/ground.h"

namespace vantage::python {

using namespace nb::literals;

namespace {

using NumberArray = nb::ndarray<const double, nb::ndim<1>, nb::c_contig, nb::device::cpu>;

/// `hold_s` and `speed_m_s`: as many as there are positions; a speed that is NaN is not stated.
PyFlight flight_of_arrays(const PointArray& positions, const NumberArray& hold_s, const NumberArray& speed_m_s) {
  Flight flight;
  const std::vector<Vec3> points = points_of(positions);
  for (std::size_t i = 0; i < points.size(); ++i) {
    flight.points.push_back({points[i], hold_s.data()[i], speed_m_s.data()[i], "positions[" + std::to_string(i) + "]"});
  }
  check_flight_points(flight);
  return py_flight(std::move(flight));
}

std::optional<HeightDatum> datum_of(const std::optional<std::string>& word) {
  if (!word) return std::nullopt;
  if (*word == "sea") return HeightDatum::sea_level;
  if (*word == "ellipsoid") return HeightDatum::ellipsoid;
  if (*word == "ground") return HeightDatum::ground;
  if (*word == "home") return HeightDatum::home;
  if (*word == "scene") return HeightDatum::scene_z;
  throw Error(ErrorCode::unknown_choice, "there are no heights above '" + *word + "'", "heights",
              "choose 'sea', 'ellipsoid', 'ground', 'home' or 'scene'");
}

NoteRows note_rows(const std::vector<Warning>& of_plan, const std::vector<Warning>& of_locating) {
  NoteRows rows;
  for (const std::vector<Warning>* notes : {&of_plan, &of_locating}) {
    for (const Warning& note : *notes) rows.emplace_back(name_of(note.code), note.text);
  }
  return rows;
}

/// `home`: latitude and longitude, or x and y of a plan in the scene frame. What is not given is what the plan and the
/// mission say.
PyFlight read_plan(const PyMission& mission, const std::filesystem::path& file, const std::string& track,
                   const std::optional<std::array<double, 2>>& home, std::optional<double> home_z_m,
                   std::optional<double> undulation_m, const std::optional<std::string>& heights,
                   std::optional<double> height_m, std::optional<double> return_height_m,
                   std::optional<double> loiter_radius_m, bool with_ground_legs, nb::object progress) {
  LocateOptions options;
  options.levels.undulation_m = undulation_m;
  options.home_z_m = home_z_m;
  options.unknown_heights = datum_of(heights);
  options.missing_height_m = height_m;
  options.return_height_m = return_height_m;
  options.loiter_radius_m = loiter_radius_m;
  options.with_ground_legs = with_ground_legs;
  return computed(std::move(progress), 0, [&](const Progress& told) {
    const FlightPlan plan = read_flight_plan(file, {track, told});
    if (home && plan.is_in_scene_frame) options.home = Eigen::Vector2d((*home)[0], (*home)[1]);
    if (home && !plan.is_in_scene_frame) options.home = Eigen::Vector2d((*home)[1], (*home)[0]);
    options.progress = told;
    LocatedPlan located = locate_flight(*mission, plan, options);
    PyFlight flight = py_flight(std::move(located.flight));
    flight.notes = note_rows(plan.notes, located.notes);
    return flight;
  });
}

PointView positions_of(const PyFlight& flight) {
  auto points = std::make_shared<std::vector<Vec3>>();
  for (const FlightPoint& point : flight->points) points->push_back(point.position);
  return points_view(*points, std::shared_ptr<const std::vector<Vec3>>(points));
}

ListView<double> numbers_of(const PyFlight& flight, double FlightPoint::*member) {
  std::vector<double> numbers;
  for (const FlightPoint& point : flight->points) numbers.push_back(point.*member);
  return array_of(std::move(numbers));
}

/// The mission as flights ask for it: with a volume for each of its targets. `tour`: a mission file's text of which the
/// section `tour` counts, instead of the mission's own.
PyMission for_flights(const PyMission& mission, const std::optional<std::string>& tour, const std::string& name,
                      nb::object progress) {
  MissionFile file = mission->as_written;
  const bool is_joined = !mission.is_part && file.lists_targets() && file.combine != Combine::each;
  if (!tour && !is_joined) return mission;
  return computed_here(std::move(progress), 0, [&](const Progress& told) {
    if (tour) {
      MissionFile given = read_mission_text(*tour, name, SceneSource());
      file.tour = given.tour;
      file.places.tour = given.places.tour;
    }
    if (is_joined) file.combine = Combine::each;
    Mission made = resolve_mission(file, mission->loaded, told);
    if (is_joined) {
      made.navigation = mission->navigation;  // with meshes that are in memory alone
    } else {
      Mission same = *mission;
      same.as_written.tour = made.as_written.tour;
      same.as_written.places.tour = made.as_written.places.tour;
      same.home = made.home;
      made = std::move(same);
    }
    return PyMission{mission.scene, std::make_shared<const Mission>(std::move(made)), mission.is_part};
  });
}

/// z of the highest ground under or over each point; NaN where there is none. Nothing without ground.
std::optional<ListView<double>> ground_under(const PyMission& mission, const PointArray& array) {
  std::optional<Ground> ground;
  try {
    ground = ground_of(*mission);
  } catch (const Error& error) {
    if (error.code() != ErrorCode::ground_missing) throw;
    return std::nullopt;
  }
  const std::vector<Vec3> points = points_of(array);
  return array_of(computed(nb::none(), 0, [&](const Progress&) {
    const GroundLevels levels(*ground);
    std::vector<double> z_m;
    for (const Vec3& point : points) {
      const auto level = levels.at(point.x(), point.y());
      z_m.push_back(level ? level->highest_m : std::numeric_limits<double>::quiet_NaN());
    }
    return z_m;
  }));
}

// ---- the check ----

struct PyFlightCheck {
  PyMission mission;
  std::shared_ptr<const FlightCheck> check;

  const FlightCheck* operator->() const { return check.get(); }
};

/// begin_m, end_m, begin_s, end_s, begin, end.
using SpanRow = std::tuple<double, double, double, double, std::vector<double>, std::vector<double>>;
using SpanRows = std::vector<SpanRow>;
/// Kind, name, spans.
using NotSeenRow = std::tuple<std::string, std::string, SpanRows>;
/// min_pitch_deg, max_pitch_deg, begin_yaw_deg, end_yaw_deg, rate_deg_s.
using GimbalRow = std::tuple<double, double, double, double, double>;
/// Name, is_volume, centre, seen, which of them is the longest, not_seen, gimbal, followed (one span or none).
using TargetRow = std::tuple<std::string, bool, std::vector<double>, SpanRows, std::optional<std::size_t>,
                             std::vector<NotSeenRow>, std::optional<GimbalRow>, SpanRows>;
/// Name, point, max_range_m, frequency_ghz, clear, linked, lost, reasons, farthest_m, farthest_at_m, farthest_at.
using LinkRow =
    std::tuple<std::string, std::vector<double>, std::optional<double>, std::optional<double>, std::optional<double>,
               SpanRows, SpanRows, std::vector<NotSeenRow>, double, double, std::vector<double>>;
/// Name, spans, worst, unit, worst_at_m, worst_at.
using BrokenRow = std::tuple<std::string, SpanRows, double, std::string, double, std::vector<double>>;
/// distance_m, at_m, position, point, object.
using NearestRow = std::tuple<double, double, std::vector<double>, std::vector<double>, std::string>;

SpanRows rows_of(const std::vector<FlightSpan>& spans) {
  SpanRows rows;
  for (const FlightSpan& span : spans) {
    rows.emplace_back(span.begin_m, span.end_m, span.begin_s, span.end_s, list_of(span.begin), list_of(span.end));
  }
  return rows;
}

std::vector<NotSeenRow> reason_rows(const std::vector<NotSeen>& reasons) {
  std::vector<NotSeenRow> rows;
  for (const NotSeen& reason : reasons) rows.emplace_back(name_of(reason.kind), reason.name, rows_of(reason.spans));
  return rows;
}

std::vector<LinkRow> link_rows(const PyFlightCheck& of) {
  std::vector<LinkRow> rows;
  for (const LinkCheck& link : of->links) {
    std::optional<double> frequency_ghz, clear;
    if (link.radio) {
      frequency_ghz = link.radio->frequency_ghz;
      clear = link.radio->clear;
    }
    rows.emplace_back(link.name, list_of(link.point), link.max_range_m, frequency_ghz, clear, rows_of(link.linked),
                      rows_of(link.lost), reason_rows(link.reasons), link.farthest_m, link.farthest_at_m,
                      list_of(link.farthest_at));
  }
  return rows;
}

std::vector<TargetRow> target_rows(const PyFlightCheck& of) {
  std::vector<TargetRow> rows;
  for (const TargetCheck& target : of->targets) {
    std::optional<GimbalRow> gimbal;
    if (const auto& use = target.gimbal) {
      gimbal = {use->min_pitch_deg, use->max_pitch_deg, use->begin_yaw_deg, use->end_yaw_deg, use->rate_deg_s};
    }
    rows.emplace_back(target.name, target.is_volume, list_of(target.centre), rows_of(target.seen), target.longest,
                      reason_rows(target.not_seen), gimbal, target.followed ? rows_of({*target.followed}) : SpanRows());
  }
  return rows;
}

std::vector<BrokenRow> broken_rows(const PyFlightCheck& of) {
  std::vector<BrokenRow> rows;
  for (const BrokenLimit& limit : of->broken) {
    rows.emplace_back(limit.name, rows_of(limit.spans), limit.worst, limit.unit, limit.worst_at_m,
                      list_of(limit.worst_at));
  }
  return rows;
}

/// Nothing where there is nothing to come near to.
std::optional<NearestRow> nearest_row(const PyFlightCheck& of) {
  const NearestPass& nearest = of->nearest;
  if (!std::isfinite(nearest.distance_m)) return std::nullopt;
  return NearestRow{nearest.distance_m, nearest.at_m, list_of(nearest.position), list_of(nearest.point),
                    nearest.object};
}

PyFlightCheck check(const PyMission& mission, const PyFlight& flight, double tube_m, std::optional<double> speed_m_s,
                    std::optional<double> dwell_s, std::optional<double> clearance_m,
                    std::optional<double> gimbal_rate_deg_s, int threads, nb::object progress) {
  FlightCheckOptions options{tube_m, speed_m_s, dwell_s, clearance_m, gimbal_rate_deg_s};
  FlightCheck made = computed(std::move(progress), threads, [&](const Progress& told) {
    options.prepared = mission.prepared(told);
    return check_flight(*mission, *flight, options, told);
  });
  for (const auto& [code, text] : flight.notes) made.notes.push_back(text);
  return {mission, std::make_shared<const FlightCheck>(std::move(made))};
}

std::string json_of(const PyFlightCheck& of) {
  const auto& place = of.mission->scene().georeference;
  return json_text(*of.check, place ? &*place : nullptr);
}

}  // namespace

void bind_flights(nb::module_& module) {
  nb::class_<PyFlight>(module, "Flight")
      .def_prop_ro("positions", &positions_of, kKept)
      .def_prop_ro(
          "hold_s", [](const PyFlight& f) { return numbers_of(f, &FlightPoint::hold_s); }, kKept)
      .def_prop_ro(
          "speed_m_s", [](const PyFlight& f) { return numbers_of(f, &FlightPoint::speed_m_s); }, kKept)
      .def_prop_ro("chord_error_m", [](const PyFlight& f) { return f->chord_error_m; })
      .def_prop_ro("length_m", [](const PyFlight& f) { return length_m(*f); })
      .def_prop_ro("notes", [](const PyFlight& f) { return f.notes; });
  module.def("flight_from_arrays", &flight_of_arrays, "positions"_a.noconvert(), "hold_s"_a.noconvert(),
             "speed_m_s"_a.noconvert());
  module.def("read_plan", &read_plan, "mission"_a, "file"_a, "track"_a, "home"_a, "home_z_m"_a, "undulation_m"_a,
             "heights"_a, "height_m"_a, "return_height_m"_a, "loiter_radius_m"_a, "with_ground_legs"_a,
             "progress"_a = nb::none());
  module.def("for_flights", &for_flights, "mission"_a, "tour"_a, "name"_a, "progress"_a = nb::none());
  module.def("ground_under", &ground_under, "mission"_a, "points"_a.noconvert());

  nb::class_<PyFlightCheck>(module, "FlightCheck")
      .def_prop_ro("length_m", [](const PyFlightCheck& c) { return c->length_m; })
      .def_prop_ro("duration_s", [](const PyFlightCheck& c) { return c->duration_s; })
      .def_prop_ro("tube_radius_m", [](const PyFlightCheck& c) { return c->tube_radius_m; })
      .def_prop_ro(
          "point_at_m", [](const PyFlightCheck& c) { return list_view(c->point_at_m, c.check); }, kKept)
      .def_prop_ro(
          "arrival_s", [](const PyFlightCheck& c) { return list_view(c->arrival_s, c.check); }, kKept)
      .def_prop_ro("targets", &target_rows)
      .def_prop_ro("links", &link_rows)
      .def_prop_ro("broken", &broken_rows)
      .def_prop_ro("nearest", &nearest_row)
      .def_prop_ro("failures", [](const PyFlightCheck& c) { return c->failures; })
      .def_prop_ro("not_judged", [](const PyFlightCheck& c) { return c->not_judged; })
      .def_prop_ro("notes", [](const PyFlightCheck& c) { return c->notes; })
      .def("json", &json_of)
      .def("csv", [](const PyFlightCheck& c) { return csv_text(*c.check); });
  module.def("check_flight", &check, "mission"_a, "flight"_a, "tube_m"_a, "speed_m_s"_a, "dwell_s"_a, "clearance_m"_a,
             "gimbal_rate_deg_s"_a, "threads"_a = 0, "progress"_a = nb::none());
}

}  // namespace vantage::python
