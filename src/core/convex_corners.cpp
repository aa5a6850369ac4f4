#include "core/convex_corners.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace vantage::internal::core {
namespace {

class CornerSearch {
 public:
  CornerSearch(std::span<const Vec3> polygon, const Vec3& normal, const CornerSlack& slack)
      : polygon_(polygon), normal_(normal), slack_(slack) {}

  std::optional<std::vector<bool>> run() {
    scan();
    if (corners_.size() < 3 || !turns_left_once()) return std::nullopt;
    std::vector<bool> is_corner(polygon_.size(), false);
    for (std::size_t k = 0; k < corners_.size(); ++k) {
      is_corner[corners_[k]] = true;
      if (!follows(corners_[k], corners_[(k + 1) % corners_.size()])) return std::nullopt;
    }
    return is_corner;
  }

 private:
  std::size_t after(std::size_t i) const { return i + 1 == polygon_.size() ? 0 : i + 1; }

  // Graham's scan in the order of the outline, from a vertex that is on the hull: the farthest from any other.
  void scan() {
    std::size_t start = 0;
    for (std::size_t i = 1; i < polygon_.size(); ++i) {
      if ((polygon_[i] - polygon_[0]).squaredNorm() > (polygon_[start] - polygon_[0]).squaredNorm()) start = i;
    }
    corners_ = {start};
    for (std::size_t i = after(start); i != start; i = after(i)) {
      drop_flat_before(i);
      corners_.push_back(i);
    }
    drop_flat_before(start);
    if (corners_.size() > 3 && is_flat(corners_.back(), start, corners_[1])) corners_.erase(corners_.begin());
  }

  void drop_flat_before(std::size_t next) {
    while (corners_.size() > 1 && corners_[corners_.size() - 2] != next &&
           is_flat(corners_[corners_.size() - 2], corners_.back(), next)) {
      corners_.pop_back();
    }
  }

  // Whether neither `middle` nor any other vertex between two corners to be sticks out of the line between these.
  bool is_flat(std::size_t from, std::size_t middle, std::size_t to) const {
    const auto sticks_out = [&](std::size_t i) {
      return !(distance_right_of(polygon_[from], polygon_[to], polygon_[i], normal_) <= slack_.outside);
    };
    if (sticks_out(middle)) return false;
    for (std::size_t i = after(from); i != to; i = after(i)) {
      if (sticks_out(i)) return false;
    }
    return true;
  }

  bool turns_left_once() const {
    double turn = 0;
    for (std::size_t k = 0; k < corners_.size(); ++k) {
      const Vec3& here = polygon_[corners_[k]];
      const Vec3 in = here - polygon_[corners_[(k + corners_.size() - 1) % corners_.size()]];
      const Vec3 out = polygon_[corners_[(k + 1) % corners_.size()]] - here;
      const double cross = normal_.dot(in.cross(out));
      if (!(cross > 0)) return false;
      turn += std::atan2(cross, in.dot(out));
    }
    return turn < 3 * std::numbers::pi;
  }

  // Whether the outline runs from one corner to the next along the straight line between them.
  bool follows(std::size_t from, std::size_t to) const {
    const Vec3 side = (polygon_[to] - polygon_[from]).normalized();
    double reached = 0;
    for (std::size_t i = after(from); i != to; i = after(i)) {
      if (distance_right_of(polygon_[from], polygon_[to], polygon_[i], normal_) < -slack_.inside) return false;
      const double along = side.dot(polygon_[i] - polygon_[from]);
      if (along < reached - slack_.inside) return false;
      reached = std::max(reached, along);
    }
    return reached <= (polygon_[to] - polygon_[from]).norm() + slack_.inside;
  }

  std::span<const Vec3> polygon_;
  const Vec3& normal_;
  CornerSlack slack_;
  std::vector<std::size_t> corners_;
};

}  // namespace

double distance_right_of(const Vec3& a, const Vec3& c, const Vec3& b, const Vec3& normal) {
  const Vec3 line = c - a;
  return normal.dot((b - a).cross(line)) / line.norm();
}

std::optional<std::vector<bool>> find_corners(std::span<const Vec3> polygon, const Vec3& normal,
                                              const CornerSlack& slack) {
  return CornerSearch(polygon, normal, slack).run();
}

}  // namespace vantage::internal::core
