// What is written in longitudes and latitudes near the antimeridian: cut there, so that no side runs around the globe.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "geo/on_globe.h"
#include "io/antimeridian.h"
#include "support/random.h"
#include "support/solids.h"
#include "support/temporary_directory.h"
#include "support/wording.h"
#include "vantage/error.h"
#include "vantage/flight.h"
#include "vantage/fraction.h"
#include "vantage/georeference.h"
#include "vantage/volume.h"

namespace vantage::testing {
namespace {

using internal::geo::OnGlobe;
using internal::io::cut_at_antimeridian;
using internal::io::GlobeCorner;
using internal::io::GlobePolygon;
using nlohmann::json;
using Ring = std::vector<Vec3>;

/// Its z is the height above the sea.
Georeference fiji(double longitude_deg) { return {-17, longitude_deg, "EGM96 geoid", ""}; }

std::vector<GlobePolygon> cut_in(const Georeference& place, const std::vector<Ring>& rings) {
  const OnGlobe globe(place);
  return cut_at_antimeridian(rings, [&](const Vec3& point) { return globe.to_geodetic(point); });
}

Vec3 area_of(const std::vector<Vec3>& ring) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 1; i + 1 < ring.size(); ++i) sum += (ring[i] - ring[0]).cross(ring[i + 1] - ring[0]) / 2;
  return sum;
}

Vec3 area_of(const std::vector<GlobePolygon>& parts) {
  Vec3 sum = Vec3::Zero();
  for (const GlobePolygon& part : parts) {
    for (const auto& ring : part) {
      Ring corners;
      for (const GlobeCorner& corner : ring) corners.push_back(corner.scene);
      sum += area_of(corners);
    }
  }
  return sum;
}

/// That all its longitudes have one sign, and lie where the corners do.
void expect_on_one_side(const GlobePolygon& part, const Georeference& place) {
  const double first = part.at(0).at(0).at.place.longitude_deg;
  for (const auto& ring : part) {
    EXPECT_GE(ring.size(), 3U);
    for (const GlobeCorner& corner : ring) {
      const double longitude = corner.at.place.longitude_deg;
      EXPECT_EQ(std::signbit(longitude), std::signbit(first)) << longitude;
      EXPECT_LE(std::abs(longitude), 180);
      const Eigen::Vector2d at = scene_position(place, longitude, corner.at.place.latitude_deg);
      EXPECT_LT((at - corner.scene.head<2>()).norm(), 1e-6);
    }
  }
}

TEST(Antimeridian, CutsAPolygonWithHoles) {
  const Georeference place = fiji(180);
  const Ring outer{{-10, -10, 5}, {10, -10, 5}, {10, 10, 5}, {-10, 10, 5}};
  const Ring across{{-3, -3, 5}, {-3, 3, 5}, {3, 3, 5}, {3, -3, 5}};
  const Ring west{{-7, -2, 5}, {-7, 2, 5}, {-5, 2, 5}, {-5, -2, 5}}, east{{5, 5, 5}, {5, 7, 5}, {7, 7, 5}, {7, 5, 5}};
  const auto parts = cut_in(place, {outer, across, west, east});
  ASSERT_EQ(parts.size(), 2U);
  for (const GlobePolygon& part : parts) {
    expect_on_one_side(part, place);
    EXPECT_EQ(part.size(), 2U);  // with the hole that lies on its side
    EXPECT_EQ(part[0].size(), 8U);
  }
  EXPECT_LT((area_of(parts) - Vec3(0, 0, 400 - 36 - 8 - 4)).norm(), 1e-6);
}

TEST(Antimeridian, CutsAUIntoThreeAndAWallInTwo) {
  const Georeference place = fiji(180);
  const Ring u{{-9, 0, 0}, {5, 0, 0}, {5, 3, 0}, {-6, 3, 0}, {-6, 6, 0}, {5, 6, 0}, {5, 9, 0}, {-9, 9, 0}};
  const auto three = cut_in(place, {u});
  ASSERT_EQ(three.size(), 3U);
  for (const GlobePolygon& part : three) expect_on_one_side(part, place);
  EXPECT_LT((area_of(three) - area_of(u)).norm(), 1e-6);
  const Ring wall{{-4, 0, 0}, {6, 0, 0}, {6, 0, 8}, {-4, 0, 8}};
  const auto two = cut_in(place, {wall});
  ASSERT_EQ(two.size(), 2U);
  for (const GlobePolygon& part : two) expect_on_one_side(part, place);
  EXPECT_LT((area_of(two) - area_of(wall)).norm(), 1e-6);
}

TEST(Antimeridian, CornersThatTouchItAreNoCuts) {
  const Georeference place = fiji(180);
  for (const double side : {-1.0, 1.0}) {
    const auto whole = cut_in(place, {{{0, 0, 0}, {8 * side, -5, 0}, {8 * side, 5, 0}}});
    ASSERT_EQ(whole.size(), 1U);
    expect_on_one_side(whole[0], place);
    const auto edge = cut_in(place, {{{0, -5, 0}, {8 * side, 0, 0}, {0, 5, 0}}});
    ASSERT_EQ(edge.size(), 1U);
    expect_on_one_side(edge[0], place);
    // A spike from the other side that ends on the line: two parts meet there.
    const Ring notched{{8 * side, -9, 0}, {8 * side, 9, 0}, {-8 * side, 9, 0}, {0, 0, 0}, {-8 * side, -9, 0}};
    const auto notch = cut_in(place, {notched});
    EXPECT_LT((area_of(notch) - area_of(notched)).norm(), 1e-6);
    for (const GlobePolygon& part : notch) expect_on_one_side(part, place);
  }
}

/// Sides along the line, with nothing on their other side, make no parts there and no ways along it and back.
TEST(Antimeridian, SidesAlongItHoldNothing) {
  const Georeference place = fiji(180);
  for (const double side : {-1.0, 1.0}) {
    const Ring step{{-8 * side, 0, 0}, {8 * side, 0, 0}, {8 * side, 4, 0}, {0, 4, 0},
                    {0, 6, 0},         {0, 9, 0},        {-8 * side, 9, 0}};
    const auto parts = cut_in(place, {step});
    ASSERT_EQ(parts.size(), 2U);
    EXPECT_LT((area_of(parts) - area_of(step)).norm(), 1e-6);
    for (const GlobePolygon& part : parts) {
      expect_on_one_side(part, place);
      EXPECT_EQ(part[0].size(), 4U);
    }
    const Ring slit{{0, 0, 0}, {0, 3, 0}, {0, 5, 0}, {-8 * side, 5, 0}, {-8 * side, 0, 0}};
    EXPECT_EQ(cut_in(place, {slit}).size(), 1U);
  }
  // Walls that stand along it stay, also where rounding puts a corner beside it.
  for (const double beside : {0.0, -1e-8, 1e-8}) {
    const Ring wall{{beside, 0, 0}, {0, 9, 0}, {0, 9, 4}, {0, 0, 4}};
    EXPECT_LT((area_of(cut_in(place, {wall})) - area_of(wall)).norm(), 1e-6);
  }
}

TEST(Antimeridian, LeavesOthersAsTheyAre) {
  const Ring square{{-10, -10, 5}, {10, -10, 5}, {10, 10, 5}, {-10, 10, 5}};
  for (const double longitude : {11.0, -0.00001, 179.9, -179.9}) {
    const auto parts = cut_in(fiji(longitude), {square});
    ASSERT_EQ(parts.size(), 1U);
    ASSERT_EQ(parts[0].size(), 1U);
    for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(parts[0][0][i].scene, square[i]);
  }
}

// Stars about the middle, with and without a hole, at all scales.
TEST(Antimeridian, LosesNoArea) {
  Random random(180);
  for (int round = 0; round < 300; ++round) {
    const double scale = std::pow(10, random.uniform(-2, 3.3));
    Georeference place = fiji(180);
    place.latitude_deg = random.uniform(-80, 80);
    const double off =
        random.uniform(-0.9, 0.9) * scale / (111'320 * std::cos(place.latitude_deg * std::numbers::pi / 180));
    place.longitude_deg = std::remainder(180 + off, 360);
    Ring outer, hole;
    const int corners = random.integer(3, 12);
    for (int i = 0; i < corners; ++i) {
      const double angle = 2 * std::numbers::pi * i / corners, r = scale * random.uniform(0.6, 1);
      outer.push_back({r * std::cos(angle), r * std::sin(angle), 20});
      hole.insert(hole.begin(), Vec3(0.2 * scale * std::cos(angle), 0.2 * scale * std::sin(angle), 20));
    }
    const bool has_hole = random.chance(0.5);
    const std::vector<Ring> rings = has_hole ? std::vector<Ring>{outer, hole} : std::vector<Ring>{outer};
    const auto parts = cut_in(place, rings);
    const Vec3 whole = area_of(outer) + (has_hole ? area_of(hole) : Vec3(0, 0, 0));
    ASSERT_LT((area_of(parts) - whole).norm(), 1e-6 * scale * scale) << round;
    for (const GlobePolygon& part : parts) expect_on_one_side(part, place);
  }
}

TEST(Antimeridian, RefusesAPole) {
  Georeference place = fiji(10);
  place.latitude_deg = 89.9999;
  expect_error([&] { cut_in(place, {{{-50, -50, 0}, {50, -50, 0}, {0, 90, 0}}}); }, ErrorCode::value_unsupported);
}

/// All longitudes of a KML file's rings and lines, each apart.
std::vector<std::vector<double>> longitudes_of(const std::string& kml) {
  std::vector<std::vector<double>> all;
  const std::string begin = "<coordinates>", end = "</coordinates>";
  for (std::size_t at = kml.find(begin); at != std::string::npos; at = kml.find(begin, at)) {
    at += begin.size();
    std::istringstream positions(kml.substr(at, kml.find(end, at) - at));
    std::vector<double>& one = all.emplace_back();
    for (std::string position; positions >> position;) one.push_back(std::stod(position));
  }
  return all;
}

void expect_no_way_around(const std::vector<std::vector<double>>& shapes) {
  for (const std::vector<double>& shape : shapes) {
    const auto [low, high] = std::minmax_element(shape.begin(), shape.end());
    EXPECT_LT(*high - *low, 1);
    EXPECT_LE(std::max(std::abs(*low), std::abs(*high)), 180);
  }
}

TEST(Antimeridian, VolumesInKmlAreCut) {
  Volume volume = volume_of_mesh(make_box_mesh({-30, -20, 5}, {30, 20, 45}), "hand");
  const auto kml_at = [&](double longitude_deg) {
    volume.georeference = fiji(longitude_deg);
    const TemporaryDirectory folder;
    write_volume(volume, folder / "v.kml");
    return longitudes_of(read_bytes(folder / "v.kml"));
  };
  const auto cut = kml_at(-179.9999);
  EXPECT_GT(cut.size(), volume.mesh.triangles.size());
  expect_no_way_around(cut);
  EXPECT_EQ(kml_at(-17).size(), volume.mesh.triangles.size());
}

/// Across, along and back.
FlightOut flight_across(double longitude_deg) {
  FlightOut out;
  out.flight.points = {{{-100, 5, 40}, 2, 8}, {{70, 20, 60}, 0, 9}, {{90, -40, 50}, 1, 6}, {{-20, -60, 55}, 0, 7}};
  out.georeference = fiji(longitude_deg);
  out.levels.undulation_m = 55;
  out.name = "across";
  return out;
}

LocatedPlan located(const FlightOut& out, PlanFormat format) {
  LocateOptions options;
  options.georeference = out.georeference;
  options.levels = out.levels;
  return locate_flight(parse_flight_plan(flight_plan_bytes(out, format), "written"), options);
}

TEST(Antimeridian, FlightsAreCutAndReadBackWhole) {
  FlightOut out = flight_across(180);
  const json features = json::parse(flight_plan_bytes(out, PlanFormat::geojson)).at("features");
  const json& line = features.at(0).at("geometry");
  EXPECT_EQ(line.at("type"), "MultiLineString");
  ASSERT_EQ(line.at("coordinates").size(), 3U);
  std::vector<std::vector<double>> shapes;
  for (const json& part : line.at("coordinates")) {
    std::vector<double>& shape = shapes.emplace_back();
    for (const json& position : part) shape.push_back(position[0]);
  }
  expect_no_way_around(shapes);
  EXPECT_EQ(shapes[0].back(), 180);
  EXPECT_EQ(shapes[1].front(), -180);
  out.volumes = {{"box", make_box_mesh({-30, -20, 5}, {30, 20, 45})}};
  expect_no_way_around(longitudes_of(flight_plan_bytes(out, PlanFormat::kml)));
  for (const PlanFormat format : {PlanFormat::geojson, PlanFormat::kml}) {
    const LocatedPlan read = located(out, format);
    ASSERT_EQ(read.flight.points.size(), 6U);
    std::size_t next = 0;
    for (const std::size_t i : {0U, 2U, 3U, 5U}) {
      const FlightPoint &was = out.flight.points[next++], &is = read.flight.points[i];
      EXPECT_LT((is.position - was.position).norm(), 1.5e-6);
      EXPECT_EQ(is.hold_s, was.hold_s);
    }
    for (const std::size_t i : {1U, 4U}) {  // on the leg, at its speed
      EXPECT_NEAR(read.flight.points[i].position.x(), 0, 1e-6);
      EXPECT_EQ(read.flight.points[i].speed_m_s, read.flight.points[i + 1].speed_m_s);
      const Vec3 a = read.flight.points[i - 1].position, b = read.flight.points[i + 1].position;
      EXPECT_LT((b - a).normalized().cross(read.flight.points[i].position - a).norm(), 2e-6);
    }
    EXPECT_TRUE(read.notes.empty());
  }
}

TEST(Antimeridian, PointsOfFlightsOnItAreNoCuts) {
  FlightOut out = flight_across(180);
  out.flight.points = {
      {{-100, 0, 40}, 0, 8}, {{0, 0, 40}, 3, 8}, {{-50, 90, 40}, 0, 8}, {{0, 60, 40}, 0, 8}, {{80, 0, 40}, 0, 8}};
  for (const PlanFormat format : {PlanFormat::geojson, PlanFormat::kml}) {
    const LocatedPlan read = located(out, format);
    ASSERT_EQ(read.flight.points.size(), 5U);
    EXPECT_EQ(read.flight.points[1].hold_s, 3);
  }
  const json features = json::parse(flight_plan_bytes(out, PlanFormat::geojson)).at("features");
  EXPECT_EQ(features.at(0).at("geometry").at("coordinates").size(), 2U);
}

/// A line of one position is none, in GeoJSON (RFC 7946, section 3.1.4) and in KML.
TEST(Antimeridian, FlightsThatBeginOnItHaveNoLinesOfOnePoint) {
  for (const double longitude_deg : {180.0, -180.0}) {
    for (const double east : {50.0, -50.0}) {
      for (const bool is_along : {false, true}) {
        FlightOut out = flight_across(longitude_deg);
        out.flight.points = {{{0, 0, 40}, 2, 8}, {{east, 0, 40}, 0, 8}, {{-east, 9, 40}, 0, 8}};
        if (is_along) out.flight.points.insert(out.flight.points.begin() + 1, FlightPoint{{0, 30, 40}, 0, 8});
        const json features = json::parse(flight_plan_bytes(out, PlanFormat::geojson)).at("features");
        const json& lines = features.at(0).at("geometry").at("coordinates");
        ASSERT_EQ(lines.size(), 2U);
        for (const json& line : lines) {
          EXPECT_GE(line.size(), 2U);
          for (const json& position : line) EXPECT_GT(position[0].get<double>() * line.back()[0].get<double>(), 0);
        }
        for (const PlanFormat format : {PlanFormat::geojson, PlanFormat::kml}) {
          const LocatedPlan read = located(out, format);
          EXPECT_EQ(read.flight.points.size(), is_along ? 5U : 4U);
          EXPECT_EQ(read.flight.points.front().hold_s, 2);
          EXPECT_TRUE(read.notes.empty());
        }
      }
    }
  }
}

TEST(Antimeridian, OtherPlansHoldPointsAlone) {
  FlightOut out = flight_across(180);
  out.flight.points[1].position.x() = 0;
  const std::string gpx = flight_plan_bytes(out, PlanFormat::gpx);
  EXPECT_EQ(gpx.find("lon=\"180\""), std::string::npos);
  EXPECT_NE(gpx.find("lon=\"-180\""), std::string::npos);
  EXPECT_EQ(located(out, PlanFormat::gpx).flight.points.size(), 4U);
  // Programs turn the degrees of CZML into places on the earth first, and draw lines between these.
  const json packets = json::parse(flight_plan_bytes(out, PlanFormat::czml));
  const json& numbers = packets.at(1).at("position").at("cartographicDegrees");
  for (std::size_t i = 1; i < numbers.size(); i += 4) EXPECT_LE(std::abs(numbers[i].get<double>()), 180);
}

TEST(Antimeridian, SeenPolygonsAreCut) {
  PointFraction answer;
  answer.seen = {
      {{{-20, -20, 5}, {20, -20, 5}, {20, 20, 5}, {-20, 20, 5}}, {{{-5, -5, 5}, {-5, 5, 5}, {5, 5, 5}, {5, -5, 5}}}}};
  SeenGeoJson writer(fiji(-179.99999), FractionMeasure::area);
  const json geometry =
      json::parse(writer.beginning() + writer.feature(answer) + writer.end()).at("features").at(0).at("geometry");
  EXPECT_EQ(geometry.at("type"), "MultiPolygon");
  ASSERT_EQ(geometry.at("coordinates").size(), 2U);
  std::vector<std::vector<double>> shapes;
  for (const json& polygon : geometry.at("coordinates")) {
    EXPECT_EQ(polygon.size(), 1U);
    EXPECT_EQ(polygon[0].front(), polygon[0].back());
    double turn = 0;
    std::vector<double>& shape = shapes.emplace_back();
    for (std::size_t i = 0; i + 1 < polygon[0].size(); ++i) {
      const json &a = polygon[0][i], &b = polygon[0][i + 1];
      shape.push_back(a[0]);
      turn += a[0].get<double>() * b[1].get<double>() - b[0].get<double>() * a[1].get<double>();
      EXPECT_EQ(a[2], 5);
    }
    EXPECT_GT(turn, 0);  // counter-clockwise
  }
  expect_no_way_around(shapes);
}

}  // namespace
}  // namespace vantage::testing
