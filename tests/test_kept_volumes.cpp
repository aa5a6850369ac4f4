// Runs that take volumes from the one before have the same bits as those from scratch.
#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "support/progress_check.h"
#include "support/random.h"
#include "support/scenes.h"
#include "support/shared_data.h"
#include "support/wording.h"
#include "vantage/error.h"
#include "vantage/mission.h"
#include "vantage/volume.h"

namespace vantage::testing {
namespace {

/// A scene that is loaded and prepared.
struct Place {
  std::shared_ptr<const LoadedScene> loaded;
  PreparedScene prepared;
  std::string hash;

  explicit Place(Scene scene)
      : loaded(std::make_shared<const LoadedScene>(LoadedScene{.scene = std::move(scene)})),
        prepared(loaded->scene),
        hash(scene_hash(loaded->scene)) {}
};

std::vector<std::uint64_t> bits_of(const Volume& volume) {
  std::vector<std::uint64_t> bits;
  for (const Vec3& v : volume.mesh.vertices) {
    for (const double x : v) bits.push_back(std::bit_cast<std::uint64_t>(x));
  }
  for (const Cause& cause : volume.causes) bits.push_back(std::bit_cast<std::uint64_t>(cause.area_m2));
  return bits;
}

void expect_same(const Result& result, const Result& scratch) {
  const Volume &a = result.volume, &b = scratch.volume;
  EXPECT_EQ(a.outcome, b.outcome);
  EXPECT_EQ(a.reason, b.reason);
  EXPECT_EQ(bits_of(a), bits_of(b));
  EXPECT_EQ(a.mesh.triangles, b.mesh.triangles);
  EXPECT_EQ(a.cause_of, b.cause_of);
  EXPECT_EQ(a.polygon_of, b.polygon_of);
  EXPECT_EQ(a.lift_m, b.lift_m);
  EXPECT_EQ(a.notes, b.notes);
  EXPECT_EQ(a.counts.visible_facets, b.counts.visible_facets);
  ASSERT_EQ(a.causes.size(), b.causes.size());
  for (std::size_t i = 0; i < a.causes.size(); ++i) EXPECT_EQ(a.causes[i].name, b.causes[i].name);
  ASSERT_EQ(a.provenance.has_value(), b.provenance.has_value());
  if (!a.provenance) return;
  EXPECT_EQ(a.provenance->mission_hash, b.provenance->mission_hash);
  EXPECT_EQ(a.provenance->scene_hash, b.provenance->scene_hash);
  EXPECT_EQ(a.provenance->sensor.incidence_deg, b.provenance->sensor.incidence_deg);
  EXPECT_EQ(a.provenance->target.parts, b.provenance->target.parts);
}

/// One who edits missions: each run is made with what is kept, and from scratch.
class Editing {
 public:
  /// How many volumes the run took from the last one. The mission's scene is that of `place`.
  std::size_t run(const MissionFile& file, const Place& place) {
    RunOptions options{.threads = 1, .prepared = place.prepared, .scene_hash = place.hash};
    const Outcomes scratch = outcomes(file, place, options);
    options.kept = kept;
    options.threads = 2;
    const std::size_t before = kept->taken();
    const Outcomes result = outcomes(file, place, options);
    EXPECT_EQ(result.code, scratch.code);
    refused = result.results.empty();
    EXPECT_EQ(result.results.size(), scratch.results.size());
    if (result.results.size() != scratch.results.size()) return 0;
    for (std::size_t i = 0; i < result.results.size(); ++i) expect_same(result.results[i], scratch.results[i]);
    return kept->taken() - before;
  }

  std::shared_ptr<KeptVolumes> kept = std::make_shared<KeptVolumes>();
  bool refused = false;  ///< the last run

 private:
  struct Outcomes {
    std::vector<Result> results;
    ErrorCode code = ErrorCode::cancelled;  // of a run that was refused; else this one
  };
  static Outcomes outcomes(const MissionFile& file, const Place& place, const RunOptions& options) {
    try {
      return {run_missions(resolve_mission(file, place.loaded), options)};
    } catch (const Error& error) {
      return {{}, error.code()};
    }
  }
};

MissionFile mission_of(Target target, double range) {
  MissionFile file;
  file.targets[0].target = std::move(target);
  file.sensor.max_range_m = range;
  file.exact.tolerance_m = 1e-3 * range;
  return file;
}

Scene moved(Scene scene, double scale, const Vec3& by) {
  for (Vec3& v : scene.mesh.vertices) v = scale * v + by;
  return scene;
}

Target moved(Target target, double scale, const Vec3& by) {
  for (auto& part : target.parts) {
    for (Vec3& v : part) v = scale * v + by;
  }
  return target;
}

Target square(double x, double y) {
  return target_of({{x - 2, y - 2, 1}, {x + 2, y - 2, 1}, {x + 2, y + 2, 1}, {x - 2, y + 2, 1}});
}

/// A city with a target in it; the unit is `scale` metres.
struct Drawn {
  Drawn(Random& random, double scale_m, const Vec3& at)
      : scale(scale_m),
        origin(at),
        place(moved(random_city(random, 12, 8), scale, origin)),
        file(mission_of(moved(random_target(random, random.integer(3, 6), 4, {0, 0, 1}, Vec3::UnitZ()), scale, origin),
                        scale * random.uniform(40, 90))) {}

  double scale;
  Vec3 origin;
  Place place;
  MissionFile file;
};

/// An edit, and whether what the volume depends on stays.
bool edit(Random& random, Drawn& drawn) {
  MissionFile& file = drawn.file;
  std::vector<Vec3>& corners = file.targets[0].target.parts[0];
  const double scale = drawn.scale, z = drawn.origin.z();
  switch (random.integer(0, 7)) {
    case 0:  // a corner is dragged
      corners[0] += scale * Vec3(random.uniform(-0.1, 0.1), random.uniform(-0.1, 0.1), 0);
      return false;
    case 1: {  // by as little as there is
      double& x = corners[0].x();
      x = std::nextafter(x, std::numeric_limits<double>::infinity());
      return false;
    }
    case 2:  // a jump
      for (Vec3& corner : corners) corner += scale * Vec3(random.uniform(-3, 3), random.uniform(-3, 3), 0);
      return false;
    case 3:
      file.sensor.max_range_m *= random.uniform(0.8, 1.25);
      return false;
    case 4:
      file.exact.tolerance_m *= random.uniform(0.8, 1.25);
      return false;
    case 5:
      file.navigation.altitude = Navigation::Altitude{z + scale * 2, z + scale * random.uniform(10, 60)};
      return true;
    case 6:  // cut where the view is computed
      file.sensor.incidence_deg = random.uniform(30, 80);
      return false;
    default:
      file.navigation.keep_out = {
          Box{drawn.origin - scale * Vec3(9, 9, 9), drawn.origin + scale * Vec3(random.uniform(1, 9), 0, 30)}};
      return true;
  }
}

TEST(KeptVolumes, HaveTheSameBitsWhateverIsEdited) {
  Random random(1203);
  struct World {
    double scale;
    Vec3 origin;
  };
  for (const World& world : {World{1, {0, 0, 0}}, World{1, {1e6, -2e6, 300}}, World{1e-6, {0, 0, 0}}}) {
    SCOPED_TRACE(world.scale);
    Drawn drawn(random, world.scale, world.origin);
    Editing editing;
    EXPECT_EQ(editing.run(drawn.file, drawn.place), 0u);
    std::size_t fitting = 0;
    for (int step = 0; step < 14; ++step) {
      SCOPED_TRACE(step);
      const MissionFile before = drawn.file;
      const bool fits = edit(random, drawn);
      const std::size_t now = editing.run(drawn.file, drawn.place);
      if (editing.refused) {  // the corner went too far, or into a block: as it was
        drawn.file = before;
        continue;
      }
      EXPECT_EQ(now, fits ? 1u : 0u);
      fitting += now;
      EXPECT_LE(editing.kept->count(), 2u);
    }
    EXPECT_GT(fitting, 0u);
  }
}

TEST(KeptVolumes, AreNotTakenInAnotherScene) {
  Random random(1204);
  const Scene scene = random_city(random, 12, 8);
  const Place first(scene), again(scene), other(random_city(random, 12, 8));
  const MissionFile file = mission_of(square(0, 0), 60);
  Editing editing;
  EXPECT_EQ(editing.run(file, first), 0u);
  EXPECT_EQ(editing.run(file, other), 0u);
  EXPECT_EQ(editing.run(file, first), 0u);  // the run before was in the other one
  EXPECT_EQ(editing.run(file, first), 1u);
  EXPECT_EQ(editing.run(file, again), 0u);  // prepared anew
}

TEST(KeptVolumes, StayOfTheTargetsThatAreNotMoved) {
  Random random(1205);
  const Place place(random_city(random, 10, 10));
  MissionFile file = mission_of(square(0, 0), 50);
  file.combine = Combine::any;
  file.targets = {{square(0, 0)}, {square(4, 1)}, {Target::point({-3, 2, 4})}};
  for (std::size_t i = 0; i < 3; ++i) file.targets[i].target.name = "abc"[i];
  Editing editing;
  EXPECT_EQ(editing.run(file, place), 0u);
  file.targets[1].target.parts[0][2] += Vec3(0.1, 0.1, 0);
  EXPECT_EQ(editing.run(file, place), 2u);
  file.combine = Combine::each;
  EXPECT_EQ(editing.run(file, place), 3u);
  file.targets.pop_back();
  file.navigation.altitude = Navigation::Altitude{1, 20};
  EXPECT_EQ(editing.run(file, place), 2u);
  EXPECT_EQ(editing.run(file, place), 2u);
  EXPECT_EQ(editing.kept->count(), 2u);  // that of the third target is gone
}

TEST(KeptVolumes, DependOnTheShareThatMustBeSeen) {
  Random random(1206);
  const Place place(random_city(random, 8, 10));
  MissionFile file = mission_of(square(0, 0), 40);
  Editing editing;
  const std::vector<std::pair<VisibleShare, std::size_t>> steps = {
      {{0.7, 4}, 0}, {{0.7, 4}, 1}, {{0.7, 6}, 0}, {{0.8, 6}, 0}, {{0.8, 6}, 1}};
  for (const auto& [share, taken] : steps) {
    file.sensor.visible = share;
    EXPECT_EQ(editing.run(file, place), taken) << share.share << " of " << share.cells;
  }
  file.sensor.visible.reset();
  EXPECT_EQ(editing.run(file, place), 0u);
}

TEST(KeptVolumes, DependOnTheRangeThatPixelsAllow) {
  Random random(1207);
  const Place place(random_city(random, 8, 10));
  MissionFile file = mission_of(square(0, 0), 60);
  file.sensor.camera = Pinhole{.half_width = 1, .half_height = 1, .focal_px = 1000};
  file.sensor.pixel = PixelLimit{0.05, PixelLimit::Kind::perpendicular};
  Editing editing;
  EXPECT_EQ(editing.run(file, place), 0u);
  file.sensor.camera->focal_px = 900;
  EXPECT_EQ(editing.run(file, place), 0u);
  // The camera's frame is cut where the view is computed, which so depends on all of the sensor.
  file.sensor.pixel->kind = PixelLimit::Kind::worst;
  EXPECT_EQ(editing.run(file, place), 0u);
  EXPECT_EQ(editing.run(file, place), 1u);
}

TEST(KeptVolumes, AreNotThereOfRadioLinksNorOfTargetsOutOfRange) {
  Random random(1208);
  const Place place(random_city(random, 6, 12));
  MissionFile file = mission_of(Target::point({0, 0, 5}), 60);
  file.sensor.link = RadioLink{5.8};
  Editing editing;
  EXPECT_EQ(editing.run(file, place), 0u);
  file.sensor.link = RadioLink{2.4};
  EXPECT_EQ(editing.run(file, place), 0u);
  EXPECT_EQ(editing.run(mission_of(square(0, 0), 2), place), 0u);
  EXPECT_FALSE(editing.refused);
  EXPECT_EQ(editing.kept->count(), 0u);
}

TEST(KeptVolumes, OutliveTargetsThatAreRefused) {
  Random random(1209);
  const Place place(random_city(random, 10, 8));
  const MissionFile good = mission_of(square(0, 0), 60);
  Editing editing;
  EXPECT_EQ(editing.run(good, place), 0u);
  const std::vector<std::vector<Vec3>> wrong = {
      {{0, 0, 1}, {1, 0, 1}, {2, 0, 1}},                   // without area
      {{0, 0, 1}, {4, 0, 1}, {1, 1, 1}, {0, 4, 1}},        // not convex
      {{-2, -2, -1}, {2, -2, -1}, {2, 2, 3}, {-2, 2, 3}},  // through the ground
      {{0, 0, 1}, {1, 0, 1}, {0, 0, 1}, {0, 1, 1}},        // a corner twice
  };
  for (const auto& corners : wrong) {
    MissionFile file = good;
    file.targets[0].target.parts[0] = corners;
    EXPECT_EQ(editing.run(file, place), 0u);
    EXPECT_EQ(editing.run(good, place), 1u);
  }
}

TEST(KeptVolumes, AreWholeAfterARunThatWasStopped) {
  Random random(1210);
  const Place place(random_city(random, 12, 8));
  MissionFile file = mission_of(square(0, 0), 60);
  file.combine = Combine::any;
  file.targets = {{square(0, 0)}, {square(3, 1)}};
  const auto kept = std::make_shared<KeptVolumes>();
  const RunOptions options{.threads = 1, .prepared = place.prepared, .scene_hash = place.hash, .kept = kept};
  check_progress([&](const Progress& progress) {
    kept->clear();
    file.targets[1].target.parts[0][0].x() += 0.01;
    run_mission(resolve_mission(file, place.loaded), options, progress);
  });
  Editing editing;
  editing.kept = kept;
  editing.run(file, place);
  EXPECT_EQ(editing.run(file, place), 2u);
}

TEST(KeptVolumes, AreDroppedWhenTold) {
  Random random(1211);
  const Place place(random_city(random, 6, 8));
  const MissionFile file = mission_of(square(0, 0), 40);
  Editing editing;
  editing.run(file, place);
  EXPECT_EQ(editing.kept->count(), 1u);
  editing.kept->clear();
  EXPECT_EQ(editing.kept->count(), 0u);
  EXPECT_EQ(editing.run(file, place), 0u);
}

void drag_in_city(const char* file_name, UpAxis up, const Target& target) {
  const Place place(read_scene(shared_data(file_name), {.up = up}));
  MissionFile file = mission_of(target, 150);
  Editing editing;
  EXPECT_EQ(editing.run(file, place), 0u);
  file.targets[0].target.parts[0][0].x() += 0.1;
  EXPECT_EQ(editing.run(file, place), 0u);
  file.navigation.altitude = Navigation::Altitude{2, 60};
  EXPECT_EQ(editing.run(file, place), 1u);
  file.navigation.altitude->max_m = 59;
  EXPECT_EQ(editing.run(file, place), 1u);
}

TEST(KeptVolumes, HaveTheSameBitsInCharlotte) {
  VANTAGE_REQUIRE_SHARED("charlotte/uptownCharlotte.obj");
  drag_in_city("charlotte/uptownCharlotte.obj", UpAxis::y,
               target_of({{-346.654, -59.171, 1}, {-369.28, -39.471, 1}, {-340.906, -29.727, 1}}));
}

TEST(KeptVolumes, HaveTheSameBitsInMunich) {
  VANTAGE_REQUIRE_SHARED("mesh/munich_merged.ply");
  drag_in_city("mesh/munich_merged.ply", UpAxis::z,
               target_of({{-5, -112, 0}, {25, -112, 0}, {22, -97, 0}, {-8, -97, 0}}));
}

}  // namespace
}  // namespace vantage::testing
