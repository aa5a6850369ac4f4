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
  template <typename Positions>
  double out_by(const CameraAim& aim, const Positions& positions) const {
    double most = -std::numeric_limits<double>::infinity();
    for (const Vec3& edge : edges(aim)) {
      double nearest = std::numeric_limits<double>::infinity(), farthest = -nearest;
      for (const Vec3& corner : corners_) nearest = std::min(nearest, edge.dot(corner));
      for (const Vec3& position : positions) farthest = std::max(farthest, edge.dot(position));
      most = std::max(most, farthest - nearest);
    }
    return most;
  }

  /// Orientations from which a search may start: towards the target, and turned about the vertical.
  std::vector<CameraAim> starts(const LimitedVolume::Corners& positions) const {
    const Vec3 towards = middle_ - (positions[0] + positions[1] + positions[2]) / 3;
    const double pitch = clamped(std::atan2(towards.z(), towards.head<2>().norm()));
    if (mount_.yaw_deg) return {{*mount_.yaw_deg * kDegrees, pitch}};
    constexpr int kStarts = 16;
    std::vector<CameraAim> aims;
    for (int start = 0; start < kStarts; ++start) {
      aims.push_back({std::atan2(towards.x(), towards.y()) + start * 2 * std::numbers::pi / kStarts, pitch});
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

  /// Goes to the best of the neighbours, in shorter steps where there is none. Whether nothing is out by more than what
  /// is allowed then.
  template <typename Positions>
  bool improve(CameraAim& aim, const Positions& positions, double allowed) const {
    double out = out_by(aim, positions), farthest = 0;
    const CameraAim middle = centred(aim, positions);
    const double out_of_middle = out_by(middle, positions);
    if (out_of_middle < out) {
      aim = middle;
      out = out_of_middle;
    }
    for (const Vec3& corner : corners_) farthest = std::max(farthest, (corner - positions[0]).norm());
    constexpr double kLongest = 0.2, kShortest = 1e-6;  // radians
    constexpr double kHope = 6;                         // steps of this length, not many more, are to come
    for (double step = kLongest; step > kShortest && out > allowed;) {
      CameraAim best = aim;
      double least = out;
      for (int yaw = -1; yaw <= 1; ++yaw) {
        if (yaw != 0 && mount_.yaw_deg) continue;
        for (int pitch = -1; pitch <= 1; ++pitch) {
          const CameraAim next{aim.yaw + yaw * step, clamped(aim.pitch + pitch * step)};
          const double by = out_by(next, positions);
          if (by >= least) continue;
          least = by;
          best = next;
        }
      }
      if (!(least < out)) {
        step /= 2;
        if (std::isfinite(allowed) && out - allowed > kHope * step * farthest) break;
      }
      out = least;
      aim = best;
    }
    return out <= allowed;
  }

  /// The same by one search within another, for each pitch the best yaw: slower, but it ends nowhere on a slanted
  /// ridge, where all the neighbours are worse.
  template <typename Positions>
  bool refine(CameraAim& aim, const Positions& positions, double allowed) const {
    constexpr double kAround = 0.1;  // radians
    CameraAim best = aim;
    double least = out_by(aim, positions);
    const auto out_at = [&](const CameraAim& at) {
      const double out = out_by(at, positions);
      if (out < least) {
        least = out;
        best = at;
      }
      return out;
    };
    const auto out_at_pitch = [&](double pitch) {
      if (mount_.yaw_deg) return out_at({aim.yaw, pitch});
      return least_between(aim.yaw - kAround, aim.yaw + kAround, [&](double yaw) { return out_at({yaw, pitch}); });
    };
    least_between(clamped(aim.pitch - kAround), clamped(aim.pitch + kAround), out_at_pitch);
    aim = best;
    return least <= allowed;
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
      for (const Vec3& corner : corners_) farthest = std::max(farthest, (corner - facet[i]).norm());
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

  /// The best orientation that is found from all starts.
  bool find(CameraAim& aim, const LimitedVolume::Corners& positions, double allowed) const {
    double least = std::numeric_limits<double>::infinity();
    for (CameraAim start : starts(positions)) {
      const bool fits = improve(start, positions, allowed);
      const double out = out_by(start, positions);
      if (out < least) aim = start;
      least = std::min(least, out);
      if (fits) return true;
    }
    return false;
  }

 private:
  /// The least of a function that falls and then rises (Kiefer 1953).
  template <typename Function>
  static double least_between(double begin, double end, const Function& value) {
    constexpr double kPart = 0.6180339887498949, kLast = 2e-6;  // radians
    double left = end - kPart * (end - begin), right = begin + kPart * (end - begin);
    double at_left = value(left), at_right = value(right);
    while (end - begin > kLast) {
      if (at_left < at_right) {
        end = right;
        right = left;
        at_right = at_left;
        left = end - kPart * (end - begin);
        at_left = value(left);
      } else {
        begin = left;
        left = right;
        at_left = at_right;
        right = begin + kPart * (end - begin);
        at_right = value(right);
      }
    }
    return std::min(at_left, at_right);
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
    CameraAim aim = picture_.starts(facet).front();
    if (picture_.improve(aim, facet, allowed_)) return true;
    std::array<CameraAim, 3> aims = {aim, aim, aim};
    if (!serves_corners(facet, aims)) return false;
    if (picture_.serve(aims, facet, allowed_) || picture_.find(aim, facet, allowed_)) return true;
    if (picture_.refine(aim, facet, allowed_)) return true;
    aims = {aim, aim, aim};  // orientations of the corners that are alike
    if (serves_corners(facet, aims) && serves_in_parts(facet, aims)) return true;
    is_fine_ = true;
    left_ = kMostCuts;
    aims = {aim, aim, aim};
    return serves_corners(facet, aims) && serves_in_parts(facet, aims);
  }

 private:
  bool serves_corner(const Vec3& corner, CameraAim& aim) const {
    const std::array<Vec3, 1> only = {corner};
    picture_.improve(aim, only, -std::numeric_limits<double>::infinity());
    if (is_fine_) return picture_.refine(aim, only, allowed_);
    return picture_.out_by(aim, only) <= allowed_ || picture_.refine(aim, only, allowed_) ||
           picture_.find(aim, {corner, corner, corner}, allowed_);
  }

  bool serves_corners(const LimitedVolume::Corners& facet, std::array<CameraAim, 3>& aims) const {
    for (std::size_t i = 0; i < 3; ++i) {
      if (!serves_corner(facet[i], aims[i])) return false;
    }
    return true;
  }

  /// `aims`: that serve the corners.
  bool serves_in_parts(const LimitedVolume::Corners& facet, const std::array<CameraAim, 3>& aims) {
    if (picture_.serve(aims, facet, allowed_)) return true;
    CameraAim middle{(aims[0].yaw + aims[1].yaw + aims[2].yaw) / 3,
                     (aims[0].pitch + aims[1].pitch + aims[2].pitch) / 3};
    if (picture_.improve(middle, facet, allowed_) || picture_.find(middle, facet, allowed_)) return true;
    if (left_ == 0) return false;
    --left_;
    LimitedVolume::Corners between;
    std::array<CameraAim, 3> aims_between = aims;
    for (std::size_t i = 0; i < 3; ++i) between[i] = (facet[i] + facet[(i + 1) % 3]) / 2;
    if (!serves_corners(between, aims_between)) return false;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t before = (i + 2) % 3;
      if (!serves_in_parts({facet[i], between[i], between[before]}, {aims[i], aims_between[i], aims_between[before]})) {
        return false;
      }
    }
    return serves_in_parts(between, aims_between);
  }

  const Picture& picture_;
  double allowed_;
  static constexpr int kMostCuts = 100;  // of a facet and its parts
  int left_ = kMostCuts;
  bool is_fine_ = false;  // whether each corner gets the best orientation
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
