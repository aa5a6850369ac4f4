#include "flight_oracle.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "sensor_oracle.h"

namespace attack {
namespace {

std::vector<vantage::Target> parts_of(const vantage::PreparedTarget& prepared) {
  std::vector<vantage::Target> parts;
  for (std::size_t i = 0; i < prepared.part_count(); ++i) {
    vantage::Target part = prepared.target().part(i);
    if (part.front_by_order && !part.front && !part.is_point()) {
      const std::vector<Vec3>& corners = part.parts[0];
      Vec3 normal = Vec3::Zero();
      for (std::size_t k = 1; k + 1 < corners.size(); ++k) {
        normal += (corners[k] - corners[0]).cross(corners[k + 1] - corners[0]);
      }
      part.front = normal.normalized();
    }
    parts.push_back(part);
  }
  return parts;
}

/// Where the leg passes a plane through three points: from -infinity to infinity; NaN where it is parallel.
double share_in_plane(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& from, const Vec3& to) {
  const Vec3 normal = (b - a).cross(c - a);
  const double at_from = normal.dot(from - a), at_to = normal.dot(to - a);
  return at_from / (at_from - at_to);
}

/// All shares at which what the triangle hides may change, 0 and 1 among them; sorted.
std::vector<double> changes(const Corners& t, const std::vector<Vec3>& corners, const Vec3& from, const Vec3& to) {
  std::vector<double> shares{0, 1};
  const auto add = [&](const Vec3& a, const Vec3& b, const Vec3& c) {
    const double share = share_in_plane(a, b, c, from, to);
    if (share > 0 && share < 1) shares.push_back(share);
  };
  add(t[0], t[1], t[2]);
  const std::size_t n = corners.size();
  if (n >= 3) add(corners[0], corners[1], corners[2]);
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      add(corners[i], t[k], t[(k + 1) % 3]);
      if (n >= 3) add(corners[i], corners[(i + 1) % n], t[k]);
    }
  }
  std::sort(shares.begin(), shares.end());
  return shares;
}

double distance_between_segments(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const auto to_segment = [](const Vec3& p, const Vec3& u, const Vec3& v) {
    const double square = (v - u).squaredNorm();
    const double share = square > 0 ? std::clamp((p - u).dot(v - u) / square, 0.0, 1.0) : 0.0;
    return (p - u - share * (v - u)).norm();
  };
  double least = std::min({to_segment(a, c, d), to_segment(b, c, d), to_segment(c, a, b), to_segment(d, a, b)});
  const Vec3 u = b - a, v = d - c, w = c - a, n = u.cross(v);
  const double square = n.squaredNorm();
  if (square <= 1e-24 * u.squaredNorm() * v.squaredNorm()) return least;
  const double s = w.cross(v).dot(n) / square, t = w.cross(u).dot(n) / square;
  if (s > 0 && s < 1 && t > 0 && t < 1) least = std::min(least, std::abs(w.dot(n)) / std::sqrt(square));
  return least;
}

/// Whether a place within `aside` of the position may be hidden from a point: a triangle of the radius stands for it
/// (docs/theory.md, "A single point"), and all of the ball that holds this is asked for. At a share of the line of
/// sight something hides where it is as near as the ball's cone is wide there. Distances from a triangle are convex, so
/// this is one over a linear function, and has one minimum.
bool may_be_hidden_from_point(const Vec3& point, double radius, const Vec3& position, const Corners& triangle,
                              double aside) {
  const Vec3 along = position - point;
  const auto margin = [&](double share) {
    return (distance_to_triangle(point + share * along, triangle) - radius * (1 - share)) / share;
  };
  double low = 1e-9, high = 1;
  for (int i = 0; i < 120; ++i) {
    const double a = low + (high - low) / 3, b = high - (high - low) / 3;
    if (margin(a) < margin(b)) {
      high = b;
    } else {
      low = a;
    }
  }
  return std::min(margin(low), margin(1)) <= aside;
}

}  // namespace

double distance_from_leg(const vantage::Leg& leg, const Corners& t) {
  if (segment_crosses(leg.from, leg.to, t)) return 0;
  double least = std::min(distance_to_triangle(leg.from, t), distance_to_triangle(leg.to, t));
  for (std::size_t k = 0; k < 3; ++k) {
    least = std::min(least, distance_between_segments(leg.from, leg.to, t[k], t[(k + 1) % 3]));
  }
  return least;
}

OneTarget::OneTarget(const vantage::Scene& scene, const vantage::PreparedTarget& prepared)
    : sensor_(prepared.sensor()), blockers_(scene, parts_of(prepared)) {
  const double range = range_limit_m(sensor_);
  const std::vector<vantage::Target> parts = parts_of(prepared);
  for (std::size_t i = 0; i < parts.size(); ++i) {
    parts_.push_back(make_seen_target(parts[i], prepared.lift_m(i), blockers_.origin));
  }
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    const Vec3 centre = prepared.frame(i).origin - blockers_.origin;
    views_.emplace_back(blockers_, parts_[i], strip_width(blockers_, parts_[i], range), centre);
  }
  margins_ = std::make_unique<SensorMargins>(sensor_, parts_);
}

std::string OneTarget::surely_not_seen(const Vec3& position, double rounding_m) const {
  const Vec3 at = local(position);
  for (const Margin& margin : margins_->at(at)) {
    if (margin.high < -rounding_m) return margin.limit + " by " + std::to_string(-margin.high) + " m";
  }
  if (sensor_.link) {
    const auto entering = entering_zone(*sensor_.link, blockers_, parts_[0].corners[0], at);
    return entering ? "hidden by triangle " + std::to_string(*entering) : std::string();
  }
  for (const PartView& part : views_) {
    if (const auto hiding = part.surely_hiding(at)) return "hidden by triangle " + std::to_string(*hiding);
  }
  return {};
}

std::vector<Vec3> OneTarget::places_beside(const Vec3& at, double aside_m) const {
  std::vector<Vec3> places{at};
  for (int i = 0; i < 27 && aside_m > 0; ++i) {
    const Vec3 way(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1);
    if (!way.isZero(0)) places.push_back(at + aside_m * way.normalized());
  }
  return places;
}

bool OneTarget::surely_seen(const Vec3& position, double aside_m, double margin_m) const {
  const Vec3 at = local(position);
  for (const Margin& margin : margins_->at(at)) {
    if (!(margin.low > margin_m)) return false;
  }
  if (sensor_.link) {
    vantage::RadioLink wide = *sensor_.link;
    // More than twice too long a way; and that of the smallest part of a leg, which a short wave's zone is less than.
    const double excess = wide.clear * wide.clear * 0.299792458 / wide.frequency_ghz / 2;
    wide.clear *= std::sqrt(2.25 + margin_m / excess);
    for (const Vec3& place : places_beside(at, aside_m)) {
      if (entering_zone(wide, blockers_, parts_[0].corners[0], place)) return false;
    }
    return true;
  }
  for (const SeenTarget& part : parts_) {
    for (const double rise : {0.0, -aside_m, aside_m}) {
      const View larger(blockers_, moved_in(part, part.is_point() ? 0 : -aside_m, rise));
      for (const Vec3& place : places_beside(at, aside_m)) {
        if (!larger.clear(place)) return false;
      }
    }
    if (!part.is_point()) continue;
    const double radius = point_radius(range_limit_m(sensor_));
    for (const Blocker& blocker : blockers_.triangles) {
      if (may_be_hidden_from_point(part.corners[0], radius, at, blocker.corners, aside_m)) return false;
    }
  }
  return true;
}

bool OneTarget::surely_hidden_by(const Vec3& position, std::uint32_t object) const {
  const Vec3 at = local(position);
  for (const PartView& part : views_) {
    for (std::size_t i = 0; i < blockers_.triangles.size(); ++i) {
      if (blockers_.triangles[i].object == object && part.surely_hides(i, at)) return true;
    }
  }
  return false;
}

bool OneTarget::may_be_hidden_by(const Vec3& position, std::uint32_t object, double aside_m) const {
  const Vec3 at = local(position);
  for (const SeenTarget& part : parts_) {
    for (const double rise : {0.0, -aside_m, aside_m}) {
      const View larger(blockers_, moved_in(part, part.is_point() ? 0 : -aside_m, rise));
      for (const Vec3& place : places_beside(at, aside_m)) {
        for (std::size_t i = 0; i < blockers_.triangles.size(); ++i) {
          if (blockers_.triangles[i].object == object && larger.hides(i, place)) return true;
        }
      }
    }
    if (!part.is_point()) continue;
    const double radius = point_radius(range_limit_m(sensor_));
    for (const Blocker& blocker : blockers_.triangles) {
      const bool is_of_object = blocker.object == object;
      if (is_of_object && may_be_hidden_from_point(part.corners[0], radius, at, blocker.corners, aside_m)) return true;
    }
  }
  return false;
}

std::vector<HiddenPart> OneTarget::hidden_parts(const vantage::Leg& leg) const {
  constexpr double kMostTests = 4e5;
  double tests = 0;
  for (const SeenTarget& part : parts_) {
    tests += static_cast<double>(part.corners.size() * 6 + 4) * static_cast<double>(blockers_.triangles.size());
  }
  if (sensor_.link || tests > kMostTests) return {};
  const Vec3 from = local(leg.from), to = local(leg.to);
  std::vector<HiddenPart> hidden;
  for (const PartView& view : views_) {
    for (std::size_t i = 0; i < blockers_.triangles.size(); ++i) {
      const Blocker& blocker = blockers_.triangles[i];
      if (blocker.repeat) continue;  // preparing drops it: the first one is told
      const std::vector<double> shares = changes(blocker.corners, view.exact.target().corners, from, to);
      HiddenPart part{2, -1, blocker.object};
      for (std::size_t k = 0; k + 1 < shares.size(); ++k) {
        if (shares[k] == shares[k + 1]) continue;
        if (!hides(view, i, from + 0.5 * (shares[k] + shares[k + 1]) * (to - from))) continue;
        part.begin = std::min(part.begin, shares[k]);
        part.end = std::max(part.end, shares[k + 1]);
      }
      if (part.begin < part.end) hidden.push_back(part);
    }
  }
  return hidden;
}

double OneTarget::reach(const Vec3& position) const {
  double farthest = 0;
  for (const SeenTarget& part : parts_) {
    for (const Vec3& corner : part.corners) farthest = std::max(farthest, (local(position) - corner).norm());
  }
  return farthest;
}

FlightOracle::FlightOracle(const vantage::Mission& mission, const vantage::PreparedScene& scene) {
  for (const std::vector<vantage::PreparedTarget>& list : prepare_views(mission, scene)) {
    lists_.emplace_back();
    for (const vantage::PreparedTarget& target : list) {
      lists_.back().push_back(std::make_unique<OneTarget>(mission.scene(), target));
    }
  }
}

std::string FlightOracle::surely_not_seen(const Vec3& position, double rounding_m) const {
  for (const auto& list : lists_) {
    std::string reasons;
    for (const auto& target : list) {
      const std::string reason = target->surely_not_seen(position, rounding_m);
      if (reason.empty()) {
        reasons.clear();
        break;
      }
      reasons += (reasons.empty() ? "" : ", ") + reason;
    }
    if (!reasons.empty()) return reasons;
  }
  return {};
}

bool FlightOracle::surely_seen(const Vec3& position, double aside_m, double margin_m) const {
  return std::all_of(lists_.begin(), lists_.end(), [&](const auto& list) {
    return std::any_of(list.begin(), list.end(),
                       [&](const auto& target) { return target->surely_seen(position, aside_m, margin_m); });
  });
}

const OneTarget* FlightOracle::single() const {
  return lists_.size() == 1 && lists_[0].size() == 1 ? lists_[0][0].get() : nullptr;
}

}  // namespace attack
