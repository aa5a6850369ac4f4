// CZML of flights: when the vehicle is where, when targets are seen, and what is refused.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "geo/ellipsoid.h"
#include "support/wording.h"
#include "vantage/error.h"
#include "vantage/flight.h"
#include "vantage/georeference.h"

namespace vantage::testing {
namespace {

using nlohmann::json;

constexpr double kUndulationM = 45.75;

FlightOut flight_out() {
  FlightOut out;
  out.flight.points = {{{100, 50, 40}, 2, 8}, {{-1100, 300, 60}, 0, 8}, {{10, -40, 55.25}, 1.5, 6}};
  out.georeference = Georeference{48.1374, 11.5755, "EGM96 geoid", ""};
  out.levels.undulation_m = kUndulationM;
  out.name = "a <flight>";
  return out;
}

json packets_of(const FlightOut& out) { return json::parse(flight_plan_bytes(out, PlanFormat::czml)); }

/// The packet with that id.
json packet(const FlightOut& out, const std::string& id) {
  for (const json& one : packets_of(out)) {
    if (one.at("id") == id) return one;
  }
  ADD_FAILURE() << "no packet " << id;
  return {};
}

struct Sample {
  double at_s = 0;
  Vec3 position;  ///< scene frame
  Vec3 ecef;
};

std::vector<Sample> samples_of(const FlightOut& out) {
  const json numbers = packet(out, "vehicle").at("position").at("cartographicDegrees");
  std::vector<Sample> samples;
  for (std::size_t i = 0; i + 3 < numbers.size(); i += 4) {
    const double longitude = numbers[i + 1], latitude = numbers[i + 2], height = numbers[i + 3];
    const Eigen::Vector2d at = scene_position(*out.georeference, longitude, latitude);
    samples.push_back({numbers[i], Vec3(at.x(), at.y(), height - kUndulationM),
                       internal::geo::to_ecef({{longitude, latitude}, height})});
  }
  return samples;
}

TEST(WriteCzml, SaysWhenTheVehicleIsWhere) {
  const FlightOut out = flight_out();
  const std::vector<Sample> samples = samples_of(out);
  double at_s = 0;
  for (std::size_t i = 0; i < out.flight.points.size(); ++i) {
    const FlightPoint& point = out.flight.points[i];
    if (i > 0) at_s += (point.position - out.flight.points[i - 1].position).norm() / point.speed_m_s;
    for (const double stay_s : {0.0, point.hold_s}) {
      double nearest_m = std::numeric_limits<double>::infinity();
      for (const Sample& sample : samples) {
        if (std::abs(sample.at_s - (at_s + stay_s)) > 1e-9) continue;
        nearest_m = std::min(nearest_m, (sample.position - point.position).norm());
      }
      EXPECT_LE(nearest_m, 1e-6) << "point " << i << " after " << stay_s << " s";
    }
    at_s += point.hold_s;
  }
  EXPECT_NEAR(samples.back().at_s, at_s, 1e-9);
  for (std::size_t i = 1; i < samples.size(); ++i) EXPECT_GT(samples[i].at_s, samples[i - 1].at_s);
}

// Programs draw straight lines between samples, in the earth's frame.
TEST(WriteCzml, LongLegsStayWithinAMillimetre) {
  FlightOut out = flight_out();
  out.flight.points = {{{-3000, 1000, 100}, 0, 10}, {{2000, -1500, 300}, 0, 10}};
  const std::vector<Sample> samples = samples_of(out);
  const Vec3 from = out.flight.points[0].position, leg = out.flight.points[1].position - from;
  for (std::size_t i = 1; i < samples.size(); ++i) {
    const internal::geo::Geodetic middle = internal::geo::from_ecef((samples[i - 1].ecef + samples[i].ecef) / 2);
    const Eigen::Vector2d at = scene_position(*out.georeference, middle.place.longitude_deg, middle.place.latitude_deg);
    const double at_s = (samples[i - 1].at_s + samples[i].at_s) / 2;
    const Vec3 exact = from + leg * (at_s * 10 / leg.norm());
    EXPECT_LE((Vec3(at.x(), at.y(), middle.height_m - kUndulationM) - exact).norm(), 1e-3);
  }
}

TEST(WriteCzml, BeginsWhenItIsAsked) {
  FlightOut out = flight_out();
  const auto begins = [&] { return packet(out, "vehicle").at("position").at("epoch").get<std::string>(); };
  EXPECT_EQ(begins(), "2026-01-01T00:00:00Z");
  out.start_unix_s = 1782057600.25;
  EXPECT_EQ(begins(), "2026-06-21T16:00:00.250000Z");
  out.start_unix_s = -1;
  EXPECT_EQ(begins(), "1969-12-31T23:59:59Z");
  for (const double wrong : {-1e12, 1e12, std::numeric_limits<double>::quiet_NaN()}) {
    out.start_unix_s = wrong;
    expect_code([&] { packets_of(out); }, ErrorCode::value_out_of_range, out.name);
  }
  out.start_unix_s = 0;
  out.flight.points[0].hold_s = 1e12;
  expect_code([&] { packets_of(out); }, ErrorCode::value_out_of_range, out.name);
}

TEST(WriteCzml, TheClockHoldsTheWholeFlight) {
  FlightOut out = flight_out();
  out.flight.points = {{{0, 0, 10}, 0.5, 8}, {{10, 0, 10}, 0, 3}};
  const json document = packets_of(out).at(0);
  EXPECT_EQ(document.at("id"), "document");
  EXPECT_EQ(document.at("version"), "1.0");
  // 0.5 s and 10 m at 3 m/s, up to the next microsecond.
  const std::string whole = "2026-01-01T00:00:00Z/2026-01-01T00:00:03.833334Z";
  EXPECT_EQ(document.at("clock").at("interval"), whole);
  EXPECT_EQ(document.at("clock").at("currentTime"), "2026-01-01T00:00:00Z");
  EXPECT_EQ(packet(out, "vehicle").at("availability"), whole);
}

TEST(WriteCzml, TargetsHaveAnotherColourWhileTheyAreSeen) {
  FlightOut out = flight_out();
  const std::vector<Vec3> roof = {{0, 0, 10}, {5, 0, 10}, {5, 5, 10}, {0, 5, 10}};
  const std::vector<Vec3> wall = {{0, 0, 0}, {5, 0, 0}, {5, 0, 10}, {0, 0, 10}};
  out.targets = {{"house", {roof, wall}, {{1.0000004, 2.0000006}, {3.0000003, 3.0000006}, {-5, -4}}},
                 {"mast", {{{1, 2, 3}}}, {}},
                 {"air", {}, {{0, 4}}}};
  const json first = packet(out, "target 1"), second = packet(out, "target 1, part 2");
  const json& seen = first.at("properties").at("seen");
  ASSERT_EQ(seen.size(), 2U) << "of the second stretch nothing is left at a microsecond";
  EXPECT_EQ(seen[0].at("interval"), packet(out, "vehicle").at("availability"));
  EXPECT_EQ(seen[0].at("boolean"), false);
  EXPECT_EQ(seen[1].at("interval"), "2026-01-01T00:00:01.000001Z/2026-01-01T00:00:02Z") << "never longer";
  EXPECT_EQ(seen[1].at("boolean"), true);
  const json& colour = first.at("polygon").at("material").at("solidColor").at("color");
  EXPECT_EQ(colour[1].at("interval"), seen[1].at("interval"));
  EXPECT_NE(colour[0].at("rgba"), colour[1].at("rgba"));
  EXPECT_EQ(first.at("polygon").at("positions").at("cartographicDegrees").size(), 12U);
  EXPECT_EQ(first.at("polygon").at("positions").at("cartographicDegrees")[2], 10 + kUndulationM);
  EXPECT_FALSE(second.contains("polygon")) << "a wall has its outline alone";
  EXPECT_EQ(second.at("polyline").at("positions").at("cartographicDegrees").size(), 15U);
  EXPECT_EQ(second.at("parent"), "target 1");
  EXPECT_TRUE(packet(out, "target 2").contains("point"));
  EXPECT_EQ(packet(out, "target 3").at("properties").at("seen").size(), 2U);
}

TEST(WriteCzml, TheSameFlightIsTheSameBytes) {
  EXPECT_EQ(flight_plan_bytes(flight_out(), PlanFormat::czml), flight_plan_bytes(flight_out(), PlanFormat::czml));
  EXPECT_EQ(plan_format_of("a.CZML"), PlanFormat::czml);
}

TEST(WriteCzml, RefusesWhatItCannotState) {
  const auto refuse = [](const FlightOut& out, ErrorCode code) {
    expect_code([&] { flight_plan_bytes(out, PlanFormat::czml); }, code, out.name);
  };
  FlightOut out = flight_out();
  out.flight.points[1].speed_m_s = std::numeric_limits<double>::quiet_NaN();
  refuse(out, ErrorCode::missing_key);
  out.speed_m_s = 5;
  EXPECT_NO_THROW(flight_plan_bytes(out, PlanFormat::czml));
  out.heights = HeightDatum::sea_level;
  refuse(out, ErrorCode::value_unsupported);
  out = flight_out();
  out.levels.undulation_m.reset();
  refuse(out, ErrorCode::height_unknown);
  out = flight_out();
  out.georeference.reset();
  refuse(out, ErrorCode::not_georeferenced);
  out = flight_out();
  out.flight.points.clear();
  expect_code([&] { flight_plan_bytes(out, PlanFormat::czml); }, ErrorCode::nothing_given);
}

}  // namespace
}  // namespace vantage::testing
