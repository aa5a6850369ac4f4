#include "flight/gimbal.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace vantage::internal::flight {
namespace {

constexpr double kDegreesPerRadian = 180 / std::numbers::pi;

}  // namespace

Aim aim_at(const Vec3& from, const Vec3& to) {
  const Vec3 d = to - from;
  const double level = d.head<2>().norm();
  const double yaw = level > 0 ? std::atan2(d.x(), d.y()) * kDegreesPerRadian : 0;
  return {yaw < 0 ? yaw + 360 : yaw, d.isZero(0) ? 0 : std::atan2(d.z(), level) * kDegreesPerRadian};
}

PitchRange pitch_range(const Leg& piece, const Vec3& to) {
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
  return range;
}

double fastest_turn_deg_s(const Leg& piece, const Vec3& to, double speed_m_s) {
  const Vec3 e = piece.to - piece.from, d = to - piece.from;
  const double length = e.norm();
  if (!(length > 0)) return 0;
  // speed * |e x d| / (|e| |d - t e|^2) is largest where the piece is nearest.
  const double t = std::clamp(d.dot(e) / (length * length), 0.0, 1.0);
  const double nearest2 = (d - t * e).squaredNorm();
  if (nearest2 == 0) return std::numeric_limits<double>::infinity();
  return speed_m_s * e.cross(d).norm() / (length * nearest2) * kDegreesPerRadian;
}

double fastest_turn_near_deg_s(const Leg& piece, const Vec3& to, double speed_m_s, double reach_m) {
  const Vec3 e = piece.to - piece.from, d = to - piece.from;
  const double length = e.norm();
  if (!(length > 0)) return 0;
  const double t = std::clamp(d.dot(e) / (length * length), 0.0, 1.0);
  const double nearest = (d - t * e).norm() - reach_m, aside = e.cross(d).norm() / length + reach_m;
  if (!(nearest > 0)) return std::numeric_limits<double>::infinity();
  return speed_m_s * aside / (nearest * nearest) * kDegreesPerRadian;
}

std::vector<LegInterval> slow_turns(const Leg& piece, const Vec3& to, double speed_m_s, double rate_deg_s) {
  const Vec3 e = piece.to - piece.from, d = to - piece.from;
  const double length = e.norm();
  if (!(length > 0)) return {{0, 1}};
  // At `s` metres from the foot of the point on the line, whose distance is h, the rate is speed h / (h^2 + s^2).
  const double foot = d.dot(e) / length, h = e.cross(d).norm() / length;
  const double squared = speed_m_s * h / (rate_deg_s / kDegreesPerRadian) - h * h;
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
