// What the sensor can do: its range, and what a camera asks besides. docs/camera.md has the conventions, with drawings.
#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

#include "vantage/camera.h"
#include "vantage/export.h"
#include "vantage/geometry.h"

namespace vantage {

/// Which ways the camera may look. Yaw is clockwise from the scene's +y axis (north), pitch 0 is level and -90 straight
/// down, and a positive roll lowers the right edge of the picture.
struct Mount {
  std::optional<double> yaw_deg = {};              ///< empty: any
  double min_pitch_deg = -90, max_pitch_deg = 90;  ///< both in [-90, 90]; the same: fixed
  double roll_deg = 0;                             ///< in [-180, 180]

  bool is_fixed() const { return yaw_deg && min_pitch_deg == max_pitch_deg; }

  bool operator==(const Mount&) const = default;
};

/// How much of the target one pixel may cover.
struct PixelLimit {
  enum class Kind {
    perpendicular,  ///< d / f: as if the target were seen face on; d is the distance, f the focal length in pixels
    worst,          ///< d * d / (f h): foreshortened, in the worst direction; h is the height over the target's plane
  };
  double size_m = 0;  ///< of a step from one pixel to the next; > 0
  Kind kind = Kind::worst;

  bool operator==(const PixelLimit&) const = default;
};

/// What must not shine into the camera.
struct SunLimit {
  Vec3 direction = Vec3::Zero();  ///< towards the sun, scene frame, of any length but 0
  double exclude_deg = 0;         ///< no point of the target may be seen nearer to the sun than this; > 0, at most 90

  bool operator==(const SunLimit&) const = default;
};

/// A radio link between the target, a point where an antenna is, and the vehicle. Its first Fresnel zone is the
/// ellipsoid of the points over which the way is longer by at most half of a wavelength (ITU-R P.526). With a share c
/// of its radius it is that of the points over which the way is longer by at most c * c / 2 of a wavelength, and
/// nothing of the scene may enter its interior: so the straight way is free, too. docs/camera.md, "The zone of a radio
/// link".
struct RadioLink {
  double frequency_ghz = 0;  ///< > 0, at most 3000
  double clear = 0.6;        ///< share of the zone's radius that nothing of the scene may enter; > 0, at most 1

  bool operator==(const RadioLink&) const = default;
};

/// How much of the target, which is no point, must be seen where that is not all of it. Of a target in parts it is the
/// share of the sum of their areas, each of which must be looked at from its front.
struct VisibleShare {
  double share = 1;        ///< of the target's area; > 0, at most 1
  std::size_t cells = 16;  ///< into how many pieces of the same area it is cut, each of which counts where it is seen
                           ///< whole: 1 to 1024. The more there are the larger, up to what is right, is the volume.
                           ///< For volumes only: what is asked about points counts every part that is seen

  bool operator==(const VisibleShare&) const = default;
};

/// The direction to the sun's centre, east, north and up, of unit length: where it is seen at 10 degrees and 1010 hPa.
/// Seconds since 1970-01-01 UTC. Right to 0.02 degrees from 1950 to 2050, near the horizon to what refraction changes
/// with the weather (Michalsky 1988, Saemundsson 1986).
VANTAGE_API Vec3 sun_direction(double latitude_deg, double longitude_deg, double unix_time_s);

/// What the sensor can do. What is not given does not limit. A limit holds for all of the target: for every point of
/// every part. Viewpoints on the border of a limit keep it.
struct Sensor {
  double max_range_m = std::numeric_limits<double>::infinity();  ///< to every point of the target; > 0. May be infinite
                                                                 ///< where `pixel` bounds the range
  double min_range_m = 0;                    ///< to every point of the target; >= 0, less than the range
  std::optional<double> incidence_deg = {};  ///< largest angle between the target's normal and the line to the
                                             ///< viewpoint; > 0, < 90. Of a point: it needs a front
  std::optional<Pinhole> camera = {};        ///< all parts of the target must be in one picture
  Mount mount = {};                          ///< of the camera
  std::optional<PixelLimit> pixel = {};      ///< needs the camera's focal length
  std::optional<SunLimit> sun = {};
  std::optional<RadioLink> link = {};        ///< the target is a point
  std::optional<VisibleShare> visible = {};  ///< all other limits hold for all of the target nevertheless

  /// Whether there are limits that a volume is cut to once it is computed: all but the range, and a link.
  VANTAGE_API bool limits_view() const;

  bool operator==(const Sensor&) const = default;
};

/// The farthest that a viewpoint can be from a point of the target: max_range_m, or what the size of a pixel allows
/// where that is less. Metres; infinity where nothing bounds it.
VANTAGE_API double range_limit_m(const Sensor& sensor);

/// Throws Error(input) for a limit that is wrong in itself, or that another one excludes whatever the target is.
VANTAGE_API void check_sensor(const Sensor& sensor);

// ---- How far a pilot may be from an aircraft that is flown in sight

/// EASA, "Guidelines for UAS operations in the open and specific category - Ref to Regulation (EU) 2019/947", and the
/// same in SORA 2.5, AMC1 to Article 11: the smaller one of two distances counts. The attitude line of sight (ALOS) is
/// from where the pilot still tells the aircraft's position and direction, the detection line of sight (DLOS) from
/// where other aircraft are seen in time.
struct VisualRange {
  enum class Kind { multirotor, fixed_wing };  ///< helicopters count as multirotors
  double aircraft_size_m = 0;                  ///< characteristic dimension: the largest one, > 0
  Kind kind = Kind::multirotor;
  double visibility_m = 0;  ///< ground visibility, > 0; the guidelines ask for 5000 at least
};

/// 327 CD + 20 m of a multirotor, 490 CD + 30 m of a fixed wing, CD being the aircraft's size.
VANTAGE_API double attitude_line_of_sight_m(const VisualRange& of);

/// 0.3 times the visibility.
VANTAGE_API double detection_line_of_sight_m(const VisualRange& of);

/// The smaller one of both. Throws Error(input) for a size or a visibility that is not positive and finite.
VANTAGE_API double visual_range_m(const VisualRange& of);

// ---- Where to turn a camera so that it has something in its picture

/// An orientation of a camera, but for its roll.
struct CameraAim {
  double yaw_deg = 0;    ///< clockwise from +y of the scene (north), in [0, 360)
  double pitch_deg = 0;  ///< 0 is level, -90 straight down
};

/// Whether all points (relative to the camera, scene axes) are in the picture.
VANTAGE_API bool is_in_picture(const Pinhole& camera, double roll_deg, const CameraAim& aim,
                               const std::vector<Vec3>& points);

struct FittingAim {
  CameraAim aim;
  double room_deg = 0;  ///< between the edges of the picture and the points: an angle; negative where some are outside
};

/// Of the orientations that the mount allows the one with the most room between all points (relative to the camera,
/// scene axes) and the edges of the picture, to 0.01 degrees of room. Nothing where none has all of them in the
/// picture, and for points that are not finite; where one is on its edge, within 0.0001 degrees, either answer may
/// come. `outside_deg`: points may also lie so far outside of the edges, which must be less than 90 degrees. Cost: some
/// hundred microseconds.
VANTAGE_API std::optional<FittingAim> fit_in_picture(const Pinhole& camera, const Mount& mount,
                                                     const std::vector<Vec3>& points, double outside_deg = 0);

}  // namespace vantage
