// Triangles so thin that they are all but segments hide what is behind them, whatever the scale.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <iostream>
#include <string>

#include "support/claimed_points.h"
#include "support/outlines.h"
#include "support/random.h"
#include "support/scenes.h"
#include "vantage/scene.h"
#include "vantage/volume.h"

namespace vantage {
namespace {

using testing::judge;
using testing::log_uniform;
using testing::Random;
using testing::SceneBuilder;
using testing::target_of;
using testing::Verdict;

constexpr double kScales[] = {1e-3, 1e-1, 1, 1e2, 1e4};  // metres
const Vec3 kOnMap(4'512'345.6, 5'012'345.6, 812.3);

double width_of(const std::vector<Vec3>& t) {
  const double length = std::max({(t[1] - t[0]).norm(), (t[2] - t[1]).norm(), (t[0] - t[2]).norm()});
  return length > 0 ? (t[1] - t[0]).cross(t[2] - t[0]).norm() / length : 0;
}

TEST(ThinTriangles, HideWhateverTheirWidth) {
  Random random(1013);
  std::size_t volumes = 0, looked = 0, thinner = 0;
  for (const double scale : kScales) {
    for (const bool on_map : {false, true}) {
      if (on_map && scale < 1) continue;
      for (int draw = 0; draw < 30; ++draw) {
        SCOPED_TRACE(std::to_string(scale) + (on_map ? " m on the map, draw " : " m, draw ") + std::to_string(draw));
        const Vec3 n = random.direction(), u = n.unitOrthogonal(), v = n.cross(u);
        const Vec3 centre = on_map ? kOnMap : Vec3(scale * random.point(-3, 3));
        Target target;
        for (const auto& [x, y] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}})
          target.parts[0].push_back(centre + 0.1 * scale * (x * u + y * v));
        target.front = n;
        SceneBuilder builder;
        double size = 0;
        for (int k = 0; k < 4; ++k) {
          const Vec3 middle = centre + scale * (random.uniform(-0.5, 0.5) * u + random.uniform(-0.5, 0.5) * v +
                                                random.uniform(0.3, 0.8) * n);
          const Vec3 along = random.direction(), across = along.unitOrthogonal();
          const double length = scale * log_uniform(random, 0.02, 0.3);
          const double width = scale * log_uniform(random, 4e-15, 1e-6);
          const std::vector<Vec3> corners{middle - length * along, middle + length * along,
                                          middle + random.uniform(-1, 1) * length * along + width * across};
          for (const Vec3& corner : corners) size = std::max(size, (corner - centre).cwiseAbs().maxCoeff());
          if (!(width_of(corners) > 0x1p-49 * size)) continue;  // rounding to map coordinates made it a segment
          thinner += width_of(corners) < 1e-9;
          builder.polygon("wire " + std::to_string(k), corners);
        }
        const Scene scene = builder;
        const PreparedScene prepared(scene);
        EXPECT_EQ(prepared.statistics().degenerate_triangles, 0U);
        const Volume volume = compute_visibility(PreparedTarget(prepared, target, {3 * scale}), {0.03 * scale, 0});
        if (volume.outcome != Outcome::computed) continue;
        ++volumes;
        const MeshMeasures m = measure(volume.mesh);
        EXPECT_TRUE(m.closed && m.oriented && m.euler == 2 && m.pieces == 1);
        const double rounding = 1e-15 * (10 * scale + centre.cwiseAbs().maxCoeff());
        const Verdict verdict = judge(volume, scene.mesh, target.parts[0], 250, rounding, random);
        looked += verdict.looked;
        EXPECT_EQ(verdict.hidden, 0U) << "of " << verdict.looked << ", deepest " << verdict.deepest;
      }
    }
  }
  std::cout << volumes << " volumes, " << looked << " points, " << thinner << " triangles thinner than 1e-9 m\n";
  EXPECT_GT(volumes, 200U);
}

TEST(ThinTriangles, AreDroppedOnlyWhereRoundingMayHaveMadeThem) {
  for (const double scale : {1e-6, 1e-3, 1.0, 1e3, 1e6}) {
    SCOPED_TRACE(scale);
    const auto drops = [scale](double width) {
      Scene scene;
      scene.mesh.vertices = {{-1, -1, -1}, {1, 1, 1}, {1, -1, 0}, {0, 0, 0}, {0.5, 0, 0}, {0.2, width, 0}};
      for (Vec3& v : scene.mesh.vertices) v *= scale;
      scene.mesh.triangles = {{0, 1, 2}, {3, 4, 5}};
      return PreparedScene(scene).statistics().degenerate_triangles;
    };
    EXPECT_EQ(drops(0), 1U);
    EXPECT_EQ(drops(0.9 * 0x1p-50), 1U);
    EXPECT_EQ(drops(1.1 * 0x1p-50), 0U);
    EXPECT_EQ(drops(1e-9), 0U);
  }
}

TEST(ThinTriangles, DoNotMoveTheOrigin) {
  // The limit is relative to the scene, so it is known only when its bounds are: a triangle without area has no part in
  // these.
  Scene scene = SceneBuilder().box("block", kOnMap, kOnMap + Vec3(4, 2, 6));
  const Box bounds = PreparedScene(scene).statistics().bounds;
  const auto stray = static_cast<std::uint32_t>(scene.mesh.vertices.size());
  for (const double x : {0.1, 0.2, 0.3}) scene.mesh.vertices.emplace_back(x, 2 * x, 3 * x);
  scene.mesh.triangles.push_back({stray, stray + 1, stray + 2});
  scene.object_of.push_back(0);
  const PreparedScene prepared(scene);
  EXPECT_EQ(prepared.statistics().degenerate_triangles, 1U);
  EXPECT_EQ(prepared.statistics().bounds.min, bounds.min);
  EXPECT_EQ(prepared.statistics().bounds.max, bounds.max);
}

}  // namespace
}  // namespace vantage
