// Random flights, and what vantage says of them: docs/verification.md.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "vantage/flight_check.h"

namespace attack {

/// What became of a drawn case: words to be counted, and what is wrong with it.
struct FlightJudgement {
  std::vector<std::string> words;
  std::vector<std::string> wrong;
  std::vector<std::pair<std::string, double>> counts;  ///< "positions judged": so many

  void count(const std::string& what, double more = 1);
  /// The first of each kind is kept: its text up to a colon.
  void add_wrong(const std::string& text);
};

/// A flight before a mission.
struct DrawnFlight {
  std::uint64_t seed = 0;  ///< of the judge's own draws
  std::string kind;        ///< "walls, canopy", "mission": and how the legs lie
  vantage::Mission mission;
  vantage::Flight flight;
  vantage::FlightCheckOptions options;
  double scale = 1;  ///< size of the world, about: of the target's range, metres
};

/// The case `index` of the run `seed`, the same on every machine. Throws Error(input) where a drawn mission is refused.
DrawnFlight draw_flight(std::uint64_t seed, std::size_t index);

/// Judges what `check` says of the flight; a check of another kind for self tests and minimising.
using CheckFlight = std::function<vantage::FlightCheck(const DrawnFlight&)>;
FlightJudgement judge_flight(const DrawnFlight& drawn, const CheckFlight& check);
vantage::FlightCheck ask_check_flight(const DrawnFlight& drawn);

/// Legs, triangles and limits are left out one by one, as long as something of that kind is wrong.
DrawnFlight minimise_flight(const DrawnFlight& drawn, const std::string& wrong, const CheckFlight& check);
/// scene.obj, flight.csv and a note of what is asked.
void write_flight(const DrawnFlight& drawn, const std::string& wrong, const std::string& folder);

struct FlightRun {
  std::uint64_t seed = 1;
  std::size_t first = 0, count = 0;
  int jobs = 2;
  unsigned seconds = 60;
  std::string out;  ///< where wrong flights are written, made small; may be empty
  int written = 3;  ///< of each kind
};
/// True when nothing is wrong and enough were judged.
bool run_drawn_flights(const FlightRun& run);

}  // namespace attack
