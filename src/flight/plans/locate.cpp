// A plan in the frame of a scene.
#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/input.h"
#include "core/progress_reporter.h"
#include "core/text.h"
#include "flight/plans/arcs.h"
#include "flight/plans/ground_profile.h"
#include "flight/plans/levels.h"
#include "flight/plans/plan_source.h"
#include "geo/local_frame.h"
#include "geo/on_globe.h"
#include "vantage/error.h"
#include "vantage/flight.h"

namespace vantage {
namespace {

namespace plans = internal::flight::plans;
namespace geo = internal::geo;
using Point = Eigen::Vector2d;

/// A corner of the way, before its legs are cut.
struct Corner {
  Vec3 position;                         ///< x and y of the map about the origin, and the height (Locator::scene_of)
  std::optional<double> above_ground_m;  ///< where its height is that
  bool follows_ground = false;           ///< the leg that ends here
  double hold_s = 0, speed_m_s = std::nan(""), cut_m = 0;
  bool is_other_way = false;  ///< FlightPoint::is_other_way
  std::size_t item = 0;
};

/// A circle that the vehicle leaves where it likes. Angles are clockwise from north.
struct Circle {
  Corner centre;
  double radius_m, begin, end;  ///< > 0: clockwise; angles of where it was come to, and of where its turns end
};

[[noreturn]] void fail(ErrorCode code, const std::string& where, const std::string& problem, const std::string& fix) {
  throw Error(code, problem, where, fix);
}

class Locator {
 public:
  Locator(const FlightPlan& plan, const LocateOptions& options)
      : plan_(plan),
        options_(options),
        progress_(options.progress, plan.file),
        levels_(options.georeference, options.levels) {
    check_options();
    if (plan.is_in_scene_frame) return;
    if (!options.georeference) {
      fail(ErrorCode::not_georeferenced, plan.file,
           "the plan is in longitudes and latitudes, and the scene does not say where on the earth it lies",
           "give a scene of a map, or its place: 'origin' under 'scene'");
    }
    frame_.emplace(geo::LonLat{options.georeference->longitude_deg, options.georeference->latitude_deg});
    const internal::geo::OnGlobe globe(*options.georeference);
    if (globe.is_cartesian()) globe_.emplace(*options.georeference);
  }

  LocatedPlan locate();

 private:
  void check_options() const;
  double farthest_m() const { return std::min(options_.farthest_m, geo::kFarthestM); }
  Point local(const Point& horizontal, const std::string& where) const;
  Vec3 scene_of(const Vec3& at) const;
  double level_of(const Point& at, double scene_z) const;
  double home_level(double scene_z);
  std::optional<Point> home_position() const;
  std::optional<double> known_home_z();
  double home_z(const std::string& where);
  std::optional<double> ground_level(const Point& at);
  double ground_z(const Point& at, const std::string& where);
  double stated_home_z(const std::string& where);
  double z_of(const PlanPosition& position, const Point& at, const std::string& where);
  Corner corner_of(std::size_t item);
  void add(Corner corner, bool is_other_way = false);
  void add_waypoint(std::size_t index);
  void add_level_way(const Corner& to, PlanWay way);
  void add_arc(std::size_t index);
  void add_spline(std::size_t index);
  Vec3 spline_begin(std::size_t index, const Corner& to, bool above_ground);
  Vec3 spline_end(std::size_t index, const Corner& from, const Corner& to, bool above_ground);
  bool check_alike(std::size_t spline, const Corner& corner, const Corner& to);
  void add_curve(const std::vector<Vec3>& points, bool above_ground, const Corner& to);
  void add_item(std::size_t index);
  bool add_start(std::size_t index);
  void add_from_any(std::size_t index);
  void add_lap(const Circle& circle, std::size_t next);
  void add_there_and_back(std::size_t index);
  void add_back_to(Corner from, const Corner& to);
  void add_takeoff(std::size_t index);
  void add_loiter(std::size_t index);
  void add_levels(const PlanItem& item, const std::vector<Corner>& circle);
  Point from_centre(const Corner& centre, const Point& at) const;
  std::vector<Corner> circle_corners(const Corner& centre, double angle, double radius_m, double turns);
  void tell_open_circle(std::size_t index);
  void add_landing(std::size_t index);
  bool is_at_home(const Corner& corner) const;
  bool may_circle() const { return plan_.vehicle != PlanVehicle::multirotor; }
  bool may_stop() const { return plan_.vehicle == PlanVehicle::multirotor || plan_.vehicle == PlanVehicle::unknown; }
  void add_return(std::size_t index);
  bool knows_own_radius(std::size_t index, const std::string& about);
  void add_circle_about_home(const Corner& home);
  void add_end();
  double loiter_radius(const PlanItem& item) const;
  double loiter_turns(const PlanItem& item, double radius_m);
  std::vector<Corner> with_cut_corners();
  void add_leg(const Corner& from, const Corner& to);
  void add_following(const Corner& from, const Corner& to, bool is_last);
  void cut_geodesic(const Point& from, const Point& to, double begin, double end, int depth,
                    std::vector<double>& shares) const;
  std::vector<double> leg_shares(const Corner& from, const Corner& to) const;
  std::vector<double> level_shares(const std::vector<double>& shares, double length_m, double climb_m) const;
  Point between(const Point& from, const Point& to, double share) const;
  void push(const Vec3& position, const Corner& to, bool is_last);
  void note(const std::string& text) {
    located_.notes.push_back({WarningCode::plan_assumed, plan_.file + ": " + text});
  }
  const std::string& place(std::size_t item) const { return plan_.items[item].place; }
  /// What is left of the allowed error for circles and corners, and for geodesics.
  double arc_error_m() const { return 0.8 * options_.chord_error_m; }
  double geodesic_error_m() const { return 0.1 * options_.chord_error_m; }

  const FlightPlan& plan_;
  const LocateOptions& options_;
  internal::core::ProgressReporter progress_;
  plans::Levels levels_;
  std::optional<geo::LocalFrame> frame_;         ///< none: the plan is in the scene frame
  std::optional<internal::geo::OnGlobe> globe_;  ///< of a scene whose frame is no map: from a tileset
  std::optional<GroundLevels> ground_;
  std::optional<plans::GroundProfile> profile_;
  std::optional<double> home_z_;
  std::vector<Corner> corners_;
  // Of the last item: where the way to the next one may begin, too.
  std::optional<Circle> circle_;
  std::optional<Corner> other_start_;
  bool is_other_way_ = false;           ///< what is added
  Vec3 spline_tangent_ = Vec3::Zero();  ///< at the end of the last spline
  LocatedPlan located_;
  plans::NotJudged not_judged_{plan_.file, located_.flight.not_judged};
  struct Counts {
    std::size_t timed_circles = 0, level_returns = 0, open_circles = 0;
  } counts_;
  bool has_curves_ = false, has_following_ = false, has_levels_ = false;
  mutable double bent_m_ = 0;  // geodesics lie at most so far from their chords
};

void Locator::check_options() const {
  const auto check = [](bool holds, const char* what) {
    if (!holds) fail(ErrorCode::value_out_of_range, what, "it is not a positive number", "give metres");
  };
  check(options_.chord_error_m > 0 && std::isfinite(options_.chord_error_m), "chord_error_m");
  check(options_.ground_error_m > 0 && std::isfinite(options_.ground_error_m), "ground_error_m");
  check(options_.farthest_m > 0, "farthest_m");
  for (const auto& height : {options_.home_z_m, options_.missing_height_m, options_.return_height_m,
                             options_.loiter_radius_m, options_.levels.sea_level_z_m, options_.levels.undulation_m}) {
    if (height && !std::isfinite(*height)) {
      fail(ErrorCode::value_out_of_range, plan_.file, "a height that is given is not finite", "give metres");
    }
  }
  if (plan_.items.empty()) fail(ErrorCode::plan_empty, plan_.file, "the plan holds no positions", "give another plan");
}

Point Locator::local(const Point& horizontal, const std::string& where) const {
  if (!frame_) return horizontal;
  const geo::LonLat position{horizontal.x(), horizontal.y()};
  Point at = frame_->to_local(position);
  if (at.norm() <= farthest_m()) return at;
  const geo::LonLat swapped{horizontal.y(), horizontal.x()};
  const bool is_swapped = std::abs(swapped.latitude_deg) <= 90 && frame_->to_local(swapped).norm() <= farthest_m();
  fail(ErrorCode::too_far_away, where,
       "the plan is in another place: " + internal::core::number_text(std::round(at.norm() / 1000)) +
           " km from the scene",
       is_swapped ? "longitude and latitude seem to be swapped" : "give the plan and the scene of one place");
}

/// From the map, in which plans are followed, with heights that are level all over, to the scene frame. Of most scenes
/// they are the same.
Vec3 Locator::scene_of(const Vec3& at) const {
  return globe_ ? globe_->to_scene({frame_->to_lonlat(at.head<2>()), at.z()}) : at;
}

/// The height in the map of what has a z in the scene. They differ by less than their distance over the earth's radius.
double Locator::level_of(const Point& at, double scene_z) const {
  constexpr int kSteps = 3;
  double level = scene_z;
  for (int i = 0; globe_ && i < kSteps; ++i) level += scene_z - scene_of({at.x(), at.y(), level}).z();
  return level;
}

/// Asked once: it is kept in home_z_. Where a z lies depends on the place; where the home's is not known, that where
/// the plan begins is taken.
double Locator::home_level(double scene_z) {
  if (!globe_) return scene_z;
  if (const auto at = home_position()) return level_of(*at, scene_z);
  for (const PlanItem& item : plan_.items) {
    if (!item.position.horizontal.allFinite()) continue;
    note("the home's z is taken for the height at the plan's first position, as it does not say where the home is");
    return level_of(local(item.position.horizontal, item.place), scene_z);
  }
  return scene_z;
}

std::optional<Point> Locator::home_position() const {
  if (options_.home) return local(*options_.home, "home");
  if (plan_.home) return local(plan_.home->horizontal, plan_.file + ": home");
  return std::nullopt;
}

/// The height in the map, of the highest ground there.
std::optional<double> Locator::ground_level(const Point& at) {
  if (!ground_) ground_.emplace(*options_.ground);
  if (!globe_) {
    const auto range = ground_->at(at.x(), at.y());
    return range ? std::optional(range->highest_m) : std::nullopt;
  }
  constexpr int kSteps = 3;  // x and y of the scene depend on the height, by centimetres
  double level = 0;
  for (int i = 0; i < kSteps; ++i) {
    const Vec3 point = scene_of({at.x(), at.y(), level});
    const auto range = ground_->at(point.x(), point.y());
    if (!range) return std::nullopt;
    level += range->highest_m - point.z();
  }
  return level;
}

double Locator::ground_z(const Point& at, const std::string& where) {
  if (!options_.ground) {
    fail(ErrorCode::ground_missing, where, "a height above ground is given, and the scene has no ground",
         "give a scene with terrain, or say what of it is ground ('navigation.ground' of a mission)");
  }
  if (const auto level = ground_level(at)) return *level;
  fail(ErrorCode::ground_missing, where,
       "there is no ground below it, at x " + internal::core::number_text(at.x()) + ", y " +
           internal::core::number_text(at.y()) + " of the scene",
       "take a scene that reaches so far");
}

double Locator::stated_home_z(const std::string& where) {
  const PlanPosition& home = *plan_.home;
  switch (home.datum) {
    case HeightDatum::scene_z:
      return home_level(home.height_m);
    case HeightDatum::ellipsoid:
      return home.height_m + levels_.ellipsoid_z(where);
    default:
      return home.height_m + levels_.sea_level_z(where);
  }
}

/// What is given; the ground there; what the plan states.
std::optional<double> Locator::known_home_z() {
  if (home_z_) return home_z_;
  if (options_.home_z_m) return home_z_ = home_level(*options_.home_z_m);
  const std::string where = plan_.file + ": home";
  const bool is_stated = plan_.home && !options_.home && std::isfinite(plan_.home->height_m);
  const bool can_state = is_stated && (plan_.home->datum == HeightDatum::scene_z ||
                                       (plan_.home->datum == HeightDatum::ellipsoid && levels_.knows_ellipsoid()) ||
                                       (plan_.home->datum == HeightDatum::sea_level && levels_.knows_sea_level()));
  const auto at = home_position();
  std::optional<double> ground;
  if (options_.ground && !options_.ground->surface) ground = home_level(options_.ground->plane_z_m);
  if (!ground && options_.ground && at) ground = ground_level(*at);
  if (ground) {
    constexpr double kMuchM = 1;
    const double stated = can_state ? stated_home_z(where) : *ground;
    if (std::abs(stated - *ground) > kMuchM) {
      note("the home is taken to be on the ground of the scene, " +
           internal::core::metres_text(std::abs(stated - *ground)) + (stated > *ground ? " below" : " above") +
           " what the plan says");
    }
    return home_z_ = ground;
  }
  if (can_state) home_z_ = stated_home_z(where);
  return home_z_;
}

double Locator::home_z(const std::string& where) {
  if (const auto z = known_home_z()) return *z;
  const auto at = home_position();
  fail(ErrorCode::height_unknown, where,
       plan_.home && !options_.home && std::isfinite(plan_.home->height_m)
           ? "a height above the home is given, and the scene does not know the level that the home's own height "
             "is measured from"
           : "a height above the home is given, and the height of the home is not known",
       at ? "give the z of the home in the scene with --home-z (home_z_m in Python), or a scene with ground there"
          : "say where the vehicle takes off with --home or --home-z (home or home_z_m in Python)");
}

double Locator::z_of(const PlanPosition& stated, const Point& at, const std::string& where) {
  PlanPosition position = stated;
  const bool is_missing = std::isnan(position.height_m);
  if (is_missing && options_.missing_height_m) position.height_m = *options_.missing_height_m;
  if (std::isnan(position.height_m)) {
    fail(ErrorCode::height_unknown, where, "the plan gives no height here",
         "say how high it is flown with --height (height_m in Python)");
  }
  if (position.datum == HeightDatum::unknown && options_.unknown_heights) position.datum = *options_.unknown_heights;
  switch (position.datum) {
    case HeightDatum::scene_z:
      return level_of(at, position.height_m);
    case HeightDatum::sea_level:
      return position.height_m + levels_.sea_level_z(where);
    case HeightDatum::ellipsoid:
      return position.height_m + levels_.ellipsoid_z(where);
    case HeightDatum::ground:
      return position.height_m + ground_z(at, where);
    case HeightDatum::home:
      return position.height_m + home_z(where);
    case HeightDatum::unknown:
      break;
  }
  fail(ErrorCode::height_unknown, where, "the plan does not say what its heights are measured from",
       "say it with --heights sea, ellipsoid, ground, home or scene (heights in Python)");
}

Corner Locator::corner_of(std::size_t index) {
  const PlanItem& item = plan_.items[index];
  Corner corner;
  corner.item = index;
  corner.hold_s = may_stop() ? item.hold_s : 0;
  corner.speed_m_s = std::isnan(item.speed_m_s) ? plan_.speed_m_s : item.speed_m_s;
  corner.cut_m = item.cut_m;
  corner.follows_ground = item.follows_ground;
  Point at;
  if (item.position.horizontal.allFinite()) {
    at = local(item.position.horizontal, item.place);
  } else if (const auto home = home_position()) {
    at = *home;
  } else {
    fail(ErrorCode::missing_key, item.place, "the item is at the home, and the plan does not say where that is",
         "say where the vehicle takes off with --home (home in Python)");
  }
  corner.position << at, 0;
  if (item.kind != PlanItemKind::return_home && item.kind != PlanItemKind::land) {
    corner.position.z() = z_of(item.position, at, item.place);
    const bool is_above_ground =
        item.position.datum == HeightDatum::ground ||
        (item.position.datum == HeightDatum::unknown && options_.unknown_heights == HeightDatum::ground);
    if (is_above_ground) {
      corner.above_ground_m = std::isnan(item.position.height_m) ? *options_.missing_height_m : item.position.height_m;
    }
  }
  return corner;
}

/// Circles and curves may lead farther than the positions of a plan.
void Locator::add(Corner corner, bool is_other_way) {
  progress_.tick();
  const double away_m = corner.position.head<2>().norm();
  if (frame_ && !(away_m <= farthest_m())) {
    fail(ErrorCode::too_far_away, place(corner.item),
         "the way to it leads " + internal::core::number_text(std::round(away_m / 1000)) + " km from the scene",
         "correct its circle or its curve");
  }
  corner.is_other_way = is_other_way || is_other_way_;
  if (corner.is_other_way) corner.hold_s = 0;
  corners_.push_back(std::move(corner));
}

void Locator::add_waypoint(std::size_t index) {
  const PlanItem& item = plan_.items[index];
  if (!corners_.empty() && item.way != PlanWay::straight) add_level_way(corner_of(index), item.way);
  if (corners_.empty() || (item.arc_deg == 0 && !item.is_spline)) return add(corner_of(index));
  return item.is_spline ? add_spline(index) : add_arc(index);
}

/// The level part of the way from a takeoff, and back where others fly straight.
void Locator::add_level_way(const Corner& to, PlanWay way) {
  const Corner from = corners_.back();
  if (to.position.z() >= from.position.z()) {
    if (way != PlanWay::either) corners_.back().position.z() = to.position.z();
    return;
  }
  Corner down = to;
  down.hold_s = down.cut_m = 0;
  Corner above = down;
  above.above_ground_m.reset();
  above.position.z() = from.position.z();
  if (way == PlanWay::levels) {
    Corner low = from;
    low.position.z() = to.position.z();
    add(low, true);
    add(down, true);
    add_back_to(from, down);
  }
  if (way != PlanWay::either) return add(above);
  add(above, true);
  add(down, true);
  add_back_to(from, down);
}

/// With the corner's height above the ground, or in the map, as third coordinate.
Vec3 with_height(const Corner& corner, bool above_ground) {
  return {corner.position.x(), corner.position.y(), above_ground ? corner.above_ground_m.value() : corner.position.z()};
}

/// Points from the last corner on to `to`: their third coordinate is a height above the ground, or in the map.
void Locator::add_curve(const std::vector<Vec3>& points, bool above_ground, const Corner& to) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    Corner corner = to;
    if (i + 1 < points.size()) {
      corner.hold_s = 0;
      corner.position = points[i];
      corner.follows_ground = above_ground;
      corner.above_ground_m.reset();
      if (above_ground) {
        corner.above_ground_m = points[i].z();
        corner.position.z() = ground_z(points[i].head<2>(), place(to.item)) + points[i].z();
      }
    }
    add(corner);
  }
  has_curves_ = true;
}

/// A circle on the earth about the place where the arc begins; its height changes evenly.
void Locator::add_arc(std::size_t index) {
  const PlanItem& item = plan_.items[index];
  const Corner from = corners_.back(), to = corner_of(index);
  const bool above_ground = to.follows_ground && from.above_ground_m && to.above_ground_m;
  const Point begin = from.position.head<2>();
  std::optional<geo::LocalFrame> about;
  if (frame_) about.emplace(frame_->to_lonlat(begin));
  const Point end =
      about ? about->to_local(frame_->to_lonlat(to.position.head<2>())) : Point(to.position.head<2>() - begin);
  const Point centre = plans::arc_centre(end, item.arc_deg);
  constexpr double kNoChordM = 1e-3;
  if (end.norm() < kNoChordM) return add(to);  // as the autopilot does
  const double turns = std::abs(item.arc_deg) / 360;
  if (!(plans::chord_count(centre.norm(), turns, arc_error_m()) < static_cast<double>(kMostFlightPoints))) {
    fail(ErrorCode::work_too_large, item.place, "the arc takes more than a million chords",
         "allow a larger error of chords");
  }
  const double radius = item.arc_deg > 0 ? centre.norm() : -centre.norm();
  const std::vector<Point> circle = plans::circle_points(-centre, radius, turns, arc_error_m());
  const double first = with_height(from, above_ground).z(), last = with_height(to, above_ground).z();
  std::vector<Vec3> points;
  for (std::size_t i = 1; i < circle.size(); ++i) {
    const Point p = centre + circle[i];
    const Point at = about ? frame_->to_local(about->to_lonlat(p)) : Point(begin + p);
    const double share = static_cast<double>(i) / static_cast<double>(circle.size() - 1);
    points.emplace_back(at.x(), at.y(), first + share * (last - first));
  }
  add_curve(points, above_ground, to);
}

/// The spline of ArduPilot's Copter (its classes SplineCurve and AC_WPNav tell it): a cubic curve whose tangents at its
/// ends follow from the waypoints before and behind, shortened where they are long for its length.
void Locator::add_spline(std::size_t index) {
  const Corner from = corners_.back(), to = corner_of(index);
  const bool above_ground = to.follows_ground && from.above_ground_m && to.above_ground_m;
  check_alike(index, from, to);
  const Vec3 begin = with_height(from, above_ground), end = with_height(to, above_ground);
  Vec3 first = spline_begin(index, to, above_ground), last = spline_end(index, from, to, above_ground);
  spline_tangent_ = last;
  constexpr double kMostOfLength = 4;
  const double most = kMostOfLength * (end - begin).norm(), length = first.norm() + last.norm();
  if (most == 0) return add(to);
  if (length > most) {
    first *= most / length;
    last *= most / length;
  }
  add_curve(plans::spline_points(begin, end, first, last, arc_error_m()), above_ground, to);
}

/// Where a corner's height is not measured as that of the spline's end is, Copter takes tangents of its own: not
/// judged, and false. Of heights above ground some are sent as heights above sea level: no legs follow the ground
/// there.
bool Locator::check_alike(std::size_t spline, const Corner& corner, const Corner& to) {
  const bool is_like = corner.above_ground_m.has_value() == to.above_ground_m.has_value();
  if (is_like && (to.follows_ground || !corner.follows_ground)) return true;
  not_judged_.name(place(spline),
                   "it is a spline, and of the heights before and behind it some are above ground and some are not: "
                   "give all of them in one frame");
  return false;
}

/// How the vehicle comes from the item before: not at all where it stops there.
Vec3 Locator::spline_begin(std::size_t index, const Corner& end, bool above_ground) {
  if (index == 0) return Vec3::Zero();
  const PlanItem& before = plan_.items[index - 1];
  const bool stops = before.kind != PlanItemKind::waypoint || before.hold_s > 0 || corners_.size() < 2;
  if (stops) return Vec3::Zero();
  if (before.is_spline) return spline_tangent_;
  const Corner &from = corners_[corners_.size() - 2], &to = corners_.back();
  if (!check_alike(index, from, end)) return Vec3::Zero();
  return with_height(to, above_ground) - with_height(from, above_ground);
}

/// How it leaves: along the leg to the next item, or before another spline parallel to the line from the item before to
/// the next one.
Vec3 Locator::spline_end(std::size_t index, const Corner& from, const Corner& to, bool above_ground) {
  if (to.hold_s > 0 || index + 1 == plan_.items.size()) return Vec3::Zero();
  const PlanItem& after = plan_.items[index + 1];
  if (after.kind == PlanItemKind::takeoff || after.kind == PlanItemKind::return_home) return Vec3::Zero();
  Corner next = corner_of(index + 1);
  if (after.kind == PlanItemKind::land) {
    next.position.z() = to.position.z();
    next.above_ground_m = to.above_ground_m;
    next.follows_ground = to.follows_ground;
  }
  if (!check_alike(index, next, to)) return Vec3::Zero();
  return with_height(next, above_ground) - with_height(after.is_spline ? from : to, above_ground);
}

constexpr double kSamePlaceM = 1;  // plans round positions to centimetres

/// A multirotor climbs above the home, or where it is, and then goes to the place of the item, or on to the next one at
/// once; a fixed wing climbs on the way to it.
void Locator::add_takeoff(std::size_t index) {
  const Corner corner = corner_of(index);
  const auto home = home_position();
  Corner above = corner;
  above.hold_s = 0;
  above.follows_ground = false;
  above.above_ground_m.reset();
  const bool is_first = corners_.empty();
  if (is_first && home) {
    above.position.head<2>() = *home;
    if (options_.with_ground_legs) {
      Corner below = above;
      below.position.z() = home_z(place(index));
      add(below);
    }
  } else if (!is_first) {
    above.position.head<2>() = corners_.back().position.head<2>();
  }
  const double away_m = (corner.position - above.position).head<2>().norm();
  constexpr double kSameM = 1e-3;
  if (plan_.vehicle == PlanVehicle::fixed_wing || away_m <= kSameM) return add(corner);
  if (plan_.vehicle == PlanVehicle::unknown && !corners_.empty()) {
    const Corner last = corners_.back();
    add(corner, true);
    add_back_to(last, corner);
  }
  if (is_first || above.position.z() > corners_.back().position.z()) add(above);
  const bool is_elsewhere = away_m > kSamePlaceM;
  if (is_elsewhere && is_first) other_start_ = above;
  if (is_elsewhere && !is_first) {
    not_judged_.name(place(index), "it takes off elsewhere than the vehicle is, and some climb where they are");
  }
  add(corner, is_elsewhere);
}

double Locator::loiter_radius(const PlanItem& item) const {
  if (item.loiter_radius_m != 0) return item.loiter_radius_m;
  const double radius = options_.loiter_radius_m.value_or(0);
  if (radius != 0) return std::signbit(item.loiter_radius_m) ? -std::abs(radius) : radius;
  fail(ErrorCode::missing_key, item.place, "the plan leaves the radius of the circle to the vehicle",
       "say how large the circles of the vehicle are with --loiter-radius (loiter_radius_m in Python)");
}

/// For a time: as often as that takes. The time is then in the legs.
double Locator::loiter_turns(const PlanItem& item, double radius_m) {
  if (!item.is_timed) return item.turns;
  const double speed = std::isnan(item.speed_m_s) ? plan_.speed_m_s : item.speed_m_s;
  if (speed > 0) return item.hold_s * speed / (2 * std::numbers::pi * std::abs(radius_m));
  ++counts_.timed_circles;
  return 1;
}

/// The place about the circle's centre, on the earth: the frame bends circles that are far from its origin.
Point Locator::from_centre(const Corner& centre, const Point& at) const {
  if (!frame_) return at - centre.position.head<2>();
  return geo::LocalFrame(frame_->to_lonlat(centre.position.head<2>())).to_local(frame_->to_lonlat(at));
}

/// Clockwise from north; 0 for the origin.
double angle_of(const Point& p) {
  constexpr double kNoDirectionM = 1e-6;
  return p.norm() > kNoDirectionM ? std::atan2(p.x(), p.y()) : 0;
}

/// On the circle from that angle on.
std::vector<Corner> Locator::circle_corners(const Corner& centre, double angle, double radius_m, double turns) {
  if (plans::chord_count(radius_m, turns, arc_error_m()) > static_cast<double>(kMostFlightPoints)) {
    fail(ErrorCode::work_too_large, place(centre.item), "the circles take more than a million chords",
         "allow a larger error of chords");
  }
  std::optional<geo::LocalFrame> about;
  if (frame_) about.emplace(frame_->to_lonlat(centre.position.head<2>()));
  std::vector<Corner> circle;
  for (const Point& p : plans::circle_points(Point(std::sin(angle), std::cos(angle)), radius_m, turns, arc_error_m())) {
    Corner corner = centre;
    corner.hold_s = corner.cut_m = 0;
    corner.position.head<2>() = about ? frame_->to_local(about->to_lonlat(p)) : Point(centre.position.head<2>() + p);
    if (corner.follows_ground && corner.above_ground_m) {
      corner.position.z() = ground_z(corner.position.head<2>(), place(centre.item)) + *corner.above_ground_m;
    }
    circle.push_back(corner);
  }
  has_curves_ = true;
  return circle;
}

/// What circles, and of a vehicle that nobody knows the stay in the centre first: the next item begins at either.
void Locator::add_loiter(std::size_t index) {
  const PlanItem& item = plan_.items[index];
  Corner centre = corner_of(index);
  const bool is_open = item.may_stay && item.loiter_radius_m == 0 && options_.loiter_radius_m.value_or(0) == 0;
  if (is_open) tell_open_circle(index);
  if (item.turns == 0 || is_open) return add_levels(item, {centre});
  if (item.may_stay) {
    const std::optional<Corner> from = corners_.empty() ? std::nullopt : std::optional(corners_.back());
    const bool was_other_way = std::exchange(is_other_way_, true);
    add_levels(item, {centre});
    if (from) add_back_to(*from, centre);
    is_other_way_ = was_other_way;
  }
  const double radius = loiter_radius(item), turns = loiter_turns(item, radius);
  const double begin = corners_.empty() ? 0 : angle_of(from_centre(centre, corners_.back().position.head<2>()));
  const bool is_flown_anyway = is_other_way_ && may_circle();
  std::vector<Corner> circle = circle_corners(centre, begin, radius, is_flown_anyway ? 0 : turns);
  if (!item.is_timed) circle.back().hold_s = centre.hold_s;
  add_levels(item, circle);
  const double end = begin + std::copysign(2 * std::numbers::pi * turns, radius);
  if (may_circle()) circle_ = Circle{centre, radius, begin, end};
  if (item.may_stay) other_start_ = centre;
}

/// A circle, or the place of a stay. It is come to at its own height or at that before, and between these the vehicle
/// may be anywhere on a circle: all of that is flown. Circles lie so close that none of the heights between is farther
/// away than the ground's error. How much of them it flies is not known.
void Locator::add_levels(const PlanItem& item, const std::vector<Corner>& circle) {
  const std::optional<Corner> from = corners_.empty() ? std::nullopt : std::optional(corners_.back());
  const bool above_ground =
      from && circle.front().follows_ground && from->above_ground_m && circle.front().above_ground_m;
  const double last = with_height(circle.front(), above_ground).z(),
               first = from ? with_height(*from, above_ground).z() : last;
  const bool climbs = item.is_climb && first != last;
  for (std::size_t i = 0; i < circle.size(); ++i) add(circle[i], climbs || (item.is_climb && i > 0));
  if (!climbs) return;
  const double steps = circle.size() > 1 ? std::ceil(std::abs(last - first) / (2 * options_.ground_error_m)) : 1;
  if (!(steps * static_cast<double>(circle.size()) < static_cast<double>(kMostFlightPoints))) {
    fail(ErrorCode::work_too_large, item.place, "the circles take more than a million chords",
         "allow larger errors of chords and of the ground");
  }
  for (double step = 1; step <= steps; ++step) {
    for (std::size_t i = 0; i < circle.size(); ++i) {
      Corner corner = circle[i];
      corner.hold_s = 0;
      corner.follows_ground = above_ground && i > 0;  // the first one lies straight above or below the last one
      const double height = last + step / steps * (first - last);
      if (above_ground) corner.above_ground_m = height;
      corner.position.z() = height + (above_ground ? ground_z(corner.position.head<2>(), item.place) : 0);
      add(corner, true);
    }
  }
  add_back_to(*from, circle.front());
  add(circle.back());
  has_levels_ = has_levels_ || circle.size() > 1;
}

/// Goes back to where `to` was come to from.
void Locator::add_back_to(Corner from, const Corner& to) {
  from.hold_s = from.cut_m = 0;
  from.follows_ground = to.follows_ground;
  from.item = to.item;
  add(from, true);
}

/// Tables of waypoints never say which vehicle it is, and are taken as of ArduPilot's Copter; others leave it out.
void Locator::tell_open_circle(std::size_t index) {
  if (plan_.format == PlanFormat::waypoints) {
    ++counts_.open_circles;
  } else {
    not_judged_.name(place(index),
                     "a multirotor stays there, and others circle with a radius of their own: give a plan that names "
                     "the vehicle, or the radius with --loiter-radius (loiter_radius_m in Python)");
  }
}

bool Locator::is_at_home(const Corner& corner) const {
  const auto home = home_position();
  return home && (corner.position.head<2>() - *home).norm() <= kSamePlaceM;
}

/// At the height before, above the place, and down to the ground; above the home only with ground legs. A fixed wing
/// comes down on a slope, and what nobody knows on one of the two ways.
void Locator::add_landing(std::size_t index) {
  const PlanItem& item = plan_.items[index];
  Corner corner = corner_of(index);
  corner.follows_ground = false;
  corner.hold_s = 0;
  Corner below = corner;
  below.hold_s = item.hold_s;
  const Point at = corner.position.head<2>();
  const bool is_first = corners_.empty(), is_home = is_at_home(corner),
             comes_down = !is_first && (options_.with_ground_legs || !is_home);
  if (comes_down || is_first) {
    // Whatever height is stated, it goes on down until it is on the ground.
    std::optional<double> ground;
    if (is_home) {
      ground = known_home_z();
    } else if (options_.ground) {
      ground = ground_level(at);
    }
    below.position.z() = ground ? *ground : z_of(item.position, at, item.place);
    if (!ground) {
      not_judged_.name(item.place,
                       "it lands, and how far down the ground is there is not known: give a scene with ground there "
                       "('navigation.ground' of a mission)");
    }
  }
  corner.position.z() = is_first ? below.position.z() : corners_.back().position.z();
  if (comes_down && plan_.vehicle == PlanVehicle::unknown) {
    const Corner last = corners_.back();
    add(below, true);
    add_back_to(last, below);
  }
  if (!(comes_down && plan_.vehicle == PlanVehicle::fixed_wing)) add(corner);
  if (comes_down) add(below);
}

void Locator::add_return(std::size_t index) {
  Corner corner = corner_of(index);
  double z = corners_.empty() ? home_z(place(index)) : corners_.back().position.z();
  const double stated = plan_.items[index].position.height_m;
  if (options_.return_height_m || std::isfinite(stated)) {
    const double above_m = options_.return_height_m.value_or(stated), least = home_z(place(index)) + above_m;
    constexpr double kSameHeightM = 1e-3;
    if (std::abs(z - least) > kSameHeightM && may_circle() && plan_.format == PlanFormat::qgroundcontrol) {
      not_judged_.name(place(index),
                       "what has wings comes to the height of its return in circles or on the way: let the mission end "
                       "at that height");
    }
    if (z < least && !corners_.empty()) {
      Corner climb = corner, there = corner;
      climb.position = corners_.back().position;
      climb.position.z() = there.position.z() = least;
      climb.hold_s = 0;
      // Near the home it climbs less (PX4, ArduPilot), or not at all (DJI, within 50 m): to any height up to that.
      constexpr double kNearM = 50;
      const double away_m = (there.position - climb.position).norm();
      if (away_m <= kSamePlaceM || away_m >= std::max(above_m, kNearM)) {
        add(climb);
      } else {
        PlanItem item = plan_.items[index];
        item.is_climb = true;
        const bool was_other_way = std::exchange(is_other_way_, true);
        add_levels(item, {climb, there});
        is_other_way_ = was_other_way;
      }
    }
    z = std::max(z, least);
  } else {
    ++counts_.level_returns;
  }
  corner.position.z() = z;
  if (may_circle()) add_circle_about_home(corner);
  add(corner);
  if (!options_.with_ground_legs) return;
  corner.position.z() = home_z(place(index));
  add(corner);
}

/// Whether the radius is given of a circle that the vehicle flies where the plan is over.
bool Locator::knows_own_radius(std::size_t index, const std::string& about) {
  if (options_.loiter_radius_m.value_or(0) != 0) return true;
  if (plan_.vehicle == PlanVehicle::unknown) {
    tell_open_circle(index);
  } else {
    not_judged_.name(place(index), "the vehicle circles about " + about +
                                       ", with a radius of its own: give it with --loiter-radius (loiter_radius_m in "
                                       "Python)");
  }
  return false;
}

/// A fixed wing circles there until the pilot acts. The circle is come to on the way to its centre.
void Locator::add_circle_about_home(const Corner& home) {
  if (!knows_own_radius(home.item, "the home")) return;
  const double begin = corners_.empty() ? 0 : angle_of(from_centre(home, corners_.back().position.head<2>()));
  const std::vector<Corner> circle = circle_corners(home, begin, *options_.loiter_radius_m, is_other_way_ ? 0 : 1);
  for (std::size_t i = 0; i < circle.size(); ++i) add(circle[i], i > 0);
}

/// PX4 lets what has wings circle about the last waypoint until the pilot acts. It comes to the circle from within, on
/// ways of its own: all of the disc is flown, on chords so close that nothing between is farther away than the ground's
/// error. ArduPilot's plans end otherwise (end_in_air).
void Locator::add_end() {
  const std::size_t last = plan_.items.size() - 1;
  const bool circles = plan_.items[last].kind == PlanItemKind::waypoint && may_circle();
  if (plan_.format != PlanFormat::qgroundcontrol || !circles || !knows_own_radius(last, "the last waypoint")) return;
  const Corner centre = corners_.back();
  const double radius = std::abs(*options_.loiter_radius_m);
  for (const Corner& corner : circle_corners(centre, 0, radius, 1)) add(corner, true);
  const double chords = radius / options_.ground_error_m;
  if (!(2 * chords < static_cast<double>(kMostFlightPoints))) {
    fail(ErrorCode::work_too_large, place(last), "the circle takes more than a million chords",
         "allow a larger error of the ground");
  }
  for (double chord = 0; chord < chords; ++chord) {
    const double along = std::acos(1 - 2 * chord / chords), angle = std::fmod(chord, 2) == 0 ? along : -along;
    add(circle_corners(centre, angle, radius, 0).front(), true);
    add(circle_corners(centre, -angle, radius, 0).front(), true);
  }
  has_levels_ = true;
}

std::vector<Corner> Locator::with_cut_corners() {
  std::vector<Corner> corners;
  for (std::size_t i = 0; i < corners_.size(); ++i) {
    progress_.tick();
    const Corner& corner = corners_[i];
    const bool is_turned = corner.cut_m > 0 && i > 0 && i + 1 < corners_.size(),
               is_cut = is_turned && corner.hold_s == 0,
               follows = is_cut && (corner.follows_ground || corners_[i + 1].follows_ground);
    if (follows) {
      not_judged_.name(place(corner.item),
                       "the vehicle turns before it, and how it follows the ground there is not said");
    }
    if (is_turned && !is_cut) not_judged_.name(place(corner.item), "the vehicle turns before it, and is to stay there");
    if (!is_cut || follows) {
      corners.push_back(corner);
      continue;
    }
    // Plans of DJI must not have such; other vehicles turn as they can.
    const auto reach = [&](std::size_t other) {
      const Corner& end = corners_[other];
      const bool is_end = other == 0 || other + 1 == corners_.size();
      return (end.position - corner.position).norm() * (1 + 1e-9) - (is_end ? 0 : end.cut_m);
    };
    if (corner.cut_m > std::min(reach(i - 1), reach(i + 1))) {
      not_judged_.name(place(corner.item), "the vehicle turns before it by more than the legs are long");
    }
    for (const Vec3& position : plans::corner_points(corners_[i - 1].position, corner.position,
                                                     corners_[i + 1].position, corner.cut_m, arc_error_m())) {
      corners.push_back(corner);
      corners.back().position = position;
    }
  }
  return corners;
}

/// The point of the geodesic.
Point Locator::between(const Point& from, const Point& to, double share) const {
  if (!frame_) return from + share * (to - from);
  const geo::LocalFrame about(frame_->to_lonlat(from));
  return frame_->to_local(about.to_lonlat(share * about.to_local(frame_->to_lonlat(to))));
}

/// Halves until the middle is near enough to the chord's: a geodesic of less than 200 km is a parabola in the frame.
void Locator::cut_geodesic(const Point& from, const Point& to, double begin, double end, int depth,
                           std::vector<double>& shares) const {
  constexpr int kDeepest = 16;
  const double middle = (begin + end) / 2;
  const Point chord = (between(from, to, begin) + between(from, to, end)) / 2;
  if (depth == kDeepest || (between(from, to, middle) - chord).norm() <= geodesic_error_m()) return;
  cut_geodesic(from, to, begin, middle, depth + 1, shares);
  shares.push_back(middle);
  cut_geodesic(from, to, middle, end, depth + 1, shares);
}

/// Where a leg is cut, up to its end.
std::vector<double> Locator::leg_shares(const Corner& begin, const Corner& end) const {
  const Point from = begin.position.head<2>(), to = end.position.head<2>();
  std::vector<double> shares;
  if (frame_) {
    // The frame bends a geodesic at the distance d from the origin by less than d / R^2 for each metre: nothing to ask
    // where the sagitta of that is far below what is allowed.
    constexpr double kRadiusM = 6.3e6;
    const double bend = std::max(from.norm(), to.norm()) / (kRadiusM * kRadiusM), length = (to - from).norm();
    const double sagitta = length * length * bend / 8;
    if (sagitta > geodesic_error_m()) cut_geodesic(from, to, 0, 1, 0, shares);
    bent_m_ = std::max(bent_m_, std::min(sagitta, geodesic_error_m()));
  }
  shares.push_back(1);
  const double climb_m = std::abs(end.position.z() - begin.position.z());
  return globe_ ? level_shares(shares, (to - from).norm(), climb_m) : shares;
}

/// The same with parts so short that a way, which the earth bends, is near enough to its chord: with the part t of a
/// leg of length d and climb h it is at (R + t h) e(t d / R), with a unit vector e, whose second derivative is at most
/// (d^2 + 2 d h) / R. What the height adds to R is less than what kRadiusM is too small by.
std::vector<double> Locator::level_shares(const std::vector<double>& shares, double length_m, double climb_m) const {
  constexpr double kRadiusM = 6.3e6;
  const double bend_m = length_m * (length_m + 2 * climb_m) / (8 * kRadiusM);  // of the leg in one part
  std::vector<double> shorter;
  double begin = 0;
  for (const double end : shares) {
    const double share = end - begin, parts = std::max(std::ceil(share * std::sqrt(bend_m / geodesic_error_m())), 1.0);
    for (double part = 1; part < parts; ++part) shorter.push_back(begin + share * part / parts);
    shorter.push_back(end);
    bent_m_ = std::max(bent_m_, bend_m * share / parts * share / parts);
    begin = end;
  }
  return shorter;
}

void Locator::push(const Vec3& position, const Corner& to, bool is_last) {
  progress_.tick();
  if (located_.flight.points.size() >= kMostFlightPoints) {
    fail(ErrorCode::work_too_large, place(to.item), "the flight takes more than a million points",
         "take a part of the plan, or allow larger errors of chords and of the ground");
  }
  FlightPoint& point = located_.flight.points.emplace_back();
  point.position = position;
  point.hold_s = is_last ? to.hold_s : 0;
  point.speed_m_s = to.speed_m_s;
  point.place = place(to.item);
  point.is_other_way = to.is_other_way;
  located_.items.push_back(to.item);
}

/// From the point that was pushed last.
void Locator::add_leg(const Corner& from, const Corner& to) {
  const Point a = from.position.head<2>(), b = to.position.head<2>();
  const bool follows = to.follows_ground && from.above_ground_m && to.above_ground_m;
  Corner begin = from, end = to;
  for (const double share : leg_shares(from, to)) {
    const bool is_last = share == 1;
    end = to;
    if (!is_last) {
      end.position.head<2>() = between(a, b, share);
      end.position.z() = from.position.z() + share * (to.position.z() - from.position.z());
      end.hold_s = 0;
      if (follows) end.above_ground_m = *from.above_ground_m + share * (*to.above_ground_m - *from.above_ground_m);
    }
    if (follows) {
      add_following(begin, end, is_last);
    } else {
      push(scene_of(end.position), end, is_last);
    }
    begin = end;
  }
}

void Locator::add_following(const Corner& from, const Corner& to, bool is_last) {
  if (!options_.ground) (void)ground_z(to.position.head<2>(), place(to.item));
  if (!profile_) profile_.emplace(*options_.ground);
  has_following_ = true;
  const Vec3 first = scene_of(from.position), last = scene_of(to.position);
  std::vector<plans::ProfilePoint> profile = profile_->along(first.head<2>(), last.head<2>());
  if (profile.empty()) {
    fail(ErrorCode::ground_missing, place(to.item), "the way to it follows the ground, and leaves it",
         "take a scene that reaches so far");
  }
  const auto above = [&](double share) {
    return *from.above_ground_m + share * (*to.above_ground_m - *from.above_ground_m);
  };
  for (plans::ProfilePoint& point : profile) point.z_m += above(point.share);
  profile = plans::thinned(profile, options_.ground_error_m);
  // Where the ground jumps at an end, the way goes up or down there.
  constexpr double kSameM = 1e-6;
  const auto push_at = [&](double share, double z, bool is_end) {
    const Point at = first.head<2>() + share * (last - first).head<2>();
    push({at.x(), at.y(), z}, to, is_end);
  };
  const bool jumps_at_begin = std::abs(profile.front().z_m - located_.flight.points.back().position.z()) > kSameM;
  const bool jumps_at_end = is_last && std::abs(profile.back().z_m - last.z()) > kSameM;
  for (std::size_t i = jumps_at_begin ? 0 : 1; i < profile.size(); ++i) {
    push_at(profile[i].share, profile[i].z_m, is_last && !jumps_at_end && i + 1 == profile.size());
  }
  if (jumps_at_end) push_at(1, last.z(), true);
}

/// To the item and back.
void Locator::add_there_and_back(std::size_t index) {
  const std::size_t first = corners_.size();
  const Counts counts = counts_;
  add_item(index);
  counts_ = counts;  // it is counted again
  circle_.reset();
  other_start_.reset();
  for (std::size_t i = corners_.size(); i-- > first;) add_back_to(corners_[i - 1], corners_[i]);
}

/// Once round the circle, back to where its turns end. Vehicles with wings leave it where they head for the next item,
/// on a tangent, or on the line from its centre to that.
void Locator::add_lap(const Circle& circle, std::size_t next) {
  constexpr double kTurn = 2 * std::numbers::pi;
  std::vector<double> stops;  // how many turns from the end of its turns on
  const auto stop_at = [&](double angle) {
    const double turns = (angle - circle.end) / kTurn * (circle.radius_m < 0 ? -1 : 1),
                 share = turns - std::floor(turns);
    constexpr double kSame = 1e-9;
    if (kSame < share && share < 1 - kSame) stops.push_back(share);
  };
  if (next < plan_.items.size()) {
    const Point to = from_centre(circle.centre, corner_of(next).position.head<2>());
    const double angle = angle_of(to), radius = std::abs(circle.radius_m);
    stop_at(circle.begin);
    stop_at(angle);
    if (to.norm() > radius) {
      stop_at(angle - std::acos(radius / to.norm()));
      stop_at(angle + std::acos(radius / to.norm()));
    }
    std::sort(stops.begin(), stops.end());
  }
  double at = 0;
  const auto go_on_to = [&](double stop) {
    const double angle = circle.end + std::copysign(kTurn * at, circle.radius_m);
    const std::vector<Corner> part = circle_corners(circle.centre, angle, circle.radius_m, stop - at);
    for (std::size_t i = 1; i < part.size(); ++i) add(part[i]);
    at = stop;
  };
  for (const double stop : stops) {
    go_on_to(stop);
    add_there_and_back(next);
  }
  go_on_to(1);
}

/// A mission without a takeoff: it comes from above the home at the height of its first item, or on a slope. That it
/// begins there is not certain: it may be in the air.
bool Locator::add_start(std::size_t index) {
  const PlanItem& item = plan_.items[index];
  const bool is_mission = plan_.format == PlanFormat::qgroundcontrol || plan_.format == PlanFormat::waypoints ||
                          plan_.format == PlanFormat::wpml,
             is_in_air = item.kind == PlanItemKind::waypoint || item.kind == PlanItemKind::loiter;
  const auto home = home_position();
  if (!is_mission || !is_in_air || !corners_.empty() || !home) return false;
  Corner corner = corner_of(index);
  if (!options_.with_ground_legs && is_at_home(corner)) return false;
  corner.follows_ground = false;
  corner.above_ground_m.reset();
  Corner above = corner;
  above.position.head<2>() = *home;
  if (options_.with_ground_legs) {
    Corner below = above;
    below.position.z() = home_z(item.place);
    add(below, true);
    if (plan_.vehicle == PlanVehicle::unknown) {
      add(corner, true);
      add(below, true);
    }
  }
  if (plan_.vehicle != PlanVehicle::fixed_wing) add(above, true);
  return !corners_.empty();
}

/// The item, from all places where the vehicle may leave the one before: nobody knows then on which way it is come to.
/// Behind the last item that is but the rest of its circle.
void Locator::add_from_any(std::size_t index) {
  auto circle = std::exchange(circle_, std::nullopt);
  auto start = std::exchange(other_start_, std::nullopt);
  const bool is_over = index == plan_.items.size();
  is_other_way_ = true;
  if (circle) {
    if (!is_over) circle->centre.item = index;
    add_lap(*circle, index);
  }
  if (start && !is_over) {
    Corner here = corners_.back();
    here.item = start->item = index;
    add(*start);
    add_there_and_back(index);
    add(here);
  }
  is_other_way_ = false;
  if (is_over) return;
  const bool is_start = add_start(index);
  const std::size_t first = corners_.size();
  add_item(index);
  if (!circle && !start && !is_start) return;
  std::size_t last = plan_.items[index].is_spline ? corners_.size() - 1 : first;
  while (last + 1 < corners_.size() && corners_[last].is_other_way) ++last;
  for (std::size_t i = first; i <= last; ++i) corners_[i].is_other_way = true;
  if (corners_[last].cut_m > 0) return;
  // It is there whichever way it came.
  Corner there = corners_[last];
  there.is_other_way = there.follows_ground = false;
  corners_[last].hold_s = 0;
  corners_.insert(corners_.begin() + static_cast<std::ptrdiff_t>(last) + 1, there);
}

void Locator::add_item(std::size_t index) {
  switch (plan_.items[index].kind) {
    case PlanItemKind::waypoint:
      return add_waypoint(index);
    case PlanItemKind::takeoff:
      return add_takeoff(index);
    case PlanItemKind::loiter:
      return add_loiter(index);
    case PlanItemKind::land:
      return add_landing(index);
    case PlanItemKind::return_home:
      return add_return(index);
  }
}

LocatedPlan Locator::locate() {
  located_.flight.not_judged = plan_.not_judged;
  progress_.begin("locate the plan");
  std::size_t stays = 0;
  for (std::size_t i = 0; i < plan_.items.size(); ++i) {
    const PlanItem& item = plan_.items[i];
    // DJI's takeoff: nobody knows where.
    if (i == 0 && plan_.format == PlanFormat::wpml && item.kind == PlanItemKind::takeoff && !home_position()) continue;
    const bool passes = item.hold_s > 0 && !item.is_timed && item.kind != PlanItemKind::land && !may_stop();
    stays += passes ? 1 : 0;
    add_from_any(i);
    if (corners_.size() > kMostFlightPoints) {
      fail(ErrorCode::work_too_large, place(i), "the flight takes more than a million points",
           "take a part of the plan, or allow a larger error of chords");
    }
  }
  add_from_any(plan_.items.size());
  add_end();
  for (const Corner& corner : corners_) has_curves_ = has_curves_ || corner.cut_m > 0;
  const std::vector<Corner> corners = with_cut_corners();
  for (std::size_t i = 0; i < corners.size(); ++i) {
    if (i == 0) {
      push(scene_of(corners[i].position), corners[i], true);
    } else {
      add_leg(corners[i - 1], corners[i]);
    }
  }
  located_.flight.chord_error_m = (has_curves_ ? options_.chord_error_m : 2 * bent_m_) +
                                  (has_following_ ? options_.ground_error_m : 0) +
                                  (has_levels_ ? options_.ground_error_m : 0);
  const auto home = home_position();
  if (home && known_home_z()) located_.home = scene_of({home->x(), home->y(), *known_home_z()});
  using internal::core::count_text;
  if (stays > 0) {
    note(count_text(stays, "stay is", "stays are") + " taken as none: a vehicle with wings does not stop there");
  }
  if (counts_.timed_circles > 0) {
    note(count_text(counts_.timed_circles, "loiter is", "loiters are") +
         " for a time, and no speed is known: one circle is taken");
  }
  if (counts_.open_circles > 0) {
    note(count_text(counts_.open_circles, "loiter or return is", "loiters or returns are") +
         " taken as a stay, as of a multirotor: others circle there, judged where the radius is given with "
         "--loiter-radius (loiter_radius_m in Python)");
  }
  if (counts_.level_returns > 0) {
    note(
        "the return to the home is taken at the height of the last item: the height that the vehicle is set to is not "
        "in the plan");
  }
  check_flight_points(located_.flight);
  return std::move(located_);
}

}  // namespace

LocatedPlan locate_flight(const FlightPlan& plan, const LocateOptions& options) {
  return Locator(plan, options).locate();
}

}  // namespace vantage
