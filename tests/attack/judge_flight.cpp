#include "judge_flight.h"

#include <array>
#include <numbers>

#include "vantage/error.h"

namespace attack {

FlightJudge::FlightJudge(const DrawnFlight& drawn, const FlightCheck& check, FlightJudgement& result)
    : drawn_(drawn), check_(check), result_(result), scene_(drawn.mission.scene()), random_(drawn.seed ^ 0x666c79) {
  for (std::size_t i = 0; i < volume_count(drawn.mission); ++i) {
    oracles_.push_back(std::make_unique<FlightOracle>(one_volume(drawn.mission, i), scene_));
  }
  radius_ = drawn.options.tube_radius_m + drawn.flight.chord_error_m;
  double largest = 0;
  for (const Vec3& v : drawn.mission.scene().mesh.vertices) largest = std::max(largest, v.cwiseAbs().maxCoeff());
  for (const auto& point : drawn.flight.points) largest = std::max(largest, point.position.cwiseAbs().maxCoeff());
  rounding_ = 32 * kRoundoff * largest;
  near_ = std::min(0.01, 1e-4 * drawn.scale);
}

void FlightJudge::run() {
  if (!has_right_frame()) return;
  for (std::size_t i = 0; i < oracles_.size(); ++i) {
    judge_seen(*oracles_[i], check_.targets[i]);
    if (const OneTarget* single = oracles_[i]->single()) judge_reasons(check_.targets[i], *single);
    judge_gimbal(check_.targets[i]);
  }
  for (const vantage::LinkCheck& link : check_.links) judge_link(link);
  judge_navigation();
  judge_nearest();
  judge_failures();
}

std::vector<FlightPlace> FlightJudge::places(const std::vector<const std::vector<FlightSpan>*>& of, int at_random,
                                             int evenly) {
  std::vector<FlightPlace> result;
  for (std::size_t i = 0; i < leg_count(); ++i) {
    std::vector<double> shares{0, 1};
    const double metres = length(i);
    if (metres > 0) {
      for (int k = 1; k < evenly; ++k) shares.push_back(static_cast<double>(k) / evenly);
      for (int k = 0; k < at_random; ++k) shares.push_back(random_.uniform(0, 1));
      for (const auto* spans : of) {
        for (const FlightSpan& span : *spans) {
          for (const double end : {span.begin_m, span.end_m}) {
            for (const double aside : {-1.01, -0.3, -1e-3, 1e-3, 0.3, 1.01}) {
              shares.push_back((end - begin_m(i) + aside * near_) / metres);
            }
          }
          shares.push_back((random_.uniform(span.begin_m, span.end_m) - begin_m(i)) / metres);
        }
      }
    }
    for (const double share : shares) {
      if (share >= 0 && share <= 1) result.push_back(place(i, share));
    }
  }
  return result;
}

Vec3 FlightJudge::in_tube(const Vec3& p) {
  const double share = random_.chance(0.5) ? 1 : std::cbrt(random_.uniform(0, 1));
  return p + (1 - 1e-9) * share * radius_ * random_.direction();
}

bool FlightJudge::has_right_frame() {
  const bool is_right =
      check_.targets.size() == oracles_.size() && check_.links.size() == drawn_.mission.links.size() &&
      check_.point_at_m.size() == drawn_.flight.points.size() && check_.arrival_s.size() == drawn_.flight.points.size();
  if (!is_right) {
    wrong("sizes", "targets or points");
    return false;
  }
  double at = 0;
  for (std::size_t i = 0; i < drawn_.flight.points.size(); ++i) {
    if (i > 0) at += length(i - 1);
    if (!(std::abs(check_.point_at_m[i] - at) <= 1e-12 * (at + rounding_)))
      wrong("length", "of point " + std::to_string(i));
  }
  for (const auto& target : check_.targets) judge_spans(target.seen, target.name);
  for (const auto& link : check_.links) {
    judge_spans(link.linked, link.name);
    judge_spans(link.lost, link.name);
  }
  for (const auto& limit : check_.broken) judge_spans(limit.spans, limit.name);
  return true;
}

void FlightJudge::judge_spans(const std::vector<FlightSpan>& spans, const std::string& name) {
  double last = -1;
  for (const FlightSpan& span : spans) {
    if (!(span.begin_m <= span.end_m) || span.begin_m < last - slack_m() || span.begin_m < 0 ||
        span.end_m > check_.length_m * (1 + 1e-12)) {
      wrong("spans", name + " are not sorted, or not on the flight");
    }
    last = span.end_m;
    if (!std::isnan(check_.duration_s)) judge_times(span, name);
  }
}

void FlightJudge::judge_times(const FlightSpan& span, const std::string& name) {
  const auto& points = drawn_.flight.points;
  double least = 0, most = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double at = check_.point_at_m[i], slack = 1e-9 * check_.length_m;
    if (std::abs(at - span.begin_m) <= slack || std::abs(at - span.end_m) <= slack) {
      most += points[i].hold_s;
    } else if (at > span.begin_m && at < span.end_m) {
      least += points[i].hold_s;
      most += points[i].hold_s;
    }
    if (i == 0) continue;
    const double from = std::max(span.begin_m, check_.point_at_m[i - 1]), to = std::min(span.end_m, at);
    const double speed = std::isnan(points[i].speed_m_s) ? drawn_.options.speed_m_s.value_or(NAN) : points[i].speed_m_s;
    if (to > from) {
      least += (to - from) / speed;
      most += (to - from) / speed;
    }
  }
  const double slack = 1e-9 * (1 + check_.duration_s);
  if (!(span.duration_s() >= least - slack && span.duration_s() <= most + slack)) {
    wrong("times", name + ", " + std::to_string(span.duration_s()) + " s, not from " + std::to_string(least) + " to " +
                       std::to_string(most));
  }
}

std::vector<std::uint32_t> FlightJudge::ground_objects() const {
  std::vector<std::uint32_t> left_out;
  const auto& objects = drawn_.mission.scene().objects;
  for (std::uint32_t i = 0; i < objects.size(); ++i) {
    if (objects[i].kind == vantage::ObjectKind::ground) left_out.push_back(i);
  }
  return left_out;
}

double FlightJudge::most_wound(const Vec3& place, const std::vector<std::uint32_t>& ground) const {
  const vantage::Scene& scene = drawn_.mission.scene();
  std::vector<double> angles(scene.objects.size(), 0);
  for (std::size_t t = 0; t < scene.mesh.triangles.size(); ++t) {
    std::array<Vec3, 3> c;
    for (std::size_t k = 0; k < 3; ++k) c[k] = (scene.mesh.vertices[scene.mesh.triangles[t][k]] - place).normalized();
    // A. van Oosterom and J. Strackee, 1983, of directions.
    angles[scene.object_of[t]] +=
        2 * std::atan2(c[0].dot(c[1].cross(c[2])), 1 + c[0].dot(c[1]) + c[1].dot(c[2]) + c[2].dot(c[0]));
  }
  for (const std::uint32_t object : ground) angles[object] = 0;
  double most = 0;
  for (const double angle : angles) most = std::max(most, std::abs(angle) / (4 * std::numbers::pi));
  return most;
}

void FlightJudge::judge_nearest() {
  const vantage::Scene& scene = drawn_.mission.scene();
  const std::vector<std::uint32_t> ground = ground_objects();
  const Blockers blockers(
      scene, {drawn_.mission.views.empty() ? drawn_.mission.target.part(0) : drawn_.mission.views[0][0].part(0)});
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < leg_count(); ++i) {
    const Leg local{leg(i).from - blockers.origin, leg(i).to - blockers.origin};
    for (const Blocker& blocker : blockers.triangles) {
      if (std::find(ground.begin(), ground.end(), blocker.object) != ground.end()) continue;
      least = std::min(least, distance_from_leg(local, blocker.corners));
    }
  }
  result_.count("nearest distances");
  const double expected = std::max(0.0, least - radius_), told = check_.nearest.distance_m;
  // LegDistances: twice what rounding may do. Merging: blockers.merging is twice that of half the scene's size.
  const double rounding = 4 * rounding_ + 1e-12 * (std::isfinite(least) ? least : 0) + 4 * blockers.merging;
  if (std::isinf(expected) && std::isinf(told)) return;
  const double wound = least > rounding ? most_wound(leg(0).from, ground) : 0;
  if (told == 0 && wound > 0.25) return;  // inside; several pieces of one object may be wound the other way round
  if (told > 0 && wound > 0.999 && wound < 1.001) wrong("nearest", "the flight is inside of an object");
  if (told > expected + 1e-14 * expected + kRoundoff * rounding_) {
    // Merging may move corners, and triangles as narrow as rounding are dropped: within that either is right.
    if (told > expected + rounding)
      wrong("nearest", std::to_string(told) + " m, and " + std::to_string(expected) + " m are right");
    result_.count("nearest, above by rounding");
  }
  if (told < expected - rounding)
    wrong("nearest, less", std::to_string((expected - told) * 1e12) + " pm, of " + std::to_string(rounding * 1e12) +
                               " pm; " + std::to_string(expected) + " m are right");
}

void FlightJudge::judge_failures() {
  bool fails = !check_.broken.empty();
  for (const vantage::LinkCheck& link : check_.links) fails = fails || !link.lost.empty();
  for (const vantage::TargetCheck& target : check_.targets) {
    if (target.seen.empty()) {
      fails = true;
      continue;
    }
    const FlightSpan& longest = target.seen[*target.longest];
    for (const FlightSpan& span : target.seen) {
      const bool by_time = !std::isnan(check_.duration_s);
      if (by_time ? span.duration_s() > longest.duration_s() : span.length_m() > longest.length_m()) {
        wrong("longest", target.name);
      }
    }
    const double dwell = drawn_.options.dwell_s.value_or(0);
    fails = fails || longest.duration_s() < dwell;
    if (!drawn_.options.gimbal_rate_deg_s) continue;
    fails = fails || !target.followed || target.followed->duration_s() < dwell;
    judge_followed(target, longest);
  }
  fails = fails || check_.nearest.distance_m == 0 || check_.nearest.distance_m < drawn_.options.clearance_m.value_or(0);
  if (fails == check_.passes()) wrong("verdict", fails ? "it passes" : check_.failures[0]);
}

void FlightJudgement::count(const std::string& what, double more) {
  for (auto& [name, so_far] : counts) {
    if (name != what) continue;
    so_far += more;
    return;
  }
  counts.emplace_back(what, more);
}

void FlightJudgement::add_wrong(const std::string& text) {
  const std::string kind = text.substr(0, text.find(':') + 1);
  const bool is_known =
      std::any_of(wrong.begin(), wrong.end(), [&](const std::string& w) { return w.starts_with(kind); });
  if (!is_known) wrong.push_back(text);
}

vantage::FlightCheck ask_check_flight(const DrawnFlight& drawn) {
  return check_flight(drawn.mission, drawn.flight, drawn.options);
}

FlightJudgement judge_flight(const DrawnFlight& drawn, const CheckFlight& ask) {
  FlightJudgement result;
  try {
    const FlightCheck check = ask(drawn);
    FlightJudge(drawn, check, result).run();
    result.words.emplace_back("flight");
    bool is_seen = false;
    for (const auto& target : check.targets) is_seen = is_seen || !target.seen.empty();
    result.words.emplace_back(is_seen ? "flight, something is seen" : "flight, nothing is seen");
    for (const auto& link : check.links) result.words.emplace_back(link.radio ? "flight, radio link" : "flight, link");
    if (check.tube_radius_m > 0) result.words.emplace_back("flight, with a tube");
    if (!check.broken.empty()) result.words.emplace_back("flight, limits are broken");
    if (!drawn.mission.navigation.empty()) result.words.emplace_back("flight, with limits of navigation");
    if (drawn.mission.sensor.limits_view() || drawn.mission.sensor.link)
      result.words.emplace_back("flight, with limits of the sensor");
    if (drawn.mission.views.size() > 0) result.words.emplace_back("flight, several targets or both sides");
  } catch (const vantage::Error& error) {
    result.words.push_back(std::string("flight, refused: ") + name_of(error.code()));
    if (error.kind() != vantage::ErrorKind::input) result.add_wrong(std::string("error: ") + error.what());
  }
  return result;
}

}  // namespace attack
