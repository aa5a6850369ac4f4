#include "flight/gimbal.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace vantage::internal::flight {
namespace {

constexpr double kDegreesPerRadian = 180 / std::numbers::pi;

double distance_m(const Leg& piece, const Vec3& to) {
  const Vec3 along = piece.to - piece.from;
  const double squared = along.squaredNorm();
  const double share = squared > 0 ? std::clamp((to - piece.from).dot(along) / squared, 0.0, 1.0) : 0;
  return (piece.from + share * along - to).norm();
}

}  // namespace

Aim aim_at(const Vec3& from, const Vec3& to) {
  const Vec3 d = to - from;
  const double level = d.head<2>().norm();
  const double yaw = level > 0 ? std::atan2(d.x(), d.y()) * kDegreesPerRadian : 0;
  return {yaw < 0 ? yaw + 360 : yaw, d.isZero(0) ? 0 : std::atan2(d.z(), level) * kDegreesPerRadian};
}

PitchRange pitch_range(const Leg& piece, const Vec3& to, double radius_m) {
  PitchRange range;
  range.min_deg = std::min(aim_at(piece.from, to).pitch_deg, aim_at(piece.to, to).pitch_deg);
  range.max_deg = std::max(aim_at(piece.from, to).pitch_deg, aim_at(piece.to, to).pitch_deg);
  // d(t) = d - t e. dz / |dxy| has its one stationary point where dz' |dxy|^2 = dz (dxy . dxy'): the squares of t
  // cancel.
  const Vec3 d = to - piece.from, e = piece.to - piece.from;
  const double ee = e.head<2>().squaredNorm(), de = d.head<2>().dot(e.head<2>()), dd = d.head<2>().squaredNorm();
  const double slope = e.z() * de - d.z() * ee;
  const auto include = [&](double t) {
    if (!(t > 0 && t < 1)) return;
    const double pitch = aim_at(piece.from + t * e, to).pitch_deg;
    range.min_deg = std::min(range.min_deg, pitch);
    range.max_deg = std::max(range.max_deg, pitch);
  };
  if (slope != 0) include((e.z() * dd - d.z() * de) / slope);
  if (ee > 0) include(de / ee);  // nearest in plan: where it passes straight over the point, the pitch jumps
  if (radius_m > 0) {
    const double distance = distance_m(piece, to);
    const double wider = distance > radius_m ? std::asin(radius_m / distance) * kDegreesPerRadian : 180;
    range = {std::max(-90.0, range.min_deg - wider), std::min(90.0, range.max_deg + wider)};
  }
  return range;
}

// The circle through both ends of a chord c with sagitta s turns from it by an angle whose half has the tangent 2 s /
// c.
Deviation off_chord(const Leg& piece, double reach_m, double chord_error_m) {
  if (!(chord_error_m > 0)) return {reach_m, 0};
  const double length = (piece.to - piece.from).norm(), tangent = 2 * chord_error_m / length;
  return {reach_m, length > 0 ? 2 * tangent / std::hypot(1.0, tangent) : 2};
}

// Seen from d, a vehicle in the direction e turns by speed |e x d| / |d|^2. With d off by r and e off by a that is at
// most speed (h + r + a |d|) / |d|^2, h the distance of the whole line; it falls with |d|.
double fastest_turn_deg_s(const Leg& piece, const Vec3& to, double speed_m_s, const Deviation& off) {
  const Vec3 e = piece.to - piece.from, d = to - piece.from;
  const double length = e.norm();
  if (!(length > 0)) return 0;
  const double t = std::clamp(d.dot(e) / (length * length), 0.0, 1.0);
  const double nearest = (d - t * e).norm() - off.reach_m;
  if (!(nearest > 0)) return std::numeric_limits<double>::infinity();
  const double h = e.cross(d).norm() / length;
  return speed_m_s * (h + off.reach_m + off.aside * nearest) / (nearest * nearest) * kDegreesPerRadian;
}

std::vector<LegInterval> slow_turns(const Leg& piece, const Vec3& to, double speed_m_s, double rate_deg_s,
                                    const Deviation& off) {
  const Vec3 e = piece.to - piece.from, d = to - piece.from;
  const double length = e.norm();
  if (!(length > 0)) return {{0, 1}};
  // At `s` metres from the foot of the point on the line, whose distance is h, the vehicle is sqrt(h^2 + s^2) - r away.
  // It must be so far that rate |d|^2 >= speed (h + r + a |d|).
  const double foot = d.dot(e) / length, h = e.cross(d).norm() / length;
  const double turns = speed_m_s / (rate_deg_s / kDegreesPerRadian), b = 0.5 * turns * off.aside;
  const double least = off.reach_m + b + std::sqrt(b * b + turns * (h + off.reach_m));
  const double squared = (least - h) * (least + h);
  if (squared < 0 && h > 0) return {{0, 1}};
  constexpr double kRounding = 1e-9;  // of all lengths that play a part; through the point itself the turn is a jump
  const double half = std::sqrt(std::max(0.0, squared)) * (1 + kRounding) + kRounding * (length + d.norm());
  std::vector<LegInterval> slow;
  const double begin = (foot - half) / length, end = (foot + half) / length;
  if (begin >= 0) slow.push_back({0, std::min(begin, 1.0)});
  if (end <= 1 && begin < 1) slow.push_back({std::max(end, 0.0), 1});
  return slow;
}

}  // namespace vantage::internal::flight
