#include "flight/tour/mission_positions.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "flight/tour/tour_region.h"
#include "vantage/error.h"
#include "vantage/query.h"
#include "vantage/result.h"

namespace vantage::internal::flight::tour {
namespace {

/// Limits that outer volumes are not cut to, each once, in their order.
void add_names(const std::vector<std::string>& more, std::vector<std::string>& names) {
  for (const std::string& name : more) {
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  }
}

FewestTarget seen_target(const Mission& one, const MissionTourTarget& target, const PreparedScene& scene,
                         const RunOptions& run, std::vector<std::string>& ignored) {
  FewestTarget result{target.name, target.volume};
  if (is_volume(one)) {
    result.outer = [&one](const Progress&) { return one.target.volume->mesh; };
    result.outer_rounding_m = one.target.volume->rounding_m;
    return result;
  }
  const auto query = std::make_shared<ViewsQuery>(prepare_views(one, scene), one.navigation);
  result.sees = [query](const Vec3& position) { return query->answer({&position, 1}).front().inside; };
  result.outer = [&one, &run, &ignored](const Progress& progress) {
    OuterVolume outer = outer_volume(one, run, {}, progress);
    add_names(outer.ignored, ignored);
    return std::move(outer.volume.mesh);
  };
  return result;
}

void add_notes(const FewestPositions& found, const std::vector<std::string>& ignored, std::vector<std::string>& notes) {
  if (found.is_proved()) return;
  if (found.end == FewestPositions::End::time_limit) {
    notes.emplace_back("time ran out in the search for positions: fewer may do, or more may be necessary");
  } else if (found.end == FewestPositions::End::cancelled) {
    notes.emplace_back("the search for positions was stopped: fewer may do, or more may be necessary");
  }
  if (!ignored.empty()) {
    std::string names;
    for (const std::string& name : ignored) names += (names.empty() ? "" : ", ") + name;
    notes.push_back("how many positions are necessary does not take into account: " + names);
  }
}

}  // namespace

bool is_volume(const Mission& one) { return one.views.empty() && one.target.is_volume(); }

std::vector<Mission> each_of(const Mission& mission) {
  std::vector<Mission> each;
  const std::size_t count = volume_count(mission);
  Mission rest = mission;
  const bool is_split = count > 1 && mission.as_written.targets.size() == count;
  for (std::size_t i = 0; i < count; ++i) {
    if (is_split) {  // thousands of copies of thousands of targets would take gigabytes
      rest.views = {mission.views[i]};
      rest.as_written.targets = {mission.as_written.targets[i]};
    }
    each.push_back(one_volume(rest, is_split ? 0 : i));
  }
  return each;
}

double view_depth_m(const Mission& mission) {
  const TourSettings settings = mission.as_written.tour.value_or(TourSettings());
  double reach = reach_m(settings);
  if (const auto& camera = mission.sensor.camera; camera && !mission.sensor.mount.is_fixed()) {
    // limits/frame/leg.cpp judges a tube by pieces and cubes of a 32nd of its radius, each by one orientation from its
    // middle, in which all must be farther inside the picture than the piece is large. A metre nearer to the target
    // costs as much of that as the sine of half the angle of view.
    const double tangent = std::min(camera->half_width, camera->half_height);
    reach *= 1 + (0.5 + 2.5 * std::sqrt(1 + 1 / (tangent * tangent))) / 32;
  }
  return std::max(settings.margin_m, reach);
}

void check_can_hover(const TourSettings& settings, const MissionTourOptions& options) {
  if (settings.vehicle.kind == TourVehicle::Kind::fixed_wing) {
    throw Error(ErrorCode::not_applicable,
                "a fixed wing cannot hover, and the fewest positions to hover at are asked for", "tour.vehicle.kind",
                "give a multirotor, or plan the shortest flight");
  }
  if (!options.positions.empty()) {
    throw Error(ErrorCode::conflicting_keys, "positions are given, and the fewest are asked for", "positions",
                "leave out one of them");
  }
  if (!options.certificate.empty()) {
    throw Error(ErrorCode::conflicting_keys,
                "a certificate is of the bound of the shortest flight, and the fewest positions are asked for",
                options.certificate.string(), "leave out one of them");
  }
}

FewestPositions positions_for(const Mission& mission, const std::vector<MissionTourTarget>& targets,
                              const PreparedScene& scene, const std::shared_ptr<const Airspace>& airspace,
                              double slack_m, const MissionTourOptions& options, std::vector<std::string>& notes,
                              const Progress& progress) {
  const TourSettings settings = mission.as_written.tour.value_or(TourSettings());
  RunOptions run;
  run.threads = options.threads;
  run.prepared = scene;
  const std::vector<Mission> each = each_of(mission);
  std::vector<std::string> ignored;
  FewestRequest request;
  for (std::size_t i = 0; i < each.size(); ++i) {
    request.targets.push_back(seen_target(each[i], targets[i], scene, run, ignored));
    if (!options.with_bound) request.targets.back().outer = {};
  }
  request.margin_m = view_depth_m(mission) + slack_m;
  request.airspace = airspace;
  request.deviation_m = slack_m;
  request.time_limit_s = settings.time_limit_s;
  request.threads = options.threads;
  FewestPositions found = fewest_positions(request, progress);
  add_notes(found, ignored, notes);
  return found;
}

std::vector<Vec3> position_of_each(const FewestPositions& found, const std::vector<MissionTourTarget>& targets,
                                   double margin_m) {
  std::vector<Vec3> places(targets.size(), Vec3::Zero());
  for (const HoverPosition& one : found.positions) {
    for (const std::size_t target : one.assigned) places[target] = one.position;
  }
  for (const std::size_t target : found.unseen) {
    places[target] = TourRegion(targets[target].name, targets[target].volume, margin_m).anchors().front();
  }
  return places;
}

}  // namespace vantage::internal::flight::tour
