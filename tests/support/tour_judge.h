// An independent and simple judge of tours: flies them in steps, and asks for each whether it keeps the limits.
#pragma once

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "support/simple_airspace.h"
#include "support/solids.h"
#include "vantage/tour.h"

namespace vantage::testing {

/// A moment of a flight.
struct Moment {
  double seconds = 0;
  Vec3 position = Vec3::Zero();
};

/// Every `step_m` of a flight at full speed, with all its points and holds: faster than any vehicle flies it.
inline std::vector<Moment> fly(const Flight& flight, double speed_m_s, double step_m) {
  std::vector<Moment> moments;
  double seconds = 0;
  for (std::size_t i = 0; i < flight.points.size(); ++i) {
    moments.push_back({seconds, flight.points[i].position});
    if (flight.points[i].hold_s > 0) {
      seconds += flight.points[i].hold_s;
      moments.push_back({seconds, flight.points[i].position});
    }
    if (i + 1 == flight.points.size()) break;
    const Vec3 from = flight.points[i].position, along = flight.points[i + 1].position - from;
    const int steps = std::max(1, static_cast<int>(std::ceil(along.norm() / step_m)));
    for (int k = 1; k < steps; ++k) {
      moments.push_back({seconds + along.norm() * k / steps / speed_m_s, from + along * k / steps});
    }
    seconds += along.norm() / speed_m_s;
  }
  return moments;
}

/// Distance from a point to a triangle, by the plane and by the sides.
inline double distance_to_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const auto to_side = [&](const Vec3& u, const Vec3& v) {
    const Vec3 along = v - u;
    const double t = std::clamp(along.dot(p - u) / std::max(along.squaredNorm(), 1e-300), 0.0, 1.0);
    return (p - u - t * along).norm();
  };
  const Vec3 n = (b - a).cross(c - a).normalized(), foot = p - n.dot(p - a) * n;
  const bool is_over =
      n.dot((b - a).cross(foot - a)) >= 0 && n.dot((c - b).cross(foot - b)) >= 0 && n.dot((a - c).cross(foot - c)) >= 0;
  return is_over ? std::abs(n.dot(p - a)) : std::min({to_side(a, b), to_side(b, c), to_side(c, a)});
}

/// Positive inside, negative outside: parity of the crossings of a ray, and the nearest triangle.
inline double slow_depth(const Mesh& mesh, const Vec3& p) {
  const Vec3 ray = Vec3(0.3141, 0.2718, 0.9095).normalized();
  int crossings = 0;
  double nearest = std::numeric_limits<double>::infinity();
  for (const Triangle& t : mesh.triangles) {
    const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    nearest = std::min(nearest, distance_to_triangle(p, a, b, c));
    const Vec3 e = b - a, f = c - a, h = ray.cross(f);
    const double det = e.dot(h);
    if (std::abs(det) < 1e-14) continue;
    const double u = (p - a).dot(h) / det, v = ray.dot((p - a).cross(e)) / det;
    if (u >= 0 && v >= 0 && u + v <= 1 && f.dot((p - a).cross(e)) / det > 0) ++crossings;
  }
  return crossings % 2 == 1 ? nearest : -nearest;
}

/// Adds failures for what is wrong with a tour: visits that are too short or not deep enough, views at the same time,
/// legs too near to obstacles, ends that are not where they should be. `slack_m`: what rounding and curves may cost.
inline void judge(const TourRequest& request, const Tour& tour, const BoxAirspace* airspace, double slack_m = 1e-5) {
  const TourSettings& settings = request.settings;
  const std::vector<FlightPoint>& points = tour.flight.points;
  ASSERT_EQ(tour.visits.size() + tour.problems.size(), request.targets.size());
  ASSERT_EQ(tour.order.size(), tour.visits.size());
  if (tour.visits.empty()) return;
  check_flight_points(tour.flight);
  if (request.home) {
    EXPECT_LE((points.front().position - *request.home).norm(), slack_m);
  }
  if (settings.closed) {
    EXPECT_LE((points.front().position - points.back().position).norm(), 1e-6 + slack_m);
  }

  std::vector<bool> seen(request.targets.size(), false);
  for (const TourVisit& visit : tour.visits) {
    EXPECT_FALSE(seen[visit.target]) << "twice";
    seen[visit.target] = true;
    ASSERT_LE(visit.first_point, visit.last_point);
    ASSERT_LT(visit.last_point, points.size());
    // What of the hold belongs to others at the same point is theirs.
    Flight part;
    part.points.assign(points.begin() + static_cast<std::ptrdiff_t>(visit.first_point),
                       points.begin() + static_cast<std::ptrdiff_t>(visit.last_point) + 1);
    const std::vector<Moment> moments = fly(part, settings.vehicle.speed_m_s, 0.1);
    EXPECT_GE(moments.back().seconds, settings.dwell_s * (1 - 1e-6)) << request.targets[visit.target].name;
    for (const Moment& moment : moments) {
      ASSERT_GE(slow_depth(request.targets[visit.target].volume, moment.position), settings.margin_m - slack_m)
          << request.targets[visit.target].name;
    }
  }
  for (const TourProblem& problem : tour.problems) EXPECT_FALSE(seen[problem.target]);

  if (!settings.simultaneous && settings.vehicle.kind == TourVehicle::Kind::multirotor) {
    // Views one after the other: what is held at a point is enough for all who are viewed from it.
    std::vector<double> needed(points.size(), 0);
    for (std::size_t i = 0; i < tour.visits.size(); ++i) {
      const TourVisit& a = tour.visits[i];
      if (a.first_point == a.last_point) needed[a.first_point] += settings.dwell_s;
      for (std::size_t j = i + 1; j < tour.visits.size(); ++j) {
        const TourVisit& b = tour.visits[j];
        const double common = std::min(a.end_m, b.end_m) - std::max(a.begin_m, b.begin_m);
        EXPECT_LE(common, 1e-6);
        if (a.first_point < a.last_point && b.first_point == b.last_point && settings.dwell_s > 0) {
          EXPECT_FALSE(b.first_point > a.first_point && b.first_point < a.last_point)
              << "hovers while another is viewed";
        }
      }
    }
    for (std::size_t i = 0; i < points.size(); ++i) EXPECT_GE(points[i].hold_s, needed[i] - 1e-9);
  }
  if (!airspace) return;
  for (const Moment& moment : fly(tour.flight, settings.vehicle.speed_m_s, 0.1)) {
    for (const NamedBox& obstacle : airspace->obstacles()) {
      ASSERT_GE(distance_to(obstacle.box, moment.position), airspace->clearance() - slack_m) << obstacle.name;
    }
    EXPECT_LE(distance_to(airspace->bounds(), moment.position), slack_m);
  }
}

}  // namespace vantage::testing
