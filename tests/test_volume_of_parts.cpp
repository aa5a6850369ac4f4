// Volumes of targets of several parts, in one plane and in several, against the proof, against the intersection of
// what each part has, and against the share that is seen by the definition.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "solid/range_of_parts.h"
#include "support/mesh_probe.h"
#include "support/random.h"
#include "support/scenes.h"
#include "support/solids.h"
#include "support/sweep_oracle.h"
#include "vantage/prove.h"
#include "vantage/volume.h"

namespace vantage {
namespace {

using testing::first_open_edge;
using testing::MeshProbe;
using testing::Random;
using testing::SweepOracle;
using Parts = std::vector<std::vector<Vec3>>;

/// Teeth on a bar: all in one plane.
Parts comb(int teeth) {
  const double width = 12, pitch = width / teeth;
  Parts parts{{{0, 0, 8}, {width, 0, 8}, {width, 1, 8}, {0, 1, 8}}};
  for (int i = 0; i < teeth; ++i) {
    const double x = i * pitch, end = x + 0.8 * pitch;
    parts.push_back({{x, 1, 8}, {end, 1, 8}, {end, 4, 8}, {x, 4, 8}});
  }
  return parts;
}

/// Two bars that share a corner, on a slope: one point of theirs sees them all.
Parts ell() {
  Parts parts = {{{0, 0, 8}, {9, 0, 8}, {9, 3, 8}, {0, 3, 8}}, {{0, 3, 8}, {3, 3, 8}, {3, 10, 8}, {0, 10, 8}}};
  for (auto& part : parts) {
    for (Vec3& v : part) v.z() += v.y() / 4;
  }
  return parts;
}

/// Triangles about a middle, with tips and notches.
Parts star(int tips) {
  const auto at = [&](int i) {
    const double angle = std::numbers::pi * i / tips, radius = i % 2 == 0 ? 6 : 3;
    return Vec3(5 + radius * std::cos(angle), 4 + radius * std::sin(angle), 8);
  };
  Parts parts;
  for (int i = 0; i < 2 * tips; ++i) parts.push_back({{5, 4, 8}, at(i), at(i + 1)});
  return parts;
}

/// Two slopes, each in two parts.
Parts gable() {
  return {{{0, 0, 8}, {6, 0, 8}, {6, 4, 10}, {0, 4, 10}},
          {{6, 0, 8}, {12, 0, 8}, {12, 4, 10}, {6, 4, 10}},
          {{6, 8, 8}, {0, 8, 8}, {0, 4, 10}, {6, 4, 10}},
          {{12, 8, 8}, {6, 8, 8}, {6, 4, 10}, {12, 4, 10}}};
}

/// So many slopes round a top.
Parts dome(int sides) {
  const auto at = [&](int i, double radius, double height) {
    const double angle = 2 * std::numbers::pi * i / sides;
    return Vec3(radius * std::cos(angle), radius * std::sin(angle), height);
  };
  Parts parts(1);
  for (int i = 0; i < sides; ++i) parts[0].push_back(at(i, 2, 10));
  for (int i = 0; i < sides; ++i) parts.push_back({at(i, 5, 8.5), at(i + 1, 5, 8.5), at(i + 1, 2, 10), at(i, 2, 10)});
  return parts;
}

struct PartsPlace {
  const char* name;
  double scale;
  Vec3 origin;
};

class VolumeOfParts : public ::testing::TestWithParam<PartsPlace> {
 protected:
  Target placed(Parts parts) const {
    Target target;
    target.parts = std::move(parts);
    target.front = Vec3(0, 0, 1);
    for (auto& part : target.parts) {
      for (Vec3& v : part) v = GetParam().origin + GetParam().scale * v;
    }
    return target;
  }
  Scene placed(Scene scene) const {
    for (Vec3& v : scene.mesh.vertices) v = GetParam().origin + GetParam().scale * v;
    return scene;
  }
  double range() const { return 70 * GetParam().scale; }
};

/// Each part is seen whole from points of the volume, just below its surface, too.
void expect_sees_all(const Scene& scene, const PreparedTarget& target, const Volume& volume, Random& random) {
  const MeshProbe probe(volume);
  const double range = target.sensor().max_range_m;
  int looked = 0;
  for (int i = 0; i < 40; ++i) {
    Vec3 p = probe.draw(random);
    if (i % 2 > 0) {
      const int last = static_cast<int>(volume.mesh.triangles.size()) - 1;
      const Triangle& t = volume.mesh.triangles[static_cast<std::size_t>(random.integer(0, last))];
      const Vec3 &a = volume.mesh.vertices[t[0]], &b = volume.mesh.vertices[t[1]], &c = volume.mesh.vertices[t[2]];
      p = (a + b + c) / 3 - 1e-5 * range * (b - a).cross(c - a).normalized();
    }
    if (!p.allFinite() || !probe.holds(p) || probe.depth(p) < 5e-6 * range) continue;
    ++looked;
    for (std::size_t part = 0; part < target.part_count(); ++part) {
      EXPECT_LE(testing::farthest_vertex(target.frame(part), p), range);
      const testing::SweptFraction seen = SweepOracle(scene.mesh, target.frame(part)).look_from(p);
      EXPECT_GE(static_cast<double>(seen.seen.area / seen.all.area), 1 - 1e-6) << p.transpose() << " part " << part;
    }
  }
  EXPECT_GT(looked, 15);
}

/// What the intersection of the parts' volumes holds deeper than the tolerance.
void expect_as_large_as(const Volume& reference, const Volume& volume, double tolerance, Random& random) {
  const MeshProbe all(reference), probe(volume);
  int looked = 0;
  for (int i = 0; i < 300; ++i) {
    const Vec3 p = all.draw(random);
    if (all.depth(p) < tolerance) continue;
    ++looked;
    EXPECT_TRUE(probe.holds(p)) << p.transpose();
  }
  EXPECT_GT(looked, 50);
}

TEST_P(VolumeOfParts, IsWhatSeesThemAll) {
  Random random(3301);
  const std::vector<Parts> all = {comb(2), comb(7), ell(), star(5), gable(), dome(5), dome(12)};
  for (std::size_t i = 0; i < all.size(); ++i) {
    SCOPED_TRACE("target " + std::to_string(i));
    const Scene scene = placed(testing::random_city(random, 12, 16));
    const double tolerance = 5e-3 * range();
    const PreparedTarget target(PreparedScene(scene), placed(all[i]), {.max_range_m = range()});
    const ExactOptions options{.tolerance_m = tolerance};
    const Volume volume = compute_volume(target, {}, options);
    ASSERT_EQ(volume.outcome, Outcome::computed) << volume.reason;
    EXPECT_EQ(volume.counts.boolean_fallbacks, 0U);
    EXPECT_EQ(first_open_edge(volume.mesh), "");
    EXPECT_EQ(volume.lift_m.size(), all[i].size());
    expect_sees_all(scene, target, volume, random);
    std::vector<Volume> volumes;
    for (std::size_t part = 0; part < target.part_count(); ++part) {
      volumes.push_back(compute_visibility(target.part(part), options));
    }
    expect_as_large_as(intersect_volumes(volumes), volume, tolerance, random);
  }
}

TEST_P(VolumeOfParts, LiesAllInRangeThatIsMadeOfPlaces) {
  Random random(3302);
  for (const Parts& parts : {comb(30), gable(), dome(30)}) {
    const Target target = placed(parts);
    const double tolerance = 2e-3 * range();
    const PreparedTarget prepared(PreparedScene(Scene()), target, {.max_range_m = range()});
    const auto volume = internal::solid::range_of_parts(prepared, {.tolerance_m = tolerance});
    ASSERT_TRUE(volume);
    EXPECT_EQ(first_open_edge(volume->mesh), "");
    const auto farthest = [&](const Vec3& p) {
      double most = 0;
      for (std::size_t i = 0; i < prepared.part_count(); ++i) {
        most = std::max(most, testing::farthest_vertex(prepared.frame(i), p));
      }
      return most;
    };
    const double rounding = 4e-16 * (GetParam().origin.norm() + range());
    for (const Vec3& v : volume->mesh.vertices) EXPECT_LE(farthest(v), range() + rounding);
    // No point of a facet of the range is farther inside than the tolerance.
    for (std::size_t t = 0; t < volume->mesh.triangles.size(); ++t) {
      if (volume->causes[volume->cause_of[t]].kind != CauseKind::range) continue;
      const auto& [a, b, c] = volume->mesh.triangles[t];
      for (int i = 0; i < 8; ++i) {
        const double u = random.uniform(0, 1), v = random.uniform(0, 1 - u);
        const Vec3 p =
            (1 - u - v) * volume->mesh.vertices[a] + u * volume->mesh.vertices[b] + v * volume->mesh.vertices[c];
        ASSERT_GE(farthest(p), range() - (1 + 1e-6) * tolerance) << p.transpose();
      }
    }
    // A place in front of the plane that is within all spheres by more than the tolerance is held.
    const MeshProbe probe(*volume);
    const TargetFrame& plane = prepared.frame();
    int held = 0;
    for (int i = 0; i < 2000; ++i) {
      const Vec3 p = plane.origin + random.uniform(0.8, 1) * range() * random.direction();
      if (plane.to_local(p).z() < 1e-3 * range() || farthest(p) > range() - 1.01 * tolerance) continue;
      ++held;
      EXPECT_TRUE(probe.holds(p)) << p.transpose();
    }
    EXPECT_GT(held, 100);
  }
}

INSTANTIATE_TEST_SUITE_P(All, VolumeOfParts,
                         ::testing::Values(PartsPlace{"micrometres", 1e-6, Vec3::Zero()},
                                           PartsPlace{"metres", 1, Vec3::Zero()},
                                           PartsPlace{"kilometres", 100, Vec3::Zero()},
                                           PartsPlace{"map", 1, Vec3(689000, 5334000, 520)}),
                         [](const auto& place) { return place.param.name; });

TEST(VolumeOfPartsAlone, IsProved) {
  Random random(3303);
  for (const Parts& parts : {comb(9), dome(9)}) {
    const Scene scene = testing::random_city(random, 12, 16);
    Target target;
    target.parts = parts;
    target.front = Vec3(0, 0, 1);
    const Sensor sensor{.max_range_m = 70};
    const Volume volume =
        compute_volume(PreparedTarget(PreparedScene(scene), target, sensor), {}, {.tolerance_m = 0.3});
    ASSERT_EQ(volume.outcome, Outcome::computed);
    const ProofReport report = prove_volume(scene, target, sensor, {}, volume.mesh, {.lift_m = volume.lift_m});
    EXPECT_EQ(report.verdict(), ProofVerdict::proved);
  }
}

/// The middle of a long target is out of its range: there is another way.
TEST(VolumeOfPartsAlone, IsThereWhereTheMiddleIsOutOfRange) {
  Target target;
  target.parts = {{{0, 0, 0}, {10, 0, 0}, {10, 10, 0}, {0, 10, 0}},
                  {{0, 0, 10}, {10, 0, 10}, {10, 10, 30}, {0, 10, 30}}};
  target.front = Vec3(0, 0, 1);
  const PreparedTarget prepared(PreparedScene(Scene()), target, {.max_range_m = 20});
  EXPECT_FALSE(internal::solid::range_of_parts(prepared, {}));
  const Volume volume = compute_volume(prepared);
  EXPECT_EQ(volume.outcome, Outcome::computed) << volume.reason;
}

}  // namespace
}  // namespace vantage
