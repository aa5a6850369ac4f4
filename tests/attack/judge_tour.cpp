// Whether a tour is what was asked for, told by the triangles of the scene and the definitions of limits.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <memory>
#include <numbers>

#include "closed_mesh.h"
#include "flight_margins.h"
#include "flight_oracle.h"
#include "tours.h"
#include "vantage/error.h"

namespace attack {
namespace {

using vantage::Leg;
using vantage::TourVehicle;
using vantage::TourVisit;
using vantage::Vec3;

constexpr double kStepM = 0.1;
constexpr double kTourRoundingM = 1e-9;  // towns are some hundred metres wide

std::string tour_place_text(const Vec3& p) {
  char text[100];
  std::snprintf(text, sizeof text, "(%.9g, %.9g, %.9g)", p.x(), p.y(), p.z());
  return text;
}

class TourJudge {
 public:
  TourJudge(const DrawnTour& drawn, const AnsweredTour& answer, FlightJudgement& result)
      : drawn_(drawn),
        settings_(drawn.settings),
        tour_(answer.tour.tour),
        points_(tour_.flight.points),
        home_(answer.tour.home),
        result_(result),
        is_wing_(drawn.settings.vehicle.kind == TourVehicle::Kind::fixed_wing),
        chord_m_(is_wing_ ? tour_.flight.chord_error_m : 0),
        tube_m_(drawn.mission ? drawn.settings.tube_m : 0) {  // a request keeps none
    at_m_.assign(points_.size(), 0);
    for (std::size_t i = 1; i < points_.size(); ++i) {
      at_m_[i] = at_m_[i - 1] + (points_[i].position - points_[i - 1].position).norm();
    }
  }

  void run() {
    if (points_.empty()) return judge_nothing();
    if (!has_right_targets()) return;
    judge_ends();
    judge_lengths();
    judge_clearance();
    judge_navigation();
    judge_wing();
    judge_visits();
    judge_times();
  }

 private:
  void wrong(const std::string& what, const std::string& more) { result_.add_wrong(what + ": " + more); }
  std::size_t target_count() const { return drawn_.mission ? volume_count(*drawn_.mission) : drawn_.regions.size(); }
  Leg leg(std::size_t i) const { return tour_.flight.leg(i); }

  void judge_nothing() {
    if (tour_.problems.size() != target_count()) wrong("nothing", "and targets without a reason");
  }

  /// Each target is visited, or has its problem.
  bool has_right_targets() {
    std::vector<int> told(target_count(), 0);
    for (const TourVisit& visit : tour_.visits) {
      if (visit.target >= told.size() || visit.first_point > visit.last_point || visit.last_point >= points_.size()) {
        wrong("visit", "out of range");
        return false;
      }
      told[visit.target] = 1;
    }
    for (const vantage::TourProblem& problem : tour_.problems) ++told[problem.target];
    for (const int count : told) {
      if (count != 1) wrong("targets", "neither visited nor left out, or both");
    }
    for (const vantage::FlightPoint& point : points_) {
      if (!point.position.allFinite() || !(point.hold_s >= 0)) wrong("point", "not finite");
    }
    return true;
  }

  void judge_ends() {
    const Vec3 &first = points_.front().position, &last = points_.back().position;
    if (settings_.closed && (first - last).norm() > kTourRoundingM) wrong("closed", tour_place_text(last));
    if (drawn_.mission && drawn_.mission->home) {
      const Vec3 up = first - *drawn_.mission->home;
      if (up.head<2>().norm() > kTourRoundingM || up.z() < 0) wrong("home", "it begins at " + tour_place_text(first));
      judge_climb({*drawn_.mission->home, first});
    }
    if (drawn_.region_home && (first - *drawn_.region_home).norm() > kTourRoundingM) {
      wrong("home", "it begins at " + tour_place_text(first));
    }
  }

  /// Straight up from the home nothing may be in the way.
  void judge_climb(const Leg& up) {
    for_each_obstacle([&](const Corners& triangle, const std::string& name) {
      if (segment_crosses(up.from, up.to, triangle)) wrong("climb", "through " + name);
    });
  }

  void judge_lengths() {
    const double legs = at_m_.back();
    const double most = is_wing_ ? legs * 1.02 + chord_m_ : legs * (1 + 1e-9);
    if (tour_.length_m < legs * (1 - 1e-9) || tour_.length_m > most) {
      wrong("length", std::to_string(tour_.length_m) + " m, of legs " + std::to_string(legs));
    }
    double least = tour_.length_m / settings_.vehicle.speed_m_s;
    for (const vantage::FlightPoint& point : points_) least += point.hold_s;
    if (tour_.time_s < least * (1 - 1e-9)) {
      wrong("time", std::to_string(tour_.time_s) + " s, of at least " + std::to_string(least));
    }
  }

  template <typename Visit>
  void for_each_obstacle(const Visit& visit) const {
    const vantage::Scene& scene = drawn_.scene;
    for (std::size_t i = 0; i < scene.mesh.triangles.size(); ++i) {
      const vantage::SceneObject& object = scene.objects[scene.object_of[i]];
      if (object.kind == vantage::ObjectKind::ground) continue;
      const vantage::Triangle& t = scene.mesh.triangles[i];
      visit(Corners{scene.mesh.vertices[t[0]], scene.mesh.vertices[t[1]], scene.mesh.vertices[t[2]]}, object.name);
    }
  }

  /// The curve of a fixed wing is up to a chord's error from its legs.
  void judge_clearance() {
    const double asked = settings_.clearance_m + chord_m_ + tube_m_;
    for (std::size_t i = 0; i < tour_.flight.leg_count(); ++i) {
      for_each_obstacle([&](const Corners& triangle, const std::string& name) {
        result_.count("legs before triangles");
        const double distance = distance_from_leg(leg(i), triangle);
        if (distance >= asked - kTourRoundingM && !segment_crosses(leg(i).from, leg(i).to, triangle)) return;
        wrong("clearance", std::to_string(distance) + " m from " + name + ", on leg " + std::to_string(i));
      });
    }
  }

  /// Places of a leg, at most so far apart; both ends. And places about these, as far away as the tube is wide.
  template <typename Visit>
  void for_each_place(std::size_t i, const Visit& visit) const {
    const Leg on = leg(i);
    const double parts = std::max(1.0, std::ceil((on.to - on.from).norm() / kStepM));
    for (double k = 0; k <= parts; ++k) {
      const Vec3 place = on.from + k / parts * (on.to - on.from);
      visit(place);
      if (tube_m_ > 0) visit_about(place, k, visit);
    }
  }

  /// A few directions, others at each place: Fibonacci's sphere.
  template <typename Visit>
  void visit_about(const Vec3& place, double number, const Visit& visit) const {
    constexpr double kGolden = 2.399963229728653, kDirections = 4, kWithin = 1 - 1e-6;
    for (double i = 0; i < kDirections; ++i) {
      const double turn = kGolden * (kDirections * number + i), up = 1 - (2 * i + 1) / kDirections;
      const double flat = std::sqrt(1 - up * up);
      visit(Vec3(place + kWithin * tube_m_ * Vec3(flat * std::cos(turn), flat * std::sin(turn), up)));
    }
  }

  void judge_navigation() {
    const NavigationMargins limits(drawn_.navigation);
    for (std::size_t i = 0; i < tour_.flight.leg_count(); ++i) {
      for_each_place(i, [&](const Vec3& place) {
        result_.count("places before limits");
        for (const Margin& margin : limits.at(place)) {
          if (margin.high < -kTourRoundingM)
            wrong("limit",
                  margin.limit + " at " + tour_place_text(place) + " by " + std::to_string(-margin.high) + " m");
        }
        const bool is_low = place.z() <= 0 && !drawn_.scene.objects.empty() &&
                            drawn_.scene.objects[0].kind == vantage::ObjectKind::ground;
        if (is_low) wrong("ground", "met at " + tour_place_text(place));
      });
    }
  }

  // ---- fixed wings ----

  void judge_wing() {
    if (!is_wing_) return;
    constexpr double kDegrees = 180 / std::numbers::pi;
    std::vector<Vec3> places;
    for (const vantage::FlightPoint& point : points_) {
      if (point.hold_s > 0) wrong("wing", "it hovers at " + tour_place_text(point.position));
      if (places.empty() || (point.position - places.back()).norm() > 1e-3) places.push_back(point.position);
    }
    const double least = 1 / settings_.vehicle.turn_radius_m;
    for (std::size_t i = 0; i + 1 < places.size(); ++i) {
      const Vec3 along = places[i + 1] - places[i];
      // Seen from above the arc is longer than its chord, and so less steep.
      const double chord = along.head<2>().norm(), across = 2 * settings_.vehicle.turn_radius_m;
      const double arc = chord < across ? across * std::asin(chord / across) : chord;
      const double climb = std::atan2(along.z(), arc) * kDegrees;
      if (climb < settings_.vehicle.min_climb_deg - 1e-4 || climb > settings_.vehicle.max_climb_deg + 1e-4) {
        wrong("wing climbs", std::to_string(climb) + " degrees at " + tour_place_text(places[i]) + ", not " +
                                 std::to_string(settings_.vehicle.min_climb_deg) + " to " +
                                 std::to_string(settings_.vehicle.max_climb_deg) + ", along " +
                                 std::to_string(along.norm()) + " m");
      }
      if (i == 0) continue;
      // Three places of a curve: the circle through them.
      const Vec3 a = places[i] - places[i - 1], b = places[i + 1] - places[i - 1];
      const double curvature = 2 * a.cross(b).norm() / (a.norm() * b.norm() * along.norm());
      const double rounding = 1e-6 / std::min(a.norm(), along.norm()) / std::max(a.norm(), along.norm());
      if (curvature > least * (1 + 1e-3) + rounding || a.dot(along) < 0) {
        wrong("wing turns",
              "with a radius of " + std::to_string(1 / curvature) + " m at " + tour_place_text(places[i]));
      }
    }
  }

  // ---- what is seen ----

  void judge_visits() {
    std::unique_ptr<vantage::PreparedScene> scene;
    if (drawn_.mission) scene = std::make_unique<vantage::PreparedScene>(drawn_.scene);
    for (const TourVisit& visit : tour_.visits) {
      if (drawn_.mission) {
        const FlightOracle oracle(one_volume(*drawn_.mission, visit.target), *scene);
        judge_visit(visit, [&](const Vec3& place) {
          const double reach = oracle.lists()[0][0]->reach(place);
          return oracle.surely_not_seen(place, 1e-9 + 1e-11 * reach);
        });
      } else {
        const ClosedMesh region(drawn_.regions[visit.target].volume);
        judge_visit(visit, [&](const Vec3& place) -> std::string {
          if (region.locate(place) == Place::outside) return "outside";
          const double depth = region.distance(place);
          return depth < settings_.margin_m - 1e-7 ? std::to_string(depth) + " m deep" : "";
        });
      }
    }
  }

  template <typename Complain>
  void judge_visit(const TourVisit& visit, const Complain& complain) {
    double stay_s = 0;
    for (std::size_t i = visit.first_point; i <= visit.last_point; ++i) {
      stay_s += points_[i].hold_s;
      const auto judge_place = [&](const Vec3& place) {
        result_.count("places of visits");
        const std::string reason = complain(place);
        if (!reason.empty()) {
          wrong("not in view",
                "target " + std::to_string(visit.target) + " at " + tour_place_text(place) + ": " + reason);
        }
      };
      if (i == visit.last_point) {
        judge_place(points_[i].position);
        if (tube_m_ > 0) visit_about(points_[i].position, static_cast<double>(i), judge_place);
        break;
      }
      for_each_place(i, judge_place);
      stay_s += (leg(i).to - leg(i).from).norm() / settings_.vehicle.speed_m_s;
    }
    // The chords of circles are shorter than these.
    const double least = settings_.dwell_s * (is_wing_ ? 1 - 0.02 : 1 - 1e-9) - 1e-6;
    if (stay_s < least) {
      wrong("dwell", std::to_string(stay_s) + " s at target " + std::to_string(visit.target) + ", " +
                         std::to_string(settings_.dwell_s) + " are asked for");
    }
  }

  /// Without `simultaneous` no two targets are in view for the same seconds of their dwell.
  void judge_times() {
    if (settings_.simultaneous) return;
    std::vector<double> asked_s(points_.size(), 0);
    for (const TourVisit& visit : tour_.visits) {
      if (visit.first_point == visit.last_point) asked_s[visit.first_point] += settings_.dwell_s;
    }
    for (std::size_t i = 0; i < points_.size(); ++i) {
      if (points_[i].hold_s < asked_s[i] * (1 - 1e-9) - 1e-6) {
        wrong("dwell", "of several targets at " + tour_place_text(points_[i].position));
      }
    }
    for (const TourVisit& a : tour_.visits) {
      for (const TourVisit& b : tour_.visits) {
        if (a.target == b.target || a.first_point == a.last_point || b.first_point == b.last_point) continue;
        if (a.first_point < b.last_point && b.first_point < a.last_point) {
          wrong("one after the other", "targets " + std::to_string(a.target) + " and " + std::to_string(b.target));
        }
      }
    }
  }

  const DrawnTour& drawn_;
  const vantage::TourSettings& settings_;
  const vantage::Tour& tour_;
  const std::vector<vantage::FlightPoint>& points_;
  std::optional<Vec3> home_;
  FlightJudgement& result_;
  bool is_wing_;
  double chord_m_, tube_m_;
  std::vector<double> at_m_;
};

}  // namespace

void judge_tour(const DrawnTour& drawn, const AnsweredTour& answer, FlightJudgement& result) {
  TourJudge(drawn, answer, result).run();
}

void judge_bound(const DrawnTour& drawn, const AnsweredTour& answer, FlightJudgement& result) {
  const vantage::MissionTour& of = answer.tour;
  if (!of.bound || of.tour.flight.points.empty()) return;
  const double bound = of.bound->length_m;
  if (!(bound >= 0) || bound > of.tour.length_m * (1 + 1e-9)) result.add_wrong("bound: above the tour itself");
  // Other tours, which keep less: without the margin, and through everything.
  vantage::TourRequest request;
  request.settings = drawn.settings;
  request.settings.margin_m = 0;
  request.settings.simultaneous = true;
  request.settings.time_limit_s = 1;
  if (of.home) request.home = of.tour.flight.points.front().position;
  for (const std::size_t target : of.tour.order) {
    request.targets.push_back({of.targets[target].name, of.targets[target].volume});
  }
  for (request.seed = 2; request.seed < 5; ++request.seed) {
    request.rounds = request.seed == 2 ? 0 : 20;
    try {
      const vantage::Tour other = plan_tour(request);
      if (!other.problems.empty()) continue;
      result.count("bounds against other tours");
      if (other.length_m < bound * (1 - 1e-9)) {
        result.add_wrong("bound: " + std::to_string(bound) + " m, and a tour of " + std::to_string(other.length_m));
      }
    } catch (const vantage::Error& error) {
      if (error.kind() != vantage::ErrorKind::input) result.add_wrong(std::string("error: ") + error.what());
    }
  }
}

AnsweredTour ask_tour(const DrawnTour& drawn) {
  AnsweredTour answer;
  if (drawn.mission) {
    answer.tour = plan_mission_tour(*drawn.mission, {.threads = 1});
    return answer;
  }
  const vantage::PreparedScene scene(drawn.scene);
  vantage::TourRequest request;
  request.settings = drawn.settings;
  request.home = drawn.region_home;
  request.targets = drawn.regions;
  request.airspace = make_airspace(scene, drawn.settings.clearance_m, drawn.navigation);
  request.seed = drawn.seed % 1000 + 1;
  answer.tour.settings = drawn.settings;
  answer.tour.tour = plan_tour(request);
  return answer;
}

}  // namespace attack
