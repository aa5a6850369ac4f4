// What all writers of plans share: positions on the earth, heights, and numbers as text.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/xml_text.h"
#include "flight/plans/levels.h"
#include "geo/on_globe.h"
#include "io/antimeridian.h"
#include "vantage/flight.h"

namespace vantage::internal::flight::plans {

/// The triangles of all volumes in a KML file: it takes 300 bytes for each, and must be no larger than what is read
/// (kMostPlanBytes).
inline constexpr std::size_t kMostKmlTriangles = 150'000;

/// How many of the flight's volumes a KML file draws: the first ones that it has room for.
inline std::size_t drawn_in_kml(const FlightOut& flight) {
  std::size_t triangles = 0, drawn = 0;
  for (const NamedVolume& volume : flight.volumes) {
    triangles += volume.mesh.triangles.size();
    if (triangles > kMostKmlTriangles) break;
    ++drawn;
  }
  return drawn;
}

/// A point as it is written.
struct OutPoint {
  Vec3 position;                     ///< scene frame
  double hold_s = 0, speed_m_s = 0;  ///< the speed of the leg that ends here; NaN: not stated
  FlightAction action;
  bool is_of_circle = false;        ///< one of the chords' ends
  bool is_on_antimeridian = false;  ///< a line is cut there
};

/// A position of a line, as it is written.
struct LinePosition {
  double longitude_deg = 0, latitude_deg = 0, height_m = 0;
};

class PlanWriter {
 public:
  /// Checks the flight, its actions and its heights, which `allowed` lists; where there is one alone, it need not be
  /// given. Throws Error(input).
  PlanWriter(const FlightOut& flight, PlanFormat format, const std::vector<HeightDatum>& allowed);

  const FlightOut& flight() const { return flight_; }
  HeightDatum heights() const { return heights_; }
  const std::string& place() const { return flight_.name; }  ///< for messages

  /// For as long as the writer is there. Throws Error(not_georeferenced).
  io::GlobePlace on_globe() const;
  bool is_on_earth() const { return globe_.has_value(); }
  /// Longitude and latitude, rounded to 1e-11 degrees. Throws Error(not_georeferenced).
  Eigen::Vector2d lonlat(const Vec3& position) const;
  /// Rounded to a micrometre. On a scene from a tileset, whose z is not the height, as the ellipsoid curves; but for
  /// scene_z. Throws Error(height_unknown), and missing_key for a home that is needed.
  double height(const Vec3& position, HeightDatum datum) const;
  double height(const Vec3& position) const { return height(position, heights_); }
  bool knows(HeightDatum datum) const;
  /// Throws Error(missing_key).
  const Vec3& home() const;

  /// The points with their actions, and chords for circles.
  std::vector<OutPoint> points() const;
  /// The same as chords, with a point more where a leg crosses the antimeridian: a line is cut there.
  std::vector<OutPoint> points_to_cut() const;
  /// Of these points, each on one side of the antimeridian: where a line ends there, the next one begins in its place.
  std::vector<std::vector<LinePosition>> lines(const std::vector<OutPoint>& points) const;

 private:
  void check_actions() const;
  double level(const Vec3& position) const;

  const FlightOut& flight_;
  Levels levels_;
  std::optional<geo::OnGlobe> globe_;
  HeightDatum heights_;
};

/// Angles to what the camera is turned to, or those that are given. Degrees; the yaw in -180 to 180.
struct CameraAngles {
  std::optional<double> yaw_deg, pitch_deg;
};
CameraAngles camera_angles(const OutPoint& point);

/// Seconds to a thousandth, rounded up: a stay is never shorter than what was planned.
std::string hold_text(double hold_s);

using core::decimal;
using core::xml_text;

// ---- the formats ----

std::string write_qgroundcontrol(const FlightOut& flight);
std::string write_waypoints(const FlightOut& flight);
std::string write_wpml(const FlightOut& flight);
std::string write_kml(const FlightOut& flight);
std::string write_gpx(const FlightOut& flight);
std::string write_geojson(const FlightOut& flight);
std::string write_csv(const FlightOut& flight);
std::string write_czml(const FlightOut& flight);

}  // namespace vantage::internal::flight::plans
