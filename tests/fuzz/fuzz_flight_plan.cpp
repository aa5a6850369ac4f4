// libFuzzer target: any bytes as a plan of a ground station. They may be refused with an input error; a plan that is
// taken has items on the earth with numbers that can be flown. It is then located in a scene, and written.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "vantage/error.h"
#include "vantage/flight.h"

namespace {

void require(bool holds) {
  if (!holds) std::abort();
}

void check_error(const vantage::Error& error) {
  require(error.kind() == vantage::ErrorKind::input);
  require(!error.problem().empty() && !error.where().empty() && !error.fix().empty());
  require(error.problem().find('\n') == std::string::npos);
}

void check_plan(const vantage::FlightPlan& plan) {
  require(!plan.items.empty() && plan.items.size() <= vantage::kMostPlanItems);
  for (const vantage::PlanItem& item : plan.items) {
    const Eigen::Vector2d& at = item.position.horizontal;
    const bool is_missing = !at.allFinite();
    require(is_missing || plan.is_in_scene_frame || (std::abs(at.x()) <= 180 && std::abs(at.y()) <= 90));
    require(!is_missing || item.kind != vantage::PlanItemKind::waypoint);
    require(!std::isinf(item.position.height_m) && item.hold_s >= 0 && std::isfinite(item.hold_s));
    require(std::isnan(item.speed_m_s) || item.speed_m_s > 0);
    require(!item.place.empty());
  }
}

void check_located(const vantage::FlightPlan& plan) {
  const vantage::Ground ground{12, nullptr};
  vantage::LocateOptions options;
  options.georeference.emplace();
  for (const vantage::PlanItem& item : plan.items) {  // where the plan is
    if (!item.position.horizontal.allFinite() || plan.is_in_scene_frame) continue;
    options.georeference->longitude_deg = item.position.horizontal.x();
    options.georeference->latitude_deg = item.position.horizontal.y();
    break;
  }
  options.georeference->vertical = "EGM96 geoid";
  options.levels.undulation_m = 40;
  options.ground = &ground;
  options.unknown_heights = vantage::HeightDatum::ground;
  options.missing_height_m = 30;
  options.loiter_radius_m = 50;
  options.home_z_m = 12;
  options.with_ground_legs = true;
  const vantage::LocatedPlan located = vantage::locate_flight(plan, options);
  require(!located.flight.points.empty() && located.flight.points.size() <= vantage::kMostFlightPoints);
  require(located.items.size() == located.flight.points.size());
  vantage::FlightOut out;
  out.flight = located.flight;
  out.georeference = options.georeference;
  out.heights = vantage::HeightDatum::sea_level;
  if (out.flight.points.size() > 1000) return;
  require(!vantage::flight_plan_bytes(out, vantage::PlanFormat::kml).empty());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  try {
    const vantage::FlightPlan plan = vantage::parse_flight_plan(bytes, "/nowhere/a.plan");
    check_plan(plan);
    check_located(plan);
  } catch (const vantage::Error& error) {
    check_error(error);
  }
  return 0;
}
