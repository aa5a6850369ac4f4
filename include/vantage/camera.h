// Cameras by name: a table of data sheets, lists in files, and the pinhole that follows from them.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "vantage/export.h"

namespace vantage {

/// What carries a camera: its gimbal and its aircraft, as their maker documents them. What is not known is empty.
struct CameraCarrier {
  using Range = std::array<double, 2>;  ///< lowest, highest

  /// That the gimbal can be told to take: pitch, 0 level and -90 straight down; roll; yaw from the aircraft's nose.
  std::optional<Range> pitch_deg, roll_deg, yaw_deg;
  std::optional<double> rate_deg_s;                               ///< so fast its pitch turns at most
  std::optional<int> dji_drone, dji_drone_sub_type, dji_payload;  ///< as WPML numbers them: DjiAircraft
  std::optional<double> climb_m_s, descent_m_s, speed_m_s;        ///< the fastest of the aircraft's normal mode
  std::string source = {};                                        ///< empty: nothing is known
};

/// What a data sheet says of a camera with its lens. A number that is not known is 0.
struct Camera {
  std::string name;  ///< "sony_a7r_iv_35mm" in the table of vantage; in a list from a file as it is written there
  std::string maker, model;
  int width_px = 0, height_px = 0;  ///< of the whole picture
  double sensor_width_mm = 0;       ///< of the part of the sensor that makes the picture
  double sensor_height_mm = 0;
  double focal_length_mm = 0;  ///< of the lens itself, not its "35 mm equivalent"
  std::string source;          ///< where the numbers are from: a data sheet, or a file and the entry in it
  CameraCarrier carrier = {};  ///< of the table; lists from files have none
};

/// A camera without distortion, whose axis meets the middle of the picture. Its axes are those of computer vision: x to
/// the right of the picture, y down the picture, z ahead. It sees the point (x, y, z) if z > 0, |x| <= half_width * z
/// and |y| <= half_height * z.
struct Pinhole {
  double half_width = 0, half_height = 0;  ///< tangents of half the field of view; 1 is 90 degrees
  int width_px = 0, height_px = 0;         ///< of the picture; 0: not known
  /// The focal length in pixels: a length at right angles to the axis, at depth z, has focal_px * length / z pixels.
  /// Where width and height give two values, the smaller one. No value if the pixels are not known.
  std::optional<double> focal_px;

  /// Of the whole picture, horizontal and vertical, in degrees.
  VANTAGE_API std::array<double, 2> fov_deg() const;

  bool operator==(const Pinhole&) const = default;
};

/// The camera with what follows from the rest: a side of the sensor that is 0, if the picture and the other side are
/// known, as pixels are square. Throws Error(camera_invalid) if a number is impossible or contradicts the others:
/// not finite, negative, larger than any camera has, a sensor in pixels instead of millimetres, or sides of a pixel
/// that differ by more than 5 %.
VANTAGE_API Camera completed(const Camera& camera);

/// The pinhole of a camera: half_width = sensor_width_mm / (2 focal_length_mm), half_height likewise, and focal_px =
/// width_px * focal_length_mm / sensor_width_mm, or the same with the heights if that is smaller. Throws
/// Error(camera_invalid) as completed() does, and if the focal length or the sensor are not known.
VANTAGE_API Pinhole pinhole_of(const Camera& camera);

/// The pinhole of a field of view in degrees, horizontal and vertical, each from 0.001 to 179. With the pixels of
/// the picture (both, or 0 for not known), focal_px is the smaller one of width_px / (2 half_width) and height_px /
/// (2 half_height). Throws Error(camera_invalid).
VANTAGE_API Pinhole pinhole_of_fov(double horizontal_deg, double vertical_deg, int width_px = 0, int height_px = 0);

/// The table of vantage, by name: docs/camera.md. Every camera in it has all numbers.
VANTAGE_API const std::vector<Camera>& known_cameras();

/// The camera of that name in the table. Throws Error(unknown_choice) with the names that are most alike.
VANTAGE_API const Camera& find_camera(std::string_view name);

/// An entry of a list of cameras.
struct ListedCamera {
  Camera camera;        ///< what the entry says; 0 or empty where it says nothing, or nothing that can be used
  std::string problem;  ///< why it cannot be used; empty if it can
};

/// pinhole_of() the camera; nothing if the entry has a problem, or lacks the focal length or the sensor. Throws as
/// completed() does.
VANTAGE_API std::optional<Pinhole> pinhole_if_known(const ListedCamera& listed);

/// The entries of a list of cameras, in the order of the file or by name. Two formats are recognised by their content:
/// - QGroundControl's CameraMetaData.json: an array of objects with "canonicalName", "brand", "model", "sensorWidth"
///   and "sensorHeight" in millimetres, "imageWidth" and "imageHeight" in pixels, and "focalLength" in millimetres;
///   other members are ignored;
/// - OpenSfM's sensor_data.json: an object whose members are names, as "DJI FC6310", with the width of the sensor in
///   millimetres. Such a camera has neither pixels nor a focal length, so pinhole_of() refuses it.
/// An entry that is wrong does not spoil the others: it has a `problem`. Throws Error(camera_list_syntax) with line and
/// column for what is not JSON, and for JSON of another kind; as reading any file does; and Error(file_too_large) for
/// more than 64 MB.
VANTAGE_API std::vector<ListedCamera> read_cameras(const std::filesystem::path& file);

}  // namespace vantage
