#include "vantage/mission_tour.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "common/known_data.h"
#include "core/format.h"
#include "core/text.h"
#include "flight/gimbal.h"
#include "flight/tour/mission_limits.h"
#include "flight/tour/mission_positions.h"
#include "flight/tour/tour_bound.h"
#include "flight/tour/tour_certificate.h"
#include "flight/tour/tour_region.h"
#include "flight/tour/tour_views.h"
#include "flight/view_aim.h"
#include "vantage/error.h"
#include "vantage/flight_check.h"
#include "vantage/result.h"
#include "vantage/solid.h"
#include "vantage/volume.h"

namespace vantage {

struct TourProof {
  internal::flight::tour::TourBound bound;
};

namespace {

namespace core = internal::core;
namespace tour = internal::flight::tour;

using tour::each_of;
using tour::is_volume;

/// The slack of positions to hover at: the tour comes within 8.7 mm of them (view_from).
constexpr double kHoverSlackM = 0.01;

using Json = nlohmann::ordered_json;

Json point_json(const Vec3& p) { return {p.x(), p.y(), p.z()}; }

Json positions_json(const MissionTour& of) {
  const auto names_json = [&](const std::vector<std::size_t>& targets) {
    Json names = Json::array();
    for (const std::size_t target : targets) names.push_back(of.targets[target].name);
    return names;
  };
  Json found = Json::array();
  for (const HoverPosition& one : of.fewest->positions) {
    found.push_back({{"position", point_json(one.position)},
                     {"depth_m", one.depth_m},
                     {"sees", names_json(one.sees)},
                     {"assigned", names_json(one.assigned)}});
  }
  return {{"necessary", of.fewest->necessary},
          {"apart", names_json(of.fewest->apart)},
          {"unseen", names_json(of.fewest->unseen)},
          {"found", std::move(found)}};
}

/// The mean of all corners.
Vec3 middle_of(const Target& target) {
  Vec3 sum = Vec3::Zero();
  std::size_t corners = 0;
  for (const std::vector<Vec3>& part : target.parts) {
    for (const Vec3& corner : part) sum += corner;
    corners += part.size();
  }
  return corners == 0 ? sum : Vec3(sum / static_cast<double>(corners));
}

/// The mission without the targets that are volumes: nothing of these is computed.
Mission of_what_is_seen(const Mission& mission, const std::vector<Mission>& each) {
  if (std::none_of(each.begin(), each.end(), is_volume)) return mission;
  Mission seen = mission;
  std::vector<MissionTarget>& written = seen.as_written.targets;
  const bool are_in_step = written.size() == seen.views.size();
  for (std::size_t i = each.size(); i-- > 0;) {
    if (!is_volume(each[i])) continue;
    seen.views.erase(seen.views.begin() + static_cast<std::ptrdiff_t>(i));
    if (are_in_step) written.erase(written.begin() + static_cast<std::ptrdiff_t>(i));
  }
  return seen;
}

std::vector<MissionTourTarget> volumes_of(const Mission& mission, const PreparedScene& scene, int threads,
                                          const Progress& progress) {
  RunOptions options;
  options.threads = threads;
  options.prepared = scene;
  const std::vector<Mission> each = each_of(mission);
  std::vector<Result> results;
  if (!std::all_of(each.begin(), each.end(), is_volume)) {
    const Mission seen = of_what_is_seen(mission, each);
    results = run_missions(volume_count(seen) == 1 ? one_volume(seen, 0) : seen, options, progress);
  }
  const core::ProgressReporter asking(progress);
  asking.begin("volumes of the tour");
  std::vector<MissionTourTarget> targets;
  std::size_t next = 0;
  for (const Mission& one : each) {
    asking.tick();
    const bool is_given = is_volume(one);
    Volume volume = is_given ? volume_to_fly_through(one, progress) : std::move(results.at(next++).volume);
    if (volume.mesh.empty()) {
      throw Error(ErrorCode::nothing_given,
                  "the target '" + one.target.name + "' can be " + (is_given ? "reached" : "seen") +
                      " from nowhere: " + volume.reason,
                  one.as_written.places.target, volume.hint.empty() ? "take it out" : volume.hint);
    }
    const Box box = bounding_box(volume.mesh);
    const Vec3 centre = is_given ? Vec3((box.min + box.max) / 2) : middle_of(one.target);
    targets.push_back({one.target.name, centre, std::move(volume.mesh), is_given});
  }
  return targets;
}

/// Closed, outward oriented.
Mesh cube_about(const Vec3& middle, double half_m) {
  Mesh mesh;
  for (const double x : {-half_m, half_m}) {
    for (const double y : {-half_m, half_m}) {
      for (const double z : {-half_m, half_m}) mesh.vertices.push_back(middle + Vec3(x, y, z));
    }
  }
  mesh.triangles = {{0, 1, 3}, {0, 3, 2}, {4, 6, 7}, {4, 7, 5}, {0, 4, 5}, {0, 5, 1},
                    {2, 3, 7}, {2, 7, 6}, {0, 2, 6}, {0, 6, 4}, {1, 5, 7}, {1, 7, 3}};
  return mesh;
}

/// Targets are viewed from these positions alone: from small cubes about them, which lie in the volumes.
void view_from(const std::vector<Vec3>& positions, TourRequest& request, std::vector<std::string>& notes) {
  constexpr double kDepth = 0.01, kHalf = 0.005;  // metres; the corners of the cube are 8.7 mm away
  if (positions.size() != request.targets.size()) {
    throw Error(ErrorCode::array_sizes_differ,
                core::format("there are {} positions for {} targets", positions.size(), request.targets.size()),
                "positions", "give one for each target");
  }
  for (std::size_t i = 0; i < positions.size(); ++i) {
    TourTarget& target = request.targets[i];
    const double depth_m = SolidIndex(target.volume).depths_m({&positions[i], 1}).front();
    if (!(depth_m >= kDepth)) {
      throw Error(ErrorCode::value_out_of_range,
                  core::format("the position that '{}' is to be viewed from lies {} m inside its volume, and {} m are "
                               "needed",
                               target.name, core::number_text(depth_m), core::number_text(kDepth)),
                  core::format("positions[{}]", i), "move it into the volume");
    }
    if (depth_m < request.tube_m + kHoverSlackM / 2) {
      notes.push_back(core::format("{} is viewed from {} m inside its volume: not from all within tour.tube of there",
                                   target.name, core::number_text(depth_m)));
    }
    target.volume = cube_about(positions[i], kHalf);
  }
  request.settings.margin_m = 0;
}

tour::Incumbent incumbent_of(const Tour& found) {
  tour::Incumbent incumbent;
  std::vector<std::size_t> place(found.order.size());
  std::vector<std::size_t> visited = found.order;
  std::sort(visited.begin(), visited.end());
  const auto number = [&](std::size_t target) {  // among those that are visited
    return static_cast<std::size_t>(std::lower_bound(visited.begin(), visited.end(), target) - visited.begin());
  };
  for (const std::size_t target : found.order) {
    incumbent.order.push_back(number(target));
    for (const TourVisit& visit : found.visits) {
      if (visit.target != target) continue;
      incumbent.points.push_back(found.flight.points[visit.first_point].position);
      break;
    }
  }
  incumbent.length_m = found.length_m;
  return incumbent;
}

/// What a bound is over.
struct BoundRegions {
  std::vector<tour::OuterRegion> outer;
  /// What visits a volume that was larger by its rounding comes by the volume itself with a detour of two roundings;
  /// where it has to stay there, both ends of the stay move by that.
  double rounded_away_m = 0;
  bool is_limited = false;  ///< of volumes that are given, navigation leaves less
};

BoundRegions regions_of(const Mission& mission, const PreparedScene& scene, const MissionTour& of,
                        const std::vector<std::size_t>& visited, int threads, const Progress& progress) {
  BoundRegions regions;
  RunOptions run;
  run.threads = threads;
  run.prepared = scene;
  const auto told = [&](std::string_view, double) {
    return progress("outer volumes", static_cast<double>(regions.outer.size()) / static_cast<double>(visited.size()));
  };
  for (const std::size_t target : visited) {
    const Mission one = volume_count(mission) == 1 ? mission : one_volume(mission, target);
    const std::string& name = of.targets[target].name;
    if (is_volume(one)) {
      regions.outer.push_back(tour::OuterRegion::given(one.target.volume->mesh, name));
      regions.rounded_away_m += 4 * one.target.volume->rounding_m;
      regions.is_limited = regions.is_limited || !mission.navigation.empty();
    } else {
      const OuterVolume outer = outer_volume(one, run, {}, progress ? Progress(told) : Progress());
      regions.outer.push_back(tour::OuterRegion::of(outer, name));
    }
  }
  return regions;
}

TourLowerBound bound_of(const Mission& mission, const PreparedScene& scene, const MissionTour& of,
                        const std::optional<Vec3>& start, const MissionTourOptions& options, const Progress& progress) {
  std::vector<std::size_t> visited = of.tour.order;
  std::sort(visited.begin(), visited.end());
  BoundRegions regions = regions_of(mission, scene, of, visited, options.threads, progress);
  const double rounded_away_m = regions.rounded_away_m;
  tour::BoundProblem problem;
  problem.regions = std::move(regions.outer);
  const TourSettings& settings = of.settings;
  problem.closed = settings.closed;
  problem.start = start;
  if (settings.vehicle.kind == TourVehicle::Kind::fixed_wing) {
    // The detours to what was rounded away are no turns that it could fly.
    if (rounded_away_m == 0) problem.turn_radius_m = settings.vehicle.turn_radius_m;
    // A multirotor may hover: its dwell is no length.
    if (!settings.simultaneous) {
      problem.dwell_m.assign(problem.regions.size(), settings.vehicle.speed_m_s * settings.dwell_s);
    }
  }
  tour::BoundOptions bounds;
  bounds.gap = settings.gap.value_or(kTourGap);
  bounds.time_limit_s = settings.time_limit_s;
  bounds.threads = options.threads;
  auto proof =
      std::make_shared<const TourProof>(TourProof{tour::bound_tour(problem, incumbent_of(of.tour), bounds, progress)});
  const tour::TourBound& found = proof->bound;
  if (!options.certificate.empty()) {
    tour::write_tour_certificate(found, options.certificate, of.scene_incomplete);
  }
  TourLowerBound bound = {found.length_m, found.gap, tour::name_of(found.kind), found.ignored, proof};
  if (rounded_away_m > 0) {
    bound.length_m = std::max(0.0, bound.length_m - rounded_away_m);
    bound.gap = of.tour.length_m > 0 ? (of.tour.length_m - bound.length_m) / of.tour.length_m : 0;
  }
  bound.time_s = bound.length_m / settings.vehicle.speed_m_s;
  if (!settings.simultaneous) {
    bound.time_s = std::max(bound.time_s, static_cast<double>(visited.size()) * settings.dwell_s);
  }
  if (regions.is_limited) bound.ignored.emplace_back("the limits of navigation in targets that are volumes");
  if (settings.tube_m > 0) bound.ignored.emplace_back("the tube about the flight");
  if (!options.positions.empty()) {
    bound.ignored.emplace_back("the positions that are given");
  } else if (settings.margin_m > 0) {
    bound.ignored.emplace_back("the margin inside the volumes");
  }
  return bound;
}

/// As in check_flight, which judges what is planned.
void check_is_seen_whole(const Mission& mission) {
  for (const Mission& one : each_of(mission)) {
    if (is_volume(one) || !one.sensor.visible || !(one.sensor.visible->share < 1)) continue;
    throw Error(ErrorCode::not_applicable,
                "tours are planned only from where all of a target is seen, not a share of it",
                one.as_written.places.sensor, "leave 'visible' out");
  }
}

void note_beyond_data(const Mission& mission, MissionTour& of) {
  const Flight& flight = of.tour.flight;
  FlownPlaces places{{}, {}, {}, of.settings.tube_m + flight.chord_error_m, of.settings.clearance_m};
  for (const FlightPoint& point : flight.points) places.positions.push_back(point.position);
  for (const MissionTourTarget& target : of.targets) places.seen.push_back(target.centre);
  for (const Warning& note : beyond_data_warnings(mission, places)) {
    of.notes.push_back(note.text);
    if (note.code == WarningCode::scene_incomplete) of.scene_incomplete = note.text;
  }
  if (!of.scene_incomplete.empty()) return;
  // The flight keeps away, and the volumes and the bound depend on it none the less.
  if (const auto missing = incomplete_warning(mission)) {
    of.scene_incomplete = missing->text;
    of.notes.push_back(missing->text);
  }
}

/// A computed volume is a right region to fly through, but its bound is none of flights that see its target.
void note_computed(const Mission& mission, std::vector<std::string>& notes) {
  for (const Mission& one : each_of(mission)) {
    if (!is_volume(one) || !one.target.volume->is_computed) continue;
    notes.push_back(
        "the volume '" + one.target.name +
        "' was computed, and lies inside of where its target is seen: flights through other places that see "
        "it may be shorter than the bound");
  }
}

void add_notes(const Mission& mission, MissionTour& of) {
  if (const auto note = tour::note_of_narrow_zones(mission, of.settings, of.tour)) of.notes.push_back(*note);
  if (!of.tour.problems.empty() && of.settings.tube_m > 0) {
    of.notes.push_back(
        core::format("all within {:g} m of the flight keeps the limits, too: with a smaller tour.tube it "
                     "may reach the targets that are left out",
                     of.settings.tube_m));
  }
  if (const auto note = tour::note_of_pitches(of, mission)) of.notes.push_back(*note);
  note_computed(mission, of.notes);
  note_beyond_data(mission, of);
  const std::size_t asked = mission.as_written.targets.size();
  if (mission.as_written.lists_targets() && asked < of.targets.size()) {
    of.notes.push_back("the mission's " + std::to_string(asked) + " targets have " + std::to_string(of.targets.size()) +
                       " parts, each of which is viewed by itself: 'facing' or 'nearest' choose of them");
  }
  if (!mission.links.empty()) {
    of.notes.emplace_back("the mission has links, and tours are not planned for them: check the plan");
  }
}

}  // namespace

Volume volume_to_fly_through(const Mission& mission, const Progress& progress) {
  if (!is_volume(mission)) {
    throw Error(ErrorCode::not_applicable, "the target '" + mission.target.name + "' is no volume",
                mission.as_written.places.target, "compute its volume with run_mission");
  }
  const Volume all = volume_of_mesh(mission.target.volume->mesh, mission.target.name);
  return cut_to_navigation(all, mission.navigation, progress, mission.as_written.exact.work_limit);
}

std::optional<double> start_above_home_m(const MissionTour& tour) {
  if (!tour.home || tour.tour.flight.points.empty()) return std::nullopt;
  return tour.tour.flight.points.front().position.z() - tour.home->z();
}

MissionTour plan_mission_tour(const Mission& mission, const MissionTourOptions& options, const Progress& progress) {
  MissionTour result;
  result.settings = mission.as_written.tour.value_or(TourSettings());
  if (options.fewest_positions) tour::check_can_hover(result.settings, options);
  result.home = mission.home;
  if (!options.certificate.empty()) tour::check_tour_certificate_files(mission, options.certificate);
  check_is_seen_whole(mission);
  tour::check_room_to_turn(mission, result.settings);
  const PreparedScene scene = options.prepared ? *options.prepared : PreparedScene(mission.scene(), progress);

  TourRequest request;
  request.settings = result.settings;
  request.settings.margin_m = tour::view_depth_m(mission);
  request.tube_m = tour::reach_m(result.settings);
  const double rounding_m = request.tube_m > 0 ? 0 : tour::kPlanRoundingM;
  request.airspace = make_airspace(scene, result.settings.clearance_m + rounding_m, mission.navigation, request.tube_m);
  if (mission.home) {
    const bool is_wing = result.settings.vehicle.kind == TourVehicle::Kind::fixed_wing;
    const double deviation = is_wing ? request.chord_error_m : tour::kPlanRoundingM;
    request.home = tour::start_above(*mission.home, mission, scene, *request.airspace, deviation);
    result.highest_takeoff_m = tour::room_above_m(*mission.home, *request.home, *request.airspace);
  }
  result.targets = volumes_of(mission, scene, options.threads, progress);
  const core::ProgressReporter asking(progress);
  asking.begin("volumes of the tour");
  for (const MissionTourTarget& target : result.targets) {
    asking.tick();
    request.targets.push_back({target.name, target.volume, std::nullopt});
    if (!target.is_volume) request.targets.back().look_at = target.centre;
  }
  Progress followed = progress;
  if (options.fewest_positions) {
    result.fewest = tour::positions_for(mission, result.targets, scene, request.airspace, kHoverSlackM, options,
                                        result.notes, progress);
    const double margin_m = request.settings.margin_m + kHoverSlackM;
    view_from(tour::position_of_each(*result.fewest, result.targets, margin_m), request, result.notes);
    if (result.fewest->end == FewestPositions::End::cancelled) {  // the flight to what was found, soon
      request.rounds = 1;
      followed = {};
    }
  } else if (!options.positions.empty()) {
    view_from(options.positions, request, result.notes);
  }
  result.tour = plan_tour(request, followed);
  add_notes(mission, result);
  if (!options.with_bound || options.fewest_positions || result.tour.order.empty() ||
      result.tour.end == Tour::End::cancelled)
    return result;
  try {
    result.bound = bound_of(mission, scene, result, request.home, options, progress);
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::cancelled) throw;
    result.notes.emplace_back("the bound was stopped: the tour is known, and not how much shorter one could be");
  }
  return result;
}

FlightOut plan_of_tour(const MissionTour& of, const Mission& mission) {
  FlightOut out;
  out.flight = of.tour.flight;
  tour::add_views(of, mission, out);
  if (mission.scene().georeference) {
    out.georeference = *mission.scene().georeference;
  } else {
    out.heights = HeightDatum::scene_z;
  }
  out.levels.sea_level_z_m = sea_level_m(mission);
  out.home = of.home;
  out.highest_takeoff_m = of.highest_takeoff_m;
  const bool is_wing = of.settings.vehicle.kind == TourVehicle::Kind::fixed_wing;
  out.vehicle = is_wing ? PlanVehicle::fixed_wing : PlanVehicle::multirotor;
  out.speed_m_s = of.settings.vehicle.speed_m_s;
  out.takes_off = of.home.has_value();
  out.returns_home = out.takes_off && of.settings.closed;  // else the way back is not planned
  if (of.home && mission.scene().georeference) out.heights = HeightDatum::home;
  out.keep_in = mission.navigation.keep_in;
  out.keep_out = mission.navigation.keep_out;
  out.aircraft = internal::flight::aircraft_of_camera(mission);
  for (const MissionTourTarget& target : of.targets) out.volumes.push_back({target.name, target.volume});
  return out;
}

FlightOut plan_of_tour(const MissionTour& of, const Mission& mission, PlanFormat format) {
  if (!mission.scene().georeference && format != PlanFormat::csv) {
    throw Error(ErrorCode::not_georeferenced, "the scene does not say where on the earth it lies, and the plan has to",
                name_of(format), "write it as .csv, or give a scene with a place: a map, or a mesh with 'crs'");
  }
  FlightOut plan = plan_of_tour(of, mission);
  const bool has_no_home = format == PlanFormat::kml || format == PlanFormat::gpx || format == PlanFormat::geojson ||
                           format == PlanFormat::czml;
  if (plan.heights == HeightDatum::home && has_no_home) plan.heights.reset();
  const bool is_of_autopilot = format == PlanFormat::qgroundcontrol || format == PlanFormat::waypoints;
  if (is_of_autopilot && !of.home) {
    if (!plan.levels.sea_level_z_m) {
      throw Error(ErrorCode::missing_key, "the plan states heights above the home, and the mission has none",
                  name_of(format), "give 'home' in the mission's section 'tour', or write .csv");
    }
    plan.heights = HeightDatum::sea_level;
  }
  if (format == PlanFormat::czml) {
    FlightCheckOptions options;
    options.speed_m_s = plan.speed_m_s;
    plan.targets = seen_targets(check_flight(mission, plan.flight, options));
  }
  return plan;
}

void write_tour_certificate(const MissionTour& of, const std::filesystem::path& file) {
  if (!of.bound || !of.bound->proof) {
    throw Error(ErrorCode::nothing_given, "the tour has no bound that a certificate could prove", file.string(),
                "plan it with its bound");
  }
  tour::write_tour_certificate(of.bound->proof->bound, file, of.scene_incomplete);
}

std::string json_text(const MissionTour& of) {
  const auto target_json = [&of](std::size_t index) {
    const MissionTourTarget& target = of.targets[index];
    Json one = {{"target", target.name}};
    if (target.is_volume) one["volume"] = true;
    return one;
  };
  Json json;
  json["vehicle"] = name_of(of.settings.vehicle.kind);
  json["length_m"] = of.tour.length_m;
  json["time_s"] = of.tour.time_s;
  json["bound"] = nullptr;
  if (of.bound) {
    json["bound"] = {{"length_m", of.bound->length_m},
                     {"time_s", of.bound->time_s},
                     {"gap", of.bound->gap},
                     {"kind", of.bound->kind},
                     {"ignored", of.bound->ignored}};
    if (const auto height = start_above_home_m(of)) json["bound"]["start_above_home_m"] = *height;
  }
  if (of.fewest) json["positions"] = positions_json(of);
  json["visits"] = Json::array();
  for (const TourVisit& visit : of.tour.visits) {
    Json one = target_json(visit.target);
    one["begin_m"] = visit.begin_m;
    one["end_m"] = visit.end_m;
    one["dwell_s"] = visit.dwell_s;
    one["from"] = point_json(of.tour.flight.points[visit.first_point].position);
    one["to"] = point_json(of.tour.flight.points[visit.last_point].position);
    json["visits"].push_back(std::move(one));
  }
  json["left_out"] = Json::array();
  for (const TourProblem& problem : of.tour.problems) {
    Json one = target_json(problem.target);
    one["obstacle"] = problem.obstacle;
    json["left_out"].push_back(std::move(one));
  }
  json["notes"] = of.notes;
  json["points"] = Json::array();
  for (const FlightPoint& point : of.tour.flight.points) {
    json["points"].push_back({{"position", point_json(point.position)}, {"hold_s", point.hold_s}});
  }
  constexpr int kIndentation = 2;
  return internal::core::escaped_json(json.dump(kIndentation, ' ', false, Json::error_handler_t::replace)) + "\n";
}

}  // namespace vantage
