// Volumes of positions that see a share of the target, against closed forms and against exact shares.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "core/progress_reporter.h"
#include "support/internals.h"
#include "support/mesh_probe.h"
#include "support/random.h"
#include "support/scenes.h"
#include "support/shared_data.h"
#include "support/solids.h"
#include "support/sweep_oracle.h"
#include "support/wording.h"
#include "vantage/error.h"
#include "vantage/query.h"
#include "vantage/scene.h"
#include "vantage/spheres.h"
#include "vantage/verify.h"
#include "vantage/volume.h"

namespace vantage {
namespace {

using testing::first_open_edge;
using testing::MeshProbe;
using testing::Random;
using testing::SceneBuilder;
using testing::SweepOracle;
using testing::target_of;

Sensor sharing(double range, double share, std::size_t cells) {
  Sensor sensor{.max_range_m = range};
  sensor.visible = VisibleShare{share, cells};
  return sensor;
}

Target rectangle(double width, double length) {
  const double x = 0.5 * width, y = 0.5 * length;
  return target_of({{-x, -y, 0}, {x, -y, 0}, {x, y, 0}, {-x, y, 0}});
}

/// A plate 10 m over the target that ends over its middle: from (x, y, z) over it the target is seen where its x is
/// less than -10 x / (z - 10).
Scene half_plate() {
  SceneBuilder scene;
  scene.ground("ground", 90, -1).polygon("plate", {{0, -300, 10}, {300, -300, 10}, {300, 300, 10}, {0, 300, 10}});
  return scene;
}

/// What is seen of a target of that width.
double seen_beside_plate(const Vec3& p, double width) {
  if (p.z() <= 10) return 1;
  return std::clamp(-10 * p.x() / (p.z() - 10) / width + 0.5, 0.0, 1.0);
}

Volume volume_of(const Scene& scene, const Target& target, const Sensor& sensor) {
  Volume volume = compute_volume(PreparedTarget(PreparedScene(scene), target, sensor));
  EXPECT_EQ(volume.outcome, Outcome::computed) << volume.reason;
  EXPECT_EQ(volume.counts.boolean_fallbacks, 0U);
  EXPECT_EQ(first_open_edge(volume.mesh), "");
  EXPECT_EQ(volume.cause_of.size(), volume.mesh.triangles.size());
  EXPECT_EQ(volume.polygon_of.size(), volume.mesh.triangles.size());
  return volume;
}

double size_of(const Volume& volume) { return measure(volume.mesh).volume_m3; }

/// Inside are the points in range that see at least `least` metres of a strip of that width, and no others.
void expect_beside_plate(const Volume& volume, double width, double least, double range) {
  Random random(21);
  const MeshProbe probe(volume);
  int inside = 0, outside = 0;
  for (int i = 0; i < 20000; ++i) {
    const Vec3 p = random.in_box({{-range, -range, 0}, {range, range, range}});
    const double seen = width * seen_beside_plate(p, width);
    const bool in_range = testing::farthest_vertex(volume.frame, p) < range - 0.02;
    const double depth = probe.depth(p);
    if (depth > 1e-5) {
      ++inside;
      EXPECT_GE(seen, least - 1e-5) << p.transpose();
    } else if (in_range && p.z() > 1e-3 && depth < -1e-5) {
      ++outside;
      EXPECT_LE(seen, least + 1e-5) << p.transpose();
    }
  }
  EXPECT_GT(inside, 500);
  EXPECT_GT(outside, 500);
}

TEST(VisibleShare, OfAPlateThatHidesHalf) {
  for (const std::size_t cells : {4, 16}) {
    const Volume volume = volume_of(half_plate(), rectangle(10, 10), sharing(60, 0.5, cells));
    expect_beside_plate(volume, 10, 5, 60);
    EXPECT_TRUE(std::any_of(volume.causes.begin(), volume.causes.end(), [](const Cause& cause) {
      return cause.kind == CauseKind::scene && cause.name == "plate";
    }));
  }
}

TEST(VisibleShare, CountsSoManyCellsAndNotOneMore) {
  // 0.55 * 20 is more than 11 in binary numbers, and 0.7 * 10 less than 7.
  for (const auto& [share, cells, least] :
       {std::tuple(0.55, 20, 11.0), std::tuple(0.7, 20, 14.0), std::tuple(0.7, 10, 14.0), std::tuple(0.71, 20, 15.0),
        std::tuple(0.8, 20, 16.0), std::tuple(0.8000001, 20, 17.0), std::tuple(0.3, 5, 8.0)}) {
    SCOPED_TRACE(std::to_string(share) + " of " + std::to_string(cells));
    const auto count = static_cast<std::size_t>(cells);
    expect_beside_plate(volume_of(half_plate(), rectangle(20, 1), sharing(60, share, count)), 20, least, 60);
  }
}

TEST(VisibleShare, OfAllIsTheWholeTarget) {
  Random random(22);
  const Scene scene = testing::random_city(random, 12, 14);
  const Volume whole = volume_of(scene, rectangle(12, 8), {80});
  for (const VisibleShare& visible :
       {VisibleShare{1, 16}, VisibleShare{1, 1}, VisibleShare{0.5, 1}, VisibleShare{0.99, 64}}) {
    const Volume same = volume_of(scene, rectangle(12, 8), sharing(80, visible.share, visible.cells));
    EXPECT_EQ(same.mesh.vertices, whole.mesh.vertices);
    EXPECT_EQ(same.mesh.triangles, whole.mesh.triangles);
  }
}

/// A city of blocks, as large as asked and where asked, with a target of one or two parts in it.
struct Place {
  Scene scene;
  Target target;
  double range = 0;
};

Place random_place(Random& random, double scale, const Vec3& origin) {
  Place place;
  place.scene = testing::random_city(random, random.integer(6, 18), 16);
  const double height = random.uniform(7, 9);  // tilted, it stays over the ground
  place.target = testing::random_target(random, random.integer(3, 7), random.uniform(3, 12), {0, 0, height},
                                        Vec3(random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.3), 1));
  if (random.chance(0.4)) {
    const Target other = testing::random_target(random, 4, random.uniform(1, 4), {0, 0, height + 8},
                                                Vec3(random.uniform(-1, 1), random.uniform(-1, 1), 1));
    place.target.parts.push_back(other.parts[0]);
  }
  place.range = scale * random.uniform(40, 90);
  for (Vec3& v : place.scene.mesh.vertices) v = origin + scale * v;
  for (auto& part : place.target.parts) {
    for (Vec3& v : part) v = origin + scale * v;
  }
  return place;
}

/// The share by the oracle, of all parts.
double exact_share(const Scene& scene, const PreparedTarget& target, const Vec3& eye) {
  long double seen = 0, all = 0;
  for (std::size_t i = 0; i < target.part_count(); ++i) {
    const testing::SweptFraction part = SweepOracle(scene.mesh, target.frame(i)).look_from(eye);
    seen += part.seen.area;
    all += part.all.area;
  }
  return static_cast<double>(seen / all);
}

struct Scale {
  const char* name;
  double scale;
  Vec3 origin;
};

class VisibleShareScales : public ::testing::TestWithParam<Scale> {};

TEST_P(VisibleShareScales, ClaimsNothingThatSeesLess) {
  Random random(23);
  int looked = 0, volumes = 0;
  for (int round = 0; round < 8; ++round) {
    SCOPED_TRACE("round " + std::to_string(round));
    const Place place = random_place(random, GetParam().scale, GetParam().origin);
    const double share = std::vector<double>{0.3, 0.5, 0.8, 0.95}[static_cast<std::size_t>(random.integer(0, 3))];
    const auto cells = static_cast<std::size_t>(random.integer(2, 16));
    const PreparedTarget target(PreparedScene(place.scene), place.target, sharing(place.range, share, cells));
    // The usual tolerance is one of a hundred metres: with it large worlds have a million facets.
    const Volume volume = compute_volume(target, {}, {.tolerance_m = 2e-4 * place.range});
    if (volume.outcome != Outcome::computed) continue;
    ++volumes;
    EXPECT_EQ(first_open_edge(volume.mesh), "");
    const MeshProbe probe(volume);
    const double rounding = 1e-15 * (place.scene.mesh.vertices[0].cwiseAbs().maxCoeff() + place.range);
    for (int i = 0; i < 60; ++i) {
      Vec3 p = probe.draw(random);
      if (i % 3 > 0) {  // just below the surface
        const auto f = static_cast<std::size_t>(random.integer(0, static_cast<int>(volume.mesh.triangles.size()) - 1));
        const Triangle& t = volume.mesh.triangles[f];
        const Vec3 &a = volume.mesh.vertices[t[0]], &b = volume.mesh.vertices[t[1]], &c = volume.mesh.vertices[t[2]];
        const double u = random.uniform(0, 1), v = random.uniform(0, 1 - u);
        p = a + u * (b - a) + v * (c - a) - 1e-5 * place.range * (b - a).cross(c - a).normalized();
      }
      if (!p.allFinite() || !probe.holds(p) || probe.depth(p) < 2e-6 * (p - volume.frame.origin).norm() + 10 * rounding)
        continue;
      ++looked;
      EXPECT_GE(exact_share(place.scene, target, p), share - 1e-6) << p.transpose() << " of " << cells;
    }
  }
  EXPECT_GT(volumes, 4);
  EXPECT_GT(looked, 100);
}

INSTANTIATE_TEST_SUITE_P(All, VisibleShareScales,
                         ::testing::Values(Scale{"millimetres", 1e-3, Vec3::Zero()}, Scale{"metres", 1, Vec3::Zero()},
                                           Scale{"kilometres", 100, Vec3::Zero()},
                                           Scale{"map", 1, Vec3(689000, 5334000, 520)}),
                         [](const auto& scale) { return scale.param.name; });

/// No point of `small`, deeper than rounding, is outside of `large`.
void expect_inside(const Volume& small, const Volume& large, Random& random) {
  const MeshProbe inner(small), outer(large);
  for (int i = 0; i < 300; ++i) {
    const Vec3 p = inner.draw(random);
    if (inner.depth(p) < 1e-5) continue;
    EXPECT_GT(outer.depth(p), -1e-5) << p.transpose();
  }
}

TEST(VisibleShare, GrowsAsLessIsAskedAndWithNestedCells) {
  Random random(24);
  for (int round = 0; round < 2; ++round) {
    const Scene scene = testing::random_city(random, 10, 12);
    const Target target = rectangle(random.uniform(8, 14), random.uniform(4, 8));
    const PreparedScene prepared(scene);
    const auto with = [&](double share, std::size_t cells) {
      return compute_volume(PreparedTarget(prepared, target, sharing(70, share, cells)));
    };
    const Volume whole = compute_volume(PreparedTarget(prepared, target, {70}));
    const Volume most = with(0.85, 8), more = with(0.75, 8), half = with(0.5, 8);
    expect_inside(whole, most, random);
    expect_inside(most, more, random);
    expect_inside(more, half, random);
    EXPECT_LE(size_of(most), size_of(more) * (1 + 1e-6));
    EXPECT_LE(size_of(more), size_of(half) * (1 + 1e-6));
    const Volume coarse = with(0.75, 4), fine = with(0.75, 16);
    expect_inside(coarse, more, random);
    expect_inside(more, fine, random);
    EXPECT_LT(size_of(coarse), size_of(fine));
  }
}

TEST(VisibleShare, OtherLimitsHoldForAllOfTheTarget) {
  const Scene scene = half_plate();
  Sensor sensor = sharing(40, 0.5, 16);
  sensor.min_range_m = 15;
  sensor.incidence_deg = 50;
  sensor.sun = SunLimit{Vec3(0.2, 0.1, -1), 10};
  Navigation navigation;
  navigation.altitude = Navigation::Altitude{5, 30};
  const PreparedTarget target(PreparedScene(scene), rectangle(10, 10), sensor);
  const Volume volume = compute_volume(target, navigation);
  ASSERT_EQ(volume.outcome, Outcome::computed) << volume.reason;
  EXPECT_EQ(first_open_edge(volume.mesh), "");
  Random random(25);
  const MeshProbe probe(volume);
  std::vector<Vec3> points;
  for (int i = 0; i < 300; ++i) points.push_back(probe.draw(random));
  PointQuery query(target, navigation);
  const std::vector<PointAnswer> answers = query.answer(points);
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (probe.depth(points[i]) > 1e-4) {
      EXPECT_TRUE(answers[i].inside) << points[i].transpose();
    }
  }
}

TEST(VisibleShare, AnswersForPointsCountExactly) {
  const Scene scene = half_plate();
  const PreparedTarget target(PreparedScene(scene), rectangle(10, 10), sharing(60, 0.6, 4));
  const std::vector<Vec3> points = {{-1.5, 0, 20}, {-0.5, 0, 20}, {3, 0, 8}, {-1.5, 0, 70}, {-9, 0, -3}, {5, 1, 12}};
  PointQuery query(target);
  const std::vector<PointAnswer> answers = query.answer(points);
  ASSERT_EQ(answers.size(), points.size());
  for (const PointAnswer& answer : answers) EXPECT_TRUE(std::isnan(answer.margin_m));
  EXPECT_TRUE(answers[0].inside);  // sees 65 %
  EXPECT_TRUE(answers[0].blocked_by.empty());
  EXPECT_FALSE(answers[1].inside);  // 55 %
  EXPECT_EQ(answers[1].blocked_by, std::vector<std::string>{"plate"});
  EXPECT_TRUE(answers[2].inside);
  EXPECT_FALSE(answers[3].inside);
  EXPECT_TRUE(answers[3].out_of_range);
  EXPECT_FALSE(answers[4].inside);
  EXPECT_TRUE(answers[4].behind_target);
  EXPECT_FALSE(answers[5].inside);
  // Two of four cells are seen whole: the volume lacks a point that sees enough.
  EXPECT_LT(MeshProbe(compute_volume(target)).depth(points[0]), 0);
  // Joined, answers stay without a margin.
  EXPECT_TRUE(std::isnan(any_of(answers).margin_m));
  EXPECT_TRUE(any_of(answers).inside);
  EXPECT_FALSE(all_of(answers).inside);
}

VerifyReport judged(const Scene& scene, const Target& target, const Volume& volume, const Sensor& sensor) {
  VerifyOptions options;
  options.points = 6000;
  options.lift_m = volume.lift_m;
  return verify_volume(scene, target, sensor, {}, volume.mesh, options);
}

TEST(VisibleShare, IsJudgedByTheShareThatIsSeen) {
  Random random(26);
  const Scene scene = testing::random_city(random, 14, 12);
  Target target = rectangle(14, 6);
  for (const bool has_parts : {false, true}) {
    if (has_parts) target.parts.push_back({{-2, -2, 9}, {2, -2, 9}, {2, 2, 9.5}, {-2, 2, 9.5}});
    const Volume volume = volume_of(scene, target, sharing(70, 0.8, 16));
    const VerifyReport right = judged(scene, target, volume, sharing(70, 0.8, 16));
    EXPECT_TRUE(right.is_right()) << right.over_claimed << ", " << right.worst_over_cause << " by "
                                  << right.worst_over_depth_m << " at " << right.worst_over_point.transpose();
    EXPECT_LE(right.under_claimed, 2u);
    ASSERT_TRUE(right.share_unclaimed);
    EXPECT_GT(*right.share_unclaimed, 10u);
    // Less is fine, more is not, and all is far from it.
    EXPECT_EQ(judged(scene, target, volume, sharing(70, 0.79, 16)).over_claimed, 0u);
    const VerifyReport more = judged(scene, target, volume, sharing(70, 0.98, 16));
    EXPECT_GT(more.over_claimed, 0u);
    EXPECT_NE(more.worst_over_cause, "");
    EXPECT_GT(judged(scene, target, volume, {70}).over_claimed, more.over_claimed);
    EXPECT_FALSE(judged(scene, target, volume, {70}).share_unclaimed);
    // A volume that lacks what sees all of the target is told from one that lacks what sees enough.
    const Volume near = volume_of(scene, target, sharing(35, 0.8, 16));
    EXPECT_GT(judged(scene, target, near, sharing(70, 0.8, 16)).under_claimed, 100u);
  }
}

TEST(VisibleShare, IsJudgedToAHundredth) {
  const Scene scene = half_plate();
  const Target target = rectangle(20, 1);
  const Volume volume = volume_of(scene, target, sharing(60, 0.8, 20));
  EXPECT_TRUE(judged(scene, target, volume, sharing(60, 0.8, 20)).is_right());
  EXPECT_GT(judged(scene, target, volume, sharing(60, 0.81, 20)).over_claimed, 20u);
  EXPECT_GT(judged(scene, target, volume, sharing(60, 0.8001, 20)).over_claimed, 20u);
}

TEST(VisibleShare, OfSeveralTargetsIsJudgedToo) {
  Random random(27);
  const Scene scene = testing::random_city(random, 12, 12);
  Target left = rectangle(8, 6), right = rectangle(5, 5);
  for (Vec3& v : right.parts[0]) v += Vec3(0, 0, 12);
  const Sensor sensor = sharing(60, 0.7, 8);
  const PreparedScene prepared(scene);
  const std::vector<Volume> each = {compute_volume(PreparedTarget(prepared, left, sensor)),
                                    compute_volume(PreparedTarget(prepared, right, sensor))};
  VerifyOptions options;
  options.points = 4000;
  options.lift_m = {each[0].lift_m[0], each[1].lift_m[0]};
  const auto judge = [&](const Volume& volume, const std::vector<std::vector<Target>>& views) {
    EXPECT_EQ(first_open_edge(volume.mesh), "");
    return verify_volume(scene, views, sensor, {}, volume.mesh, options);
  };
  const VerifyReport any = judge(unite_volumes(each), {{left, right}});
  EXPECT_TRUE(any.is_right()) << any.worst_over_cause;
  EXPECT_TRUE(any.share_unclaimed);
  const VerifyReport all = judge(intersect_volumes(each), {{left}, {right}});
  EXPECT_TRUE(all.is_right()) << all.worst_over_cause;
  EXPECT_GT(judge(unite_volumes(each), {{left}, {right}}).over_claimed, 0u);
}

TEST(VisibleShare, RefusesWhatHasNoShare) {
  const PreparedScene scene(half_plate());
  testing::expect_error([&] { PreparedTarget(scene, Target::point(Vec3(0, 0, 1)), sharing(50, 0.5, 4)); },
                        ErrorCode::not_applicable, "sensor.visible");
  for (const double share : {0.0, -0.1, 1.5, std::nan("")}) {
    testing::expect_error([&] { check_sensor(sharing(50, share, 4)); }, ErrorCode::value_out_of_range,
                          "sensor.visible");
  }
  for (const std::size_t cells : {0, 1025}) {
    testing::expect_error([&] { check_sensor(sharing(50, 0.5, cells)); }, ErrorCode::value_out_of_range,
                          "sensor.cells");
  }
  const PreparedTarget target(scene, rectangle(10, 10), sharing(50, 0.5, 4));
  testing::expect_error([&] { compute_visibility_spheres(target); }, ErrorCode::not_applicable, "sensor.visible");
  testing::expect_error([&] { PreparedTarget(scene, Target::point(Vec3(0, 0, 1)), {50}).cells(0, 4, 50); },
                        ErrorCode::not_applicable, "target");
}

TEST(VisibleShare, SaysWhyThereIsNothing) {
  SceneBuilder scene;  // a lid over all of it
  scene.polygon("lid", {{-90, -90, 0.005}, {90, -90, 0.005}, {90, 90, 0.005}, {-90, 90, 0.005}});
  const Volume volume = compute_volume(PreparedTarget(PreparedScene(scene), rectangle(10, 10), sharing(50, 0.5, 4)));
  ASSERT_EQ(volume.outcome, Outcome::computed) << "what is seen from under the lid";
  EXPECT_LE(bounding_box(volume.mesh).max.z(), 0.005 + 1e-9);
  const Volume far =
      compute_volume(PreparedTarget(PreparedScene(half_plate()), rectangle(40, 40), sharing(20, 0.5, 4)));
  EXPECT_EQ(far.outcome, Outcome::out_of_range);
}

TEST(VisibleShare, StopsWhenItIsTold) {
  Random random(28);
  const PreparedTarget target(PreparedScene(testing::random_city(random, 14, 12)), rectangle(14, 6),
                              sharing(70, 0.8, 16));
  const core::ProgressReporter::AskAlways ask_always;
  int all = 0;
  compute_volume(target, {}, {}, [&](std::string_view, double) { return ++all > 0; });
  for (const int most : {all / 4, all / 2, all / 4 * 3}) {
    int calls = 0;
    const auto stop = [&](std::string_view, double) { return ++calls < most; };
    testing::expect_code([&] { compute_volume(target, {}, {}, stop); }, ErrorCode::cancelled);
    EXPECT_EQ(calls, most) << "of " << all;
  }
}

// A long facade in a real city: what is claimed sees enough by PointQuery and by the independent check.
TEST(HeavyVisibleShare, OfAFacadeInCharlotte) {
  VANTAGE_REQUIRE_SHARED("charlotte/uptownCharlotte.obj");
  const Scene scene = read_scene(testing::shared_data("charlotte/uptownCharlotte.obj"), {.up = UpAxis::y});
  const PreparedScene prepared(scene);
  Random random(29);
  const Box bounds = bounding_box(scene.mesh);
  int volumes = 0;
  for (int round = 0; round < 40 && volumes < 3; ++round) {
    // An upright rectangle over the streets, where nothing pierces it.
    Vec3 middle = random.in_box(bounds);
    middle.z() = bounds.min.z() + random.uniform(15, 60);
    const double turn = random.uniform(0, 6.3);
    const Vec3 along(std::cos(turn), std::sin(turn), 0);
    const Vec3 half = 20 * along, up(0, 0, 6);
    const Target target = target_of({middle - half - up, middle + half - up, middle + half + up, middle - half + up});
    try {
      const PreparedTarget wanted(prepared, target, sharing(200, 0.8, 16));
      const Volume volume = compute_volume(wanted);
      if (volume.outcome != Outcome::computed || size_of(volume) < 1000) continue;
      ++volumes;
      VerifyOptions options;
      options.points = 4000;
      options.lift_m = volume.lift_m;
      const VerifyReport report = verify_volume(scene, target, wanted.sensor(), {}, volume.mesh, options);
      EXPECT_TRUE(report.is_right()) << report.over_claimed << " because of " << report.worst_over_cause;
      EXPECT_EQ(report.under_claimed, 0u);
      const MeshProbe probe(volume);
      std::vector<Vec3> points;
      while (points.size() < 500) {
        const Vec3 p = probe.draw(random);
        if (probe.depth(p) > 1e-3) points.push_back(p);
      }
      for (const PointAnswer& answer : PointQuery(wanted).answer(points)) EXPECT_TRUE(answer.inside);
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::target_pierced);
    }
  }
  EXPECT_GT(volumes, 1);
}

}  // namespace
}  // namespace vantage
