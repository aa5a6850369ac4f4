// The surface about a target within which a camera that can turn takes in only a part of it.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "sensor/best_aim.h"
#include "sensor/find_aim.h"
#include "solid/frame_surface.h"
#include "support/random.h"
#include "vantage/camera.h"

namespace vantage {
namespace {

using internal::sensor::AimFinder;
using internal::sensor::find_aim;
using internal::solid::FrameSurface;
using internal::solid::FrameView;
using internal::solid::make_frame_surface;
using testing::Random;

/// A square of 4 m, level, upright or askew.
std::vector<Vec3> square_facing(const Vec3& front) {
  const auto turn = Eigen::Quaterniond::FromTwoVectors(Vec3::UnitZ(), front);
  std::vector<Vec3> corners;
  for (const auto& [x, y] : {std::pair{-2, -2}, {2, -2}, {2, 2}, {-2, 2}}) corners.push_back(turn * Vec3(x, y, 0));
  return corners;
}

TEST(FrameSurface, EndsWhereTheSearchFromANeighbourIsNoBetter) {
  // A camera that is turned on its side, on a gimbal of few pitches: it went on without end.
  const std::vector<std::vector<Vec3>> targets = {{{80.5164474, 103.025911, 3.0},
                                                   {-77.1513534, 94.7292877, 3.0},
                                                   {-77.1513534, 94.7292877, 70.6203289},
                                                   {80.5164474, 103.025911, 70.6203289}},
                                                  {{-64.1430675, 18.4369372, 3.0},
                                                   {-92.1779213, -26.0215811, 3.0},
                                                   {-92.1779213, -26.0215811, 41.6558135},
                                                   {-64.1430675, 18.4369372, 41.6558135}}};
  for (int round = 0; round < 8; ++round) {
    std::vector<Vec3> corners = targets[static_cast<std::size_t>(round) % targets.size()];
    Vec3 middle = Vec3::Zero();
    for (const Vec3& corner : corners) middle += corner / 4;
    for (Vec3& corner : corners) corner -= middle;
    const Vec3 normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalized();
    Mount mount;
    mount.min_pitch_deg = -45;
    mount.max_pitch_deg = -30;
    mount.roll_deg = round < 4 ? 90 : 180;
    FrameView view{.corners = corners, .front = normal, .camera = pinhole_of_fov(60, 45), .mount = mount};
    if (round / 2 % 2 == 1) view.front = Vec3(-normal);
    view.reach = 700;
    view.least = 7e-4;
    EXPECT_GT(make_frame_surface(view).mesh.triangles.size(), 700);
  }
}

class FrameSurfaces : public ::testing::TestWithParam<std::pair<Vec3, Mount>> {
 protected:
  const Vec3 front = GetParam().first.normalized();
  const Mount mount = GetParam().second;
  const std::vector<Vec3> corners = square_facing(front);
  const Pinhole camera = pinhole_of_fov(23, 17, 4000, 3000);
  const FrameView view{
      .corners = corners, .front = front, .camera = camera, .mount = mount, .reach = 300, .least = 3e-4};
  const FrameSurface surface = make_frame_surface(view);

  const Vec3& corner(std::size_t facet, std::size_t k) const {
    return surface.mesh.vertices[surface.mesh.triangles[facet][k]];
  }
};

/// From random points of it, on the front and within reach, the camera takes in all of the target.
TEST_P(FrameSurfaces, ShowsAllOfTheTarget) {
  Random random(71);
  int tried = 0;
  for (std::size_t facet = 0; facet < surface.mesh.triangles.size(); ++facet) {
    // Anywhere on it, in its middle and on a side, where the allowance is needed.
    const double far = random.uniform(0, 1), part = random.uniform(0, 1);
    const std::array<std::pair<double, double>, 3> places = {
        {{far * part, far * (1 - part)}, {1.0 / 3, 1.0 / 3}, {0.5, 0.0}}};
    const auto& [a, b] = places[static_cast<std::size_t>(random.integer(0, 2))];
    const Vec3 point = (1 - a - b) * corner(facet, 0) + a * corner(facet, 1) + b * corner(facet, 2);
    if (point.dot(front) <= 0 || point.norm() > view.reach) continue;
    std::vector<Vec3> seen;
    for (const Vec3& at : corners) seen.push_back(at - (1 + 1e-6) * point);
    EXPECT_TRUE(find_aim(camera, mount, seen, 1e-8).aim) << "facet " << facet << " at " << point.transpose();
    ++tried;
  }
  EXPECT_GT(tried, 1000);
}

/// The space that it takes away too much, beside what must go: from another search for the nearest place of each facet,
/// with many beginnings.
TEST_P(FrameSurfaces, LiesLittleFartherOutThanItMust) {
  const AimFinder finder(corners, camera, mount, view.least);
  double taken = 0, due = 0;
  for (std::size_t facet = 0; facet < surface.mesh.triangles.size(); ++facet) {
    const Vec3 point = (corner(facet, 0) + corner(facet, 1) + corner(facet, 2)) / 3;
    const Vec3 direction = point.normalized();
    if (direction.dot(front) < 0.05) continue;  // next to the target's plane distances are infinite
    double best = finder.best(direction).distance(direction);
    for (int i = 0; i < 12; ++i) {
      const internal::sensor::Aim start{i * std::numbers::pi / 6, std::asin(-direction.z())};
      best = std::min(best, finder.best(direction, finder.next_to(start).aim).distance(direction));
    }
    if (!(best < view.reach)) continue;
    const Vec3 a = corner(facet, 0).normalized(), b = corner(facet, 1).normalized(), c = corner(facet, 2).normalized();
    const double solid_angle = (b - a).cross(c - a).norm() / 2;
    taken += solid_angle / 3 * std::pow(std::min(point.norm(), view.reach), 3);
    due += solid_angle / 3 * std::pow(best, 3);
  }
  EXPECT_GE(taken, due);
  // Where the mount's pitch ends distances grow beyond all bounds, and facets across that are in the way wholly.
  const double half_ball = 2 * std::numbers::pi / 3 * std::pow(view.reach, 3);
  EXPECT_LT(taken, 1.2 * due + (mount.max_pitch_deg < 90 ? 0.01 * half_ball : 0));
}

INSTANTIATE_TEST_SUITE_P(Squares, FrameSurfaces,
                         ::testing::Values(std::pair{Vec3(0, 0, 1), Mount{}}, std::pair{Vec3(0, 1, 0), Mount{}},
                                           std::pair{Vec3(1, 2, 1), Mount{}}, std::pair{Vec3(-1, 0, 0.3), Mount{}},
                                           std::pair{Vec3(0, -1, 0), Mount{.min_pitch_deg = -60, .max_pitch_deg = 20}},
                                           std::pair{Vec3(1, 1, 1), Mount{.roll_deg = 20}}));

}  // namespace
}  // namespace vantage
