#include "flight/plans/mission_items.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <numbers>
#include <optional>
#include <unordered_map>
#include <utility>

#include "common/input.h"
#include "core/text.h"

namespace vantage::internal::flight::plans {
namespace {

constexpr double kNotGiven = std::numeric_limits<double>::quiet_NaN();

/// What a height of 0 is for a waypoint or a loiter.
enum class ZeroHeight {
  flown,         ///< a height as any other: PX4
  keeps,         ///< that of the item before: ArduPilot's Copter
  keeps_here,    ///< the same where the item has no position: ArduPilot's Plane
  unknown,       ///< one of these: the plan does not say which vehicle flies it
  unknown_here,  ///< flown, or keeps_here: a fixed wing of an autopilot that the plan does not say
};

/// Runs one item after the other.
class Runner {
 public:
  Runner(const std::vector<MissionItem>& mission, const PlanSource& source, Autopilot autopilot, FlightPlan& plan)
      : mission_(mission),
        source_(source),
        autopilot_(autopilot),
        plan_(plan),
        zero_height_(zero_height()),
        not_judged_(source.name, plan.not_judged),
        jumps_left_(mission.size(), -1) {
    for (std::size_t i = 0; i < mission.size(); ++i) {
      if (mission[i].id < 0) continue;
      const auto [at, is_new] = index_of_.emplace(mission[i].id, i);
      if (!is_new) at->second = mission.size();  // one of several
    }
  }

  void run();

 private:
  bool move(const MissionItem& item);  ///< false for a command of another kind
  bool set(const MissionItem& item);   ///< likewise
  void loiter(const MissionItem& item, double radius_m, double turns, double hold_s);
  void delay(const MissionItem& item);
  void land(const MissionItem& item);
  void turn_camera(const MissionItem& item);
  void come_to(const MissionItem& item);
  bool come_on_arc(const MissionItem& item);
  void leave_out(const MissionItem& item);
  void look_at_slope(const PlanItem& before, const MissionItem& item, const PlanItem& added);
  double circled_radius(const MissionItem& item, double radius_m);
  void end_in_air();
  void not_judged(const MissionItem& item, const std::string& why) { not_judged_.name(item.place, why); }
  ZeroHeight zero_height() const;
  bool may_be_ardupilot() const { return autopilot_ != Autopilot::px4; }
  /// ArduPilot stores whole seconds.
  double stay_s(double seconds) const { return std::max(may_be_ardupilot() ? std::floor(seconds) : seconds, 0.0); }
  bool has_wings() const { return plan_.vehicle == PlanVehicle::fixed_wing || plan_.vehicle == PlanVehicle::vtol; }
  std::optional<std::size_t> jump(std::size_t at);
  PlanItem& add(PlanItemKind kind, const MissionItem& item);
  void take_zero_height(const PlanItem* before, bool is_here, const MissionItem& item, PlanItem& added);
  void keep_height(const PlanItem& before, const MissionItem& item, PlanItem& added);
  void look_for_fences_and_returns();
  void add_notes();
  void note(WarningCode code, const std::string& text) { plan_.notes.push_back({code, source_.name + ": " + text}); }
  [[noreturn]] static void fail(ErrorCode code, const MissionItem& item, const std::string& problem,
                                const std::string& fix) {
    PlanSource::fail_at(code, item.place, problem, fix);
  }

  const std::vector<MissionItem>& mission_;
  const PlanSource& source_;
  Autopilot autopilot_;
  FlightPlan& plan_;
  ZeroHeight zero_height_;
  NotJudged not_judged_;
  std::unordered_map<long long, std::size_t> index_of_;
  std::vector<long long> jumps_left_;  // of each DO_JUMP; -1: not come to yet
  bool is_over_ = false;
  bool has_end_ = true;  // the vehicle goes on by itself behind the last item
  // What holds for the items to come.
  double speed_m_s_ = kNotGiven;
  std::optional<double> yaw_deg_, gimbal_yaw_deg_, gimbal_pitch_deg_;
  bool gimbal_yaw_from_north_ = false;
  std::optional<PlanPosition> look_at_;
  // For notes.
  std::map<std::string, std::size_t> unknown_;
  std::size_t splines_ = 0, old_arcs_ = 0, airspeeds_ = 0, unlimited_ = 0, climbs_ = 0, endless_jumps_ = 0,
              kept_heights_ = 0, not_flown_ = 0, settings_ = 0, until_times_ = 0, cut_corners_ = 0;
  double widest_cut_m_ = 0;
};

void Runner::run() {
  // Each step is an item or a jump; a jump takes one of a count, or leads on.
  std::size_t steps = 0;
  for (std::size_t at = 0; at < mission_.size() && !is_over_;) {
    source_.progress.tick();
    const MissionItem& item = mission_[at];
    if (++steps > 4 * kMostPlanItems || plan_.items.size() > kMostPlanItems) {
      fail(ErrorCode::value_out_of_range, item,
           "with its jumps the plan has more than " + std::to_string(kMostPlanItems) + " items",
           "let it jump less often");
    }
    if (!item.goes_on && autopilot_ != Autopilot::ardupilot && at + 1 < mission_.size()) {
      not_judged(item,
                 "it does not lead on (autoContinue), and some autopilots stay or circle there until the pilot acts");
    }
    if (item.command == kDoJump) {
      at = jump(at).value_or(at + 1);
      continue;
    }
    if (!move(item) && !set(item) && !moves_nothing(item)) leave_out(item);
    ++at;
    if (is_over_) not_flown_ = mission_.size() - at;
  }
  end_in_air();
  look_for_fences_and_returns();
  add_notes();
}

/// Autopilots of which nothing is known, and ArduPilot's other vehicles, have one rule or the other. Tables are taken
/// as of ArduPilot's Copter.
ZeroHeight Runner::zero_height() const {
  if (plan_.format == PlanFormat::waypoints) return ZeroHeight::keeps;
  if (autopilot_ == Autopilot::px4) return ZeroHeight::flown;
  if (autopilot_ == Autopilot::unknown) return has_wings() ? ZeroHeight::unknown_here : ZeroHeight::unknown;
  if (has_wings()) return ZeroHeight::keeps_here;
  return plan_.vehicle == PlanVehicle::multirotor ? ZeroHeight::keeps : ZeroHeight::unknown;
}

/// ArduPilot's Plane returns when the mission is over; PX4 circles about the last waypoint (Locator::add_end).
void Runner::end_in_air() {
  if (is_over_ || plan_.items.empty() || !has_wings() || !may_be_ardupilot() || !has_end_) return;
  MissionItem end;
  end.place = source_.place("end of the mission");
  if (autopilot_ == Autopilot::unknown) {
    return not_judged(end, "some vehicles circle there, and others return to the home: let it end with a return (20)");
  }
  add(PlanItemKind::return_home, end);
}

/// Wherever they are: also behind the return. PX4 takes any landing for one to return to, ArduPilot does not.
void Runner::look_for_fences_and_returns() {
  const auto count = [this](int first, int last) {
    return std::count_if(mission_.begin(), mission_.end(),
                         [&](const MissionItem& item) { return first <= item.command && item.command <= last; });
  };
  const auto has = [&](int command) { return count(command, command) > 0; };
  name_rally_points(static_cast<std::size_t>(count(kRallyPoint, kRallyPoint)), plan_);
  if (count(kFencePolygonIn, kFenceCircleOut) > 0) note_fence(plan_);
  const bool is_ardupilot = autopilot_ == Autopilot::ardupilot || plan_.format == PlanFormat::waypoints;
  const bool lands = !is_ardupilot && (has(kNavLand) || has(kNavVtolLand));
  const char* const way = has(kDoLandStart)         ? "a landing (DO_LAND_START)"
                          : has(kDoReturnPathStart) ? "a way back (DO_RETURN_PATH_START)"
                                                    : "a landing";
  if (has(kDoLandStart) || has(kDoReturnPathStart) || lands) {
    name_returns(std::string("the plan has ") + way + ", and the vehicle may fly to it instead of the home", plan_);
  }
}

PlanItem& Runner::add(PlanItemKind kind, const MissionItem& item) {
  PlanItem& added = plan_.items.emplace_back();
  added.kind = kind;
  added.place = item.place;
  if (kind != PlanItemKind::return_home) {
    added.position = position_of(item);
    const PlanItem* const before = plan_.items.size() > 1 ? &*std::prev(plan_.items.end(), 2) : nullptr;
    const bool is_here = !added.position.horizontal.allFinite();
    const bool has_before = before && before->position.horizontal.allFinite();
    if (is_here && (has_before || kind != PlanItemKind::takeoff)) {
      if (!has_before) {
        fail(ErrorCode::plan_empty, item, "the item has no position, and none is before it", "give it one");
      }
      added.position.horizontal = before->position.horizontal;
      const bool may_circle = before->turns > 0 && !(before->may_stay && before->loiter_radius_m == 0);
      if (may_circle) not_judged(item, "it has no position, and the circle before it may end anywhere on it");
    }
    const bool may_keep = kind == PlanItemKind::waypoint || kind == PlanItemKind::loiter;
    if (may_keep && added.position.height_m == 0) take_zero_height(before, is_here, item, added);
    if (may_keep && before) look_at_slope(*before, item, added);
    added.follows_ground = added.position.datum == HeightDatum::ground && before &&
                           before->position.datum == HeightDatum::ground && item.frame != kGlobal;
  }
  has_end_ = kind != PlanItemKind::land && item.command != kNavLoiterUnlimited;
  added.speed_m_s = speed_m_s_;
  added.yaw_deg = yaw_deg_;
  added.gimbal_yaw_deg = gimbal_yaw_deg_;
  added.gimbal_yaw_from_north = gimbal_yaw_from_north_;
  added.gimbal_pitch_deg = gimbal_pitch_deg_;
  added.look_at = look_at_;
  return added;
}

/// Where nobody knows which vehicle it is, that does not matter if the height before is 0, too. The first item comes
/// from the home. ArduPilot's Copter climbs in a loiter to its own height, also to 0.
void Runner::take_zero_height(const PlanItem* before, bool is_here, const MissionItem& item, PlanItem& added) {
  if (item.command == kNavLoiterToAltitude && zero_height_ == ZeroHeight::keeps) return;
  const bool keeps = zero_height_ == ZeroHeight::keeps || (is_here && zero_height_ == ZeroHeight::keeps_here);
  const bool is_open = zero_height_ == ZeroHeight::unknown || (is_here && zero_height_ == ZeroHeight::unknown_here);
  if (keeps && before) keep_height(*before, item, added);
  if (!is_open) return;
  const PlanPosition kept = before ? before->position : PlanPosition{{0, 0}, 0, HeightDatum::home};
  if (kept.height_m == 0 && kept.datum == added.position.datum) return;
  not_judged(item,
             "its height of 0 keeps the height before with some autopilots, and is one to fly at with others: write "
             "the height, or give a .plan that names the autopilot and the vehicle");
}

/// The height of where it comes from, in whatever frame.
void Runner::keep_height(const PlanItem& before, const MissionItem& item, PlanItem& added) {
  if (before.kind == PlanItemKind::land || std::isnan(before.position.height_m)) return;
  const bool is_level = before.position.datum == added.position.datum ||
                        (before.position.datum != HeightDatum::ground && added.position.datum != HeightDatum::ground);
  if (!is_level) not_judged(item, "its height of 0 keeps the height before, which is measured from another ground");
  added.position.height_m = before.position.height_m;
  added.position.datum = before.position.datum;
  ++kept_heights_;
}

/// ArduPilot's Plane changes its height on the whole leg only by 15 m or more (ALT_SLOPE_MIN), and if it climbs, from
/// more than 20 m above the home; else as fast as it can.
void Runner::look_at_slope(const PlanItem& before, const MissionItem& item, const PlanItem& added) {
  if (!has_wings() || !may_be_ardupilot() || before.kind == PlanItemKind::land) return;
  constexpr double kLeastChangeM = 15, kLowM = 20;
  const PlanPosition &from = before.position, &to = added.position;
  const double climb_m = from.datum == to.datum ? to.height_m - from.height_m : kNotGiven;
  if (climb_m == 0 || climb_m <= -kLeastChangeM) return;
  double above_home_m = from.datum == HeightDatum::home ? from.height_m : kNotGiven;
  if (from.datum == HeightDatum::sea_level && plan_.home) above_home_m = from.height_m - plan_.home->height_m;
  if (climb_m >= kLeastChangeM && above_home_m > kLowM) return;
  not_judged(item,
             "ArduPilot's Plane may change its height at once on the way to it, or on the whole way: keep the height "
             "before, or change it by 15 m or more, and climb from more than 20 m above the home");
}

/// A waypoint, straight or on a spline.
void Runner::come_to(const MissionItem& item) {
  const auto& p = item.parameters;
  const auto or_zero = [&](std::size_t i) { return std::isnan(p[i]) ? 0 : p[i]; };
  const bool is_spline = item.command == kNavSpline;
  const bool is_behind_arc = !plan_.items.empty() && plan_.items.back().arc_deg != 0;
  if (is_spline && is_behind_arc) not_judged(item, "it is a spline behind an arc");
  PlanItem& added = add(PlanItemKind::waypoint, item);
  added.hold_s = stay_s(or_zero(0));
  added.is_spline = is_spline;
  splines_ += is_spline ? 1 : 0;
  added.acceptance_radius_m = is_spline ? 0 : or_zero(1);
  if (added.acceptance_radius_m > 0 && (added.hold_s == 0 || has_wings())) {
    ++cut_corners_;
    widest_cut_m_ = std::max(widest_cut_m_, added.acceptance_radius_m);
  }
  if (!is_spline && or_zero(2) != 0) {
    not_judged(item, "its third parameter, " + shortest(p[2]) + ", lets the vehicle pass by the waypoint: write 0");
  }
  // 0 is north in the standard, and "not given" to those who write the files.
  if (or_zero(3) != 0) added.yaw_deg = p[3];
}

bool Runner::move(const MissionItem& item) {
  const auto& p = item.parameters;
  const auto or_zero = [&](std::size_t i) { return std::isnan(p[i]) ? 0 : p[i]; };
  switch (item.command) {
    case kNavSpline:
    case kNavWaypoint:
      come_to(item);
      return true;
    case kNavArc:
      return come_on_arc(item);
    case kDoOrbit: {  // of param4 radians
      const double turns = std::abs(or_zero(3)) / (2 * std::numbers::pi);
      unlimited_ += turns == 0 ? 1 : 0;
      loiter(item, or_zero(0), turns == 0 ? 1 : turns, 0);
      if (p[1] > 0) plan_.items.back().speed_m_s = p[1];
      return true;
    }
    case kNavLoiterUnlimited:
      ++unlimited_;
      loiter(item, or_zero(2), 1, 0);
      return true;
    case kNavLoiterTurns: {  // no number, or one below 0: a whole circle at least
      const double turns = p[0] > 0 ? p[0] : std::max(std::abs(or_zero(0)), 1.0);
      loiter(item, or_zero(2), turns, 0);
      constexpr double kMostTurns = 255;
      if (may_be_ardupilot() && (turns > kMostTurns || turns != std::floor(turns))) {
        not_judged(item, "ArduPilot rounds the number of its turns: write a whole one, up to 255");
      }
      return true;
    }
    case kNavLoiterTime:
      loiter(item, or_zero(2), 1, stay_s(or_zero(0)));
      return true;
    case kNavLoiterToAltitude:
      climbs_ += plan_.vehicle == PlanVehicle::multirotor ? 0 : 1;
      loiter(item, or_zero(1), 1, 0);
      return true;
    case kNavReturn:
      add(PlanItemKind::return_home, item);
      is_over_ = true;
      return true;
    case kNavLand:
    case kNavVtolLand:
      land(item);
      return true;
    case kNavTakeoff:
      add(PlanItemKind::takeoff, item);
      if (has_wings() && may_be_ardupilot()) {
        not_judged(item,
                   "ArduPilot's Plane climbs straight ahead from where it stands, whatever the place: take off by "
                   "hand, and judge the plan without its takeoff");
      }
      return true;
    case kNavVtolTakeoff:  // 0, 1: it turns to the next waypoint
      add(PlanItemKind::takeoff, item);
      if (or_zero(1) != 0 && or_zero(1) != 1) {
        not_judged(item, "its second parameter, " + shortest(p[1]) + ", lets the vehicle fly off another way: write 1");
      }
      return true;
    case kNavDelay:
      delay(item);
      return true;
    default:
      return false;
  }
}

/// ArduPilot stores whole metres, of turns whole tens of them above 255; its Plane circles for a time with a radius of
/// its own.
double Runner::circled_radius(const MissionItem& item, double radius_m) {
  if (!may_be_ardupilot() || item.command == kDoOrbit || radius_m == 0) return radius_m;
  const bool is_of_turns = item.command == kNavLoiterTurns;
  constexpr double kMostWholeM = 255, kMostM = 2550;
  double stored_m = std::floor(std::abs(radius_m));
  if (is_of_turns && stored_m > kMostWholeM) stored_m = 10 * std::floor(std::min(stored_m, kMostM) / 10);
  if (item.command == kNavLoiterTime) stored_m = 0;
  const double flown_m = std::copysign(stored_m, radius_m);  // -0: its own, the other way round
  if (autopilot_ == Autopilot::ardupilot || flown_m == radius_m) return flown_m;
  not_judged(item, stored_m == 0
                       ? "some autopilots circle there with the radius that it states, and others with their own: "
                         "give a .plan that names the autopilot"
                       : "some autopilots round its radius: write whole metres, above 255 whole tens, up to 2550");
  return radius_m;
}

/// A multirotor that is told to loiter for a time stays where it is; others circle.
void Runner::loiter(const MissionItem& item, double radius_m, double turns, double hold_s) {
  PlanItem& added = add(PlanItemKind::loiter, item);
  const bool all_circle = item.command == kNavLoiterTurns || item.command == kDoOrbit;
  const bool is_circle = all_circle || plan_.vehicle != PlanVehicle::multirotor;
  added.loiter_radius_m = is_circle ? circled_radius(item, radius_m) : 0;
  added.turns = is_circle ? turns : 0;
  added.may_stay = !all_circle && plan_.vehicle == PlanVehicle::unknown;
  added.is_climb = item.command == kNavLoiterToAltitude;
  added.hold_s = hold_s;
  added.is_timed = is_circle && item.command == kNavLoiterTime;
}

/// A stay where the vehicle is. Nothing with wings stays in the air.
void Runner::delay(const MissionItem& item) {
  const double seconds = std::isnan(item.parameters[0]) ? 0 : item.parameters[0];
  until_times_ += seconds > 0 ? 0 : 1;
  if (plan_.items.empty()) return;
  PlanItem& before = plan_.items.back();
  if (before.is_spline) not_judged(item, "it is a delay behind a spline");
  if (has_wings() && before.kind != PlanItemKind::land) {
    if (seconds != 0) not_judged(item, "it is a delay, and what has wings flies on or circles there, as it is set to");
  } else if (seconds > 0) {
    before.hold_s += seconds;
  }
}

/// The angle, above 0 clockwise, is the first parameter, as in the standard; in early files of ArduPilot the second.
bool Runner::come_on_arc(const MissionItem& item) {
  const double first = std::isnan(item.parameters[0]) ? 0 : item.parameters[0];
  const double second = std::isnan(item.parameters[1]) ? 0 : item.parameters[1];
  const PlanItem* const before = plan_.items.empty() ? nullptr : &plan_.items.back();
  const bool is_behind_waypoint = before && before->kind == PlanItemKind::waypoint && !before->is_spline;
  PlanItem& added = add(PlanItemKind::waypoint, item);
  added.arc_deg = first != 0 ? first : second;
  old_arcs_ += first == 0 && second != 0 ? 1 : 0;
  if (added.arc_deg == 0) return true;  // a straight leg
  constexpr double kMostTurnDeg = 360 * 100;
  if (first != 0 && second != 0) {
    not_judged(item, "it is an arc, and its first two parameters both may be the angle");
  } else if (!is_behind_waypoint) {
    not_judged(item, "it is an arc, and no waypoint is before it that says where the arc begins");
  } else if (!(std::abs(added.arc_deg) <= kMostTurnDeg) || std::remainder(added.arc_deg, 360) == 0) {
    not_judged(item, "it is an arc, and " + shortest(added.arc_deg) + " degrees do not say which");
  } else {
    return true;
  }
  added.arc_deg = 0;
  return true;
}

/// What is not known: it may move the vehicle if it is one of navigation or has a position.
void Runner::leave_out(const MissionItem& item) {
  const char* const mover = name_of_mover(item.command);
  const std::string number = "command " + std::to_string(item.command);
  if (mover) {
    not_judged(item, number + ", " + mover + ", moves the vehicle in a way that is not followed here");
  } else if (item.command <= kLastOfNavigation || is_given(item.parameters[4], item.parameters[5])) {
    not_judged(item, number + " is not known here, and may move the vehicle");
  } else {
    ++unknown_["of " + number];
  }
}

/// At the height before, and then straight down, or for a fixed wing on a slope.
void Runner::land(const MissionItem& item) {
  PlanItem& added = add(PlanItemKind::land, item);
  if (std::isnan(added.position.height_m)) added.position = {added.position.horizontal, 0, HeightDatum::home};
}

bool Runner::set(const MissionItem& item) {
  const auto& p = item.parameters;
  switch (item.command) {
    case kDoChangeSpeed:  // 0: of the air, 1: over ground; others climb
      if (!(p[0] >= 2) && p[1] > 0) {
        speed_m_s_ = p[1];
        airspeeds_ += p[0] != 1 && plan_.vehicle == PlanVehicle::fixed_wing ? 1 : 0;
      } else if (!(p[0] >= 2) && (p[1] == -2 || autopilot_ == Autopilot::px4)) {
        speed_m_s_ = kNotGiven;  // the vehicle's own again
      }
      return true;
    case kDoSetHome:
      if (p[0] != 1 || !plan_.items.empty()) {  // 1: where it is
        not_judged(item,
                   "it sets another home: heights and the return are measured from that, and not the place of takeoff");
      }
      return true;
    case kDoSetParameter:
      ++settings_;
      return true;
    case kDoReturnPathStart:  // look_for_fences_and_returns
    case kDoLandStart:
      return true;
    case kArmDisarm:  // 1: arms
      if (p[0] != 1 && !plan_.items.empty() && plan_.items.back().kind != PlanItemKind::land) {
        not_judged(item, "it disarms the vehicle in flight (COMPONENT_ARM_DISARM)");
      }
      return true;
    case kConditionYaw:
      if (p[3] == 0 && !std::isnan(p[0])) yaw_deg_ = p[0];
      return true;
    case kDoSetRoiLocation:
    case kDoSetRoi:
    case kNavRoi:
    case kDoSetRoiNone:
    case kDoMountControl:
    case kDoGimbalPitchYaw:
      turn_camera(item);
      return true;
    default:
      return false;
  }
}

void Runner::turn_camera(const MissionItem& item) {
  const auto& p = item.parameters;
  constexpr double kLocation = 3;    // MAV_ROI_LOCATION
  constexpr unsigned kYawLock = 16;  // GIMBAL_MANAGER_FLAGS_YAW_LOCK: yaw is from north
  const auto given = [](double angle) { return std::isnan(angle) ? std::nullopt : std::optional(angle); };
  const bool is_location = item.command == kDoSetRoiLocation || (item.command != kDoSetRoiNone && p[0] == kLocation);
  look_at_.reset();
  gimbal_yaw_deg_.reset();
  gimbal_pitch_deg_.reset();
  if (item.command == kDoMountControl) {
    gimbal_pitch_deg_ = given(p[0]);
    gimbal_yaw_deg_ = given(p[2]);
    gimbal_yaw_from_north_ = false;
  } else if (item.command == kDoGimbalPitchYaw) {
    gimbal_pitch_deg_ = given(p[0]);
    gimbal_yaw_deg_ = given(p[1]);
    gimbal_yaw_from_north_ = p[4] >= 0 && p[4] < 1e9 && (static_cast<unsigned>(p[4]) & kYawLock) != 0;
  } else if (is_location) {
    const PlanPosition position = position_of(item);
    if (position.horizontal.allFinite()) look_at_ = position;
  }
}

/// The item to go on with, or nothing where the jump was made often enough. As ArduPilot does, the count goes on when
/// the jump is come to again.
std::optional<std::size_t> Runner::jump(std::size_t at) {
  const MissionItem& item = mission_[at];
  const double id = item.parameters[0], repeat = item.parameters[1];
  const bool is_number = std::abs(id) < 1e15 && id == std::floor(id);
  const auto target = is_number ? index_of_.find(std::llround(id)) : index_of_.end();
  if (target == index_of_.end() || target->second == mission_.size()) {
    fail(ErrorCode::index_out_of_range, item,
         target == index_of_.end() ? "it jumps to an item that is not there" : "it jumps to one of several items",
         "name an item of the plan, by a whole number that no other one has");
  }
  long long& left = jumps_left_[at];
  if (left < 0) {
    if (!(repeat >= -1) || !(repeat <= 1e6)) {
      fail(ErrorCode::value_out_of_range, item, "the number of its jumps is not one that can be followed",
           "give 0 to 1000000, or -1 for jumps without end");
    }
    endless_jumps_ += repeat < 0 ? 1 : 0;
    left = repeat < 0 ? 1 : std::llround(repeat);
  }
  if (left == 0) return std::nullopt;
  --left;
  return target->second;
}

void Runner::add_notes() {
  if (!unknown_.empty()) {
    note(WarningCode::plan_left_out, "items of commands that are not known here were left out: " + counted(unknown_));
  }
  if (not_flown_ > 0) {
    note(WarningCode::plan_left_out,
         core::count_text(not_flown_, "item is", "items are") + " after the return to the home, and not flown");
  }
  if (settings_ > 0) {
    note(WarningCode::plan_left_out, core::count_text(settings_, "item changes", "items change") +
                                         " a setting of the vehicle (DO_SET_PARAMETER), which is not followed");
  }
  const auto assume = [this](std::size_t count, const char* one, const char* many, const char* what) {
    if (count > 0) note(WarningCode::plan_assumed, core::count_text(count, one, many) + what);
  };
  assume(splines_, "spline waypoint is", "spline waypoints are", " taken as the curves of ArduPilot's Copter");
  assume(old_arcs_, "arc has", "arcs have", " the angle in the second parameter instead of the first");
  assume(kept_heights_, "item has", "items have",
         " the height 0, which keeps the height before, as with ArduPilot's Copter (its Plane flies at 0 where a "
         "position is given)");
  assume(airspeeds_, "speed is", "speeds are", " through the air, and taken as over ground");
  assume(unlimited_, "loiter has", "loiters have", " no end: one circle is taken, or a point, and then what follows");
  assume(climbs_, "climb in circles is", "climbs in circles are",
         " taken as circles at all heights from that before: its length and its time are not those of the flight");
  assume(cut_corners_, "waypoint counts", "waypoints count",
         (" as reached up to " + core::metres_text(widest_cut_m_) +
          " before it, and the vehicle may cut the corner by so much: judge it with a tube of that radius (--tube, "
          "tube_m in Python)")
             .c_str());
  assume(until_times_, "delay is", "delays are", " until a time of the day, and taken as none");
  assume(endless_jumps_, "jump has", "jumps have", " no end: taken once");
}

}  // namespace

void run_mission(const std::vector<MissionItem>& mission, const PlanSource& source, Autopilot autopilot,
                 FlightPlan& plan) {
  Runner(mission, source, autopilot, plan).run();
}

void name_returns(const std::string& why, FlightPlan& plan) {
  const auto returns = std::find_if(plan.items.begin(), plan.items.end(),
                                    [](const PlanItem& item) { return item.kind == PlanItemKind::return_home; });
  if (returns != plan.items.end()) plan.not_judged.push_back(returns->place + ": " + why);
}

void name_rally_points(std::size_t count, FlightPlan& plan) {
  if (count == 0) return;
  name_returns("the plan has " + core::count_text(count, "rally point", "rally points") +
                   ", and the vehicle may return to one of them instead of the home",
               plan);
}

void note_fence(FlightPlan& plan) {
  plan.notes.push_back({WarningCode::plan_left_out,
                        plan.file + ": its fence is not judged, only the mission's own zones are: name the file under "
                                    "navigation.keep_in or navigation.keep_out of the mission"});
}

}  // namespace vantage::internal::flight::plans
