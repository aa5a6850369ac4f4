#include "flight/plans/plan_writer.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <numbers>

#include "common/atomic_file.h"
#include "common/input.h"
#include "flight/plans/arcs.h"
#include "vantage/error.h"

namespace vantage::internal::flight::plans {
namespace {

double rounded(double value, double steps) { return std::round(value * steps) / steps + 0.0; }  // no -0

constexpr double kAntimeridian = 180;

bool is_finite(const std::optional<double>& value) { return !value || std::isfinite(*value); }

}  // namespace

PlanWriter::PlanWriter(const FlightOut& flight, PlanFormat format, const std::vector<HeightDatum>& allowed)
    : flight_(flight), levels_(flight.georeference, flight.levels), heights_(allowed.front()) {
  check_flight_points(flight.flight);
  check_actions();
  std::string choice;
  for (std::size_t i = 0; i < allowed.size(); ++i) {
    const bool is_last = i + 1 == allowed.size();
    choice.append(i == 0 ? "" : is_last ? " or " : ", ").append(name_of(allowed[i]));
  }
  if (!flight.heights && allowed.size() > 1) {
    throw Error(ErrorCode::missing_key, std::string(name_of(format)) + " can state heights in several ways", place(),
                "say what heights are measured from: " + choice);
  }
  if (flight.heights) heights_ = *flight.heights;
  if (std::find(allowed.begin(), allowed.end(), heights_) == allowed.end()) {
    throw Error(ErrorCode::value_unsupported,
                std::string(name_of(format)) + " has no heights above " + name_of(heights_), place(),
                "choose " + choice);
  }
  if (flight.georeference) globe_.emplace(*flight.georeference);
}

void PlanWriter::check_actions() const {
  const std::size_t count = flight_.flight.points.size();
  if (!flight_.actions.empty() && flight_.actions.size() != count) {
    throw Error(
        ErrorCode::array_sizes_differ,
        "there are " + std::to_string(flight_.actions.size()) + " actions for " + std::to_string(count) + " points",
        place(), "give one for each point, or none");
  }
  if (!(flight_.chord_error_m > 0) || !std::isfinite(flight_.chord_error_m)) {
    throw Error(ErrorCode::value_out_of_range, "the error of chords is not a positive number", place(), "give metres");
  }
  for (std::size_t i = 0; i < flight_.actions.size(); ++i) {
    const FlightAction& action = flight_.actions[i];
    const std::string where = place() + ", point " + std::to_string(i + 1);
    if (action.look_at && !action.look_at->allFinite()) {
      throw Error(ErrorCode::coordinate_not_finite, "what the camera is turned to is not finite", where,
                  "give three numbers");
    }
    constexpr double kMostTurns = 1000, kWidestM = 100e3;
    const bool is_good = is_finite(action.yaw_deg) && is_finite(action.gimbal_pitch_deg) &&
                         std::abs(action.loiter_radius_m) <= kWidestM &&
                         (action.loiter_radius_m == 0 || (action.turns > 0 && action.turns <= kMostTurns));
    if (!is_good) {
      throw Error(ErrorCode::value_out_of_range, "an angle, a radius or a number of turns cannot be flown", where,
                  "give finite angles, a radius up to 100 km, and up to 1000 turns");
    }
  }
}

Eigen::Vector2d PlanWriter::lonlat(const Vec3& position) const {
  if (!globe_) {
    throw Error(ErrorCode::not_georeferenced, "the scene does not say where on the earth it lies, and a plan needs it",
                place(),
                "give a scene of a map, or its place: 'origin' under 'scene'; or write CSV with z of the scene");
  }
  constexpr double kSteps = 1e11;  // a millionth of a metre
  const geo::LonLat at = globe_->to_geodetic(position).place;
  return {rounded(at.longitude_deg, kSteps), rounded(at.latitude_deg, kSteps)};
}

io::GlobePlace PlanWriter::on_globe() const {
  if (!globe_) (void)lonlat(Vec3::Zero());  // says so
  return [this](const Vec3& position) { return globe_->to_geodetic(position); };
}

bool PlanWriter::knows(HeightDatum datum) const {
  return datum == HeightDatum::sea_level ? levels_.knows_sea_level()
                                         : datum != HeightDatum::ellipsoid || levels_.knows_ellipsoid();
}

/// How high it is above the surface that z = 0 at the origin lies in, which is level all over.
double PlanWriter::level(const Vec3& position) const {
  return globe_ && globe_->is_cartesian() ? globe_->to_geodetic(position).height_m : position.z();
}

double PlanWriter::height(const Vec3& position, HeightDatum datum) const {
  constexpr double kSteps = 1e6;
  switch (datum) {
    case HeightDatum::sea_level:
      return rounded(level(position) - levels_.sea_level_z(place()), kSteps);
    case HeightDatum::ellipsoid:
      return rounded(level(position) - levels_.ellipsoid_z(place()), kSteps);
    case HeightDatum::home:
      return rounded(level(position) - level(home()), kSteps);
    default:
      return rounded(position.z(), kSteps);
  }
}

const Vec3& PlanWriter::home() const {
  if (!flight_.home || !flight_.home->allFinite()) {
    throw Error(ErrorCode::missing_key, "the place of takeoff is not known", place(), "give the home");
  }
  return *flight_.home;
}

std::vector<OutPoint> PlanWriter::points() const {
  std::vector<OutPoint> points;
  const std::vector<FlightPoint>& corners = flight_.flight.points;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    OutPoint point;
    point.position = corners[i].position;
    point.hold_s = corners[i].hold_s;
    point.speed_m_s = std::isnan(corners[i].speed_m_s) ? flight_.speed_m_s : corners[i].speed_m_s;
    if (!flight_.actions.empty()) point.action = flight_.actions[i];
    const double radius = point.action.loiter_radius_m, turns = point.action.turns;
    if (radius == 0) {
      points.push_back(point);
      continue;
    }
    if (chord_count(radius, turns, flight_.chord_error_m) + static_cast<double>(points.size()) >
        static_cast<double>(kMostPlanItems)) {
      throw Error(ErrorCode::work_too_large, "the circles take too many chords", place(),
                  "allow a larger error of chords");
    }
    const Eigen::Vector2d centre = point.position.head<2>();
    const Eigen::Vector2d towards =
        points.empty() ? Eigen::Vector2d(0, 0) : Eigen::Vector2d(points.back().position.head<2>() - centre);
    bool is_first = true;
    for (const Eigen::Vector2d& at : circle_points(towards, radius, turns, flight_.chord_error_m)) {
      OutPoint part = point;
      part.position.head<2>() += at;
      part.is_of_circle = true;
      if (!is_first) {
        part.hold_s = 0;
        part.action.photo = part.action.video = false;
      }
      is_first = false;
      points.push_back(part);
    }
  }
  return points;
}

std::vector<OutPoint> PlanWriter::points_to_cut() const {
  const io::GlobePlace place = on_globe();
  std::vector<OutPoint> cut;
  double last_deg = 0;
  for (const OutPoint& point : points()) {
    const double longitude_deg = lonlat(point.position).x();
    const bool is_corner = std::abs(longitude_deg) == kAntimeridian || std::abs(last_deg) == kAntimeridian;
    if (!cut.empty() && !is_corner && io::crosses_antimeridian(last_deg, longitude_deg)) {
      OutPoint between;
      between.position = io::at_antimeridian(cut.back().position, point.position, place).scene;
      between.speed_m_s = point.speed_m_s;
      between.is_on_antimeridian = true;
      cut.push_back(between);
    }
    cut.push_back(point);
    last_deg = longitude_deg;
  }
  return cut;
}

std::vector<std::vector<LinePosition>> PlanWriter::lines(const std::vector<OutPoint>& points) const {
  const auto is_on_antimeridian = [](const LinePosition& at) { return std::abs(at.longitude_deg) == kAntimeridian; };
  std::vector<std::vector<LinePosition>> lines(1);
  for (const OutPoint& point : points) {
    const Eigen::Vector2d at = lonlat(point.position);
    LinePosition position{at.x(), at.y(), height(point.position)};
    if (point.is_on_antimeridian) position.longitude_deg = kAntimeridian;
    if (!lines.back().empty()) {
      const LinePosition last = lines.back().back();
      if (is_on_antimeridian(position)) {  // of either side
        position.longitude_deg = std::copysign(kAntimeridian, last.longitude_deg);
      }
      if (io::crosses_antimeridian(last.longitude_deg, position.longitude_deg)) {
        if (std::all_of(lines.back().begin(), lines.back().end(), is_on_antimeridian)) {  // all of it is of either side
          for (LinePosition& before : lines.back()) before.longitude_deg = -before.longitude_deg;
        } else {
          lines.push_back({{-last.longitude_deg, last.latitude_deg, last.height_m}});
        }
      }
    }
    lines.back().push_back(position);
  }
  return lines;
}

CameraAngles camera_angles(const OutPoint& point) {
  const FlightAction& action = point.action;
  CameraAngles angles{action.yaw_deg, action.gimbal_pitch_deg};
  constexpr double kDegrees = 180 / std::numbers::pi;
  if (action.look_at) {
    const Vec3 to = *action.look_at - point.position;
    const double across = to.head<2>().norm();
    if (across > 0) angles.yaw_deg = std::atan2(to.x(), to.y()) * kDegrees;
    angles.pitch_deg = std::atan2(to.z(), across) * kDegrees;
  }
  if (angles.yaw_deg) angles.yaw_deg = std::remainder(*angles.yaw_deg, 360);
  return angles;
}

std::string hold_text(double hold_s) {
  constexpr double kThousand = 1000, kRounding = 1e-6;  // of a thousandth: 1.1 s are 1100 and no more
  return decimal(std::ceil(hold_s * kThousand - kRounding) / kThousand, 3);
}

}  // namespace vantage::internal::flight::plans

namespace vantage {

namespace plans = internal::flight::plans;

PlanFormat plan_format_of(const std::filesystem::path& file) {
  std::string end = file.extension().string();
  for (char& c : end) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  if (end == ".plan") return PlanFormat::qgroundcontrol;
  if (end == ".waypoints") return PlanFormat::waypoints;
  if (end == ".kml") return PlanFormat::kml;
  if (end == ".kmz") return PlanFormat::wpml;
  if (end == ".gpx") return PlanFormat::gpx;
  if (end == ".geojson") return PlanFormat::geojson;
  if (end == ".csv") return PlanFormat::csv;
  if (end == ".czml") return PlanFormat::czml;
  throw Error(ErrorCode::output_format_unknown, "the name does not say which plan is to be written", file.string(),
              "let it end in .plan, .waypoints, .kml, .kmz (DJI), .gpx, .geojson, .csv or .czml");
}

std::string flight_plan_bytes(const FlightOut& flight, PlanFormat format) {
  switch (format) {
    case PlanFormat::qgroundcontrol:
      return plans::write_qgroundcontrol(flight);
    case PlanFormat::waypoints:
      return plans::write_waypoints(flight);
    case PlanFormat::kml:
      return plans::write_kml(flight);
    case PlanFormat::wpml:
      return plans::write_wpml(flight);
    case PlanFormat::gpx:
      return plans::write_gpx(flight);
    case PlanFormat::geojson:
      return plans::write_geojson(flight);
    case PlanFormat::czml:
      return plans::write_czml(flight);
    case PlanFormat::csv:
      break;
  }
  return plans::write_csv(flight);
}

void write_flight_plan(const FlightOut& flight, const std::filesystem::path& file) {
  write_whole_file(file, flight_plan_bytes(flight, plan_format_of(file)));
}

}  // namespace vantage
