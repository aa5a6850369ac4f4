// Scenes from tilesets on the earth: their frame touches the ellipsoid, and is no map. What a mission gives in a
// coordinate reference system, or by longitude and latitude, lies there all the same.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/mission_parser.h"
#include "core/format.h"
#include "geo/ellipsoid.h"
#include "geo/on_globe.h"
#include "support/internals.h"
#include "support/random.h"
#include "support/temporary_directory.h"
#include "support/tile_files.h"
#include "support/zone_texts.h"
#include "vantage/earth.h"
#include "vantage/error.h"
#include "vantage/flight.h"
#include "vantage/flight_check.h"
#include "vantage/mission.h"

namespace vantage::testing {
namespace {

constexpr double kExactM = 1e-6, kGroundM = 40;
/// What is laid on the ground is rounded to 2^-13 m in x and in y.
constexpr double kLaidM = 0.71 / 8192 + kExactM;
constexpr double kMetresPerDegree = 111.2e3;
const std::vector<double> kDistancesM = {0, 400, 2000, 10000};

struct Origin {
  double latitude_deg, longitude_deg;
};
const std::vector<Origin> kOrigins = {{0, 12}, {48.1, 11.5}, {-33.9, 151.2}, {69.6, 18.9}, {35.67, -179.999}};

Georeference georeference_of(const Origin& origin) {
  return {origin.latitude_deg, origin.longitude_deg, internal::geo::kEllipsoidalHeight, internal::geo::kEarthCentred};
}

struct Place {
  double longitude_deg, latitude_deg, height_m;
};

/// So far from the origin, to the north-east. Longitudes stay in -180 to 180.
Place place_at(const Origin& origin, double east_m, double north_m, double height_m) {
  const double scale = std::cos(origin.latitude_deg * internal::geo::kDegree);
  return {std::remainder(origin.longitude_deg + east_m / kMetresPerDegree / scale, 360),
          origin.latitude_deg + north_m / kMetresPerDegree, height_m};
}

/// A frame that touches the earth, by the formulas of the tests.
struct Frame {
  explicit Frame(double latitude_deg, double longitude_deg) {
    const nlohmann::json numbers = transform_at(latitude_deg, longitude_deg);
    for (Eigen::Index i = 0; i < 16; ++i) into_earth(i % 4, i / 4) = numbers[static_cast<std::size_t>(i)];
  }
  Vec3 origin() const { return into_earth.col(3).head<3>(); }
  Vec3 up() const { return into_earth.col(2).head<3>(); }
  Eigen::Matrix4d into_earth;
};

/// In the scene frame.
Vec3 exact(const Origin& origin, const Place& place) {
  const Frame scene(origin.latitude_deg, origin.longitude_deg), there(place.latitude_deg, place.longitude_deg);
  const Vec3 earth = there.origin() + place.height_m * there.up();
  return scene.into_earth.topLeftCorner<3, 3>().transpose() * (earth - scene.origin());
}

/// On the vertical of a place at this z of the scene frame.
Vec3 exact_at_z(const Origin& origin, Place place, double z_m) {
  place.height_m = 0;
  const Vec3 low = exact(origin, place);
  place.height_m = 1000;
  const Vec3 up = exact(origin, place) - low;
  return low + up * ((z_m - low.z()) / up.z());
}

/// Ground 25 km across, and a tower whose western side is 5 mm from a place.
std::shared_ptr<const LoadedScene> scene_at(const Origin& origin, const Vec3& tower) {
  auto loaded = std::make_shared<LoadedScene>();
  Scene& scene = loaded->scene;
  scene.georeference = georeference_of(origin);
  constexpr double kHalf = 12.5e3;
  scene.mesh.vertices = {
      {-kHalf, -kHalf, kGroundM}, {kHalf, -kHalf, kGroundM}, {kHalf, kHalf, kGroundM}, {-kHalf, kHalf, kGroundM}};
  scene.mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  scene.object_of = {0, 0};
  scene.objects = {{"ground", "", ObjectKind::ground}, {"tower", "", ObjectKind::building}};
  const double top = kGroundM + 400;
  for (const double x : {-5e-3, 1.5}) {
    for (const double y : {-1.0, 1.0}) scene.mesh.vertices.emplace_back(tower.x() + x, tower.y() + y, top);
  }
  scene.mesh.triangles.push_back({4, 6, 7});
  scene.mesh.triangles.push_back({4, 7, 5});
  scene.object_of.insert(scene.object_of.end(), {1, 1});
  return loaded;
}

constexpr double kSeaM = 36.7;

Mission resolved(const std::string& text, const std::shared_ptr<const LoadedScene>& scene,
                 const std::filesystem::path& folder = "/data") {
  const std::string city = core::format("scene: {{mesh: city.obj, sea_level: {}}}\n", kSeaM);
  return resolve_mission(app::parse_mission(city + text, folder / "mission.yaml"), scene);
}

std::string text_of(const Place& place, bool has_height = true) {
  const std::string flat = core::format("[{:.17g}, {:.17g}", place.longitude_deg, place.latitude_deg);
  return flat + (has_height ? core::format(", {:.17g}]", place.height_m) : "]");
}

void for_each_place(const std::function<void(const Origin&, double)>& check) {
  for (const Origin& origin : kOrigins) {
    for (const double distance : kDistancesM) {
      SCOPED_TRACE(core::format("{} m at {}", distance, origin.latitude_deg));
      check(origin, distance);
    }
  }
}

TEST(TangentFrames, PositionsAreWhereTheEarthHasThem) {
  for_each_place([](const Origin& origin, double distance) {
    const Georeference place = georeference_of(origin);
    for (const double height : {-20.0, 0.0, 120.0, 900.0}) {
      const Place at = place_at(origin, 0.6 * distance, -0.8 * distance, height);
      const Vec3 there = exact(origin, at);
      const std::vector<Vec3> given = {{at.longitude_deg, at.latitude_deg, height}};
      EXPECT_LT((scene_positions(place, "EPSG:4979", given).at(0) - there).norm(), kExactM);
      EXPECT_LT((scene_point(place, at.longitude_deg, at.latitude_deg, height) - there).norm(), kExactM);
      EXPECT_NEAR(height_m(place, there), height, kExactM);
      const Eigen::Vector2d flat = scene_position(place, at.longitude_deg, at.latitude_deg, there.z());
      EXPECT_LT((flat - there.head<2>()).norm(), kExactM);
      const Vec3 back = positions_in_crs(place, "EPSG:4326", std::vector<Vec3>{there}).at(0);
      EXPECT_LT((exact(origin, {back.x(), back.y(), back.z()}) - there).norm(), kExactM);
    }
    // A slope of the ground, and z = 0 where there is no height.
    const Place at = place_at(origin, distance, 0, 0);
    const auto slope = [](const Eigen::Vector2d& p) -> std::optional<double> { return 300 + 0.5 * p.x(); };
    const Eigen::Vector2d on_slope = scene_position(place, at.longitude_deg, at.latitude_deg, slope);
    const Vec3 wanted = exact_at_z(origin, at, *slope(on_slope));
    EXPECT_LT((on_slope - wanted.head<2>()).norm(), kExactM);
    const std::vector<Eigen::Vector2d> flat = {{at.longitude_deg, at.latitude_deg}};
    const Eigen::Vector2d at_zero = scene_positions(place, "EPSG:4326", flat).at(0);
    EXPECT_LT((at_zero - exact_at_z(origin, at, 0).head<2>()).norm(), kExactM);
    const Eigen::Vector2d back = positions_in_crs(place, "EPSG:4326", std::vector<Eigen::Vector2d>{at_zero}).at(0);
    EXPECT_NEAR(back.y(), at.latitude_deg, kExactM / kMetresPerDegree);
  });
}

// A volume computed about one origin, in the frame about another: turned as a whole.
TEST(TangentFrames, MovesMeshesFromFrameToFrame) {
  for_each_place([](const Origin& origin, double distance) {
    const Place other = place_at(origin, distance, distance, 0), at = place_at(origin, -300, 900, 70);
    std::vector<Vec3> points = {exact(origin, at)};
    const Origin there{other.latitude_deg, other.longitude_deg};
    EXPECT_EQ(internal::geo::move_origin(points, georeference_of(origin), georeference_of(there)), distance > 0);
    EXPECT_LT((points[0] - exact(there, at)).norm(), kExactM);
    // And into a map, where z is the height.
    points = {exact(origin, at)};
    EXPECT_TRUE(internal::geo::move_origin(
        points, georeference_of(origin), {there.latitude_deg, there.longitude_deg, "ellipsoidal height", "EPSG:4326"}));
    EXPECT_NEAR(points[0].z(), 70, kExactM);
  });
}

TEST(TangentFrames, TargetsOfACrsLieWhereTheyAreSaidTo) {
  for_each_place([](const Origin& origin, double distance) {
    const double height = 120;
    const std::vector<Place> corners = {place_at(origin, distance, 0, height),
                                        place_at(origin, distance + 9, 0, height),
                                        place_at(origin, distance, 9, height + 3)};
    const auto scene = scene_at(origin, {0, 0, 0});
    const std::string sensor = "sensor: {max_range: 300}\ncrs: EPSG:4326\n";
    std::string list, flat;
    for (const Place& corner : corners) {
      list += (list.empty() ? "" : ", ") + text_of(corner);
      flat += (flat.empty() ? "" : ", ") + text_of(corner, false);
    }
    const Mission given = resolved(sensor + "target: {vertices: [" + list + "]}\n", scene);
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_LT((given.target.parts.at(0).at(i) - exact(origin, corners[i])).norm(), kExactM) << i;
    }
    // An outline with heights in US survey feet.
    constexpr double kFootM = 1200.0 / 3937;
    std::string feet;
    for (Place corner : corners) {
      corner.height_m /= kFootM;
      feet += (feet.empty() ? "" : ", ") + text_of(corner);
    }
    const Mission drawn =
        resolved("sensor: {max_range: 300}\ncrs: EPSG:4326+6360\ntarget: {outline: [" + feet + "]}\n", scene);
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_LT((drawn.target.parts.at(0).at(i) - exact(origin, corners[i])).norm(), kExactM) << i;
    }
    // Without heights on the ground, or as far above it as they are asked to be.
    const Mission laid = resolved(sensor + "target: {outline: [" + flat + "]}\n", scene);
    for (const Vec3& corner : laid.target.parts.at(0)) {
      EXPECT_NEAR(corner.z(), kGroundM, 1e-9);
      const bool is_one = std::any_of(corners.begin(), corners.end(), [&](const Place& place) {
        return (corner - exact_at_z(origin, place, corner.z())).norm() < kLaidM;
      });
      EXPECT_TRUE(is_one) << corner.transpose();
    }
  });
}

TEST(TangentFrames, PlacesByLatitudeAndLongitudeAreOnTheirVerticals) {
  for_each_place([](const Origin& origin, double distance) {
    const Place at = place_at(origin, distance, 50, 0);
    const double top = kGroundM + 400;
    const auto scene = scene_at(origin, exact_at_z(origin, at, top));
    const std::string place = core::format("[{:.17g}, {:.17g}]", at.latitude_deg, at.longitude_deg);
    const std::string sensor = "sensor: {max_range: 300}\n";
    // The map has it 14 cm farther west, 2 km from the origin: on the tower all the same.
    EXPECT_EQ(resolved(sensor + "target: {at: " + place + ", part: roof}\n", scene).target.parts.at(0).at(0).z(), top);
    const Mission mission =
        resolved(sensor + "target: {center: " + place + ", width: 6, length: 4}\n" +
                     "links: [{name: mast, at: " + place + ", height: 300}]\n" + "tour: {home: " + place + "}\n",
                 scene);
    Vec3 centre = Vec3::Zero();
    for (const Vec3& corner : mission.target.parts.at(0)) centre += corner / 4;
    EXPECT_LT((centre - exact_at_z(origin, at, kGroundM)).norm(), kLaidM);
    EXPECT_LT((mission.links.at(0).point - exact_at_z(origin, at, kGroundM + 300)).norm(), kExactM);
    EXPECT_LT((mission.home.value() - exact_at_z(origin, at, kGroundM)).norm(), kExactM);
  });
}

bool holds(const Zone& zone, const Vec3& at) {
  bool inside = false;
  for (std::size_t i = 0; i < zone.outer.size(); ++i) {
    const Eigen::Vector2d &a = zone.outer[i], &b = zone.outer[(i + 1) % zone.outer.size()];
    if ((a.y() > at.y()) == (b.y() > at.y())) continue;
    if (at.x() < a.x() + (b.x() - a.x()) * (at.y() - a.y()) / (b.y() - a.y())) inside = !inside;
  }
  return inside && at.z() >= zone.min_z_m && at.z() <= zone.max_z_m;
}

struct BoxInDegrees {
  Place low, high;
  bool has_heights = true;  ///< else it holds all heights, and is asked about those between the two
  bool holds(const Place& at) const {
    return at.longitude_deg >= low.longitude_deg && at.longitude_deg <= high.longitude_deg &&
           at.latitude_deg >= low.latitude_deg && at.latitude_deg <= high.latitude_deg &&
           (!has_heights || (at.height_m >= low.height_m && at.height_m <= high.height_m));
  }
};

/// Points near the border of the box, on both sides of it.
void expect_safe(const Origin& origin, const BoxInDegrees& box, const Zone& kept, const Zone& out, double loss_m,
                 Random& random) {
  const double scale = std::cos(origin.latitude_deg * internal::geo::kDegree);
  for (int i = 0; i < 600; ++i) {
    Place at{random.uniform(box.low.longitude_deg, box.high.longitude_deg),
             random.uniform(box.low.latitude_deg, box.high.latitude_deg),
             random.uniform(box.low.height_m, box.high.height_m)};
    const bool is_low = random.chance(0.5);
    const Place& side = is_low ? box.low : box.high;
    const double off_m = std::pow(10, random.uniform(-5, 0.3)) * (random.chance(0.5) ? 1 : -1);
    const double inward_m = is_low ? off_m : -off_m;
    switch (random.integer(0, box.has_heights ? 2 : 1)) {
      case 0:
        at.longitude_deg = side.longitude_deg + off_m / kMetresPerDegree / scale;
        break;
      case 1:
        at.latitude_deg = side.latitude_deg + off_m / kMetresPerDegree;
        break;
      default:
        at.height_m = side.height_m + off_m;
    }
    const Vec3 there = exact(origin, at);
    const bool is_held = box.holds(at);
    EXPECT_TRUE(is_held || !holds(kept, there)) << off_m << " m, " << there.transpose();
    EXPECT_TRUE(holds(out, there) || !is_held) << off_m << " m, " << there.transpose();
    const double corner_m = 3 * loss_m;  // of a side that is cut, too
    if (inward_m > corner_m && at.height_m > box.low.height_m + corner_m &&
        at.height_m < box.high.height_m - corner_m) {
      const double east_m =
          std::min(at.longitude_deg - box.low.longitude_deg, box.high.longitude_deg - at.longitude_deg);
      const double north_m = std::min(at.latitude_deg - box.low.latitude_deg, box.high.latitude_deg - at.latitude_deg);
      if (std::min(east_m * scale, north_m) * kMetresPerDegree > corner_m) {
        EXPECT_TRUE(holds(kept, there)) << off_m;
      }
    }
    if (inward_m < -corner_m) {
      EXPECT_FALSE(holds(out, there)) << off_m << " m, " << there.transpose();
    }
  }
}

TEST(TangentFrames, ZonesOfACrsAreOnTheSafeSide) {
  Random random(71);
  for_each_place([&](const Origin& origin, double distance) {
    if (origin.longitude_deg < -179 || distance > 9000) return;  // a box in degrees; and no farther than the tower
    const BoxInDegrees box{place_at(origin, distance - 90, -80, 60), place_at(origin, distance + 70, 110, 160)};
    const Place low = box.low, high = box.high;
    const auto scene = scene_at(origin, {0, 0, 0});
    const Place target = place_at(origin, distance, 0, 50), east = place_at(origin, distance + 5, 0, 50),
                north = place_at(origin, distance, 5, 50);
    const std::string ring = "polygon: [" + text_of({low.longitude_deg, low.latitude_deg, 0}, false) + ", " +
                             text_of({high.longitude_deg, low.latitude_deg, 0}, false) + ", " +
                             text_of({high.longitude_deg, high.latitude_deg, 0}, false) + ", " +
                             text_of({low.longitude_deg, high.latitude_deg, 0}, false) + "], z: [60, 160]";
    const Mission mission =
        resolved("sensor: {max_range: 300}\ncrs: EPSG:4326\ntarget: {vertices: [" + text_of(target) + ", " +
                     text_of(east) + ", " + text_of(north) + "]}\nnavigation:\n  keep_in: [{" + ring +
                     "}, {min: " + text_of(low) + ", max: " + text_of(high) + "}]\n  keep_out: [{" + ring +
                     "}, {min: " + text_of(low) + ", max: " + text_of(high) + "}]\n",
                 scene);
    // By d / R of half the height, and the level's fall over the zone.
    const double loss = 60 * (distance + 200) / 6.3e6 + (distance + 200) * (distance + 200) / 2 / 6.3e6 + 1e-3;
    expect_safe(origin, box, mission.navigation.keep_in.at(0), mission.navigation.keep_out.at(0), loss, random);
    // A box of the frame round an askew one is larger, and one inside smaller.
    expect_safe(origin, box, mission.navigation.keep_in.at(1), mission.navigation.keep_out.at(1), loss + 160 * 0.02,
                random);
  });
}

Mission with_zones(const std::string& zone, const std::shared_ptr<const LoadedScene>& scene, const Origin& origin) {
  const Place target = place_at(origin, 0, 0, 50), east = place_at(origin, 5, 0, 50),
              north = place_at(origin, 0, 5, 50);
  return resolved("sensor: {max_range: 300}\ncrs: EPSG:4326\ntarget: {vertices: [" + text_of(target) + ", " +
                      text_of(east) + ", " + text_of(north) + "]}\nnavigation:\n  " + zone + "\n",
                  scene);
}

// Which height a z of the home has depends on where the home is: where the plan begins, if nobody says.
TEST(TangentFrames, HomesWithoutAPlaceAreWhereThePlanBegins) {
  const Origin origin{48.1, 11.5};
  FlightPlan plan;
  plan.file = "a.csv";
  LocateOptions options;
  options.georeference = georeference_of(origin);
  const double home_z = 40, above = 60;
  options.home_z_m = home_z;
  std::vector<Place> places;
  for (const double east_m : {3000.0, 3050.0}) {
    places.push_back(place_at(origin, east_m, 0, 0));
    PlanItem item;
    item.position = {{places.back().longitude_deg, places.back().latitude_deg}, above, HeightDatum::home};
    plan.items.push_back(item);
  }
  const double home_m = height_m(*options.georeference, exact_at_z(origin, places[0], home_z));
  const LocatedPlan located = locate_flight(plan, options);
  ASSERT_EQ(located.flight.points.size(), 2);
  for (std::size_t i = 0; i < 2; ++i) {
    places[i].height_m = home_m + above;
    EXPECT_LT((located.flight.points[i].position - exact(origin, places[i])).norm(), kExactM);
  }
  EXPECT_EQ(located.notes.size(), 1);
  options.home = Eigen::Vector2d(places[0].longitude_deg, places[0].latitude_deg);
  EXPECT_TRUE(locate_flight(plan, options).notes.empty());
}

/// A polygon of degrees round an origin, and beyond.
std::string ring_text(double west_deg, double south_deg, double east_deg, double north_deg) {
  return core::format(
      "polygon: [[{0:.17g}, {1:.17g}], [{2:.17g}, {1:.17g}], [{2:.17g}, {3:.17g}], [{0:.17g}, {3:.17g}]]", west_deg,
      south_deg, east_deg, north_deg);
}

// Along a parallel a side of 1100 km is 42 km from the chord of its ends.
TEST(TangentFrames, LongZonesAlongParallelsKeepTheirHeights) {
  for (const Origin& origin : {Origin{60, 12}, Origin{-70, 12}, Origin{89, 12}, Origin{0.5, 12}}) {
    const double reach_deg = std::abs(origin.latitude_deg) > 80 ? 45 : 10;
    const std::string zone = ring_text(origin.longitude_deg - reach_deg, origin.latitude_deg - 0.03,
                                       origin.longitude_deg + reach_deg, origin.latitude_deg + 0.02) +
                             ", z: [0, 120]";
    const Mission mission = with_zones(core::format("{{keep_in: [{{{0}}}], keep_out: [{{{0}}}]}}", zone),
                                       scene_at(origin, {0, 0, 0}), origin);
    const Zone &kept = mission.navigation.keep_in.at(0), &out = mission.navigation.keep_out.at(0);
    for (const double off_m : {-1e-6, 1e-6}) {
      const Vec3 top = exact(origin, place_at(origin, 0, 0, 120 + off_m)),
                 low = exact(origin, place_at(origin, 0, 0, off_m));
      EXPECT_TRUE(holds(out, off_m < 0 ? top : low)) << origin.latitude_deg;
      EXPECT_FALSE(holds(kept, off_m < 0 ? low : top)) << origin.latitude_deg;
    }
  }
}

// Where no viewpoint can be the fall of a zone's levels is nothing to it.
TEST(TangentFrames, ZonesBeyondTheReachAreNoErrors) {
  const Origin origin{48.1, 11.5};
  const auto scene = scene_at(origin, {0, 0, 0});
  const double north = origin.latitude_deg + 0.8;  // 89 km, where the ellipsoid is 620 m lower
  const std::string zone =
      ring_text(origin.longitude_deg, north, origin.longitude_deg + 0.01, north + 0.01) + ", z: [0, 120]";
  const Mission mission = with_zones("{keep_in: [{" + zone + "}], keep_out: [{" + zone + "}]}", scene, origin);
  for (const Zone& one : {mission.navigation.keep_in.at(0), mission.navigation.keep_out.at(0)}) {
    EXPECT_GT(one.max_z_m - one.min_z_m, 60);
    EXPECT_FALSE(holds(one, {0, 0, 60}));
  }
}

// Ten kilometres away a level is 8 m lower in the frame, so that verticals meet it elsewhere.
TEST(TangentFrames, ThinZonesFarAwayHaveTheirWallsWhereTheirLevelsAre) {
  for (const Origin& origin : {Origin{48.1, 11.5}, Origin{-33.9, 151.2}}) {
    const double distance = 10e3, low = 60, high = 61;
    const Place a = place_at(origin, distance - 90, -80, low), b = place_at(origin, distance + 70, 110, high);
    const Place target = place_at(origin, distance, 0, 50);
    const std::string zone =
        ring_text(a.longitude_deg, a.latitude_deg, b.longitude_deg, b.latitude_deg) + ", z: [60, 61]";
    const Mission mission = resolved("sensor: {max_range: 300}\ncrs: EPSG:4326\ntarget: {point: " + text_of(target) +
                                         "}\nnavigation: {keep_out: [{" + zone + "}]}\n",
                                     scene_at(origin, {0, 0, 0}));
    const Zone& out = mission.navigation.keep_out.at(0);
    for (const double share : {0.1, 0.5, 0.9}) {
      for (const double height : {low, high}) {
        const double longitude = a.longitude_deg + share * (b.longitude_deg - a.longitude_deg);
        const double latitude = a.latitude_deg + share * (b.latitude_deg - a.latitude_deg);
        for (const Place& at : {Place{longitude, a.latitude_deg, height}, Place{longitude, b.latitude_deg, height},
                                Place{a.longitude_deg, latitude, height}, Place{b.longitude_deg, latitude, height}}) {
          EXPECT_TRUE(holds(out, exact(origin, at)));
        }
      }
    }
  }
}

// Tours fly home, and plans that are checked go where they go.
TEST(TangentFrames, ZonesAreSafeAsFarAsTheHome) {
  const Origin origin{48.1, 11.5};
  const auto scene = scene_at(origin, {0, 0, 0});
  const Place home = place_at(origin, 20000, 0, 30);  // the scene ends at 9 km
  const std::string zone = "{keep_out: [{" +
                           ring_text(origin.longitude_deg, origin.latitude_deg - 0.02, origin.longitude_deg + 0.4,
                                     origin.latitude_deg + 0.02) +
                           ", z: [50, 120]}]}";
  const Mission without = with_zones(zone, scene, origin);
  const Mission with = with_zones(zone + "\ntour: {home: " + text_of(home) + "}", scene, origin);
  const Vec3 inside = exact(origin, place_at(origin, 19990, 0, 50.001));
  EXPECT_TRUE(holds(with.navigation.keep_out.at(0), inside));
  EXPECT_FALSE(holds(without.navigation.keep_out.at(0), inside));  // or this says nothing of the home
  FlightPlan plan;
  plan.file = "far.csv";
  plan.is_in_scene_frame = true;
  for (const double x : {0.0, inside.x()}) {
    PlanItem item;
    item.position = {{x, 0}, inside.z(), HeightDatum::scene_z};
    plan.items.push_back(item);
  }
  const auto is_told = [&](const Mission& mission) {
    const std::vector<Warning> notes = locate_flight(mission, plan).notes;
    return std::any_of(notes.begin(), notes.end(),
                       [](const Warning& note) { return note.code == WarningCode::plan_beyond_zones; });
  };
  EXPECT_TRUE(is_told(without));
  EXPECT_FALSE(is_told(with));
}

// A mission of volumes alone has no range, and so no bound of where it may be flown.
TEST(TangentFrames, ZonesWithoutHeightsSuitMissionsOfVolumes) {
  const Origin origin{48.1, 11.5};
  TemporaryDirectory folder;
  write_bytes(folder / "region.obj", "v 0 0 60\nv 20 0 60\nv 0 20 60\nv 5 5 80\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n");
  const std::string ring = ring_text(origin.longitude_deg + 0.02, origin.latitude_deg, origin.longitude_deg + 0.021,
                                     origin.latitude_deg + 0.001);
  const Mission mission = resolved(
      "targets: [{volume: region.obj}]\ncrs: EPSG:4326\nnavigation: {keep_out: [{" + ring + ", heights: any}]}\n",
      scene_at(origin, {0, 0, 0}), folder.path());
  const Zone& zone = mission.navigation.keep_out.at(0);
  const Place corner{origin.longitude_deg + 0.02, origin.latitude_deg, 100};
  EXPECT_TRUE(holds(zone, exact(origin, corner)));
  EXPECT_FALSE(holds(zone, exact(origin, corner) - Vec3(3, 3, 0)));  // walls move by far less
}

TEST(TangentFrames, ZonesToStayInThatHoldNothingLevelAreErrors) {
  const Origin origin{48.1, 11.5};
  const std::string zone = ring_text(origin.longitude_deg - 0.1, origin.latitude_deg - 0.1, origin.longitude_deg + 0.1,
                                     origin.latitude_deg + 0.1);
  const auto scene = scene_at(origin, {0, 0, 0});
  const auto code_of = [&](const std::string& list, const std::string& heights) -> std::optional<ErrorCode> {
    try {
      with_zones(list + ": [{" + zone + heights + "}]", scene, origin);
    } catch (const Error& error) {
      return error.code();
    }
    return std::nullopt;
  };
  EXPECT_EQ(code_of("keep_in", ", z: [60, 61]"), ErrorCode::limits_empty);  // 11 km away it is 8 m lower
  EXPECT_EQ(code_of("keep_in", ", z: [60, 90]"), std::nullopt);
  EXPECT_EQ(code_of("keep_out", ", z: [60, 61]"), std::nullopt);
}

/// Upright on the earth: of a radius of 150 m the chord through the ellipsoid is shorter by 4 nm.
double from_axis_m(const Place& centre, const Place& at) {
  return (Frame(at.latitude_deg, at.longitude_deg).origin() - Frame(centre.latitude_deg, centre.longitude_deg).origin())
      .norm();
}

TEST(TangentFrames, CirclesOfFilesWithHeightsAboveTheSeaAreOnTheSafeSide) {
  constexpr double kRadiusM = 150, kLow = 60, kHigh = 160, kSagittaM = 0.06;
  Random random(73);
  for_each_place([&](const Origin& origin, double distance) {
    const Place centre = place_at(origin, distance, 0, 0);
    TemporaryDirectory folder;
    const std::string projection =
        core::format("{{\"type\": \"Circle\", \"center\": [{:.17g}, {:.17g}], \"radius\": {}}}", centre.longitude_deg,
                     centre.latitude_deg, kRadiusM);
    const std::string heights = core::format(
        "\"uomDimensions\": \"M\", \"lowerLimit\": {}, \"lowerVerticalReference\": \"AMSL\", \"upperLimit\": {}, "
        "\"upperVerticalReference\": \"AMSL\"",
        kLow, kHigh);
    write_bytes(folder / "zone.json", zone_texts::volume(projection, heights));
    const std::string place = core::format("[{:.17g}, {:.17g}]", centre.latitude_deg, centre.longitude_deg);
    const Mission mission = resolved("sensor: {max_range: 300}\ntarget: {center: " + place +
                                         ", width: 6, length: 4}\nnavigation:\n  keep_in: [{file: zone.json}]\n"
                                         "  keep_out: [{file: zone.json}]\n",
                                     scene_at(origin, {0, 0, 0}), folder.path());
    const Zone &kept = mission.navigation.keep_in.at(0), &out = mission.navigation.keep_out.at(0);
    const double far = distance + 200, loss = 60 * far / 6.3e6 + 2 * 150 * far / 6.3e6 + kSagittaM;
    for (int i = 0; i < 300; ++i) {
      const double angle = random.uniform(0, 7), off_m = std::pow(10, random.uniform(-5, 0.5)) * (i % 2 == 0 ? 1 : -1);
      const bool is_at_wall = random.chance(0.5);
      const double radius = is_at_wall ? kRadiusM + off_m : random.uniform(0, kRadiusM - 4);
      const double low = kLow + kSeaM, high = kHigh + kSeaM;
      Place at = place_at(origin, distance + radius * std::cos(angle), radius * std::sin(angle), 0);
      at.height_m = is_at_wall ? random.uniform(low, high) : (random.chance(0.5) ? low : high) + off_m;
      const double inward_m = kRadiusM - from_axis_m(centre, at);
      const double within_m = std::min({inward_m, at.height_m - low, high - at.height_m});
      const Vec3 there = exact(origin, at);
      EXPECT_TRUE(within_m >= 0 ? holds(out, there) : !holds(kept, there)) << within_m;
      if (within_m > loss) {
        EXPECT_TRUE(holds(kept, there)) << within_m;
      }
      if (within_m < -loss) {
        EXPECT_FALSE(holds(out, there)) << within_m;
      }
    }
  });
}

TEST(TangentFrames, TargetsOfFilesLieWhereTheyAreSaidTo) {
  TemporaryDirectory folder;
  for_each_place([&](const Origin& origin, double distance) {
    const double height = 120;
    const std::vector<Place> corners = {place_at(origin, distance, 0, height),
                                        place_at(origin, distance + 9, 0, height),
                                        place_at(origin, distance, 9, height)};
    std::string json, kml;
    for (const std::size_t i : {0, 1, 2, 0}) {
      const Place& at = corners[i];
      json += (json.empty() ? "" : ", ") + text_of(at);
      kml += core::format("{:.17g},{:.17g},{:.17g} ", at.longitude_deg, at.latitude_deg, at.height_m);
    }
    write_bytes(folder / "a.geojson", "{\"type\": \"Polygon\", \"coordinates\": [[" + json + "]]}");
    for (const std::string mode : {"absolute", "relativeToGround"}) {
      write_bytes(folder / (mode + ".kml"),
                  zone_texts::kml(core::format("<Placemark><name>park</name><Polygon><altitudeMode>{}</altitudeMode>"
                                               "<outerBoundaryIs><LinearRing><coordinates>{}</coordinates></LinearRing>"
                                               "</outerBoundaryIs></Polygon></Placemark>",
                                               mode, kml)));
    }
    const auto scene = scene_at(origin, {0, 0, 0});
    const auto part_of = [&](const std::string& file) {
      return resolved("sensor: {max_range: 300}\ntarget: {file: " + file + "}\n", scene, folder.path())
          .target.parts.at(0);
    };
    const auto farthest_m = [&](const std::vector<Vec3>& part,
                                const std::function<Vec3(const Vec3&, const Place&)>& at) {
      double farthest = part.size() == 3 ? 0 : INFINITY;
      for (const Vec3& corner : part) {
        double nearest = INFINITY;
        for (const Place& place : corners) nearest = std::min(nearest, (corner - at(corner, place)).norm());
        farthest = std::max(farthest, nearest);
      }
      return farthest;
    };
    EXPECT_LT(farthest_m(part_of("a.geojson"), [&](const Vec3&, const Place& place) { return exact(origin, place); }),
              kExactM);
    EXPECT_LT(farthest_m(part_of("absolute.kml"),
                         [&](const Vec3&, Place place) {
                           place.height_m += kSeaM;
                           return exact(origin, place);
                         }),
              kExactM);
    const std::vector<Vec3> above = part_of("relativeToGround.kml");
    EXPECT_NEAR(above.at(0).z(), kGroundM + height, 1e-9);
    EXPECT_LT(farthest_m(above, [&](const Vec3& c, const Place& place) { return exact_at_z(origin, place, c.z()); }),
              kLaidM);
  });
}

TEST(TangentFrames, ZonesWithoutHeightsAreSafeWithinTheReach) {
  const Origin origin{48.1, 11.5};
  const double distance = 2000;
  const BoxInDegrees box{place_at(origin, distance - 90, -80, -200), place_at(origin, distance + 70, 110, 700), false};
  TemporaryDirectory folder;
  const auto corner = [](double longitude, double latitude) {
    return core::format("[{:.17g}, {:.17g}]", longitude, latitude);
  };
  const std::string ring = "[" + corner(box.low.longitude_deg, box.low.latitude_deg) + ", " +
                           corner(box.high.longitude_deg, box.low.latitude_deg) + ", " +
                           corner(box.high.longitude_deg, box.high.latitude_deg) + ", " +
                           corner(box.low.longitude_deg, box.high.latitude_deg) + ", " +
                           corner(box.low.longitude_deg, box.low.latitude_deg) + "]";
  write_bytes(folder / "zone.geojson", "{\"type\": \"Polygon\", \"coordinates\": [" + ring + "]}");
  const Place middle = place_at(origin, distance, 0, 0);
  const auto scene = scene_at(origin, exact_at_z(origin, middle, 440));
  const std::string place = core::format("[{:.17g}, {:.17g}]", middle.latitude_deg, middle.longitude_deg);
  const Mission mission = resolved("sensor: {max_range: 300}\ntarget: {center: " + place +
                                       ", width: 6, length: 4}\nnavigation:\n  keep_in: [{file: zone.geojson, heights: "
                                       "any}]\n  keep_out: [{file: zone.geojson, heights: any}]\n",
                                   scene, folder.path());
  const Zone &kept = mission.navigation.keep_in.at(0), &out = mission.navigation.keep_out.at(0);
  EXPECT_EQ(kept.max_z_m, INFINITY);
  Random random(72);
  const double lean = (440 + 300 - (40 - 300)) / 2.0 * 2500 / 6.3e6;  // half the reach in height, by d / R
  expect_safe(origin, box, kept, out, INFINITY, random);
  const auto middle_of = [](const Zone& zone, bool is_west) {
    double x = is_west ? INFINITY : -INFINITY;
    for (const Eigen::Vector2d& p : zone.outer) x = is_west ? std::min(x, p.x()) : std::max(x, p.x());
    return x;
  };
  EXPECT_LT(middle_of(kept, true) - middle_of(out, true), 2.5 * lean);
  EXPECT_GT(middle_of(kept, true) - middle_of(out, true), 0.5 * lean);
}

}  // namespace
}  // namespace vantage::testing
