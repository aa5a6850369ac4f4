// Files of zones: what they say, in longitudes and latitudes (WGS 84).
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/progress_reporter.h"
#include "vantage/error.h"
#include "vantage/navigation.h"

namespace vantage::internal::app {

enum class HeightReference { sea_level, ground, ellipsoid };

struct ZoneHeight {
  double metres = 0;
  HeightReference from = HeightReference::sea_level;
};

/// A circle on the ellipsoid. Where a file leaves open in which unit the radius is, the two are what it may mean.
struct ListedCircle {
  Eigen::Vector2d centre;  ///< longitude and latitude
  double least_radius_m = 0, radius_m = 0;
};

/// Corners in plan, and the height that the file gives each of them: not a number where it gives none.
struct ListedRing {
  Zone::Ring corners;  ///< longitude and latitude, degrees
  std::vector<double> z_m;
};

struct ListedZone {
  std::string name;                ///< as the file calls it; else its number in the file
  std::string place;               ///< in the file, for messages: "features[3]", "line 12"
  std::size_t feature = 0;         ///< number of the feature, placemark or fence that it is of, counted from 0
  std::vector<std::string> names;  ///< all names and ids that the file has for it, those for people first; may be empty
  Zone::Ring outer;                ///< longitude and latitude, degrees; neighbours differ. Empty for a circle
  std::vector<Zone::Ring> holes;
  std::optional<ListedCircle> circle;
  std::optional<ZoneHeight> lower, upper;  ///< nothing: without that bound
  bool has_heights = false;                ///< the file says between which heights; else it says nothing of them
  std::string unused_heights;              ///< what else it says of heights, and why that is not used; for messages
  std::optional<Error> heights_fault;      ///< why its heights cannot be used; it has some then
  bool is_solid = false;                   ///< the file draws a floor, a ceiling and walls: no target
  std::optional<bool> is_inclusion;        ///< of a fence: to stay in or out
  /// Of the corners themselves, of `outer` and then of the holes; empty where the file has none, or says to ignore
  /// them. Not a number for a corner without, beside others with one. They are no bounds of a zone.
  std::vector<double> corner_z_m;
  std::optional<HeightReference> corners_from;  ///< nothing: the file leaves open from where they are measured
};

/// An area whose outline cannot be read, or what may be one. Of ListedZone's members it has the names, the place, the
/// feature and `is_inclusion`.
struct UnreadZone {
  ListedZone zone;
  Error fault;
};
inline constexpr const char* kEmptyArea = "empty area";
inline constexpr const char* kDisabledArea = "disabled area";

struct ZoneList {
  std::vector<ListedZone> zones;
  std::vector<UnreadZone> unread;
  std::map<std::string, std::size_t> left_out;  ///< what bounds nothing, by what it is: "point", "line", kEmptyArea
  bool has_no_heights = false;                  ///< the format has none: its zones are without bounds
};

/// Of a file of zones, decompressed or not: national zones have some ten megabytes.
inline constexpr std::uintmax_t kMostZoneBytes = 64'000'000;

/// The zones of GeoJSON (RFC 7946), of UAS zones in ED-269 and ED-318, of KML, also in a KMZ archive, of a plan of
/// QGroundControl, and of a list of waypoints with a fence of ArduPilot. The format is told by the content. `file` is
/// for messages. What is wrong with one area is told in `unread`. Throws Error(zone_file_syntax) with the place for
/// what is none of these formats; Error(input) for positions of another system; Error(cancelled) when told to stop.
ZoneList parse_zones(std::string_view text, const std::filesystem::path& file,
                     const core::ProgressReporter& progress = {});

/// For readers: keeps a fault of one area. Throws it where it is not of the file, and where the file has more of them
/// than zones are possible.
void leave_unread(ListedZone zone, const Error& fault, ZoneList& list);

/// For readers: a line that is closed may be meant as an area to stay out of, and is none to stay in or of a target.
void leave_closed_line(ListedZone zone, const std::filesystem::path& file, ZoneList& list);

/// For readers: throws Error(input) with the file and the place in it.
[[noreturn]] void fail_in_zones(ErrorCode code, const std::filesystem::path& file, const std::string& place,
                                const std::string& problem, const std::string& fix);

/// Checks that a position is on the earth. Throws Error(input).
Eigen::Vector2d checked_position(double longitude_deg, double latitude_deg, const std::filesystem::path& file,
                                 const std::string& place);

/// A ring without the corner that closes it, and without corners that repeat the one before in plan. Throws
/// Error(input) for a ring that is not closed.
ListedRing opened_ring(const ListedRing& closed, const std::filesystem::path& file, const std::string& place);

/// Makes a ring the outer one of a polygon, or else a hole.
void add_ring(ListedRing ring, bool is_outer, ListedZone& zone);

}  // namespace vantage::internal::app
