// Branch and bound over yaw and pitch. In a cell each condition "this direction is inside of this edge" is linear up to
// a bounded remainder, so a cell shrinks to the polygon that these half-planes leave of it. Where nothing is left no
// orientation of the cell fits. The remainder falls with the square of the cell's size, so that near tangency cells as
// large as the square root of what is missing decide.
#include "verify/frame_search.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <queue>

#include "verify/tolerances.h"

namespace vantage::internal::verify {
struct FrameSearch::Cell {
  Orientation centre;
  double half_yaw = 0, half_pitch = 0;
  double promise = 0;  ///< the margin of an orientation in it or beside it: the best are looked at first

  bool operator<(const Cell& other) const { return promise < other.promise; }
};

/// A convex part of a cell, in turns from its centre.
class FrameSearch::Polygon {
 public:
  void reset(const Cell& cell) {
    const double y = cell.half_yaw, p = cell.half_pitch;
    corners_ = {{-y, -p}, {y, -p}, {y, p}, {-y, p}};
  }

  /// Keeps where value + slope . corner >= 0. Whether anything is left.
  bool keep(double value, const Eigen::Vector2d& slope) {
    kept_.clear();
    for (std::size_t i = 0; i < corners_.size(); ++i) {
      const Eigen::Vector2d &here = corners_[i], &next = corners_[(i + 1) % corners_.size()];
      const double a = value + slope.dot(here), b = value + slope.dot(next);
      if (a >= 0) kept_.push_back(here);
      if ((a > 0 && b < 0) || (a < 0 && b > 0)) kept_.emplace_back(here + a / (a - b) * (next - here));
    }
    corners_.swap(kept_);
    return !corners_.empty();
  }

  Eigen::Vector2d middle() const {
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    for (const Eigen::Vector2d& corner : corners_) sum += corner;
    return sum / static_cast<double>(corners_.size());
  }

  /// The cell about what is left, which is a part of `cell`.
  Cell box(const Cell& cell) const {
    Eigen::Vector2d low = corners_[0], high = corners_[0];
    for (const Eigen::Vector2d& corner : corners_) {
      low = low.cwiseMin(corner);
      high = high.cwiseMax(corner);
    }
    const Eigen::Vector2d centre = (low + high) / 2, half = (high - low) / 2;
    return {{cell.centre.yaw + centre.x(), cell.centre.pitch + centre.y()}, half.x(), half.y(), cell.promise};
  }

 private:
  std::vector<Eigen::Vector2d> corners_, kept_;
};

FrameSearch::FrameSearch(const Pinhole& camera, const Mount& mount) : roll_(mount.roll_deg * kDegree) {
  // x to the right of the picture (east), y ahead (north), z up.
  const double w = camera.half_width, h = camera.half_height;
  edges_ = {Vec3(1, w, 0).normalized(), Vec3(-1, w, 0).normalized(), Vec3(0, h, 1).normalized(),
            Vec3(0, h, -1).normalized()};
  least_ = {mount.yaw_deg.value_or(-180) * kDegree, mount.min_pitch_deg * kDegree};
  most_ = {mount.yaw_deg.value_or(180) * kDegree, mount.max_pitch_deg * kDegree};
}

/// From the camera's axes to the scene's. Rolled first, about its own axis, by the right hand: the right edge goes
/// down. Then raised about the level axis, then turned about the vertical, against the right hand.
Eigen::Quaterniond FrameSearch::turn(const Orientation& orientation) const {
  return Eigen::AngleAxisd(-orientation.yaw, Vec3::UnitZ()) * Eigen::AngleAxisd(orientation.pitch, Vec3::UnitX()) *
         Eigen::AngleAxisd(roll_, Vec3::UnitY());
}

double FrameSearch::margin(const std::vector<Vec3>& directions, const Orientation& orientation) const {
  const Eigen::Matrix3d turned = turn(orientation).toRotationMatrix();
  double least = 1;
  for (const Vec3& edge : edges_) {
    const Vec3 normal = turned * edge;
    for (const Vec3& direction : directions) least = std::min(least, normal.dot(direction));
  }
  return least;
}

FrameSearch::Cell FrameSearch::whole() const {
  return {{(least_.yaw + most_.yaw) / 2, (least_.pitch + most_.pitch) / 2},
          (most_.yaw - least_.yaw) / 2,
          (most_.pitch - least_.pitch) / 2,
          0};
}

/// What may fit of a cell; false where nothing does. A normal n of an edge moves by -z x n with the yaw, by r x n with
/// the pitch, r the level axis to the right. All second derivatives are at most 1 long, as every turn keeps lengths: so
/// half the squared sum of the turns bounds what the linear terms leave out.
bool FrameSearch::clip(const std::vector<Vec3>& directions, const Cell& cell, Polygon& polygon) const {
  const double sum = cell.half_yaw + cell.half_pitch;
  const double allowance = sum * sum / 2 + kAngleSlack + kAngleError;
  const Eigen::Matrix3d turned = turn(cell.centre).toRotationMatrix();
  const Vec3 level = Eigen::AngleAxisd(-cell.centre.yaw, Vec3::UnitZ()) * Vec3::UnitX();
  polygon.reset(cell);
  for (const Vec3& edge : edges_) {
    const Vec3 normal = turned * edge;
    const Vec3 by_yaw = normal.cross(Vec3::UnitZ()), by_pitch = level.cross(normal);
    for (const Vec3& direction : directions) {
      const double value = normal.dot(direction) + allowance;
      if (value >= sum) continue;  // slopes are at most 1
      if (!polygon.keep(value, {by_yaw.dot(direction), by_pitch.dot(direction)})) return false;
    }
  }
  return true;
}

FrameSearch::Result FrameSearch::search(const std::vector<Vec3>& directions) const {
  Vec3 sum = Vec3::Zero();
  for (const Vec3& direction : directions) sum += direction;
  // Towards their middle, as far as the mount allows: mostly that does.
  const Orientation ahead = {std::clamp(std::atan2(sum.x(), sum.y()), least_.yaw, most_.yaw),
                             std::clamp(std::atan2(sum.z(), sum.head<2>().norm()), least_.pitch, most_.pitch)};
  Result result{Finding::kept, ahead, 1};
  if (margin(directions, ahead) >= -kAngleSlack) return result;
  Polygon polygon;
  std::priority_queue<Cell> open;
  open.push(whole());
  bool is_certain = true;
  for (; !open.empty(); ++result.cells) {
    if (result.cells >= kMostCells) {
      result.finding = Finding::undecided;
      return result;
    }
    const Cell cell = open.top();
    open.pop();
    if (!clip(directions, cell, polygon)) continue;
    const Eigen::Vector2d middle = polygon.middle();
    result.orientation = {std::clamp(cell.centre.yaw + middle.x(), least_.yaw, most_.yaw),
                          std::clamp(cell.centre.pitch + middle.y(), least_.pitch, most_.pitch)};
    Cell left = polygon.box(cell);
    left.promise = margin(directions, result.orientation);
    if (left.promise >= -kAngleSlack) return result;
    if (cell.half_yaw + cell.half_pitch <= kSmallestCell) {
      is_certain = false;
      continue;
    }
    const bool by_yaw = left.half_yaw >= left.half_pitch;
    double& half = by_yaw ? left.half_yaw : left.half_pitch;
    double& place = by_yaw ? left.centre.yaw : left.centre.pitch;
    if (half <= 0.5 * (by_yaw ? cell.half_yaw : cell.half_pitch)) {  // has shrunk as much as by halving
      open.push(left);
      continue;
    }
    half /= 2;
    place -= half;
    open.push(left);
    place += 2 * half;
    open.push(left);
  }
  result.finding = is_certain ? Finding::broken : Finding::undecided;
  return result;
}

}  // namespace vantage::internal::verify
