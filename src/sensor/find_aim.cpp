#include "sensor/find_aim.h"

#include <algorithm>
#include <deque>
#include <numbers>
#include <vector>

#include "core/portable_math.h"

namespace vantage::internal::sensor {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;

/// Yaws that are still allowed: intervals in [0, 4 pi), each shorter than a turn or exactly one.
class Yaws {
 public:
  Yaws() : parts_{{0, kTurn}} {}

  bool empty() const { return parts_.empty(); }
  double middle_of_widest() const {
    const auto widest = std::max_element(
        parts_.begin(), parts_.end(), [](const Part& a, const Part& b) { return a.end - a.begin < b.end - b.begin; });
    return (widest->begin + widest->end) / 2;
  }

  /// Keeps what is within `half` of `centre`, both in radians.
  void keep(double centre, double half) {
    if (half >= std::numbers::pi) return;
    double begin = std::fmod(centre - half, kTurn);
    if (begin < 0) begin += kTurn;
    const double end = begin + 2 * half;
    kept_.clear();
    for (const Part& part : parts_) {
      for (const double turn : {-kTurn, 0.0, kTurn}) {
        const Part both{std::max(part.begin, begin + turn), std::min(part.end, end + turn)};
        if (both.begin <= both.end) kept_.push_back(both);
      }
    }
    parts_.swap(kept_);
  }
  void clear() { parts_.clear(); }

 private:
  struct Part {
    double begin, end;
  };
  std::vector<Part> parts_, kept_;
};

class Search {
 public:
  Search(const Pinhole& camera, const Mount& mount, std::span<const Vec3> corners, const AimRoom& room)
      : camera_(camera), yaw_(mount.yaw_deg), roll_(mount.roll_deg * std::numbers::pi / 180) {
    for (const Vec3& corner : corners) {
      const double distance = corner.norm();
      // A corner in the camera itself is not so far inside of any plane.
      if (!(distance > 0) && room.inside_m > 0) is_possible_ = false;
      if (!(distance > 0)) continue;
      directions_.push_back(corner / distance);
      rooms_.push_back(room.inside_m / distance - room.outside);
    }
  }

  /// A yaw with which this pitch does, where each direction may lie outside of each edge by `allowance` times the
  /// length of its normal.
  std::optional<double> yaw_for(double pitch, double allowance) const {
    const PictureEdges edges = picture_edges(camera_, {0, pitch}, roll_);
    Yaws yaws;
    for (const Vec3& edge : edges) {
      const double across = edge.head<2>().norm();
      // Turning the camera by a yaw y turns an edge's normal clockwise: its product with x is
      // sum of (e.x x.x + e.y x.y) cos y + (e.y x.x - e.x x.y) sin y + e.z x.z.
      for (std::size_t i = 0; i < directions_.size(); ++i) {
        const Vec3& x = directions_[i];
        const double along = edge.x() * x.x() + edge.y() * x.y(), beside = edge.y() * x.x() - edge.x() * x.y();
        const double rest = edge.z() * x.z() + (allowance - rooms_[i]) * edge.norm();
        const double reach = across * x.head<2>().norm();
        if (rest >= reach) continue;
        if (rest < -reach) return std::nullopt;
        yaws.keep(portable::atan2(beside, along), portable::acos(-rest / reach));
        if (yaws.empty()) return std::nullopt;
      }
    }
    if (!yaw_) return yaws.middle_of_widest();
    const double wanted = *yaw_ * std::numbers::pi / 180;
    yaws.keep(wanted, 0);
    if (yaws.empty()) return std::nullopt;
    return wanted;
  }

  /// By halving, the widest first: a normal turns by no more than the pitch does.
  FoundAim find(double min_pitch, double max_pitch, double slack, int most_pitches) const {
    if (!is_possible_) return {};
    std::deque<std::pair<double, double>> open{{min_pitch, max_pitch}};
    for (int pitches = 0; !open.empty(); ++pitches) {
      if (pitches == most_pitches) return {std::nullopt, true};
      const auto [low, high] = open.front();
      open.pop_front();
      const double pitch = (low + high) / 2, half = (high - low) / 2;
      if (const auto yaw = yaw_for(pitch, 0)) return {Aim{*yaw, pitch}, false};
      if (half <= slack || !yaw_for(pitch, half)) continue;
      open.emplace_back(low, pitch);
      open.emplace_back(pitch, high);
    }
    // Where it is the mount that leaves no room, one of its ends may be all that does.
    for (const double end : {min_pitch, max_pitch}) {
      if (const auto yaw = yaw_for(end, 0)) return {Aim{*yaw, end}, false};
    }
    return {};
  }

 private:
  const Pinhole camera_;
  const std::optional<double> yaw_;
  const Angle roll_;
  std::vector<Vec3> directions_;
  std::vector<double> rooms_;  // sines
  bool is_possible_ = true;
};

}  // namespace

FoundAim find_aim(const Pinhole& camera, const Mount& mount, std::span<const Vec3> corners, double slack,
                  const AimRoom& room, int most_pitches) {
  constexpr double kRadians = std::numbers::pi / 180;
  // No rounding beyond straight down and up.
  const double low = std::max(mount.min_pitch_deg * kRadians, -std::numbers::pi / 2),
               high = std::min(mount.max_pitch_deg * kRadians, std::numbers::pi / 2);
  return Search(camera, mount, corners, room).find(low, high, slack, most_pitches);
}

}  // namespace vantage::internal::sensor
