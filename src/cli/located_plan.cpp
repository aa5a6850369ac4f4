#include "cli/located_plan.h"

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>

#include "cli/command.h"
#include "cli/scene_options.h"
#include "vantage/flight_check.h"

namespace vantage::cli {
namespace {

std::optional<double> length_if_given(const char* name, const std::string& text) {
  return text.empty() ? std::nullopt : std::optional(length_option(name, text));
}

/// Longitude and latitude, or x and y for a plan in the scene frame.
std::optional<Eigen::Vector2d> home_if_given(const PlanArguments& arguments, const FlightPlan& plan) {
  if (arguments.home.empty()) return std::nullopt;
  const std::array<double, 2> at = place_option("--home", arguments.home);
  return plan.is_in_scene_frame ? Eigen::Vector2d(at[0], at[1]) : Eigen::Vector2d(at[1], at[0]);
}

}  // namespace

CLI::Option* add_heights_option(CLI::App& command, std::string& heights, const std::string& what) {
  return command
      .add_option("--heights", heights,
                  "What heights are measured from where " + what + " not say: sea, ellipsoid, ground, home or scene")
      ->option_text("LEVEL")
      ->check(CLI::IsMember({"sea", "ellipsoid", "ground", "home", "scene"}));
}

std::optional<HeightDatum> datum_of(const std::string& heights) {
  if (heights.empty()) return std::nullopt;
  if (heights == "sea") return HeightDatum::sea_level;
  if (heights == "ellipsoid") return HeightDatum::ellipsoid;
  if (heights == "ground") return HeightDatum::ground;
  if (heights == "home") return HeightDatum::home;
  return HeightDatum::scene_z;
}

void add_options_of_plan(CLI::App& command, PlanArguments& arguments, CLI::Option& plan) {
  const auto add = [&](const char* name, auto& value, const char* what, const char* text) {
    return command.add_option(name, value, what)->option_text(text)->needs(&plan);
  };
  add("--track", arguments.track, "Of several tracks, lines or routes: the name or number of the one meant", "NAME");
  add("--home", arguments.home, "Where it takes off, if the plan does not say: latitude and longitude", "LAT,LON");
  add("--home-z", arguments.home_z, "z of the home in the scene; without it that of the ground there", "METRES");
  add("--undulation", arguments.undulation,
      "How high the mean sea level lies above the ellipsoid there, for heights above the ellipsoid", "METRES");
  add_heights_option(command, arguments.heights, "the plan does")->needs(&plan);
  add("--height", arguments.height, "The height of all positions that have none, above --heights", "METRES");
  add("--return-height", arguments.return_height, "Of the way back to the home, above it", "METRES");
  add("--loiter-radius", arguments.loiter_radius, "Of circles for which the plan leaves it to the vehicle", "METRES");
  command
      .add_flag("--ground-legs", arguments.with_ground_legs, "Judge the climb from the home and the descent to it, too")
      ->needs(&plan);
}

void add_plan_options(CLI::App& command, PlanArguments& arguments) {
  CLI::Option* plan =
      command.add_option("plan", arguments.plan_file, "The plan: .plan, .waypoints, .kml, .kmz, .gpx, .geojson, .csv");
  add_options_of_plan(command, arguments, *plan->required()->option_text("PLAN"));
}

FlightPlan read_plan_argument(const PlanArguments& arguments, const Progress& progress) {
  ReadPlanOptions options;
  options.track = arguments.track;
  options.progress = progress;
  return read_flight_plan(arguments.plan_file, options);
}

LocateOptions locate_options(const PlanArguments& arguments, const FlightPlan& plan) {
  LocateOptions options;
  options.levels.undulation_m = arguments.undulation;
  options.home = home_if_given(arguments, plan);
  options.home_z_m = length_if_given("--home-z", arguments.home_z);
  options.unknown_heights = datum_of(arguments.heights);
  options.missing_height_m = length_if_given("--height", arguments.height);
  options.return_height_m = length_if_given("--return-height", arguments.return_height);
  options.loiter_radius_m = length_if_given("--loiter-radius", arguments.loiter_radius);
  options.with_ground_legs = arguments.with_ground_legs;
  return options;
}

LocatedPlan locate_plan_argument(const PlanArguments& arguments, const FlightPlan& plan, const Mission& mission,
                                 const Progress& progress) {
  LocateOptions options = locate_options(arguments, plan);
  options.progress = progress;
  return locate_flight(mission, plan, options);
}

}  // namespace vantage::cli
