// Legs and the picture of a camera: can it take in all of the target from there?
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "query/leg_convex.h"
#include "query/leg_halving.h"
#include "query/leg_limit.h"
#include "sensor/aim.h"
#include "sensor/find_aim.h"

namespace vantage::internal::query {
namespace {

constexpr double kRadian = std::numbers::pi / 180;

/// One mount along one leg. Positions are about the target's origin.
class AimLook {
 public:
  AimLook(const Pinhole& camera, const Mount& mount, const std::vector<Vec3>& corners, const Tube& local)
      : camera_(camera), mount_(mount), corners_(corners), local_(local) {}

  LegIntervals broken(const LegIntervals& within) {
    if (mount_.is_fixed()) return common(within, fixed());
    parts_.clear();
    halve(within, [&](const LegInterval& piece, bool is_last) { return look(piece, is_last); });
    return joined(std::move(parts_));
  }

  /// The angle by which a corner is out of the picture at least, degrees.
  double out_of_picture(double share) {
    double low = 0, high = 1;
    constexpr double kFine = 1e-4;  // radians
    if (has_aim(local_.at(share), {}, kFine)) return 0;
    for (int i = 0; i < 16; ++i) {
      const double middle = 0.5 * (low + high);
      (has_aim(local_.at(share), {.outside = middle}, kFine) ? high : low) = middle;
    }
    return std::asin(high) / kRadian;
  }

 private:
  static constexpr int kMostCubes = 8'000;
  /// Of the tube's radius: pieces of the leg and cubes of the tube are no smaller. So much less than all of
  /// sqrt(3) + 1/2 of it may count as out of the picture though it is within.
  static constexpr double kFinest = 1.0 / 32;

  sensor::FoundAim aim(const Vec3& place, const sensor::AimRoom& room, double slack) {
    constexpr int kMostPitches = 400;
    seen_.clear();
    for (const Vec3& corner : corners_) seen_.push_back(corner - place);
    return sensor::find_aim(camera_, mount_, seen_, slack, room, kMostPitches);
  }
  bool has_aim(const Vec3& place, const sensor::AimRoom& room, double slack) {
    return aim(place, room, slack).aim.has_value();
  }
  /// What is not decided in time counts as out of the picture, but not of long pieces.
  bool has_no_aim(const Vec3& place, const sensor::AimRoom& room, double slack, bool is_long) {
    const sensor::FoundAim found = aim(place, room, slack);
    return !found.aim && !(found.is_open && is_long);
  }

  /// The angle that so many metres subtend at the farthest corner, at most.
  double angle_of(const Vec3& place, double metres) const {
    double farthest = 0;
    for (const Vec3& corner : corners_) farthest = std::max(farthest, (corner - place).norm());
    return std::clamp(metres / std::max(farthest, metres), 1e-9, 0.05);
  }

  /// All corners inside of four planes: linear.
  LegIntervals fixed() const {
    const sensor::PictureEdges edges = sensor::picture_edges(
        camera_, {*mount_.yaw_deg * kRadian, mount_.min_pitch_deg * kRadian}, sensor::Angle(mount_.roll_deg * kRadian));
    LegIntervals parts;
    for (const Vec3& edge : edges) {
      const Vec3 normal = edge.normalized();
      for (const Vec3& corner : corners_) {
        for (const LegInterval& part : where_positive(local_.radius - normal.dot(corner - local_.leg.from),
                                                      local_.radius - normal.dot(corner - local_.leg.to))) {
          parts.push_back(part);
        }
      }
    }
    return joined(std::move(parts));
  }

  // From places r away an orientation has each corner inside of the picture's planes by no more than r less, or r more.
  /// Whether the piece is to be halved.
  bool look(const LegInterval& piece, bool is_last) {
    const double shortest = std::min(1e-3, 1e-5 * local_.length());  // metres
    local_.progress.check();
    const double middle = 0.5 * (piece.begin + piece.end), half = 0.5 * (piece.end - piece.begin) * local_.length();
    const double radius = local_.radius;
    const Vec3 place = local_.at(middle);
    // The search for an orientation ends where it is close by a fiftieth of r. An answer that comes too early is on the
    // safe side, or is made up for by looking r / 20 farther.
    const double slack = angle_of(place, 0.02 * half);
    if (has_aim(place, {.inside_m = half + radius}, slack)) return false;
    const bool is_short = 2 * half <= std::max(shortest, kFinest * radius);
    const bool is_long = piece.end - piece.begin > 1.0 / 64;
    const bool is_out = is_last || has_no_aim(place, {.inside_m = -1.05 * half}, slack, is_long) ||
                        (is_short && !all_near(place, Vec3::Zero(), radius, half));
    if (is_out) parts_.push_back(piece);
    return !is_out && !is_short;
  }

  /// Whether each place of the ball about the middle of this cube, `half` more, has its orientation. The cube's centre
  /// is `aside` from the ball's. After so many cubes of all pieces: no.
  bool all_near(const Vec3& place, const Vec3& aside, double side, double half) {
    const double corner = std::sqrt(3.0) * side, distance = aside.norm();
    if (distance - corner > local_.radius) return true;  // beside the ball
    if (++cubes_ > kMostCubes) return false;
    local_.progress.check();
    // What of the ball is near the cube's centre is as near to the place of the ball next to that.
    const Vec3 next = place + (distance > local_.radius ? local_.radius / distance : 1.0) * aside;
    const double inside = corner + half;
    if (has_aim(next, {.inside_m = inside}, angle_of(next, 0.02 * inside))) return true;
    if (!(side > kFinest * local_.radius)) return false;
    for (int child = 0; child < 8; ++child) {
      const Vec3 to(child & 1 ? 1 : -1, child & 2 ? 1 : -1, child & 4 ? 1 : -1);
      if (!all_near(place, aside + 0.5 * side * to, 0.5 * side, half)) return false;
    }
    return true;
  }

  Pinhole camera_;
  Mount mount_;
  const std::vector<Vec3>& corners_;
  Tube local_;
  std::vector<Vec3> seen_;
  LegIntervals parts_;
  int cubes_ = 0;
};

class FrameOfLeg : public LegLimit {
 public:
  FrameOfLeg(const Pinhole& camera, std::shared_ptr<const sensor::SensorView> view)
      : camera_(camera), view_(std::move(view)) {}

  void add_breaks(const Tube& tube, std::vector<LegBreak>& breaks) const override {
    const Tube local = tube.moved(-view_->target.origin);
    const std::vector<Vec3>& corners = view_->target.corners;
    const Mount& mount = view_->sensor.mount;
    const Mount free{.yaw_deg = {}, .roll_deg = mount.roll_deg};
    AimLook look(camera_, mount, corners, local), free_look(camera_, free, corners, local);
    const LegIntervals broken = look.broken({{0, 1}});
    if (broken.empty()) return;
    const LegIntervals frame = free_look.broken(broken);
    const auto amount = [&](double share) {
      double nearest = INFINITY;
      for (const Vec3& corner : corners) nearest = std::min(nearest, (corner - local.at(share)).norm());
      const double turn = nearest > tube.radius ? std::asin(tube.radius / nearest) / kRadian : 90.0;
      return look.out_of_picture(share) + turn;
    };
    add_break(breaks, "frame", LegBreak::Unit::degrees, frame, amount);
    add_break(breaks, "gimbal", LegBreak::Unit::degrees, without(broken, frame), amount);
  }

 private:
  Pinhole camera_;
  std::shared_ptr<const sensor::SensorView> view_;
};

}  // namespace

template <>
std::unique_ptr<const LegLimit> leg_limit<Limit::frame>(const Pinhole& camera,
                                                        const std::shared_ptr<const sensor::SensorView>& view) {
  return std::make_unique<FrameOfLeg>(camera, view);
}

}  // namespace vantage::internal::query
