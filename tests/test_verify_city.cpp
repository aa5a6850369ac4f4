// The check's shadow rays over real cities, against a plain loop.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <iostream>
#include <numbers>
#include <random>

#include "support/oracle.h"
#include "support/shared_data.h"
#include "vantage/scene.h"
#include "verify/occluders.h"
#include "verify/target_view.h"

namespace vantage::internal::verify {
namespace {

using testing::Oracle;
using testing::Visibility;

class RandomRays {
 public:
  RandomRays(const Scene& scene, std::uint64_t seed)
      : scene_(scene), bounds_(bounding_box(scene.mesh)), random_(seed) {}

  double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }

  /// A regular polygon of 3 to 6 corners and 5 to 40 m across, somewhere low in the city, in any pose.
  Target target() {
    const Vec3 centre(uniform(bounds_.min.x(), bounds_.max.x()), uniform(bounds_.min.y(), bounds_.max.y()),
                      uniform(0, 20));
    const Vec3 normal = Vec3(uniform(-1, 1), uniform(-1, 1), uniform(0, 1)).normalized();
    const Vec3 u = normal.unitOrthogonal(), v = normal.cross(u);
    const int corners = static_cast<int>(uniform(3, 6.999));
    const double radius = uniform(2.5, 20);
    Target target;
    for (int i = 0; i < corners; ++i) {
      const double turn = 2 * std::numbers::pi * i / corners;
      target.parts[0].push_back(centre + radius * (std::cos(turn) * u + std::sin(turn) * v));
    }
    target.front = normal;
    return target;
  }

  Vec3 target_point(const TargetView& view) {
    const auto corner = static_cast<std::size_t>(uniform(0, 4));
    return corner == 0 ? view.vertices()[0] : view.interior(uniform(0, 1), uniform(0, 1));
  }

  /// A viewpoint for the target point: anywhere in front, or (every other time) so that the ray passes an edge of the
  /// scene at 1e-12 to 1e-2 of its length, where single precision is of no use. Local coordinates.
  Vec3 viewpoint(const TargetView& view, const Vec3& target_point, double range) {
    for (int attempt = 0; attempt < 1000; ++attempt) {
      Vec3 point = target_point + range * Vec3(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1));
      if (uniform(0, 1) < 0.5) {
        const Triangle& triangle = scene_.mesh.triangles[random_() % scene_.mesh.triangles.size()];
        const double share = uniform(0, 1);
        const Vec3 on_edge =
            (1 - share) * scene_.mesh.vertices[triangle[0]] + share * scene_.mesh.vertices[triangle[1]];
        const Vec3 beyond = on_edge - view.origin() - target_point;
        const Vec3 jitter = Vec3(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1));
        point = target_point + uniform(1.01, 3) * (beyond + std::pow(10, uniform(-12, -2)) * beyond.norm() * jitter);
      }
      if (view.height(point) > 0 && view.farthest(point) < range) return point;
    }
    return view.centre() + 0.5 * range * view.normal();
  }

 private:
  const Scene& scene_;
  Box bounds_;
  std::mt19937_64 random_;
};

TEST(HeavyVerify, AgreesWithAPlainLoopOverCharlotte) {
  VANTAGE_REQUIRE_SHARED("charlotte/uptownCharlotte.obj");
  const Scene scene = read_scene(testing::shared_data("charlotte/uptownCharlotte.obj"), {UpAxis::y, 1.0});
  constexpr int kTargets = 40, kRays = 5000;
  constexpr double kRange = 400;
  const std::uint64_t seed = 77;
  RandomRays rays(scene, seed);
  int hidden = 0, clear = 0, grazing = 0;
  for (int i = 0; i < kTargets; ++i) {
    const TargetView view(rays.target());
    const Occluders occluders(scene, view, kRange);
    std::vector<Vec3> polygon;
    for (const Vec3& vertex : view.vertices()) polygon.push_back(vertex + view.origin());
    const Oracle oracle(scene.mesh, polygon, view.normal());
    for (int k = 0; k < kRays; ++k) {
      const Vec3 to = rays.target_point(view), from = rays.viewpoint(view, to, kRange);
      const Visibility truth = oracle.look(from + view.origin(), to + view.origin());
      hidden += truth == Visibility::hidden;
      clear += truth == Visibility::clear;
      grazing += truth == Visibility::grazing;
      if (truth == Visibility::grazing) continue;
      ASSERT_EQ(occluders.hide(from, to), truth == Visibility::hidden)
          << "target " << i << " ray " << k << " from " << from.transpose() << " to " << to.transpose();
    }
  }
  std::cout << "seed " << seed << ": " << kTargets * kRays << " rays, " << hidden << " hidden, " << clear << " clear, "
            << grazing << " grazing (not compared)\n";
  EXPECT_GT(hidden, kTargets * kRays / 10);
  EXPECT_GT(clear, kTargets * kRays / 10);
  EXPECT_LT(grazing, kTargets * kRays / 5);
}

/// For every viewpoint that the aimed rays clear, a plain loop over many more random rays finds nothing either.
TEST(HeavyVerify, AimedRaysFindWhatRandomRaysFind) {
  VANTAGE_REQUIRE_SHARED("charlotte/uptownCharlotte.obj");
  const Scene scene = read_scene(testing::shared_data("charlotte/uptownCharlotte.obj"), {UpAxis::y, 1.0});
  const std::uint64_t seed = 78;
  RandomRays rays(scene, seed);
  int seen = 0, hidden = 0, only_aimed = 0;
  for (int i = 0; i < 40; ++i) {
    const TargetView view(rays.target());
    const Occluders occluders(scene, view, 200);
    for (int k = 0; k < 250; ++k) {
      const Vec3 from = rays.viewpoint(view, view.centre(), 200);
      std::size_t shot = 0;
      const bool found = occluders.find_hidden(from, shot).has_value();
      bool hit = false;
      for (int ray = 0; ray < 500 && !hit; ++ray)
        hit = occluders.hide(from, view.interior(rays.uniform(0, 1), rays.uniform(0, 1)));
      ASSERT_TRUE(found || !hit) << "target " << i << " viewpoint " << from.transpose();
      seen += !found;
      hidden += found;
      only_aimed += found && !hit;
    }
  }
  std::cout << "seed " << seed << ": " << seen << " viewpoints see all, " << hidden << " do not, of which "
            << only_aimed << " were missed by 500 random rays\n";
  EXPECT_GT(seen, 100);
  EXPECT_GT(only_aimed, 0);
}

}  // namespace
}  // namespace vantage::internal::verify
