#include "app/zone_files.h"

#include <algorithm>
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
  FileZones(Mission& mission, const ZoneFile& file, ZoneUse use, const geo::OnGlobe& globe)
      : mission_(mission), file_(file), use_(use), globe_(globe), walls_(globe, mission) {}

  void add_to(std::vector<Zone>& zones, const core::ProgressReporter& progress);

 private:
  bool is_for_use(const ListedZone& listed) const {
    return !listed.is_inclusion || *listed.is_inclusion == (use_ == ZoneUse::keep_in);
  }
  Zone placed(const ListedZone& listed, bool has_none) const;
  Zone::Ring circle(const ListedCircle& circle, double z_m, double lean_m) const;
  void add_heights(const ListedZone& listed, bool has_none, Zone& zone) const;
  double z_of(const std::optional<ZoneHeight>& height, double without, const std::string& place) const;
  double distance_m(const ListedZone& listed) const;
  Zone::Ring unwrapped(Zone::Ring ring, const std::string& place) const;
  bool seems_swapped(const ListedZone& listed) const;
  void note_left_out(const ZoneList& list, std::size_t other_fences, std::size_t far, std::size_t swapped) const;
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
  ZoneWalls walls_;
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
  const auto position = [&](const Point& p) { return globe_.map().to_local({p.x(), p.y()}); };
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

/// Between its heights, those of the file converted to z.
Zone FileZones::placed(const ListedZone& listed, bool has_none) const {
  Zone zone;
  add_heights(listed, has_none, zone);
  const Heights heights{zone.min_z_m, zone.max_z_m};
  const double middle = walls_.middle_z_m(heights);
  const ToFrame to_frame = [&](const Point& p) { return globe_.at_z({p.x(), p.y()}, middle); };
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
    if (const auto fault = core::fault_of(zone)) fail(fault->code, listed.place, fault->problem, fault->fix);
    extent = extent_of(zone.outer, to_frame);
    zone = in_file(listed, [&] {
      return placed_zone(zone, use_, to_frame, kLonLatAdvice, walls_.lean_m(heights, extent.farthest_m));
    });
  }
  if (file_.z_m || file_.any_height) return zone;
  const Heights z = in_file(listed, [&] { return walls_.z_of(heights, extent, use_); });
  zone.min_z_m = z.low_m;
  zone.max_z_m = z.high_m;
  return zone;
}

void FileZones::note_left_out(const ZoneList& list, std::size_t other_fences, std::size_t far,
                              std::size_t swapped) const {
  std::string what;
  const auto add = [&](std::size_t count, const std::string& one, const std::string& many) {
    if (count == 0) return;
    what += (what.empty() ? "" : ", ") + std::to_string(count) + " " + (count == 1 ? one : many);
  };
  for (const auto& [kind, count] : list.left_out) {
    const bool is_phrase = kind.find(' ') != std::string::npos;
    add(count, kind, is_phrase ? kind : kind + "s");
  }
  const bool is_kept = use_ == ZoneUse::keep_in;
  const MissionFile& mission = mission_.as_written;
  const std::vector<ZoneFile>& others = is_kept ? mission.keep_out_files : mission.keep_in_files;
  const bool takes_others =
      std::any_of(others.begin(), others.end(), [this](const ZoneFile& other) { return other.file == file_.file; });
  if (!takes_others) {
    add(other_fences, is_kept ? "fence to stay out of" : "fence to stay in",
        is_kept ? "fences to stay out of" : "fences to stay in");
  }
  add(far, "zone beyond the reach of the sensor", "zones beyond the reach of the sensor");
  if (what.empty()) return;
  if (swapped > 0) {
    what +=
        "; longitude and latitude of " + std::to_string(swapped) + " of these seem to be swapped, so check the file";
  }
  mission_.notes.push_back({WarningCode::zones_left_out, "not taken as zones to stay " +
                                                             std::string(is_kept ? "in" : "out of") + " from " +
                                                             file_.file.filename().string() + ": " + what});
}

void FileZones::add_to(std::vector<Zone>& zones, const core::ProgressReporter& progress) {
  const ZoneList list = parse_zones(read_text(file_.file, "file of zones", kMostZoneBytes), file_.file, progress);
  std::set<std::string> names;
  for (const Zone& zone : zones) names.insert(zone.name);
  std::size_t taken = 0, other_fences = 0, far = 0, swapped = 0;
  double nearest_m = kInfinity;
  for (const ListedZone& listed : list.zones) {
    progress.check();
    if (!is_for_use(listed)) {
      ++other_fences;
      continue;
    }
    const double distance = distance_m(listed);
    nearest_m = std::min(nearest_m, distance);
    if (distance > farthest_viewpoint_m(mission_)) {
      ++far;
      swapped += seems_swapped(listed) ? 1 : 0;
      continue;
    }
    Zone zone = placed(listed, list.has_no_heights);
    const std::string name = file_.file.filename().string() + " " + listed.name;
    zone.name = name;
    for (int i = 2; !names.insert(zone.name).second; ++i) zone.name = name + " (" + std::to_string(i) + ")";
    if (const auto fault = core::fault_of(zone)) fail(fault->code, listed.place, fault->problem, fault->fix);
    zones.push_back(std::move(zone));
    const Navigation& all = mission_.navigation;
    if (const auto fault = core::fault_of_count(all.keep_in.size() + all.keep_out.size())) {
      fail(fault->code, "", fault->problem, fault->fix);
    }
    ++taken;
  }
  if (taken == 0 && far > 0) {
    fail(ErrorCode::too_far_away, "",
         "the nearest zone lies at least " + std::to_string(std::lround(nearest_m / 1000)) +
             " km from the scene's origin" + (swapped > 0 ? "; longitude and latitude seem to be swapped" : ""),
         swapped > 0 ? "write the longitude before the latitude" : kLonLatAdvice);
  }
  if (taken == 0) {
    const bool is_kept = use_ == ZoneUse::keep_in;
    fail(ErrorCode::nothing_given, "",
         other_fences > 0 ? std::string("the plan has no fence to stay ") + (is_kept ? "in" : "out of")
                          : "the file has no areas",
         other_fences > 0 ? std::string("name it under '") + (is_kept ? "keep_out'" : "keep_in'") + ", or add a fence"
                          : "give polygons or circles: lines and points are no zones");
  }
  note_left_out(list, other_fences, far, swapped);
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
        FileZones(mission, files[i], use, globe).add_to(zones, progress);
        return 0;
      });
    }
  };
  add(file.keep_in_files, file.places.keep_in_files, ZoneUse::keep_in, mission.navigation.keep_in);
  add(file.keep_out_files, file.places.keep_out_files, ZoneUse::keep_out, mission.navigation.keep_out);
  progress.finish();
}

}  // namespace vantage::internal::app
