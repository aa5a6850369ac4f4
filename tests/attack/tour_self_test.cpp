// Answers that are wrong on purpose: of tours, and of checks of flights. The judges must object to each.
#include <cstdio>
#include <functional>
#include <limits>
#include <memory>
#include <string>

#include "tours.h"
#include "vantage/error.h"

namespace attack {
namespace {

using vantage::FlightCheck;
using vantage::Vec3;

int unnoticed = 0;

bool has_kind(const FlightJudgement& judgement, const std::string& kind) {
  for (const std::string& wrong : judgement.wrong) {
    if (wrong.starts_with(kind + ":")) return true;
  }
  return false;
}

void report(const std::string& text) {
  ++unnoticed;
  std::printf("self-test: %s\n", text.c_str());
}

// ---- tours ----

using ChangeTour = std::function<bool(DrawnTour&, vantage::MissionTour&)>;  // false: not for this one

FlightJudgement judgement_of(const DrawnTour& drawn, const AnsweredTour& answer, bool with_bound) {
  FlightJudgement result;
  judge_tour(drawn, answer, result);
  if (with_bound) judge_bound(drawn, answer, result);
  return result;
}

struct ChangedTour {
  const char* wrong;  ///< that the judge must find
  ChangeTour change;
  int noticed = 0, missed = 0;
};

bool is_wing(const DrawnTour& drawn) { return drawn.settings.vehicle.kind == vantage::TourVehicle::Kind::fixed_wing; }

std::vector<ChangedTour> changed_tours() {
  return {
      {"dwell",
       [](DrawnTour& drawn, vantage::MissionTour&) {
         drawn.settings.dwell_s = 1.5 * drawn.settings.dwell_s + 30;
         return true;
       }},
      {"not in view",  // views begin one leg too early, from far away
       [](DrawnTour&, vantage::MissionTour& tour) {
         vantage::TourVisit& visit = tour.tour.visits.back();
         if (visit.first_point == 0) return false;
         const Vec3 up(0, 0, 500);
         tour.tour.flight.points[visit.first_point].position += up;
         return true;
       }},
      {"clearance",  // a leg through a house
       [](DrawnTour& drawn, vantage::MissionTour& tour) {
         const vantage::Mesh& mesh = drawn.scene.mesh;
         vantage::FlightPoint through;
         through.position = (mesh.vertices[mesh.vertices.size() - 1] + mesh.vertices[mesh.vertices.size() - 8]) / 2;
         auto& points = tour.tour.flight.points;
         if (points.size() < 2) return false;
         points.insert(points.end() - 1, through);
         return true;
       }},
      {"clearance",  // more is promised than is kept
       [](DrawnTour& drawn, vantage::MissionTour&) {
         drawn.settings.clearance_m += 500;
         return true;
       }},
      {"limit",
       [](DrawnTour& drawn, vantage::MissionTour&) {
         drawn.navigation.altitude = {-2, -1};
         return true;
       }},
      {"closed",
       [](DrawnTour& drawn, vantage::MissionTour& tour) {
         if (!drawn.settings.closed || tour.tour.flight.points.size() < 3) return false;
         tour.tour.flight.points.back().position.x() += 1e-3;
         return true;
       }},
      {"home",
       [](DrawnTour& drawn, vantage::MissionTour&) {
         if (drawn.region_home) drawn.region_home->x() += 0.01;
         if (drawn.mission && drawn.mission->home) drawn.mission->home->x() += 0.01;
         return drawn.region_home || (drawn.mission && drawn.mission->home);
       }},
      {"length",
       [](DrawnTour&, vantage::MissionTour& tour) {
         if (!(tour.tour.length_m > 1)) return false;
         tour.tour.length_m *= 0.99;
         return true;
       }},
      {"time",
       [](DrawnTour&, vantage::MissionTour& tour) {
         if (!(tour.tour.length_m > 1)) return false;
         tour.tour.time_s = 0.99 * tour.tour.length_m / tour.settings.vehicle.speed_m_s;
         return true;
       }},
      {"targets",
       [](DrawnTour&, vantage::MissionTour& tour) {
         tour.tour.visits.pop_back();
         return true;
       }},
      {"bound",
       [](DrawnTour&, vantage::MissionTour& tour) {
         if (!tour.bound || !(tour.tour.length_m > 1)) return false;
         tour.bound->length_m = 1.01 * tour.tour.length_m;
         return true;
       }},
      {"wing turns",
       [](DrawnTour& drawn, vantage::MissionTour& tour) {
         if (!is_wing(drawn) || tour.tour.flight.points.size() < 5) return false;
         drawn.settings.vehicle.turn_radius_m *= 1.05;
         return true;
       }},
      {"wing climbs",
       [](DrawnTour& drawn, vantage::MissionTour& tour) {
         if (!is_wing(drawn) || tour.tour.flight.points.size() < 5) return false;
         tour.tour.flight.points[2].position.z() += 10;
         return true;
       }},
  };
}

// ---- checks of flights ----

struct ChangedCheck {
  const char* wrong;
  std::function<bool(const DrawnFlight&, FlightCheck&)> change;
  int noticed = 0, missed = 0;
};

/// A span that ends within a leg, and is longer than that leg's part of the judge's precision.
vantage::FlightSpan* long_span(const DrawnFlight& drawn, std::vector<vantage::FlightSpan>& spans) {
  for (vantage::FlightSpan& span : spans) {
    if (span.length_m() > 1e-3 * drawn.scale) return &span;
  }
  return nullptr;
}

std::vector<ChangedCheck> changed_checks() {
  return {
      {"over-claim",  // one percent longer
       [](const DrawnFlight& drawn, FlightCheck& check) {
         for (vantage::TargetCheck& target : check.targets) {
           if (target.not_seen.empty()) continue;
           vantage::FlightSpan* span = long_span(drawn, target.seen);
           if (!span || span->end_m + 0.01 * span->length_m() > check.length_m) continue;
           const vantage::Vec3 along = span->end - span->begin;
           if (std::abs(along.norm() - span->length_m()) > 1e-9 * check.length_m) continue;  // round a corner
           for (const double at : check.point_at_m) {
             if (std::abs(at - span->end_m) <= 0.02 * span->length_m()) return false;
           }
           span->end += 0.01 * along;
           span->end_m += 0.01 * span->length_m();
           return true;
         }
         return false;
       }},
      {"under-claim",  // nothing is seen
       [](const DrawnFlight& drawn, FlightCheck& check) {
         const vantage::Sensor& sensor = drawn.mission.sensor;
         // Of tubes, links and cameras that turn the judge knows bounds only, and far from the origin rounding decides.
         const bool is_far = drawn.kind.find(", far") != std::string::npos;
         if (drawn.options.tube_radius_m > 0 || drawn.flight.chord_error_m > 0 || sensor.link || sensor.camera ||
             is_far)
           return false;
         for (vantage::TargetCheck& target : check.targets) {
           if (!long_span(drawn, target.seen) || long_span(drawn, target.seen)->length_m() < 0.05 * drawn.scale)
             continue;
           target.seen.clear();
           target.longest.reset();
           target.gimbal.reset();
           return true;
         }
         return false;
       }},
      {"over-claim",  // a link that something is in the way of
       [](const DrawnFlight&, FlightCheck& check) {
         for (vantage::LinkCheck& link : check.links) {
           if (link.holds() || link.lost.front().length_m() < 0.05 * check.length_m) continue;
           std::swap(link.linked, link.lost);
           return true;
         }
         return false;
       }},
      {"link",  // a part of the flight is left out
       [](const DrawnFlight& drawn, FlightCheck& check) {
         for (vantage::LinkCheck& link : check.links) {
           if (!long_span(drawn, link.lost)) continue;
           link.lost.clear();
           return true;
         }
         return false;
       }},
      {"nearest",
       [](const DrawnFlight& drawn, FlightCheck& check) {
         if (!(check.nearest.distance_m > 1e-4 * drawn.scale) || std::isinf(check.nearest.distance_m)) return false;
         check.nearest.distance_m *= 1.01;
         return true;
       }},
      {"limit",
       [](const DrawnFlight& drawn, FlightCheck& check) {
         for (std::size_t i = 0; i < check.broken.size(); ++i) {
           const vantage::BrokenLimit& limit = check.broken[i];
           if (!(limit.worst > 1e-3 * drawn.scale) || limit.unit != "m" || limit.name.starts_with("agl")) continue;
           check.broken.erase(check.broken.begin() + static_cast<std::ptrdiff_t>(i));
           return true;
         }
         return false;
       }},
      {"verdict",
       [](const DrawnFlight&, FlightCheck& check) {
         if (check.failures.empty()) return false;
         check.failures.clear();
         return true;
       }},
  };
}

/// Each change must be possible somewhere, and be noticed wherever it is possible.
template <typename Change>
void report_changes(const char* of, const std::vector<Change>& changes) {
  for (const Change& change : changes) {
    if (change.noticed == 0) report(std::string(of) + ": never tried: " + change.wrong);
    if (change.missed > 0)
      report(std::string(of) + ": lets pass " + std::to_string(change.missed) + ": " + change.wrong);
  }
}

}  // namespace

bool tour_self_test() {
  unnoticed = 0;
  std::vector<ChangedTour> changes = changed_tours();
  for (std::size_t index = 0; index < 10; ++index) {
    try {
      DrawnTour drawn = draw_tour(7, index);
      drawn.settings.time_limit_s = 0.5;
      if (drawn.mission) drawn.mission->as_written.tour->time_limit_s = 0.5;
      const AnsweredTour answer = ask_tour(drawn);
      if (answer.tour.tour.flight.points.empty()) continue;
      const FlightJudgement right = judgement_of(drawn, answer, true);
      if (!right.wrong.empty()) report("objects to what is right: " + right.wrong[0]);
      for (ChangedTour& change : changes) {
        DrawnTour other = drawn;
        AnsweredTour changed = answer;
        if (!change.change(other, changed.tour)) continue;
        ++(has_kind(judgement_of(other, changed, change.wrong == std::string("bound")), change.wrong) ? change.noticed
                                                                                                      : change.missed);
      }
    } catch (const vantage::Error& error) {
      if (error.kind() != vantage::ErrorKind::input) report(error.what());
    }
  }
  report_changes("tours", changes);
  return unnoticed == 0;
}

bool flight_self_test() {
  unnoticed = 0;
  std::vector<ChangedCheck> changes = changed_checks();
  constexpr std::size_t kFew = 20, kMany = 80;
  const auto was_tried = [](const ChangedCheck& change) { return change.noticed > 0; };
  for (std::size_t index = 0; index < kMany; ++index) {
    if (index >= kFew && std::all_of(changes.begin(), changes.end(), was_tried)) break;
    try {
      const DrawnFlight drawn = draw_flight(7, index);
      if (drawn.mission.scene().mesh.triangles.size() > 60) continue;
      const FlightCheck right = ask_check_flight(drawn);
      for (ChangedCheck& change : changes) {
        if (index >= kFew && was_tried(change)) continue;
        FlightCheck changed = right;
        if (!change.change(drawn, changed)) continue;
        const FlightJudgement judgement = judge_flight(drawn, [&](const DrawnFlight&) { return changed; });
        const bool is_noticed = has_kind(judgement, change.wrong);
        ++(is_noticed ? change.noticed : change.missed);
        if (!is_noticed) std::printf("self-test: flight %zu of seed 7 (%s)\n", index, drawn.kind.c_str());
      }
    } catch (const vantage::Error& error) {
      if (error.kind() != vantage::ErrorKind::input) report(error.what());
    }
  }
  report_changes("flights", changes);
  return unnoticed == 0;
}

}  // namespace attack
