#include "prove/corner_planes.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "prove/hull.h"

namespace vantage::internal::prove {
namespace {

using Whole = std::array<std::int64_t, 3>;

class CornerPlanes {
 public:
  CornerPlanes(std::span<const Vec3> points, std::span<const FineVec3> polygon, double largest)
      : points_(points), fine_polygon_(polygon), largest_(largest) {
    for (const Vec3& point : points) fine_points_.push_back(point.cast<long double>());
    for (const FineVec3& corner : polygon) polygon_.push_back(corner.cast<double>());
  }

  std::optional<Whole> find() {
    const std::size_t count = polygon_.size();
    const auto point = [&](std::size_t i) { return i; };
    const auto corner = [&](std::size_t k) { return points_.size() + k % count; };
    for (std::size_t i = 0; i < points_.size() && !found_; ++i) {
      for (std::size_t j = 0; j < points_.size() && !found_; ++j) {
        for (std::size_t k = 0; k < count; ++k) {
          consider(point(i), point(j), point(i), corner(k));
          consider(point(i), point(j), corner(k), corner(k + 1));
        }
        for (std::size_t k = 0; k < points_.size(); ++k) consider(point(i), point(j), point(i), point(k));
      }
      for (std::size_t k = 0; k < count; ++k) consider(corner(k), corner(k + 1), corner(k), point(i));
    }
    consider(corner(0), corner(1), corner(0), corner(2));
    return found_;
  }

 private:
  /// The direction across two edges, each from the first to the second of its ends.
  template <class Vector, class At>
  static Vector across(const At& at, std::size_t a, std::size_t b, std::size_t c, std::size_t d) {
    return Vector(at(b) - at(a)).cross(Vector(at(d) - at(c)));
  }

  /// How far apart the sets are along a direction; below zero where they are not.
  template <class Vector, class Points, class Polygon>
  static typename Vector::Scalar gap(const Vector& way, const Points& points, const Polygon& polygon) {
    auto low = way.dot(points[0]), high = way.dot(polygon[0]);
    for (const auto& p : points) low = std::min(low, way.dot(p));
    for (const auto& p : polygon) high = std::max(high, way.dot(p));
    return low - high;
  }

  /// Whether the gap is more than minus the doubt. Of a target of many corners the first few mostly tell.
  bool may_be_apart(const Vec3& way, double doubt) const {
    double high = way.dot(polygon_[0]);
    for (const Vec3& p : polygon_) high = std::max(high, way.dot(p));
    return std::all_of(points_.begin(), points_.end(), [&](const Vec3& p) { return way.dot(p) - high > -doubt; });
  }

  void consider(std::size_t a, std::size_t b, std::size_t c, std::size_t d) {
    if (found_) return;
    const auto at = [&](std::size_t i) { return i < points_.size() ? points_[i] : polygon_[i - points_.size()]; };
    const auto fine_at = [&](std::size_t i) {
      return i < points_.size() ? fine_points_[i] : fine_polygon_[i - points_.size()];
    };
    const Vec3 coarse = across<Vec3>(at, a, b, c, d);
    if (!(coarse.norm() > 0)) return;
    // Most directions are hopeless; doubles tell. The direction itself may be off by what its edges lose.
    constexpr double kDoubt = 1e-9;
    const double doubt = kDoubt * coarse.norm() * largest_;
    if (!may_be_apart(coarse, doubt) && !may_be_apart(-coarse, doubt)) return;
    const FineVec3 fine = across<FineVec3>(fine_at, a, b, c, d);
    if (!(fine.norm() > 0)) return;
    for (const long double sign : {1.0L, -1.0L}) try_way(sign * fine / fine.cwiseAbs().maxCoeff());
  }

  /// In whole numbers of 60 digits, and by them.
  void try_way(const FineVec3& way) {
    constexpr int kDigits = 60;
    constexpr long double kRounding = std::numeric_limits<long double>::epsilon();
    const FineVec3 whole = (way * std::ldexp(1.0L, kDigits)).array().round();
    const long double unsure = 16 * kRounding * whole.cwiseAbs().sum() * static_cast<long double>(largest_);
    if (found_ || !(gap(whole, fine_points_, fine_polygon_) > unsure)) return;
    found_ = Whole{static_cast<std::int64_t>(whole.x()), static_cast<std::int64_t>(whole.y()),
                   static_cast<std::int64_t>(whole.z())};
  }

  std::span<const Vec3> points_;
  std::span<const FineVec3> fine_polygon_;
  std::vector<FineVec3> fine_points_;
  std::vector<Vec3> polygon_;
  double largest_;
  std::optional<Whole> found_;
};

}  // namespace

std::optional<Whole> find_corner_plane(std::span<const Vec3> points, std::span<const FineVec3> polygon,
                                       double largest) {
  return CornerPlanes(points, polygon, largest).find();
}

}  // namespace vantage::internal::prove
