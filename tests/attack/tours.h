// Random tours, and whether they are what was asked for: docs/verification.md.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "flights.h"
#include "vantage/mission.h"
#include "vantage/mission_tour.h"
#include "vantage/tour.h"

namespace attack {

/// What a tour is asked for: targets of a mission, or regions that are given as meshes.
struct DrawnTour {
  std::uint64_t seed = 0;
  std::string kind;
  vantage::Scene scene;
  vantage::TourSettings settings;
  vantage::Navigation navigation;
  std::optional<vantage::Mission> mission;   ///< with the scene, the settings and the navigation of above
  std::vector<vantage::TourTarget> regions;  ///< where there is no mission
  std::optional<vantage::Vec3> region_home;  ///< of these, in the air
};

/// The tour `index` of the run `seed`, the same on every machine. Throws Error(input) for a mission that is refused.
DrawnTour draw_tour(std::uint64_t seed, std::size_t index);

/// What is judged: the answer of the library.
struct AnsweredTour {
  vantage::MissionTour tour;  ///< of regions without volumes and bound
};
AnsweredTour ask_tour(const DrawnTour& drawn);

/// Judges by the triangles of the scene, the limits and the settings: nothing that the library computed is believed.
/// The flight is sampled every 0.1 m.
void judge_tour(const DrawnTour& drawn, const AnsweredTour& answer, FlightJudgement& result);

/// Bound against the length of other tours through the same targets, that keep less than is asked for.
void judge_bound(const DrawnTour& drawn, const AnsweredTour& answer, FlightJudgement& result);

/// Changed answers, of tours and of checks of flights, must be objected to. True when all are.
bool tour_self_test();
bool flight_self_test();

/// True when nothing is wrong and enough were judged.
bool run_drawn_tours(const FlightRun& run);

}  // namespace attack
