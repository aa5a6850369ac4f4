// With one orientation what is allowed is convex, an intersection of cones at the target's corners, and vertices
// decide. With several, one of them that serves the three corners of a facet serves all of it. And what is allowed goes
// on away from the target: if c is outside, the way from a forbidden position to c leaves the volume through a
// forbidden point of a facet, which may face either way where the mesh winds round backwards. So one orientation for
// each facet, or for each part of it, is a proof.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "prove/limit_proof.h"
#include "prove/lowest_point.h"
#include "prove/orientation.h"
#include "prove/triangle_distance.h"

namespace vantage::internal::prove {
namespace {

constexpr double kDegrees = std::numbers::pi / 180;

/// Radians, as Mount has them.
struct CameraAim {
  double yaw = 0, pitch = 0;
};

class Picture {
 public:
  Picture(const Pinhole& camera, const Mount& mount, const std::vector<View>& parts, const Vec3& origin)
      : mount_(mount), roll_(mount.roll_deg * kDegrees) {
    across_ = 1 / std::hypot(1, camera.half_width);
    upright_ = 1 / std::hypot(1, camera.half_height);
    half_width_ = camera.half_width;
    half_height_ = camera.half_height;
    for (const View& part : parts) {
      for (const Vec3& corner : part.whole) corners_.push_back(part.origin - origin + corner);
    }
    for (const Vec3& corner : corners_) middle_ += corner / static_cast<double>(corners_.size());
  }

  const Vec3& middle() const { return middle_; }

  /// Ahead, to the right and down in the picture.
  std::array<Vec3, 3> axes(const CameraAim& aim) const {
    const Vec3 ahead(std::cos(aim.pitch) * std::sin(aim.yaw), std::cos(aim.pitch) * std::cos(aim.yaw),
                     std::sin(aim.pitch));
    const Vec3 level(std::cos(aim.yaw), -std::sin(aim.yaw), 0), below = ahead.cross(level);
    // A positive roll lowers the right edge.
    return {ahead, std::cos(roll_) * level + std::sin(roll_) * below,
            std::cos(roll_) * below - std::sin(roll_) * level};
  }

  /// The edges of the picture, left, right, top and bottom: unit normals of the planes through the camera, inward.
  std::array<Vec3, 4> edges(const CameraAim& aim) const {
    const auto [ahead, right, down] = axes(aim);
    return {across_ * (half_width_ * ahead + right), across_ * (half_width_ * ahead - right),
            upright_ * (half_height_ * ahead + down), upright_ * (half_height_ * ahead - down)};
  }

  /// Metres by which some corner of the target is out of the picture, from some of the positions; negative: in it.
  /// NaN where it cannot be computed, which no comparison takes for in it.
  template <typename Positions>
  double out_by(const CameraAim& aim, const Positions& positions) const {
    double most = -std::numeric_limits<double>::infinity();
    for (const Vec3& edge : edges(aim)) {
      double nearest = std::numeric_limits<double>::infinity(), farthest = -nearest;
      for (const Vec3& corner : corners_) nearest = std::min(nearest, edge.dot(corner));
      for (const Vec3& position : positions) farthest = std::max(farthest, edge.dot(position));
      const double out = farthest - nearest;
      if (!std::isfinite(out)) return std::numeric_limits<double>::quiet_NaN();  // std::max passes over NaN
      most = std::max(most, out);
    }
    return most;
  }

  /// Towards the target.
  CameraAim towards(const LimitedVolume::Corners& positions) const {
    const Vec3 way = middle_ - (positions[0] + positions[1] + positions[2]) / 3;
    return {mount_.yaw_deg ? *mount_.yaw_deg * kDegrees : std::atan2(way.x(), way.y()),
            clamped(std::atan2(way.z(), way.head<2>().norm()))};
  }

  /// Orientations of a grid over all that the mount allows, with no better neighbour there: the best ones, best first.
  std::vector<CameraAim> local_minima(const LimitedVolume::Corners& positions) const {
    constexpr int kYaws = 180, kMost = 12;
    constexpr double kPitchStep = 2 * kDegrees;
    constexpr double kDeepest = 0.1;  // radians: where more is out, none next to it lets all in
    const double low = clamped(-std::numbers::pi / 2), high = clamped(std::numbers::pi / 2);
    const int yaws = mount_.yaw_deg ? 1 : kYaws, pitches = 2 + static_cast<int>((high - low) / kPitchStep);
    const auto aim_at = [&](int yaw, int pitch) {
      const double turned = mount_.yaw_deg ? *mount_.yaw_deg * kDegrees : yaw * 2 * std::numbers::pi / kYaws;
      return CameraAim{turned, low + (high - low) * pitch / (pitches - 1)};
    };
    std::vector<double> outs;
    for (int yaw = 0; yaw < yaws; ++yaw) {
      for (int pitch = 0; pitch < pitches; ++pitch) outs.push_back(out_by(aim_at(yaw, pitch), positions));
    }
    const auto out_at = [&](int yaw, int pitch) {
      const auto row = static_cast<std::size_t>((yaw + yaws) % yaws);
      return outs[row * static_cast<std::size_t>(pitches) +
                  static_cast<std::size_t>(std::clamp(pitch, 0, pitches - 1))];
    };
    std::vector<std::pair<double, CameraAim>> found;
    for (int yaw = 0; yaw < yaws; ++yaw) {
      for (int pitch = 0; pitch < pitches; ++pitch) {
        double least = out_at(yaw, pitch);
        for (int i = 0; i < 9; ++i) least = std::min(least, out_at(yaw + i / 3 - 1, pitch + i % 3 - 1));
        if (out_at(yaw, pitch) <= least) found.emplace_back(least, aim_at(yaw, pitch));
      }
    }
    std::sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    std::vector<CameraAim> aims;
    for (const auto& minimum : found) {
      if (aims.size() < kMost && minimum.first < kDeepest * distance_from(positions[0])) aims.push_back(minimum.second);
    }
    return aims;
  }

  /// Turns the camera so that what it must see is in the middle of its picture, as far as the mount lets it.
  template <typename Positions>
  CameraAim centred(CameraAim aim, const Positions& positions) const {
    constexpr int kTurns = 4;
    for (int turn = 0; turn < kTurns; ++turn) {
      const auto [ahead, right, down] = axes(aim);
      Eigen::Array2d low = Eigen::Array2d::Constant(std::numeric_limits<double>::infinity()), high = -low;
      for (const Vec3& position : positions) {
        for (const Vec3& corner : corners_) {
          const Vec3 sight = corner - position;
          const double depth = ahead.dot(sight);
          if (!(depth > 0)) return aim;
          const Eigen::Array2d at(right.dot(sight) / depth, down.dot(sight) / depth);
          low = low.min(at);
          high = high.max(at);
        }
      }
      const Eigen::Array2d middle = (low + high) / 2;
      const Vec3 next = ahead + middle.x() * right + middle.y() * down;
      if (!mount_.yaw_deg) {
        // The nearest of the turns, so that aims of neighbours can be compared.
        aim.yaw += std::remainder(std::atan2(next.x(), next.y()) - aim.yaw, 2 * std::numbers::pi);
      }
      aim.pitch = clamped(std::atan2(next.z(), next.head<2>().norm()));
    }
    return aim;
  }

  /// Turns the camera until nothing is out by more than what is allowed, or as far as that gets better: to where the
  /// most is least that any corner is out by, were it linear, again and again (Madsen 1975). Whether it is allowed
  /// then.
  template <typename Positions>
  bool improve(CameraAim& aim, const Positions& positions, double allowed) const {
    constexpr int kMostTurns = 40;
    constexpr double kFirst = 0.3, kFarthest = 0.5, kLast = 1e-9;  // radians
    constexpr double kLeastGain = 1e-9;                            // of the distance
    const CameraAim middle = centred(aim, positions);
    if (out_by(middle, positions) < out_by(aim, positions)) aim = middle;
    double out = out_by(aim, positions), reach = kFirst;
    for (int i = 0; i < kMostTurns && out > allowed && reach > kLast; ++i) {
      const std::vector<Plane2> planes = outs_about(aim, positions);
      const double yaw = mount_.yaw_deg ? 0 : reach;
      const Eigen::Vector2d turn = lowest_point(planes, {-yaw, clamped(aim.pitch - reach) - aim.pitch},
                                                {yaw, clamped(aim.pitch + reach) - aim.pitch});
      const double hoped = highest(planes, turn);
      if (!(out - hoped > kLeastGain * distance_from(positions[0]))) break;
      const CameraAim next{aim.yaw + turn.x(), clamped(aim.pitch + turn.y())};
      const double out_of_next = out_by(next, positions), gain = (out - out_of_next) / (out - hoped);
      if (gain > 0) {
        aim = next;
        out = out_of_next;
      }
      const double turned = turn.cwiseAbs().maxCoeff();
      if (gain < 0.25) reach = turned / 4;
      if (gain > 0.75) reach = std::clamp(2 * turned, reach, kFarthest);
    }
    return out <= allowed;
  }

  /// Whether an orientation that changes linearly, from that of one corner of a facet to that of the next, serves all
  /// of it. Of the planes through an edge of the picture the normals would change linearly but for half of the square
  /// of the turn; then what is out is a polynomial of the second degree, and is no more than the most of its six
  /// coefficients in Bernstein's form.
  bool serve(const std::array<CameraAim, 3>& aims, const LimitedVolume::Corners& facet, double allowed) const {
    double turn = 0, farthest = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const CameraAim &a = aims[i], &b = aims[(i + 1) % 3];
      turn = std::max(turn, std::abs(a.yaw - b.yaw) + std::abs(a.pitch - b.pitch));
      farthest = std::max(farthest, distance_from(facet[i]));
    }
    const double most = allowed - turn * turn / 2 * farthest;
    const std::array<std::array<Vec3, 4>, 3> edges_of = {edges(aims[0]), edges(aims[1]), edges(aims[2])};
    for (std::size_t e = 0; e < 4; ++e) {
      for (const Vec3& corner : corners_) {
        for (std::size_t i = 0; i < 3; ++i) {
          for (std::size_t j = i; j < 3; ++j) {
            const double out = edges_of[i][e].dot(facet[j] - corner) + edges_of[j][e].dot(facet[i] - corner);
            if (!(out / 2 <= most)) return false;
          }
        }
      }
    }
    return true;
  }

 private:
  /// Metres by which each corner is out of each edge of the picture, from each position, as the camera turns by yaw and
  /// pitch.
  template <typename Positions>
  std::vector<Plane2> outs_about(const CameraAim& aim, const Positions& positions) const {
    std::vector<Plane2> planes;
    const Vec3 level(std::cos(aim.yaw), -std::sin(aim.yaw), 0);
    for (const Vec3& edge : edges(aim)) {
      const Vec3 by_yaw(edge.y(), -edge.x(), 0), by_pitch = level.cross(edge);
      for (const Vec3& position : positions) {
        for (const Vec3& corner : corners_) {
          const Vec3 sight = position - corner;
          planes.push_back({edge.dot(sight), {by_yaw.dot(sight), by_pitch.dot(sight)}});
        }
      }
    }
    return planes;
  }

  /// To the farthest corner.
  double distance_from(const Vec3& position) const {
    double farthest = 0;
    for (const Vec3& corner : corners_) farthest = std::max(farthest, (corner - position).norm());
    return farthest;
  }

  double clamped(double pitch) const {
    return std::clamp(pitch, mount_.min_pitch_deg * kDegrees, mount_.max_pitch_deg * kDegrees);
  }

  Mount mount_;
  double roll_, across_, upright_, half_width_, half_height_;
  std::vector<Vec3> corners_;
  Vec3 middle_ = Vec3::Zero();
};

/// Looks for orientations that serve a facet, in parts where it must.
class FacetServer {
 public:
  FacetServer(const Picture& picture, double allowed) : picture_(picture), allowed_(allowed) {}

  bool serves(const LimitedVolume::Corners& facet) {
    left_ = kMostCuts;
    if (serves_in_parts(facet, {picture_.towards(facet)})) return true;
    left_ = kMostCuts;
    return serves_in_parts(facet, picture_.local_minima(facet));
  }

 private:
  /// `aims`: of what this is a part of.
  bool serves_in_parts(const LimitedVolume::Corners& facet, std::vector<CameraAim> aims) {
    std::array<bool, 3> is_served{};
    Served served = serves_next_to(aims, facet, is_served);
    if (served == Served::nothing) {
      aims = picture_.local_minima(facet);
      served = serves_next_to(aims, facet, is_served);
    }
    if (served == Served::all) return true;
    for (std::size_t i = 0; i < 3; ++i) {
      if (!is_served[i] && !serves_corner(facet[i])) return false;
    }
    if (left_ == 0) return false;
    --left_;
    LimitedVolume::Corners between;
    for (std::size_t i = 0; i < 3; ++i) between[i] = (facet[i] + facet[(i + 1) % 3]) / 2;
    for (std::size_t i = 0; i < 3; ++i) {
      if (!serves_in_parts({facet[i], between[i], between[(i + 2) % 3]}, aims)) return false;
    }
    return serves_in_parts(between, aims);
  }

  enum class Served { nothing, corners, all };

  /// Whether an orientation next to one of these serves all of a facet, or those for its corners do, which are alike as
  /// they come from the same one. `aims` become those next to them, `is_served` true where one serves a corner.
  Served serves_next_to(std::vector<CameraAim>& aims, const LimitedVolume::Corners& facet,
                        std::array<bool, 3>& is_served) const {
    Served most = Served::nothing;
    for (CameraAim& aim : aims) {
      std::array<CameraAim, 3> aims_of_corners = {aim, aim, aim};
      if (picture_.improve(aim, facet, allowed_)) return Served::all;
      int corners = 0;
      for (std::size_t i = 0; i < 3; ++i) {
        if (!serves_corner(facet[i], aims_of_corners[i])) continue;
        is_served[i] = true;
        ++corners;
      }
      if (corners < 3) continue;
      if (picture_.serve(aims_of_corners, facet, allowed_)) return Served::all;
      most = Served::corners;
    }
    return most;
  }

  /// Whether the best orientation next to this one does; then `aim` is that.
  bool serves_corner(const Vec3& corner, CameraAim& aim) const {
    const std::array<Vec3, 1> only = {corner};
    picture_.improve(aim, only, -std::numeric_limits<double>::infinity());
    return picture_.out_by(aim, only) <= allowed_;
  }

  bool serves_corner(const Vec3& corner) const {
    for (CameraAim aim : picture_.local_minima({corner, corner, corner})) {
      if (picture_.improve(aim, std::array<Vec3, 1>{corner}, allowed_)) return true;
    }
    return false;
  }

  static constexpr int kMostCuts = 100;  // of a facet and its parts
  const Picture& picture_;
  double allowed_;
  int left_ = kMostCuts;
};

}  // namespace

template <>
ClaimProof prove_limit<Limit::frame>(const Pinhole& camera, const Claimant& of,
                                     const core::ProgressReporter& progress) {
  const LimitedVolume& volume = of.volume;
  const Mount& mount = of.sensor.mount;
  const Picture picture(camera, mount, of.parts, volume.origin());
  if (mount.is_fixed()) {
    const CameraAim aim{*mount.yaw_deg * kDegrees, mount.min_pitch_deg * kDegrees};
    return volume.judged_at_vertices("frame",
                                     [&](const Vec3& vertex) { return picture.out_by(aim, std::array{vertex}); });
  }
  const std::optional<bool> is_outside = volume.is_outside(picture.middle());
  if (!is_outside || !*is_outside) return not_proved("frame", "the volume reaches the middle of the target");
  double farthest = 0;
  for (const Vec3& vertex : volume.vertices()) farthest = std::max(farthest, (vertex - picture.middle()).norm());
  constexpr std::size_t kMostOpen = 100;  // these take longest, and one is enough not to prove it
  const auto findings = volume.look_at_facets(
      [&](const LimitedVolume::Corners& facet, FacetFinding& finding) {
        // The way to c does not leave along a facet's plane, but for a few that have neighbours which do not.
        if (orientation(facet[0], facet[1], facet[2], picture.middle()) == 0) return;
        // What is out at a facet is out by as much more behind it as that lies farther from the target.
        const double distance = nearest_points(facet, {picture.middle(), picture.middle(), picture.middle()}).distance;
        const double allowed = std::min(volume.tolerance_of(facet), volume.tolerance_m() * distance / farthest);
        finding.is_open = !FacetServer(picture, allowed).serves(facet);
      },
      progress, kMostOpen);
  ClaimProof claim = volume.judged(
      "frame", findings, "for each facet an orientation of the mount was found that serves all of it", "the picture");
  if (claim.verdict == ProofVerdict::proved) return claim;
  return {"frame", ProofVerdict::not_proved, "no orientation of the mount was found: " + claim.text};
}

}  // namespace vantage::internal::prove
