// Plans that are written: read back, and the fields that ground stations demand.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "geo/ellipsoid.h"
#include "geo/on_globe.h"
#include "io/write_zip.h"
#include "io/zip.h"
#include "support/internals.h"
#include "support/random.h"
#include "support/temporary_directory.h"
#include "support/tile_files.h"
#include "support/wording.h"
#include "vantage/flight.h"

namespace vantage::testing {
namespace {

using nlohmann::json;

constexpr PlanFormat kFormats[] = {
    PlanFormat::qgroundcontrol, PlanFormat::waypoints, PlanFormat::kml, PlanFormat::wpml, PlanFormat::gpx,
    PlanFormat::geojson,        PlanFormat::csv};

bool can_state(PlanFormat format, HeightDatum heights) {
  switch (format) {
    case PlanFormat::qgroundcontrol:
    case PlanFormat::waypoints:
      return heights == HeightDatum::home || heights == HeightDatum::sea_level;
    case PlanFormat::kml:
    case PlanFormat::gpx:
      return heights == HeightDatum::sea_level;
    case PlanFormat::geojson:
      return heights == HeightDatum::ellipsoid;
    case PlanFormat::wpml:
      return heights != HeightDatum::scene_z;
    default:
      return true;
  }
}

/// Three points, with everything that formats need.
FlightOut flight_out() {
  FlightOut out;
  out.flight.points = {{{100, 50, 40}, 2, 8}, {{-200, 300, 60}, 0, 8}, {{10, -400, 55.25}, 1.5, 6}};
  out.georeference.emplace();
  out.georeference->latitude_deg = 48.1374;
  out.georeference->longitude_deg = 11.5755;
  out.georeference->vertical = "EGM96 geoid";
  out.levels.undulation_m = 45.75;
  out.heights = HeightDatum::home;
  out.home = Vec3(5, 6, 10);
  out.speed_m_s = 8;
  out.aircraft = DjiAircraft{77, 0, 66, 20};
  return out;
}

/// As if the scene had been read from a tileset.
void on_earth(FlightOut& out) {
  out.georeference->vertical = internal::geo::kEllipsoidalHeight;
  out.georeference->source_crs = internal::geo::kEarthCentred;
}

LocatedPlan read_back(const FlightOut& out, PlanFormat format, FlightPlan* read = nullptr) {
  const FlightPlan plan = parse_flight_plan(flight_plan_bytes(out, format), "written");
  EXPECT_EQ(plan.format, format);
  if (read) *read = plan;
  LocateOptions options;
  options.georeference = out.georeference;
  options.levels = out.levels;
  if (out.home) options.home_z_m = out.home->z();
  if (out.home && out.georeference &&
      internal::geo::OnGlobe(*out.georeference).is_cartesian()) {  // z alone does not say how high that is
    const auto place = internal::geo::OnGlobe(*out.georeference).to_geodetic(*out.home).place;
    options.home = Eigen::Vector2d(place.longitude_deg, place.latitude_deg);
  }
  return locate_flight(plan, options);
}

// Rounding costs a micrometre at most: half of 1e-11 degrees is 0.6 um, half of the last digit of a height 0.5 um.
TEST(WriteFlightPlan, IsReadBackToTheMicrometre) {
  Random random(21);
  for (int round = 0; round < 40; ++round) {
    FlightOut out = flight_out();
    out.georeference->latitude_deg = random.uniform(-80, 80);
    out.georeference->longitude_deg = round % 5 == 0 ? 179.999 : random.uniform(-180, 180);
    if (round % 4 == 1) on_earth(out);
    out.home = random.point(-50, 50);
    const double extent = round % 3 == 0 ? 5e3 : 300;
    out.flight.points.clear();
    for (int i = random.integer(2, 9); i-- > 0;) {
      out.flight.points.push_back(
          {random.point(-extent, extent), random.chance(0.5) ? random.uniform(0.1, 9) : 0, random.uniform(1, 14)});
    }
    for (const PlanFormat format : kFormats) {
      for (const HeightDatum heights :
           {HeightDatum::home, HeightDatum::sea_level, HeightDatum::ellipsoid, HeightDatum::scene_z}) {
        if (!can_state(format, heights)) continue;
        SCOPED_TRACE(std::string(name_of(format)) + " above " + name_of(heights));
        out.heights = heights;
        FlightPlan plan;
        const LocatedPlan located = read_back(out, format, &plan);
        std::vector<FlightPoint> points;
        for (std::size_t i = 0; i < located.items.size(); ++i) {
          const bool is_last = i + 1 == located.items.size() || located.items[i + 1] != located.items[i];
          const PlanItem& item = plan.items[located.items[i]];
          const bool is_cut = std::abs(item.position.horizontal.x()) == 180;  // a line at the antimeridian
          if (is_last && item.kind == PlanItemKind::waypoint && !is_cut) points.push_back(located.flight.points[i]);
        }
        ASSERT_EQ(points.size(), out.flight.points.size());
        for (std::size_t i = 0; i < points.size(); ++i) {
          ASSERT_LT((points[i].position - out.flight.points[i].position).norm(), 1.5e-6);
          const bool is_mission = format == PlanFormat::qgroundcontrol || format == PlanFormat::waypoints;
          const double hold_s = out.flight.points[i].hold_s;
          ASSERT_NEAR(points[i].hold_s, is_mission ? std::ceil(hold_s) : hold_s, 1e-3);
          ASSERT_GE(points[i].hold_s, out.flight.points[i].hold_s - 1e-9);
          ASSERT_NEAR(points[i].speed_m_s, out.flight.points[i].speed_m_s, 6e-4);
        }
      }
    }
  }
}

// The frame of a scene from a tileset is turned about the earth's centre, not bent: at 2 km a level that is flat there
// is 0.3 m above the ellipsoid's.
TEST(WriteFlightPlan, ScenesOfTilesetsLieWhereTheEarthIs) {
  FlightOut out = flight_out();
  on_earth(out);
  out.heights = HeightDatum::ellipsoid;
  out.flight.points.clear();
  for (const Vec3& at : {Vec3(0, 0, 0), Vec3(2000, 0, 120), Vec3(0, -2000, 120), Vec3(-1414, 1414, 500)}) {
    out.flight.points.push_back({at, 0, 8});
  }
  const json axes = transform_at(out.georeference->latitude_deg, out.georeference->longitude_deg);
  Eigen::Matrix4d into_earth;
  for (Eigen::Index i = 0; i < 16; ++i) into_earth(i % 4, i / 4) = axes[static_cast<std::size_t>(i)];
  const json features = json::parse(flight_plan_bytes(out, PlanFormat::geojson)).at("features");
  const json& line = features.at(0).at("geometry").at("coordinates");
  ASSERT_EQ(line.size(), 4U);
  for (std::size_t i = 0; i < 4; ++i) {
    const json place = transform_at(line[i][1], line[i][0]);  // its last column is on the ellipsoid, its third is up
    Vec3 written;
    for (std::size_t k = 0; k < 3; ++k) {
      written[static_cast<Eigen::Index>(k)] =
          place[12 + k].get<double>() + line[i][2].get<double>() * place[8 + k].get<double>();
    }
    const Vec3 exact = into_earth.topLeftCorner<3, 3>() * out.flight.points[i].position + into_earth.col(3).head<3>();
    EXPECT_LT((written - exact).norm(), 1.5e-6) << i;
  }
  EXPECT_NEAR(line[1][2].get<double>(), 120 + 2000.0 * 2000 / (2 * 6.385e6), 1e-3);
  // And above the home.
  out.heights = HeightDatum::home;
  out.home = Vec3(0, 0, 20);
  std::istringstream last_row(flight_plan_bytes(out, PlanFormat::csv));
  std::string row;
  for (int i = 0; i < 5; ++i) std::getline(last_row, row);
  for (int i = 0; i < 3; ++i) row.erase(0, row.find(',') + 1);
  EXPECT_NEAR(std::stod(row), 480 + 2 * 1414.0 * 1414 / (2 * 6.385e6), 1e-3);
}

// Vehicles keep their height, and the scene is flat: long legs are cut.
TEST(WriteFlightPlan, LevelLegsInScenesOfTilesetsAreCut) {
  FlightOut out = flight_out();
  on_earth(out);
  out.heights = HeightDatum::ellipsoid;
  const internal::geo::OnGlobe globe(*out.georeference);
  for (const double longitude : {11.56, 11.62}) {
    out.flight.points.push_back({globe.to_scene({{longitude, 48.1374}, 300}), 0, 8});
  }
  out.flight.points.erase(out.flight.points.begin(), out.flight.points.begin() + 3);
  const LocatedPlan read = read_back(out, PlanFormat::geojson);
  EXPECT_GT(read.flight.points.size(), 5U);
  for (std::size_t i = 0; i + 1 < read.flight.points.size(); ++i) {
    const Vec3 middle = (read.flight.points[i].position + read.flight.points[i + 1].position) / 2;
    EXPECT_NEAR(globe.to_geodetic(middle).height_m, 300, read.flight.chord_error_m);
  }
  EXPECT_LE(read.flight.chord_error_m, 0.05);
}

// On a climb the earth also turns what is gained in height. Along a meridian, where latitude is distance.
TEST(WriteFlightPlan, ClimbsInScenesOfTilesetsAreCut) {
  for (const double climb : {300.0, 1000.0, 3000.0}) {
    FlightOut out = flight_out();
    on_earth(out);
    out.heights = HeightDatum::ellipsoid;
    const internal::geo::OnGlobe globe(*out.georeference);
    const auto on_leg = [&](double share) {
      return globe.to_scene({{11.5755, 48.1374 + 0.0044 * share}, 100 + climb * share});  // 489 m
    };
    out.flight.points = {{on_leg(0), 0, 8}, {on_leg(1), 0, 8}};
    const LocatedPlan read = read_back(out, PlanFormat::geojson);
    EXPECT_LE(read.flight.chord_error_m, 0.0101);  // a tenth of 0.05 m, twice
    for (std::size_t i = 0; i + 1 < read.flight.points.size(); ++i) {
      const Vec3 a = read.flight.points[i].position, along = (read.flight.points[i + 1].position - a).normalized();
      double beside = 0;
      for (int k = 0; k <= 1000; ++k) {
        const Vec3 way = on_leg(k / 1000.0) - a;
        const double at = way.dot(along);
        if (at > 0 && at < (read.flight.points[i + 1].position - a).norm()) {
          beside = std::max(beside, (way - at * along).norm());
        }
      }
      EXPECT_LE(beside, read.flight.chord_error_m) << climb;
    }
  }
}

TEST(WriteFlightPlan, HasTheFieldsThatQGroundControlDemands) {
  FlightOut out = flight_out();
  out.actions.resize(3);
  out.actions[0].look_at = Vec3(0, 0, 5);
  out.actions[0].photo = true;
  out.actions[1].gimbal_pitch_deg = -40;
  out.actions[1].yaw_deg = 90;
  out.actions[2].video = true;
  const json root = json::parse(flight_plan_bytes(out, PlanFormat::qgroundcontrol));
  EXPECT_EQ(root.at("fileType"), "Plan");
  EXPECT_EQ(root.at("version"), 1);
  EXPECT_TRUE(root.at("geoFence").at("polygons").is_array());
  EXPECT_TRUE(root.at("rallyPoints").at("points").is_array());
  const json& mission = root.at("mission");
  EXPECT_EQ(mission.at("version"), 2);
  EXPECT_EQ(mission.at("vehicleType"), 2);
  EXPECT_EQ(mission.at("globalPlanAltitudeMode"), 1);
  EXPECT_EQ(mission.at("plannedHomePosition").size(), 3u);
  EXPECT_EQ(mission.at("plannedHomePosition")[2], 10);
  std::vector<int> commands;
  for (const json& item : mission.at("items")) {
    commands.push_back(item.at("command"));
    EXPECT_EQ(item.at("doJumpId"), commands.size());
    EXPECT_EQ(item.at("type"), "SimpleItem");
    EXPECT_EQ(item.at("autoContinue"), true);
    ASSERT_EQ(item.at("params").size(), 7u);
    const std::size_t heights = item.count("AMSLAltAboveTerrain") + item.count("Altitude") + item.count("AltitudeMode");
    EXPECT_EQ(heights, item.at("frame") == 2 ? 0u : 3u);
    if (heights > 0) {
      EXPECT_EQ(item.at("frame"), 3);
      EXPECT_EQ(item.at("AltitudeMode"), 1);
      EXPECT_EQ(item.at("Altitude"), item.at("params")[6]);
      EXPECT_TRUE(item.at("AMSLAltAboveTerrain").is_null());
    }
  }
  EXPECT_EQ(commands, (std::vector<int>{22, 178, 195, 16, 2000, 197, 205, 16, 178, 16, 2500, 93, 2501, 20}));
  EXPECT_EQ(mission.at("items")[11].at("params")[0], 2) << "of 1.5 s: ArduPilot stores whole seconds";
  EXPECT_EQ(mission.at("items")[0].at("params")[6], 30);  // to the height of the first point, 40 - 10
  out.heights = HeightDatum::sea_level;
  const json absolute = json::parse(flight_plan_bytes(out, PlanFormat::qgroundcontrol)).at("mission").at("items");
  EXPECT_EQ(absolute[3].at("frame"), 0);
  EXPECT_EQ(absolute[3].at("AltitudeMode"), 2);
  EXPECT_EQ(absolute[3].at("Altitude"), 40);
  // Of flat ground nobody knows how high it lies: the ground station looks it up.
  out.heights = HeightDatum::home;
  out.georeference->vertical = kFlatGround;
  out.levels = {};
  EXPECT_TRUE(json::parse(flight_plan_bytes(out, PlanFormat::qgroundcontrol))
                  .at("mission")
                  .at("plannedHomePosition")[2]
                  .is_null());
}

TEST(WriteFlightPlan, HoldsTheZonesAsAGeofence) {
  const auto square = [](double x, double y, double half) {
    return Zone::Ring{{x - half, y - half}, {x + half, y - half}, {x + half, y + half}, {x - half, y + half}};
  };
  const auto zone = [&](const Zone::Ring& outer, const std::string& name) {
    Zone one;
    one.outer = outer;
    one.name = name;
    return one;
  };
  FlightOut out = flight_out();
  out.keep_in = {zone(square(0, 0, 500), "park")};
  out.keep_in[0].holes = {square(300, 300, 20)};
  out.keep_out = {zone(square(-300, -300, 50), "pond"), zone(square(-50, 175, 30), "bridge")};
  out.keep_out[1].max_z_m = 20;  // the first leg flies over it
  const auto expect_fence = [&](const std::vector<std::pair<bool, Zone::Ring>>& expected) {
    const json fence = json::parse(flight_plan_bytes(out, PlanFormat::qgroundcontrol)).at("geoFence");
    EXPECT_EQ(fence.at("circles"), json::array());
    ASSERT_EQ(fence.at("polygons").size(), expected.size());
    const internal::geo::OnGlobe globe(*out.georeference);
    for (std::size_t i = 0; i < expected.size(); ++i) {
      const json& polygon = fence.at("polygons")[i];
      EXPECT_EQ(polygon.at("version"), 1);
      EXPECT_EQ(polygon.at("inclusion"), expected[i].first);
      ASSERT_EQ(polygon.at("polygon").size(), expected[i].second.size());
      for (std::size_t k = 0; k < expected[i].second.size(); ++k) {
        const Eigen::Vector2d& corner = expected[i].second[k];
        const auto place = globe.to_geodetic(Vec3(corner.x(), corner.y(), 40)).place;
        EXPECT_NEAR(polygon.at("polygon")[k][0].get<double>(), place.latitude_deg, 1e-10);
        EXPECT_NEAR(polygon.at("polygon")[k][1].get<double>(), place.longitude_deg, 1e-10);
      }
    }
    expect_wording(plan_notes(out, PlanFormat::qgroundcontrol));
  };
  expect_fence({{true, square(0, 0, 500)}, {false, square(300, 300, 20)}, {false, square(-300, -300, 50)}});
  out.keep_in.push_back(zone(square(900, 0, 100), "meadow"));
  out.keep_out[1].outer = square(5, 6, 4);  // the home lies in it
  expect_fence({{true, square(0, 0, 500)},
                {true, square(900, 0, 100)},
                {false, square(300, 300, 20)},
                {false, square(-300, -300, 50)}});
  out.keep_in = {zone(square(0, 0, 200), "yard")};  // the flight leaves it
  expect_fence({{false, square(-300, -300, 50)}});
}

TEST(WriteFlightPlan, KeepsWhatIsDone) {
  FlightOut out = flight_out();
  out.actions.resize(3);
  out.actions[0].look_at = Vec3(100, 150, 40);  // north, level
  out.actions[1].gimbal_pitch_deg = -40;
  out.actions[1].yaw_deg = -90;
  out.actions[2].look_at = Vec3(10, -400, 0);  // straight down
  FlightPlan plan;
  read_back(out, PlanFormat::qgroundcontrol, &plan);
  ASSERT_EQ(plan.items.size(), 5u);
  ASSERT_TRUE(plan.items[1].look_at);
  EXPECT_NEAR(plan.items[1].look_at->height_m, 30, 1e-6);
  EXPECT_EQ(plan.items[2].gimbal_pitch_deg, -40);
  EXPECT_EQ(plan.items[2].yaw_deg, -90);
  EXPECT_FALSE(plan.items[2].look_at);
  EXPECT_EQ(plan.vehicle, PlanVehicle::multirotor);
  for (const PlanFormat format :
       {PlanFormat::wpml, PlanFormat::csv, PlanFormat::kml, PlanFormat::gpx, PlanFormat::geojson}) {
    SCOPED_TRACE(name_of(format));
    out.heights.reset();
    if (can_state(format, HeightDatum::home)) out.heights = HeightDatum::home;
    read_back(out, format, &plan);
    const std::size_t first = plan.items[0].kind == PlanItemKind::takeoff ? 1 : 0;
    EXPECT_EQ(plan.items[first].yaw_deg, 0);
    EXPECT_EQ(plan.items[first].gimbal_pitch_deg, 0);
    EXPECT_EQ(plan.items[first + 1].yaw_deg, -90);
    EXPECT_EQ(plan.items[first + 1].gimbal_pitch_deg, -40);
    EXPECT_EQ(plan.items[first + 2].gimbal_pitch_deg, -90);
  }
}

TEST(WriteFlightPlan, MakesCirclesChords) {
  FlightOut out = flight_out();
  out.actions.resize(3);
  out.actions[1].loiter_radius_m = 30;
  out.actions[1].turns = 1.5;
  out.chord_error_m = 0.01;
  for (const PlanFormat format : kFormats) {
    SCOPED_TRACE(name_of(format));
    out.heights = can_state(format, HeightDatum::sea_level) ? HeightDatum::sea_level : HeightDatum::ellipsoid;
    const LocatedPlan located = read_back(out, format);
    std::size_t on_circle = 0;
    for (const FlightPoint& point : located.flight.points) {
      const Vec3 off = point.position - out.flight.points[1].position;
      if (off.norm() > 40) continue;
      EXPECT_NEAR(off.head<2>().norm(), 30, 0.011);
      ++on_circle;
    }
    EXPECT_GT(on_circle, 50u);
  }
}

TEST(WriteFlightPlan, SaysWhatIsDoneInTheWordsOfEachFormat) {
  FlightOut out = flight_out();
  out.heights.reset();
  out.actions.resize(3);
  out.actions[0].photo = true;
  out.actions[0].sees = "a <b>";
  out.actions[2].loiter_radius_m = 20;
  out.actions[2].look_at = Vec3(0, 0, 5);
  const std::string shown = flight_plan_bytes(out, PlanFormat::kml), route = flight_plan_bytes(out, PlanFormat::gpx);
  for (const std::string part : {"<Data name=\"point\"><value>1</value></Data>", "<Data name=\"photo\"><value>1<",
                                 "<Data name=\"hold_s\"><value>2<", "<Data name=\"sees\"><value>a &lt;b&gt;<",
                                 "<Data name=\"point\"><value>9<", "<Data name=\"gimbal_pitch_deg\"><value>-"}) {
    EXPECT_NE(shown.find(part), std::string::npos) << part;
  }
  for (const std::string part : {"<vantage:hold_s>2</vantage:hold_s>", "<vantage:speed_m_s>8<", "<vantage:photo>1<",
                                 "<vantage:sees>a &lt;b&gt;<", "xmlns:vantage="}) {
    EXPECT_NE(route.find(part), std::string::npos) << part;
  }
  const json features = json::parse(flight_plan_bytes(
      [&] {
        FlightOut of = out;
        of.heights = HeightDatum::ellipsoid;
        return of;
      }(),
      PlanFormat::geojson))["features"];
  EXPECT_EQ(features[1]["properties"]["photo"], true);
  EXPECT_EQ(features[1]["properties"]["sees"], "a <b>");
  FlightOut dji = flight_out();
  dji.actions = {out.actions[0], {}, {}};
  const std::string waylines =
      io::unzipped(flight_plan_bytes(dji, PlanFormat::wpml), "wpmz/waylines.wpml", ".none", 1'000'000);
  EXPECT_NE(waylines.find("<wpml:fileSuffix>point1_a_b_<"), std::string::npos) << "the name of the photo's file";
  EXPECT_EQ(features.size(), features[0]["geometry"]["coordinates"].size() + 1) << "the camera turns at each chord";
}

TEST(WriteFlightPlan, TakesOffNoHigherThanIsAllowed) {
  FlightOut out = flight_out();
  const auto climbs_to = [&](double highest_m, const std::string& height) {
    out.highest_takeoff_m = highest_m;
    const std::string text =
        io::unzipped(flight_plan_bytes(out, PlanFormat::wpml), "wpmz/waylines.wpml", ".none", 1'000'000);
    EXPECT_NE(text.find("<wpml:takeOffSecurityHeight>" + height + "<"), std::string::npos) << height;
  };
  climbs_to(12, "12");
  climbs_to(11.9999, "11.999");
  climbs_to(100, "20");
  climbs_to(1.2, "1.2");
  out.highest_takeoff_m = 1.1;
  expect_error([&] { flight_plan_bytes(out, PlanFormat::wpml); }, ErrorCode::value_unsupported);
}

TEST(WriteFlightPlan, HasNoLineOfOnePosition) {
  FlightOut out = flight_out();
  out.flight.points = {{{100, 50, 40}, 2, 8}};
  for (const PlanFormat format : {PlanFormat::kml, PlanFormat::geojson}) {
    out.heights.reset();
    EXPECT_EQ(flight_plan_bytes(out, format).find("LineString"), std::string::npos);
    const LocatedPlan read = read_back(out, format);
    ASSERT_EQ(read.flight.points.size(), 1U);
    EXPECT_EQ(read.flight.points[0].hold_s, 2);
    EXPECT_TRUE(read.notes.empty());
  }
}

TEST(WriteFlightPlan, DrawsVolumesInKml) {
  FlightOut out = flight_out();
  out.heights.reset();
  out.name = "a <b> & \"c\"\x01";
  NamedVolume volume{"tower & square", {}};
  volume.mesh.vertices = {{0, 0, 0}, {10, 0, 0}, {0, 10, 0}, {0, 0, 10}};
  volume.mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};
  out.volumes = {volume};
  const std::string text = flight_plan_bytes(out, PlanFormat::kml);
  std::size_t polygons = 0;
  for (std::size_t at = text.find("<Polygon>"); at != std::string::npos; at = text.find("<Polygon>", at + 1))
    ++polygons;
  EXPECT_EQ(polygons, 4u);
  EXPECT_NE(text.find("tower &amp; square"), std::string::npos);
  EXPECT_NE(text.find("a &lt;b&gt; &amp; &quot;c&quot;"), std::string::npos);
  EXPECT_EQ(parse_flight_plan(text, "a.kml").items.size(), 3u);
}

TEST(WriteFlightPlan, PacksTheTwoFilesOfDji) {
  const std::string archive = flight_plan_bytes(flight_out(), PlanFormat::wpml);
  EXPECT_EQ(archive, flight_plan_bytes(flight_out(), PlanFormat::wpml));
  const std::string waylines = io::unzipped(archive, "wpmz/waylines.wpml", ".none", 1'000'000);
  const std::string shown = io::unzipped(archive, "wpmz/template.kml", ".none", 1'000'000);
  for (const std::string part : {"<wpml:droneEnumValue>77</wpml:droneEnumValue>", "<wpml:finishAction>goHome<",
                                 "<wpml:takeOffSecurityHeight>20<", "<wpml:index>2<", "<wpml:waypointTurnMode>"}) {
    EXPECT_NE(waylines.find(part), std::string::npos) << part;
    EXPECT_NE(shown.find(part), std::string::npos) << part;
  }
  EXPECT_NE(waylines.find("<wpml:executeHeightMode>relativeToStartPoint<"), std::string::npos);
  EXPECT_NE(shown.find("<wpml:templateType>waypoint<"), std::string::npos);
  // The template says the same.
  FlightOut out = flight_out();
  out.heights = HeightDatum::sea_level;
  const FlightPlan plan = parse_flight_plan(
      io::unzipped(flight_plan_bytes(out, PlanFormat::wpml), "wpmz/template.kml", ".none", 1'000'000), "template.kml");
  EXPECT_EQ(plan.items[1].position.datum, HeightDatum::sea_level);
  EXPECT_EQ(plan.items[1].position.height_m, 40);
}

TEST(WriteFlightPlan, ADamagedFileOfDjiIsNotReplacedByItsTemplate) {
  const std::string archive = flight_plan_bytes(flight_out(), PlanFormat::wpml);
  EXPECT_EQ(parse_flight_plan(archive, "flight.kmz").format, PlanFormat::wpml);
  // The bytes of waylines.wpml lie behind its name, those of the template before or behind them.
  const std::size_t name = archive.find("wpmz/waylines.wpml");
  int refused = 0;
  for (std::size_t at = name + 60; at < name + 400; at += 17) {
    std::string damaged = archive;
    damaged[at] = static_cast<char>(damaged[at] ^ 4);
    expect_code([&] { parse_flight_plan(damaged, "flight.kmz"); }, ErrorCode::plan_syntax, "flight.kmz");
    ++refused;
  }
  EXPECT_EQ(refused, 20);
}

TEST(WriteFlightPlan, DrawsAsManyVolumesInKmlAsAreReadBack) {
  FlightOut out = flight_out();
  out.heights = HeightDatum::sea_level;
  Mesh large;
  large.vertices = {{0, 0, 1}, {1, 0, 1}, {0, 1, 1}};
  large.triangles.assign(100'000, Triangle{0, 1, 2});
  out.volumes = {{"one", large}, {"two", large}};
  const std::string text = flight_plan_bytes(out, PlanFormat::kml);
  EXPECT_LT(text.size(), kMostPlanBytes);
  EXPECT_NE(text.find("<name>one<"), std::string::npos);
  EXPECT_EQ(text.find("<name>two<"), std::string::npos);
  EXPECT_EQ(parse_flight_plan(text, "flight.kml").items.size(), out.flight.points.size());
  const auto is_of_volumes = [](const std::string& note) { return note.find("volumes") != std::string::npos; };
  const std::vector<std::string> notes = plan_notes(out, PlanFormat::kml);
  EXPECT_TRUE(std::any_of(notes.begin(), notes.end(), is_of_volumes));
}

TEST(WriteFlightPlan, SaysWhatIsMissing) {
  const auto refuse = [](const FlightOut& out, PlanFormat format, ErrorCode code) {
    expect_error([&] { flight_plan_bytes(out, format); }, code);
  };
  FlightOut out = flight_out();
  out.heights.reset();
  for (const PlanFormat format :
       {PlanFormat::qgroundcontrol, PlanFormat::waypoints, PlanFormat::wpml, PlanFormat::csv}) {
    refuse(out, format, ErrorCode::missing_key);
  }
  out.heights = HeightDatum::ellipsoid;
  refuse(out, PlanFormat::qgroundcontrol, ErrorCode::value_unsupported);
  out.heights = HeightDatum::home;
  refuse(out, PlanFormat::kml, ErrorCode::value_unsupported);
  refuse(out, PlanFormat::gpx, ErrorCode::value_unsupported);
  refuse(out, PlanFormat::geojson, ErrorCode::value_unsupported);
  out.home.reset();
  refuse(out, PlanFormat::qgroundcontrol, ErrorCode::missing_key);
  refuse(out, PlanFormat::csv, ErrorCode::missing_key);
  out = flight_out();
  out.georeference->vertical = kFlatGround;
  out.heights = HeightDatum::sea_level;
  refuse(out, PlanFormat::kml, ErrorCode::height_unknown);
  refuse(out, PlanFormat::qgroundcontrol, ErrorCode::height_unknown);
  out.heights = HeightDatum::home;
  refuse(out, PlanFormat::waypoints, ErrorCode::height_unknown);  // its first row is above sea level
  out = flight_out();
  out.levels = {};
  out.heights = HeightDatum::ellipsoid;
  refuse(out, PlanFormat::geojson, ErrorCode::height_unknown);
  out = flight_out();
  out.georeference.reset();
  refuse(out, PlanFormat::csv, ErrorCode::not_georeferenced);
  out.heights = HeightDatum::scene_z;
  EXPECT_NO_THROW(flight_plan_bytes(out, PlanFormat::csv));
  out = flight_out();
  out.aircraft.reset();
  refuse(out, PlanFormat::wpml, ErrorCode::missing_key);
  out = flight_out();
  out.speed_m_s = out.flight.points[0].speed_m_s = std::numeric_limits<double>::quiet_NaN();
  refuse(out, PlanFormat::wpml, ErrorCode::missing_key);
  out = flight_out();
  out.flight.points[1].speed_m_s = 20;
  refuse(out, PlanFormat::wpml, ErrorCode::value_out_of_range);
  out = flight_out();
  out.aircraft->takeoff_height_m = 0;
  refuse(out, PlanFormat::wpml, ErrorCode::value_out_of_range);
  out = flight_out();
  out.aircraft->payload.reset();
  out.actions.resize(3);
  out.actions[1].photo = true;
  refuse(out, PlanFormat::wpml, ErrorCode::missing_key);
  out = flight_out();
  out.flight.points.resize(1);
  refuse(out, PlanFormat::wpml, ErrorCode::value_unsupported);
  out = flight_out();
  out.actions.resize(2);
  refuse(out, PlanFormat::csv, ErrorCode::array_sizes_differ);
  out.actions.resize(3);
  out.actions[2].turns = 0;
  out.actions[2].loiter_radius_m = 5;
  refuse(out, PlanFormat::csv, ErrorCode::value_out_of_range);
  out = flight_out();
  out.flight.points[1].position.x() = std::nan("");
  refuse(out, PlanFormat::csv, ErrorCode::coordinate_not_finite);
}

TEST(WriteFlightPlan, WritesWholeFilesByTheirNames) {
  const TemporaryDirectory folder;
  FlightOut out = flight_out();
  for (const std::string name : {"a.plan", "a.WAYPOINTS", "a.kmz", "a.csv"}) {
    write_flight_plan(out, folder / name);
    EXPECT_EQ(read_flight_plan(folder / name).format, plan_format_of(name)) << name;
  }
  const std::string before = read_bytes(folder / "a.plan");
  out.home.reset();
  expect_code([&] { write_flight_plan(out, folder / "a.plan"); }, ErrorCode::missing_key);
  EXPECT_EQ(read_bytes(folder / "a.plan"), before);
  expect_error([&] { write_flight_plan(out, "a.txt"); }, ErrorCode::output_format_unknown, "a.txt");
  EXPECT_EQ(folder.names().size(), 4u);
}

TEST(WriteZip, IsReadBack) {
  Random random(3);
  std::string noise;
  for (int i = 0; i < 100'000; ++i) noise += static_cast<char>(random.integer(0, 255));
  const std::string archive =
      io::zipped({{"a/empty.txt", ""}, {"a/zeros.bin", std::string(1'000'000, '\0')}, {"noise.bin", noise}});
  EXPECT_TRUE(io::is_zip(archive));
  EXPECT_LT(archive.size(), 110'000u);
  EXPECT_EQ(io::unzipped(archive, "a/empty.txt", ".none", 0), "");
  EXPECT_EQ(io::unzipped(archive, "a/zeros.bin", ".none", 1'000'000), std::string(1'000'000, '\0'));
  EXPECT_EQ(io::unzipped(archive, "noise.bin", ".none", 100'000), noise);
}

}  // namespace
}  // namespace vantage::testing
