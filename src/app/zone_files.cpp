#include "app/zone_files.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "app/combine_targets.h"
#include "app/input_file.h"
#include "app/zone_file.h"
#include "app/zone_places.h"
#include "common/input.h"
#include "core/places.h"
#include "core/progress_reporter.h"
#include "core/zone_check.h"
#include "geo/local_frame.h"
#include "geo/on_globe.h"
#include "vantage/error.h"
#include "vantage/ground.h"

namespace vantage::internal::app {
namespace {

using Point = Eigen::Vector2d;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kCircleMarginM = 0.001;
constexpr const char* kLonLatAdvice = "check the file: is it of another place, or are longitude and latitude swapped?";

/// No viewpoint is farther from the scene's origin.
double farthest_viewpoint_m(const Mission& mission) {
  double farthest = geo::kFarthestM;
  const auto take = [&](const std::vector<Vec3>& corners, double reach_m) {
    for (const Vec3& corner : corners) farthest = std::max(farthest, corner.head<2>().norm() + reach_m);
  };
  for (const std::vector<Target>& view : views_of(mission)) {
    for (const Target& target : view) {
      for (const std::vector<Vec3>& part : target.parts) take(part, range_limit_m(mission.sensor));
      if (target.volume) take(target.volume->mesh.vertices, 0);
    }
  }
  return farthest;
}

class FileZones {
 public:
  FileZones(Mission& mission, const ZoneFile& file, ZoneUse use, const geo::OnGlobe& globe,
            const core::ProgressReporter& progress)
      : mission_(mission), file_(file), use_(use), globe_(globe), progress_(progress), walls_(globe, mission) {}

  void add_to(std::vector<Zone>& zones);

 private:
  /// What was not taken.
  struct Left {
    std::size_t other_fences = 0, far = 0, swapped = 0;
    std::vector<std::string> skipped;
    std::optional<Error> fault;  // of the first of these
    double nearest_m = kInfinity;
  };

  bool add_one(const ListedZone& listed, bool has_none, std::vector<Zone>& zones);
  void add_zone(Zone zone, const std::string& name, const ListedZone& listed, std::vector<Zone>& zones);
  void skip(const ListedZone& listed, const Error& fault);
  bool may_be_empty(const ZoneList& list) const;
  [[noreturn]] void fail_for_nothing() const;
  bool is_for_use(const ListedZone& listed) const {
    return !listed.is_inclusion || *listed.is_inclusion == (use_ == ZoneUse::keep_in);
  }
  Zone placed(const ListedZone& listed, Zone zone) const;
  ListedZone near_part(const ListedZone& listed) const;
  Zone::Ring circle(const ListedCircle& circle, double z_m, double lean_m) const;
  void add_heights(const ListedZone& listed, bool has_none, Zone& zone) const;
  bool has_no_heights(const Zone& zone);
  double z_of(const std::optional<ZoneHeight>& height, double without, const std::string& place) const;
  double distance_m(const ListedZone& listed) const;
  Zone::Ring unwrapped(Zone::Ring ring, const std::string& place) const;
  bool may_go_round(const ListedZone& listed) const;
  bool seems_swapped(const ListedZone& listed) const;
  void note_left_out(const ZoneList& list) const;
  [[noreturn]] void fail(ErrorCode code, const std::string& place, const std::string& problem,
                         const std::string& fix) const {
    fail_in_zones(code, file_.file, place, problem, fix);
  }
  /// What `convert` returns; its errors say where in the file.
  template <typename Convert>
  auto in_file(const ListedZone& listed, const Convert& convert) const {
    try {
      return convert();
    } catch (const Error& error) {
      const std::string where = error.where().empty() ? "" : ", " + error.where();
      throw error.with_where(file_.file.string() + ", " + listed.place + where);
    }
  }

  Mission& mission_;
  const ZoneFile& file_;
  ZoneUse use_;
  const geo::OnGlobe& globe_;
  const core::ProgressReporter& progress_;
  ZoneWalls walls_;
  Left left_;
  std::set<std::string> names_;
  std::optional<Heights> ground_;  // z of its lowest and highest place, once it is needed
};

/// Sides may cross the antimeridian: each is taken the short way round, and all of the ring is turned to be nearest to
/// the scene. One that is so long that either way may be meant is refused, and so is a ring that leaves no room.
Zone::Ring FileZones::unwrapped(Zone::Ring ring, const std::string& place) const {
  constexpr double kSurelyAcross = 300, kWidest = 180;
  double low = INFINITY, high = -INFINITY, before = ring.empty() ? 0 : ring.front().x();
  double unwrapped = before;
  for (Point& p : ring) {
    const double step = p.x() - before;
    before = p.x();
    if (std::abs(step) > kWidest && std::abs(step) < kSurelyAcross) low = -INFINITY;
    unwrapped += std::abs(step) > kWidest ? std::remainder(step, 360) : step;
    p.x() = unwrapped;
    low = std::min(low, p.x());
    high = std::max(high, p.x());
  }
  if (!(high - low <= kWidest)) {
    fail(ErrorCode::value_unsupported, place, "the zone is wider than 180 degrees of longitude",
         "cut it into parts, at the antimeridian and near the scene");
  }
  const double middle = (low + high) / 2, origin = globe_.map().origin().longitude_deg;
  const double turns = origin + std::remainder(middle - origin, 360) - middle;
  for (Point& p : ring) p.x() += turns;
  return ring;
}

/// At least so far is the zone from the scene's origin. By the box about it in the frame: its sides curve there (one of
/// 2000 km by 80 km), so there are points on them every 10 km, between which they curve by far less than the slack.
double FileZones::distance_m(const ListedZone& listed) const {
  constexpr double kStepM = 10e3, kMostSteps = 2000, kSlackM = 2e3;
  const auto position = [&](const Point& p) {
    progress_.tick();
    return globe_.map().to_local({p.x(), p.y()});
  };
  if (listed.circle) {
    return std::max(position(listed.circle->centre).norm() - listed.circle->radius_m - kSlackM, 0.0);
  }
  const Zone::Ring ring = unwrapped(listed.outer, listed.place);
  Box box;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Point &from = ring[i], &to = ring[(i + 1) % ring.size()];
    const double length = (position(to) - position(from)).norm();
    const int steps = static_cast<int>(std::clamp(std::ceil(length / kStepM), 1.0, kMostSteps));
    for (int k = 0; k < steps; ++k) {
      const Point at = position(from + (to - from) * k / steps);
      box.extend(Vec3(at.x(), at.y(), 0));
    }
  }
  const double distance = Point::Zero().cwiseMax(box.min.head<2>()).cwiseMin(box.max.head<2>()).norm();
  return std::max(distance - kSlackM, 0.0);
}

/// Of a zone out of reach: whether all its corners would lie near with longitude and latitude the other way round.
bool FileZones::seems_swapped(const ListedZone& listed) const {
  const auto is_near = [this](const Point& p) {
    return std::abs(p.x()) <= 90 && globe_.map().to_local({p.y(), p.x()}).norm() <= geo::kFarthestM;
  };
  if (listed.circle) return is_near(listed.circle->centre);
  return std::all_of(listed.outer.begin(), listed.outer.end(), is_near);
}

/// Of a zone out of reach: whether a side was taken the short way round the earth that would pass at the scene's
/// latitude on the long one, as RFC 7946 has it.
bool FileZones::may_go_round(const ListedZone& listed) const {
  constexpr double kHalfRound = 180, kDegreeM = 111e3;
  const double latitude = globe_.map().origin().latitude_deg;
  double low = kInfinity, high = -kInfinity, longest = 0;
  for (std::size_t i = 0; i < listed.outer.size(); ++i) {
    const Point &from = listed.outer[i], &to = listed.outer[(i + 1) % listed.outer.size()];
    low = std::min(low, from.y());
    high = std::max(high, from.y());
    longest = std::max(longest, std::abs(to.x() - from.x()));
  }
  const double reach_deg = farthest_viewpoint_m(mission_) / kDegreeM;
  return longest > kHalfRound && latitude > low - reach_deg && latitude < high + reach_deg;
}

/// With so many corners that the sides leave the circle by 5 cm at most, 720 corners at most. They lie on it to stay
/// in, and a millimetre inside: that is more than the frame bends. To stay out of, the sides touch a circle a
/// millimetre larger.
Zone::Ring FileZones::circle(const ListedCircle& circle, double z_m, double lean_m) const {
  constexpr double kSagittaM = 0.05;
  const double margin = kCircleMarginM + lean_m;
  constexpr int kFewest = 32, kMost = 720;
  const bool is_kept = use_ == ZoneUse::keep_in;
  const double radius = is_kept ? circle.least_radius_m - margin : circle.radius_m + margin;
  const double wanted = std::ceil(std::numbers::pi * std::sqrt(std::max(radius, 0.0) / (2 * kSagittaM)));
  const int count = static_cast<int>(std::clamp(wanted, 1.0 * kFewest, 1.0 * kMost));
  const double corner_radius = is_kept ? radius : radius / std::cos(std::numbers::pi / count);
  const geo::LocalFrame about({std::remainder(circle.centre.x(), 360), circle.centre.y()});
  Zone::Ring ring;
  for (int i = 0; i < count; ++i) {
    const double angle = 2 * std::numbers::pi * i / count;
    const geo::LonLat corner = about.to_lonlat(corner_radius * Point(std::cos(angle), std::sin(angle)));
    ring.push_back(globe_.at_z(corner, z_m));
  }
  return ring;
}

/// `without`: where the height is none, or is above the ground.
double FileZones::z_of(const std::optional<ZoneHeight>& height, double without, const std::string& place) const {
  if (!height) return without;
  const std::string& vertical = mission_.scene().georeference->vertical;
  const std::string level = vertical.empty() ? "an unknown level" : vertical;
  switch (height->from) {
    case HeightReference::sea_level:
      if (const auto sea = sea_level_m(mission_)) return height->metres + *sea;
      fail(ErrorCode::heights_differ, place,
           "its heights are above mean sea level, and those of the scene above " + level,
           "say with 'scene.sea_level' which z of the scene the mean sea level has, or write 'heights: any'");
    case HeightReference::ellipsoid:
      if (vertical == geo::kEllipsoidalHeight) return height->metres;
      fail(ErrorCode::heights_differ, place,
           "its heights are above the WGS 84 ellipsoid, and those of the scene above " + level,
           "convert them to heights above mean sea level, or write 'heights: any'");
    case HeightReference::ground:
      break;
  }
  return without;
}

void FileZones::add_heights(const ListedZone& listed, bool has_none, Zone& zone) const {
  if (file_.any_height) return;
  if ((file_.z_m || file_.agl_m) && listed.has_heights) {
    fail(ErrorCode::conflicting_keys, listed.place, "the zone has heights of its own, and the mission gives others",
         std::string("leave '") + (file_.z_m ? "z" : "agl") + "' out; 'heights: any' makes zones without bounds of it");
  }
  if (file_.z_m) {
    zone.min_z_m = (*file_.z_m)[0];
    zone.max_z_m = (*file_.z_m)[1];
  }
  if (file_.agl_m) zone.above_ground = {(*file_.agl_m)[0], (*file_.agl_m)[1], {}};
  if (file_.z_m || file_.agl_m) return;
  if (!listed.has_heights && !has_none) {
    fail(ErrorCode::missing_key, listed.place,
         "the file does not say between which heights the zone lies" + listed.unused_heights,
         "write 'z: [low, high]', 'agl: [low, high]' or 'heights: any' beside 'file'");
  }
  zone.min_z_m = z_of(listed.lower, -kInfinity, listed.place);
  zone.max_z_m = z_of(listed.upper, kInfinity, listed.place);
  const auto is_above_ground = [](const std::optional<ZoneHeight>& height) {
    return height && height->from == HeightReference::ground;
  };
  if (!is_above_ground(listed.lower) && !is_above_ground(listed.upper)) return;
  zone.above_ground = {is_above_ground(listed.lower) ? listed.lower->metres : -kInfinity,
                       is_above_ground(listed.upper) ? listed.upper->metres : kInfinity,
                       {}};
}

/// Whether one bound above the ground and one above a level leave nothing between them, wherever the ground is.
bool FileZones::has_no_heights(const Zone& zone) {
  if (!zone.above_ground) return false;
  const auto& [min_m, max_m, none] = *zone.above_ground;
  const bool may_be =
      (std::isfinite(zone.min_z_m) && std::isfinite(max_m)) || (std::isfinite(zone.max_z_m) && std::isfinite(min_m));
  if (!may_be) return false;
  if (!ground_) {
    const Ground ground = ground_of(mission_);
    ground_ = Heights{ground.plane_z_m, ground.plane_z_m};
    if (ground.surface) {
      const Box box = bounding_box(*ground.surface);
      ground_ = Heights{box.min.z(), box.max.z()};
    }
  }
  return zone.min_z_m >= ground_->high_m + max_m || zone.max_z_m <= ground_->low_m + min_m;
}

/// Whether rings touch each other, or cross by rounding, and are sound by themselves: holes that touch the outline are
/// valid in GIS.
bool only_touches(const Zone& zone) {
  if (zone.holes.empty()) return false;
  const auto is_sound = [](const Zone::Ring& ring) {
    Zone alone;
    alone.outer = ring;
    return !core::fault_of(alone);
  };
  return is_sound(zone.outer) && std::all_of(zone.holes.begin(), zone.holes.end(), is_sound);
}

bool has_touching_holes(const ListedZone& listed) {
  Zone zone;
  zone.outer = listed.outer;
  zone.holes = listed.holes;
  return !listed.holes.empty() && core::fault_of(zone) && only_touches(zone);
}

/// `zone` has its heights, and gets its rings.
Zone FileZones::placed(const ListedZone& listed, Zone zone) const {
  constexpr double kTouchM = 0.05;  // seven decimals of a degree are a centimetre
  const Heights heights{zone.min_z_m, zone.max_z_m};
  const double middle = walls_.middle_z_m(heights);
  const ToFrame to_frame = [&](const Point& p) {
    progress_.tick();
    return globe_.at_z({p.x(), p.y()}, middle);
  };
  Extent extent;
  if (listed.circle) {
    if (listed.circle->radius_m > geo::kFarthestM) {
      fail(ErrorCode::value_out_of_range, listed.place, "the radius of the circle is larger than 100 km",
           "give a polygon instead");
    }
    const double distance = to_frame(listed.circle->centre).norm(), radius = listed.circle->radius_m;
    extent = {std::max(distance - 1.01 * radius, 0.0), distance + 1.01 * radius};
    const double lean = walls_.lean_m(heights, extent.farthest_m);
    if (use_ == ZoneUse::keep_in && listed.circle->least_radius_m <= 2 * kCircleMarginM + lean) {
      fail(ErrorCode::limits_empty, listed.place,
           lean == 0 ? "the circle is smaller than 2 mm" : "the circle is smaller than what its walls lean by there",
           "make it larger");
    }
    zone.outer = circle(*listed.circle, middle, lean);
  } else {
    zone.outer = unwrapped(listed.outer, listed.place);
    for (const Zone::Ring& hole : listed.holes) zone.holes.push_back(unwrapped(hole, listed.place));
    const auto fault = core::fault_of(zone);
    // To stay out of, holes shrink, and come apart from what they touch.
    const bool come_apart = fault && use_ == ZoneUse::keep_out && only_touches(zone);
    if (fault && !come_apart) fail(fault->code, listed.place, fault->problem, fault->fix);
    extent = extent_of(zone.outer, to_frame);
    const double margin = walls_.lean_m(heights, extent.farthest_m) + (come_apart ? kTouchM : 0);
    try {
      zone = in_file(listed, [&] { return placed_zone(zone, use_, to_frame, kLonLatAdvice, margin); });
    } catch (const Error& error) {
      if (!come_apart || error.kind() != ErrorKind::input) throw;
      fail(fault->code, listed.place, fault->problem, fault->fix);  // it does more than touch
    }
  }
  if (file_.z_m || file_.any_height) return zone;
  const Heights z = in_file(listed, [&] { return walls_.z_of(heights, extent, use_); });
  zone.min_z_m = z.low_m;
  zone.max_z_m = z.high_m;
  return zone;
}

/// Whether the ring is the border of a box of longitudes and latitudes.
bool is_border(const Zone::Ring& ring, const Eigen::AlignedBox2d& box) {
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Point &a = ring[i], &b = ring[(i + 1) % ring.size()];
    const bool along_x = a.y() == b.y() && (a.y() == box.min().y() || a.y() == box.max().y());
    const bool along_y = a.x() == b.x() && (a.x() == box.min().x() || a.x() == box.max().x());
    if (!along_x && !along_y) return false;
  }
  return true;
}

/// Of a belt round the world, as masks that leave out a country are: what of it lies near the scene, with the holes
/// that are there. Other zones stay as they are.
ListedZone FileZones::near_part(const ListedZone& listed) const {
  constexpr double kRound = 359, kFarthestLatitude = 75, kDegreeM = 111e3;
  constexpr int kParts = 8;  // of a side: long ones curve
  Eigen::AlignedBox2d all;
  for (const Point& p : listed.outer) all.extend(p);
  if (listed.circle || !(all.sizes().x() >= kRound) || !is_border(listed.outer, all)) return listed;
  const Point origin(globe_.map().origin().longitude_deg, globe_.map().origin().latitude_deg);
  const double reach_deg = farthest_viewpoint_m(mission_) / kDegreeM;
  for (double reach = 2; reach < 16 && std::abs(origin.y()) < kFarthestLatitude; reach *= 2) {
    if (reach < 1.5 * reach_deg) continue;
    const double wide = reach / std::cos((std::abs(origin.y()) + reach) * std::numbers::pi / 180);
    const Point half(std::min(wide, 80.0), reach);
    Eigen::AlignedBox2d near(origin - half, origin + half);
    near.min().y() = std::clamp(near.min().y(), all.min().y(), all.max().y());
    near.max().y() = std::clamp(near.max().y(), all.min().y(), all.max().y());
    if (near.sizes().y() <= 0) return listed;
    ListedZone part = listed;
    part.outer.clear();
    part.holes.clear();
    const std::array<Point, 4> corners = {
        near.min(), {near.max().x(), near.min().y()}, near.max(), {near.min().x(), near.max().y()}};
    for (std::size_t i = 0; i < corners.size(); ++i) {
      for (int k = 0; k < kParts; ++k) {
        part.outer.push_back(corners[i] + (corners[(i + 1) % corners.size()] - corners[i]) * k / kParts);
      }
    }
    bool fits = true;
    for (const Zone::Ring& hole : listed.holes) {
      Eigen::AlignedBox2d of_hole;
      for (const Point& p : unwrapped(hole, listed.place)) of_hole.extend(p);
      if (!near.intersects(of_hole)) continue;
      fits = fits && near.contains(of_hole);
      part.holes.push_back(hole);
    }
    if (fits) return part;
  }
  return listed;
}

void FileZones::note_left_out(const ZoneList& list) const {
  std::string what;
  const auto add = [&](std::size_t count, const std::string& one, const std::string& many) {
    if (count == 0) return;
    what += (what.empty() ? "" : ", ") + std::to_string(count) + " " + (count == 1 ? one : many);
  };
  for (const auto& [kind, count] : list.left_out) add(count, kind, kind + "s");
  const bool is_kept = use_ == ZoneUse::keep_in;
  const MissionFile& mission = mission_.as_written;
  const std::vector<ZoneFile>& others = is_kept ? mission.keep_out_files : mission.keep_in_files;
  const bool takes_others =
      std::any_of(others.begin(), others.end(), [this](const ZoneFile& other) { return other.file == file_.file; });
  if (!takes_others) {
    add(left_.other_fences, is_kept ? "fence to stay out of" : "fence to stay in",
        is_kept ? "fences to stay out of" : "fences to stay in");
  }
  add(left_.far, "zone beyond the reach of the sensor", "zones beyond the reach of the sensor");
  if (left_.swapped > 0) {
    what += "; longitude and latitude of " + std::to_string(left_.swapped) +
            " of these seem to be swapped, so check the file";
  }
  if (!left_.skipped.empty()) {
    constexpr std::size_t kMost = 5;
    const std::size_t count = left_.skipped.size();
    what += std::string(what.empty() ? "" : "; ") + "what cannot be read: ";
    for (std::size_t i = 0; i < std::min(count, kMost); ++i) what += (i == 0 ? "" : ", ") + left_.skipped[i];
    if (count > kMost) what += " and " + std::to_string(count - kMost) + " more";
  }
  if (what.empty()) return;
  mission_.notes.push_back({WarningCode::zones_left_out, "not taken as zones to stay " +
                                                             std::string(is_kept ? "in" : "out of") + " from " +
                                                             file_.file.filename().string() + ": " + what});
}

/// A zone that cannot be read. To stay in it may be missing; to stay out of, the mission has to say so.
void FileZones::skip(const ListedZone& listed, const Error& fault) {
  if (fault.kind() != ErrorKind::input) throw fault;
  const std::string name = listed.names.empty() ? "" : in_quotes(listed.names.front());
  const std::string problem = (name.empty() ? "" : "the zone " + name + ": ") + fault.problem();
  const bool is_kept = use_ == ZoneUse::keep_in;
  const Error named(
      fault.code(), problem, fault.where(),
      is_kept ? fault.fix() : fault.fix() + "; or leave out what cannot be read: 'skip: true' beside 'file'");
  if (!is_kept && !file_.skip) throw Error(named);
  if (!left_.fault) left_.fault = named;
  left_.skipped.push_back(listed.place + (name.empty() ? "" : " " + name) + " (" + fault.problem() + ")");
}

/// Whether it may be that no zone is taken: of a file to stay out of that has some which count nowhere.
bool FileZones::may_be_empty(const ZoneList& list) const {
  if (use_ == ZoneUse::keep_in || left_.swapped > 0) return false;
  return !left_.skipped.empty() || list.left_out.contains(kEmptyArea) || list.left_out.contains(kDisabledArea);
}

void FileZones::fail_for_nothing() const {
  const bool is_kept = use_ == ZoneUse::keep_in;
  if (left_.far > 0) {
    fail(ErrorCode::too_far_away, "",
         "the nearest zone lies at least " + std::to_string(std::lround(left_.nearest_m / 1000)) +
             " km from the scene's origin" + (left_.swapped > 0 ? "; longitude and latitude seem to be swapped" : ""),
         left_.swapped > 0 ? "write the longitude before the latitude" : kLonLatAdvice);
  }
  if (left_.other_fences > 0) {
    fail(ErrorCode::nothing_given, "", std::string("the file has no fence to stay ") + (is_kept ? "in" : "out of"),
         std::string("name it under '") + (is_kept ? "keep_out'" : "keep_in'") + ", or add a fence");
  }
  if (left_.fault) throw Error(*left_.fault);
  fail(ErrorCode::nothing_given, "", "the file has no areas",
       "give polygons or circles: lines and points are no zones");
}

void FileZones::add_zone(Zone zone, const std::string& name, const ListedZone& listed, std::vector<Zone>& zones) {
  if (names_.empty()) {
    for (const Zone& one : zones) names_.insert(one.name);
  }
  zone.name = name;
  for (int i = 2; !names_.insert(zone.name).second; ++i) zone.name = name + " (" + std::to_string(i) + ")";
  if (const auto fault = core::fault_of(zone)) fail(fault->code, listed.place, fault->problem, fault->fix);
  zones.push_back(std::move(zone));
  const Navigation& all = mission_.navigation;
  if (const auto fault = core::fault_of_count(all.keep_in.size() + all.keep_out.size())) {
    fail(fault->code, "", fault->problem, fault->fix);
  }
}

/// Whether the zone is taken.
bool FileZones::add_one(const ListedZone& listed, bool has_none, std::vector<Zone>& zones) {
  ListedZone near;
  Zone zone;
  try {
    near = near_part(listed);
    const double distance = distance_m(near);
    left_.nearest_m = std::min(left_.nearest_m, distance);
    if (distance > farthest_viewpoint_m(mission_)) {
      if (may_go_round(listed)) {
        fail(ErrorCode::value_unsupported, listed.place,
             "a side of the zone is longer than 180 degrees of longitude: it may be meant either way round the earth",
             "cut the zone into parts, at the antimeridian and near the scene");
      }
      ++left_.far;
      left_.swapped += seems_swapped(listed) ? 1 : 0;
      return false;
    }
  } catch (const Error& error) {
    skip(listed, error);
    return false;
  }
  if (listed.heights_fault && !file_.any_height) {
    skip(listed, *listed.heights_fault);
    return false;
  }
  add_heights(listed, has_none, zone);
  std::vector<Zone> holes;
  try {
    // To stay in, holes grow, and would cross what they touch: they are zones to stay out of.
    if (use_ == ZoneUse::keep_in && has_touching_holes(near)) {
      const FileZones out(mission_, file_, ZoneUse::keep_out, globe_, progress_);
      for (const Zone::Ring& hole : std::exchange(near.holes, {})) {
        ListedZone area = near;
        area.outer = hole;
        holes.push_back(out.placed(area, zone));
      }
    }
    zone = placed(near, zone);
  } catch (const Error& error) {
    skip(listed, error);
    return false;
  }
  if (has_no_heights(zone)) {
    skip(listed, Error(ErrorCode::limits_reversed, "over the scene's ground its lower limit is above its upper one",
                       file_.file.string() + ", " + listed.place,
                       "correct its heights, or the levels that they are measured from; or write 'heights: any'"));
    return false;
  }
  const std::string name = file_.file.filename().string() + " " + listed.name;
  add_zone(std::move(zone), name, listed, zones);
  for (Zone& hole : holes) add_zone(std::move(hole), name + " hole", listed, mission_.navigation.keep_out);
  return true;
}

void FileZones::add_to(std::vector<Zone>& zones) {
  const ZoneList list = parse_zones(read_text(file_.file, "file of zones", kMostZoneBytes), file_.file, progress_);
  for (const UnreadZone& unread : list.unread) {
    if (is_for_use(unread.zone)) {
      skip(unread.zone, unread.fault);
    } else {
      ++left_.other_fences;
    }
  }
  bool has_any = false;
  for (const ListedZone& listed : list.zones) {
    progress_.check();
    if (!is_for_use(listed)) {
      ++left_.other_fences;
    } else if (add_one(listed, list.has_no_heights, zones)) {
      has_any = true;
    }
  }
  if (!has_any && !may_be_empty(list)) fail_for_nothing();
  note_left_out(list);
}

}  // namespace

void add_file_zones(Mission& mission, const Progress& callback) {
  const MissionFile& file = mission.as_written;
  if (file.keep_in_files.empty() && file.keep_out_files.empty()) return;
  const std::string first = !file.places.keep_in_files.empty()    ? file.places.keep_in_files[0]
                            : !file.places.keep_out_files.empty() ? file.places.keep_out_files[0]
                                                                  : "";
  const auto& georeference = mission.scene().georeference;
  if (!georeference) {
    throw Error(ErrorCode::not_georeferenced,
                "the scene does not say where on the earth it lies, and files of zones are in longitudes and latitudes",
                first, "give the zones as polygons in the scene frame, or scene.origin");
  }
  const geo::OnGlobe globe(*georeference);
  const core::ProgressReporter progress(callback);
  progress.begin("zones");
  const auto add = [&](const std::vector<ZoneFile>& files, const std::vector<std::string>& places, ZoneUse use,
                       std::vector<Zone>& zones) {
    for (std::size_t i = 0; i < files.size(); ++i) {
      core::with_place(i < places.size() ? places[i] : "", [&] {
        FileZones(mission, files[i], use, globe, progress).add_to(zones);
        return 0;
      });
    }
  };
  add(file.keep_in_files, file.places.keep_in_files, ZoneUse::keep_in, mission.navigation.keep_in);
  add(file.keep_out_files, file.places.keep_out_files, ZoneUse::keep_out, mission.navigation.keep_out);
  progress.finish();
}

}  // namespace vantage::internal::app
