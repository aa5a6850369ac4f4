#include "prove/lowest_point.h"

#include <Eigen/LU>
#include <array>
#include <limits>

namespace vantage::internal::prove {
namespace {

using Eigen::Vector2d;

constexpr std::size_t kMostPlanes = 6;
constexpr double kRounding = 1e-12;

/// Looks at all corners of what lies above the planes within the box: one of them is lowest.
class Corners {
 public:
  Corners(std::span<const Plane2> planes, const Vector2d& min, const Vector2d& max)
      : planes_(planes), min_(min), max_(max) {}

  Vector2d lowest() {
    for (const double x : {min_.x(), max_.x()}) {
      for (const double y : {min_.y(), max_.y()}) take({x, y});
    }
    for (std::size_t i = 0; i < planes_.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        take_on_sides(i, j);
        for (std::size_t k = 0; k < j; ++k) {
          Eigen::Matrix2d slopes;
          slopes << (planes_[i].slope - planes_[k].slope).transpose(),
              (planes_[j].slope - planes_[k].slope).transpose();
          take(slopes.inverse() * Vector2d(planes_[k].value - planes_[i].value, planes_[k].value - planes_[j].value));
        }
      }
    }
    return best_;
  }

 private:
  /// Where two planes meet over the sides of the box.
  void take_on_sides(std::size_t i, std::size_t j) {
    const Vector2d slope = planes_[i].slope - planes_[j].slope;
    const double value = planes_[i].value - planes_[j].value;
    for (const Vector2d& side : {min_, max_}) {
      take({side.x(), -(value + slope.x() * side.x()) / slope.y()});
      take({-(value + slope.y() * side.y()) / slope.x(), side.y()});
    }
  }

  void take(const Vector2d& place) {
    // Not true of numbers that are none, either.
    const bool is_inside = (place.array() >= min_.array()).all() && (place.array() <= max_.array()).all();
    if (!is_inside) return;
    const double height = highest(planes_, place);
    if (!(height < least_)) return;
    least_ = height;
    best_ = place;
  }

  std::span<const Plane2> planes_;
  Vector2d min_, max_;
  double least_ = std::numeric_limits<double>::infinity();
  Vector2d best_ = min_;
};

}  // namespace

Vector2d lowest_point(std::span<const Plane2> planes, const Vector2d& min, const Vector2d& max) {
  constexpr int kMostCuts = 40;
  std::array<Plane2, kMostPlanes> taken;
  std::size_t count = 0;
  Vector2d place = Vector2d::Zero().cwiseMax(min).cwiseMin(max);
  double height = -std::numeric_limits<double>::infinity();
  for (int cut = 0; cut < kMostCuts; ++cut) {
    const Plane2& top = *std::max_element(planes.begin(), planes.end(),
                                          [&](const Plane2& a, const Plane2& b) { return a.at(place) < b.at(place); });
    if (!(top.at(place) > height)) break;
    // Of those before, the ones that hold the place up.
    const auto holds = [&](const Plane2& plane) { return plane.at(place) >= height - kRounding * std::abs(height); };
    const auto end = std::partition(taken.begin(), taken.begin() + static_cast<std::ptrdiff_t>(count), holds);
    count = std::min<std::size_t>(static_cast<std::size_t>(end - taken.begin()), kMostPlanes - 1);
    taken[count++] = top;
    const std::span<const Plane2> least(taken.data(), count);
    place = Corners(least, min, max).lowest();
    height = highest(least, place);
  }
  return place;
}

}  // namespace vantage::internal::prove
