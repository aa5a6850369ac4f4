// What plans leave to the vehicle, and what is said of it.
#include <gtest/gtest.h>

#include <cstddef>
#include <string>
#include <vector>

#include "support/wording.h"
#include "vantage/flight.h"

namespace vantage::testing {
namespace {

/// Up from the home, away, and back above it.
FlightOut round_flight() {
  FlightOut out;
  out.home = Vec3(10, 20, 3);
  out.flight.points = {{Vec3(10, 20, 8)}, {Vec3(60, 20, 30)}, {Vec3(10, 20, 8)}};
  return out;
}

/// How many notes there are; their words are in the golden file.
std::size_t notes_of(const FlightOut& flight, PlanFormat format) {
  const std::vector<std::string> notes = plan_notes(flight, format);
  for (const std::string& note : notes) expect_wording(note);
  return notes.size();
}

constexpr PlanFormat kFlown[] = {PlanFormat::qgroundcontrol, PlanFormat::waypoints, PlanFormat::wpml};

TEST(PlanNotes, AClosedFlightAboveItsHomeIsAsItWasPlanned) {
  for (const PlanFormat format : kFlown) EXPECT_EQ(notes_of(round_flight(), format), 0U);
}

TEST(PlanNotes, AnOpenFlightEndsInTheAir) {
  FlightOut out = round_flight();
  out.flight.points.pop_back();
  out.returns_home = false;
  for (const PlanFormat format : kFlown) EXPECT_EQ(notes_of(out, format), 1U);
}

TEST(PlanNotes, AFixedWingClimbsAndEndsOnWaysThatAreNotPlanned) {
  FlightOut out = round_flight();
  out.vehicle = PlanVehicle::fixed_wing;
  EXPECT_EQ(notes_of(out, PlanFormat::qgroundcontrol), 1U) << "the climb and the way down";
  out.returns_home = false;
  EXPECT_EQ(notes_of(out, PlanFormat::qgroundcontrol), 2U) << "the climb, and the circles at the end";
}

TEST(PlanNotes, WaysToAndFromAFlightElsewhereAreTold) {
  FlightOut out = round_flight();
  out.flight.points.pop_back();
  EXPECT_EQ(notes_of(out, PlanFormat::qgroundcontrol), 1U) << "the way back";
  out.flight.points = {{Vec3(10, 20, 40)}};  // a circle about the home is not above it
  EXPECT_EQ(notes_of(out, PlanFormat::wpml), 0U);
  out.actions.resize(1);
  out.actions[0].loiter_radius_m = 30;
  EXPECT_EQ(notes_of(out, PlanFormat::wpml), 1U) << "both ways";
  out.home.reset();
  out.takes_off = out.returns_home = false;
  EXPECT_EQ(notes_of(out, PlanFormat::wpml), 1U) << "its end alone";
}

TEST(PlanNotes, FormatsWithoutTakeoffSaySo) {
  for (const PlanFormat format : {PlanFormat::kml, PlanFormat::gpx, PlanFormat::geojson, PlanFormat::csv}) {
    EXPECT_EQ(notes_of(round_flight(), format), 1U);
  }
  FlightOut without = round_flight();
  without.takes_off = without.returns_home = false;
  EXPECT_EQ(notes_of(without, PlanFormat::csv), 0U);
  without.flight.points.clear();
  EXPECT_EQ(notes_of(without, PlanFormat::wpml), 0U) << "nothing to write";
}

}  // namespace
}  // namespace vantage::testing
