// make_target_frame: every check, the choice of the front, and the frame itself.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "support/random.h"
#include "support/wording.h"
#include "vantage/error.h"
#include "vantage/target.h"

namespace vantage {
namespace {

using Eigen::Vector2d;
using testing::Random;

Target plaza_of(std::vector<Vec3> vertices) {
  Target target;
  target.name = "plaza";
  target.parts[0] = std::move(vertices);
  return target;
}

Target square() { return plaza_of({{0, 0, 2}, {4, 0, 2}, {4, 4, 2}, {0, 4, 2}}); }

Target reversed(Target target) {
  std::reverse(target.parts[0].begin(), target.parts[0].end());
  return target;
}

/// A regular polygon in the plane through `centre` with the given normal; counter-clockwise seen from there.
Target regular(int corners, double radius, const Vec3& centre, const Vec3& normal) {
  const Vec3 u = normal.unitOrthogonal(), v = normal.normalized().cross(u);
  Target target = plaza_of({});
  for (int k = 0; k < corners; ++k) {
    const double angle = 2 * std::numbers::pi * k / corners;
    target.parts[0].push_back(centre + radius * (std::cos(angle) * u + std::sin(angle) * v));
  }
  return target;
}

double signed_area(const std::vector<Vector2d>& polygon) {
  double twice = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector2d &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    twice += a.x() * b.y() - a.y() * b.x();
  }
  return twice / 2;
}

/// All that a frame promises, whatever the target; `corners` are those that must be left.
void expect_frame(const TargetFrame& frame, std::vector<Vec3> corners, double offset, double tolerance = 1e-9) {
  Eigen::Matrix3d axes;
  axes << frame.axis_u, frame.axis_v, frame.normal;
  EXPECT_LT((axes.transpose() * axes - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_NEAR(axes.determinant(), 1, 1e-12);
  EXPECT_GT(signed_area(frame.polygon), 0);
  ASSERT_EQ(frame.polygon.size(), corners.size());
  double farthest = 0;
  for (std::size_t i = 0; i < frame.polygon.size(); ++i) {
    const Vector2d &a = frame.polygon[i], &b = frame.polygon[(i + 1) % frame.polygon.size()];
    EXPECT_GT(a.x() * b.y() - a.y() * b.x(), 0) << "the origin is not strictly inside, edge " << i;
    const Vec3 expected = frame.to_scene({a.x(), a.y(), 0}) - offset * frame.normal;
    const auto found = std::find_if(corners.begin(), corners.end(),
                                    [&](const Vec3& corner) { return (corner - expected).norm() < tolerance; });
    ASSERT_NE(found, corners.end()) << "vertex " << i << " at " << expected.transpose();
    EXPECT_LT((frame.to_local(*found + offset * frame.normal) - Vec3(a.x(), a.y(), 0)).norm(), tolerance);
    corners.erase(found);
    for (const Vector2d& c : frame.polygon) farthest = std::max(farthest, (a - c).norm());
  }
  EXPECT_GE(frame.enclosing_radius_m, farthest / 2 - tolerance);
  EXPECT_LE(frame.enclosing_radius_m, farthest / std::numbers::sqrt3 + tolerance);  // Jung's theorem
}

/// The code of the error of a bad target; every one names the target.
ErrorCode refusal(const Target& target) {
  const Error error = testing::error_of([&] { make_target_frame(target); });
  EXPECT_EQ(error.where(), "target \"plaza\"");
  return error.code();
}

TEST(TargetFrame, HorizontalTargetKeepsTheScenesAxes) {
  const Target target = square();
  const TargetFrame frame = make_target_frame(target);
  expect_frame(frame, target.parts[0], 0);
  EXPECT_EQ(frame.normal, Vec3(0, 0, 1));
  EXPECT_EQ(frame.axis_u, Vec3(1, 0, 0));
  EXPECT_EQ(frame.axis_v, Vec3(0, 1, 0));
  EXPECT_LT((frame.origin - Vec3(2, 2, 2)).norm(), 1e-12);
  EXPECT_NEAR(frame.enclosing_radius_m, 2 * std::numbers::sqrt2, 1e-12);
  EXPECT_LT((frame.to_local({3, 1, 7}) - Vec3(1, -1, 5)).norm(), 1e-12);
}

TEST(TargetFrame, EitherTurnLooksUp) {
  const TargetFrame one = make_target_frame(square()), other = make_target_frame(reversed(square()));
  EXPECT_EQ(other.normal, Vec3(0, 0, 1));
  EXPECT_EQ(one.origin, other.origin);
  expect_frame(other, square().parts[0], 0);
  const Vec3 tilted = Vec3(1, -2, 0.1).normalized();
  const Target slope = regular(5, 10, {3, 4, 5}, tilted);
  for (const Target& target : {slope, reversed(slope)}) {
    const TargetFrame frame = make_target_frame(target);
    expect_frame(frame, slope.parts[0], 0);
    EXPECT_LT((frame.normal - tilted).norm(), 1e-12);
  }
}

TEST(TargetFrame, TiltedTargetsDrawnFromBelowLookUp) {
  const Target overhang = regular(6, 4, {0, 0, 9}, Vec3(0.3, 0.2, -0.4));
  EXPECT_LT((make_target_frame(overhang).normal - Vec3(-0.3, -0.2, 0.4).normalized()).norm(), 1e-12);
}

TEST(TargetFrame, VerticalTargetLooksToWhereItRunsCounterClockwise) {
  // Seen from -y, the vertices run counter-clockwise.
  const Target facade = plaza_of({{0, 0, 0}, {6, 0, 0}, {6, 0, 3}, {0, 0, 3}});
  TargetFrame frame = make_target_frame(facade);
  EXPECT_LT((frame.normal - Vec3(0, -1, 0)).norm(), 1e-12);
  expect_frame(frame, facade.parts[0], 0);
  frame = make_target_frame(reversed(facade));
  EXPECT_LT((frame.normal - Vec3(0, 1, 0)).norm(), 1e-12);
  expect_frame(frame, facade.parts[0], 0);
}

TEST(TargetFrame, AlmostVerticalCountsAsVerticalWithinOneInAMillion) {
  const auto leaning = [](double lean) { return regular(4, 5, {1, 2, 3}, Vec3(1, 0, -lean)); };
  EXPECT_LT(make_target_frame(leaning(0.9e-6)).normal.z(), 0);
  EXPECT_GT(make_target_frame(leaning(1.1e-6)).normal.z(), 0);
}

TEST(TargetFrame, FrontIsObeyed) {
  Target target = square();
  target.front = Vec3(5, 3, -0.1);
  EXPECT_EQ(make_target_frame(target).normal, Vec3(0, 0, -1));
  expect_frame(make_target_frame(target), target.parts[0], 0);
  expect_frame(make_target_frame(reversed(target)), target.parts[0], 0);
  for (const double length : {1e-100, 1e100}) {
    target.front = Vec3(0, 0, length);
    EXPECT_EQ(make_target_frame(target).normal, Vec3(0, 0, 1));
  }
  Target facade = plaza_of({{0, 0, 0}, {6, 0, 0}, {6, 0, 3}, {0, 0, 3}});
  for (const double side : {-1.0, 1.0}) {
    facade.front = Vec3(0.5, side, 4);
    EXPECT_LT((make_target_frame(facade).normal - Vec3(0, side, 0)).norm(), 1e-12);
    EXPECT_LT((make_target_frame(reversed(facade)).normal - Vec3(0, side, 0)).norm(), 1e-12);
  }
}

TEST(TargetFrame, OffsetMovesTowardsTheFront) {
  Target target = square();
  target.offset_m = 1.5;
  EXPECT_LT((make_target_frame(target).origin - Vec3(2, 2, 3.5)).norm(), 1e-12);
  expect_frame(make_target_frame(target), target.parts[0], 1.5);
  target.front = Vec3(0, 0, -1);
  EXPECT_LT((make_target_frame(target).origin - Vec3(2, 2, 0.5)).norm(), 1e-12);
  target.offset_m = -0.25;
  EXPECT_LT((make_target_frame(target).origin - Vec3(2, 2, 2.25)).norm(), 1e-12);
}

TEST(TargetFrame, CollinearVerticesAreDropped) {
  const Target target = plaza_of({{0, 0, 0}, {1, 0, 0}, {4, 0, 0}, {4, 2, 0}, {4, 3, 0}, {4, 4, 0}, {0, 4, 0}});
  const std::vector<Vec3> corners = {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}};
  expect_frame(make_target_frame(target), corners, 0);
  expect_frame(make_target_frame(reversed(target)), corners, 0);
  // A triangle with a vertex in the middle of every edge, tilted: collinear but for rounding.
  const auto refined = [](const Target& triangle) {
    Target finer = plaza_of({});
    for (int i = 0; i < 3; ++i) {
      finer.parts[0].push_back(triangle.parts[0][i]);
      finer.parts[0].push_back(0.5 * (triangle.parts[0][i] + triangle.parts[0][(i + 1) % 3]));
    }
    return finer;
  };
  const Target triangle = regular(3, 7, {0, 0, 0}, {0.3, -0.4, 0.7});
  expect_frame(make_target_frame(refined(triangle)), triangle.parts[0], 0);
  // On a map the coordinates are rounded to a nanometre: a vertex that this puts outside is a corner.
  const Target on_map = refined(regular(3, 7, {580000, 4785000, 1000}, {0.3, -0.4, 0.7}));
  const TargetFrame frame = make_target_frame(on_map);
  EXPECT_LE(frame.polygon.size(), 6U);
  for (const Vec3& vertex : on_map.parts[0]) {
    const Vector2d v = frame.to_local(vertex).head<2>();
    for (std::size_t i = 0; i < frame.polygon.size(); ++i) {
      const Vector2d &a = frame.polygon[i], side = frame.polygon[(i + 1) % frame.polygon.size()] - a;
      EXPECT_GT((side.x() * (v - a).y() - side.y() * (v - a).x()) / side.norm(), -2e-9);  // the origin is rounded too
    }
  }
}

TEST(TargetFrame, SixtyFourVerticesAreTheMost) {
  for (const Vec3& normal : {Vec3(0, 0, 1), Vec3(1, 0, 0), Vec3(1, 2, 3)}) {
    const Target target = regular(64, 30, {1, 2, 3}, normal);
    const TargetFrame frame = make_target_frame(target);
    expect_frame(frame, target.parts[0], 0);
    EXPECT_NEAR(frame.enclosing_radius_m, 30, 1e-9);
    EXPECT_LT((frame.origin - Vec3(1, 2, 3)).norm(), 1e-9);
  }
  EXPECT_EQ(refusal(regular(65, 30, {1, 2, 3}, {0, 0, 1})), ErrorCode::target_vertex_count);
}

TEST(TargetFrame, RandomTargetsOfAnyShapeAndPlace) {
  Random random(17);
  for (int draw = 0; draw < 500; ++draw) {
    SCOPED_TRACE(draw);
    const int corners = random.integer(3, 12);
    const Vec3 normal = random.direction(), u = normal.unitOrthogonal(), v = normal.cross(u);
    const Vec3 centre = random.point(-1e4, 1e4);
    const double squeeze = std::pow(10, random.uniform(-3, 0));  // down to slivers
    std::vector<double> angles;
    for (int k = 0; k < corners; ++k) angles.push_back((k + random.uniform(0.1, 0.9)) * 2 * std::numbers::pi / corners);
    Target target = plaza_of({});
    for (const double angle : angles)
      target.parts[0].push_back(centre + 40 * (std::cos(angle) * u + squeeze * std::sin(angle) * v));
    target.front = normal;
    target.offset_m = random.uniform(-1, 1);
    const TargetFrame frame = make_target_frame(random.chance(0.5) ? target : reversed(target));
    EXPECT_GT(frame.normal.dot(normal), 1 - 1e-9);
    expect_frame(frame, target.parts[0], target.offset_m, 1e-7);
  }
}

TEST(TargetFrame, RefusesTooFewVertices) {
  EXPECT_EQ(refusal(plaza_of({})), ErrorCode::target_vertex_count);
  EXPECT_EQ(refusal(plaza_of({{0, 0, 0}, {1, 0, 0}})), ErrorCode::target_vertex_count);
}

TEST(TargetFrame, OfAPointSeenFromAllSides) {
  Target target = plaza_of({{1e6, 2, 3.7}});
  const TargetFrame frame = make_target_frame(target);
  EXPECT_TRUE(frame.all_sides);
  EXPECT_EQ(frame.origin, target.parts[0][0]);
  EXPECT_EQ(frame.normal, Vec3::UnitZ());
  EXPECT_EQ(frame.axis_u, Vec3::UnitX());
  EXPECT_EQ(frame.axis_v, Vec3::UnitY());
  ASSERT_EQ(frame.polygon.size(), 1U);
  EXPECT_EQ(frame.polygon[0], Vector2d(0, 0));
  EXPECT_EQ(frame.enclosing_radius_m, 0);
  EXPECT_FALSE(make_target_frame(square()).all_sides);
}

TEST(TargetFrame, OfAPointWithAFront) {
  Target target = plaza_of({{1, 2, 3}});
  target.front = Vec3(0, -3, 4);
  target.offset_m = 10;
  const TargetFrame frame = make_target_frame(target);
  EXPECT_FALSE(frame.all_sides);
  EXPECT_TRUE(frame.normal.isApprox(Vec3(0, -0.6, 0.8)));
  EXPECT_TRUE(frame.origin.isApprox(Vec3(1, -4, 11)));
  EXPECT_TRUE(frame.axis_u.cross(frame.axis_v).isApprox(frame.normal));
  target.front = Vec3(0, 0, 0);
  EXPECT_EQ(refusal(target), ErrorCode::direction_invalid);
  EXPECT_EQ(refusal(plaza_of({{0, std::nan(""), 0}})), ErrorCode::coordinate_not_finite);
}

TEST(TargetFrame, AFrontMayHaveAnyLength) {
  Target point = plaza_of({{1, 2, 3}}), down = square();
  for (const double length : {1e-320, 1e-162, 1e-30, 1e30, 1e200, 1e300}) {
    SCOPED_TRACE(length);
    point.front = Vec3(length, 0, length);
    EXPECT_TRUE(make_target_frame(point).normal.isApprox(Vec3(1, 0, 1).normalized(), 1e-14));
    down.front = Vec3(0, 0, -length);
    EXPECT_EQ(make_target_frame(down).normal, Vec3(0, 0, -1));
  }
}

TEST(TargetFrame, RefusesWhatIsNotFinite) {
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    Target target = square();
    target.parts[0][2].y() = bad;
    EXPECT_EQ(refusal(target), ErrorCode::coordinate_not_finite);
    target = square();
    target.offset_m = bad;
    EXPECT_EQ(refusal(target), ErrorCode::value_out_of_range);
    target = square();
    target.front = Vec3(0, bad, 1);
    EXPECT_EQ(refusal(target), ErrorCode::direction_invalid);
  }
}

TEST(TargetFrame, RefusesAFrontThatTellsNothing) {
  Target target = square();
  target.front = Vec3::Zero();
  EXPECT_EQ(refusal(target), ErrorCode::direction_invalid);
  target.front = Vec3(1, 1, 0);
  EXPECT_EQ(refusal(target), ErrorCode::direction_invalid);
}

TEST(TargetFrame, RefusesRepeatedVerticesAndSaysWhich) {
  Target target = square();
  target.parts[0].push_back(target.parts[0][1]);
  EXPECT_EQ(refusal(target), ErrorCode::target_vertices_coincide);
  target = plaza_of({{0, 0, 0}, {1, 0, 0}, {1, 0, 1e-12}, {0, 1, 0}});
  EXPECT_EQ(refusal(target), ErrorCode::target_vertices_coincide);
  EXPECT_EQ(refusal(plaza_of({{1, 1, 1}, {1, 1, 1}, {1, 1, 1}})), ErrorCode::target_vertices_coincide);
}

TEST(TargetFrame, RefusesZeroArea) {
  EXPECT_EQ(refusal(plaza_of({{0, 0, 0}, {1, 2, 3}, {2, 4, 6}})), ErrorCode::target_without_area);
  EXPECT_EQ(refusal(plaza_of({{0, 0, 0}, {4, 4, 0}, {4, 0, 0}, {0, 4, 0}})),
            ErrorCode::target_without_area);  // a bow tie
}

TEST(TargetFrame, RefusesWhatIsNotPlanarAndSaysByHowMuch) {
  // Lifting one corner of a square by h moves it h/4 off the mean plane; each of the others moves as much.
  Target target = square();
  target.parts[0][2].z() += 0.0039;
  expect_frame(make_target_frame(target), target.parts[0], 0, 2e-3);
  target.parts[0][2].z() += 0.0003;
  EXPECT_EQ(refusal(target), ErrorCode::target_not_planar);  // off by 0.00105 m, says the golden file
  // One in a million of the extent is forgiven.
  target = regular(8, 50e3, {0, 0, 0}, {0, 0, 1});
  target.parts[0][3].z() += 0.1;
  EXPECT_NO_THROW(make_target_frame(target));
  target.parts[0][3].z() += 0.3;
  EXPECT_EQ(refusal(target), ErrorCode::target_not_planar);
}

TEST(TargetFrame, RefusesWhatIsNotConvexAndSaysWhere) {
  const auto turns_at = [](const Target& target) {
    const Error error = testing::error_of([&] { make_target_frame(target); });
    EXPECT_EQ(error.code(), ErrorCode::target_not_convex);
    return error.problem().substr(error.problem().rfind("vertex"));
  };
  const Target arrow = plaza_of({{0, 0, 0}, {4, 0, 0}, {1, 1, 0}, {0, 4, 0}});
  EXPECT_EQ(turns_at(arrow), "vertex 2");
  EXPECT_EQ(turns_at(reversed(arrow)), "vertex 1");
  // A spike that runs out and back along one line.
  const Target spike = plaza_of({{0, 0, 0}, {4, 0, 0}, {6, 0, 0}, {5, 0, 0}, {4, 4, 0}, {0, 4, 0}});
  EXPECT_EQ(refusal(spike), ErrorCode::target_not_convex);
  // Two vertices swapped: the outline crosses itself but encloses some area.
  const Target crossed = plaza_of({{0, 0, 0}, {4, 0, 0}, {1, 3, 0}, {4, 4, 0}});
  EXPECT_EQ(refusal(crossed), ErrorCode::target_not_convex);
}

TEST(TargetFrame, RefusesAStarThatTurnsOneWayOnly) {
  const Target pentagon = regular(5, 5, {0, 0, 0}, {0, 0, 1});
  Target star = pentagon;
  for (int k = 0; k < 5; ++k) star.parts[0][k] = pentagon.parts[0][2 * k % 5];
  EXPECT_EQ(refusal(star), ErrorCode::target_not_convex);
  EXPECT_EQ(refusal(reversed(star)), ErrorCode::target_not_convex);
}

}  // namespace
}  // namespace vantage
