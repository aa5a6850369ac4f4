// The shadows of blockers on the target's plane, and what they leave of the target: docs/theory.md, "How much is seen".
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "vantage/geometry.h"

namespace vantage::internal::query {

using Point2 = Eigen::Vector2d;

/// Plane convex polygons about the target's centre, counter-clockwise, in one array.
class Pieces {
 public:
  struct Bounds {
    Point2 min, max;
    bool apart(const Bounds& other) const {
      return min.x() > other.max.x() || other.min.x() > max.x() || min.y() > other.max.y() || other.min.y() > max.y();
    }
  };

  void clear() {
    corners_.clear();
    pieces_.clear();
  }
  std::size_t count() const { return pieces_.size(); }
  std::span<const Point2> operator[](std::size_t i) const {
    return {corners_.data() + pieces_[i].first, pieces_[i].count};
  }
  const Bounds& bounds(std::size_t i) const { return pieces_[i].bounds; }
  void add(std::span<const Point2> corners);
  void remove(std::size_t i);         ///< puts the last one in its place
  void shrink_to(std::size_t count);  ///< leaves the first ones

 private:
  struct Piece {
    std::size_t first, count;
    Bounds bounds;
  };
  std::vector<Point2> corners_;
  std::vector<Piece> pieces_;
};

/// The shadow of a convex polygon: what lies on the inner side of some lines.
struct Shadow {
  /// Inside: along . (t - through) >= height. What differs from that by less than `noise` may be rounding.
  struct Line {
    Point2 along, through;
    double height, noise;
    double value(const Point2& t) const { return along.dot(t - through) - height; }
  };
  std::uint32_t first_line = 0, line_count = 0;  ///< in Shadows
  double area = 0;                               ///< of what lies on the target
  Pieces::Bounds bounds{};                       ///< of the same
  std::uint32_t polygon = 0, triangle = 0;       ///< of the scene; for an order that depends on nothing else
};

/// The shadows that an eye in front of the target sees on it, and the part that they leave. No sample is taken and no
/// corner of a shadow computed that is not on the target: a shadow is bounded by the planes through the eye and the
/// edges of what casts it, which also is right where that lies above or beside the eye, or reaches both ways.
///
/// Rounding: a line that is nearer to a corner than `noise` goes through it; pieces that are thinner than that are not
/// seen. Edges that two blockers share are one line to the last bit.
class Shadows {
 public:
  /// `target`: convex, counter-clockwise, metres about its centre; kept by reference. `eye`: local, z > 0.
  void begin(std::span<const Point2> target, const Vec3& eye);

  /// Adds what a convex polygon (local, z >= 0, planar but for rounding; at least 3 corners) hides. Returns whether any
  /// of the target is left: false ends it, the rest would be in vain.
  bool add(std::span<const Vec3> polygon, std::uint32_t name);

  /// What is seen, in convex pieces. All of the target where no shadow falls on it. The same whatever the order of the
  /// calls of add. Cost: in proportion to the shadows and the pieces whose bounds they overlap.
  const Pieces& seen();

 private:
  bool add_one(std::span<const Vec3> corners, std::uint32_t name, std::uint32_t triangle);
  void add_line(const Vec3& a, const Vec3& b, double turn);
  void subtract(const Shadow& shadow, std::size_t piece);
  bool split(const Shadow::Line& line);
  std::span<const Shadow::Line> lines_of(const Shadow& shadow) const {
    return {lines_.data() + shadow.first_line, shadow.line_count};
  }

  std::span<const Point2> target_;
  Vec3 eye_ = Vec3::Zero();
  Point2 reach_ = Point2::Zero();  // of the target, along x and y
  std::vector<Shadow> shadows_;
  std::vector<Shadow::Line> lines_;
  Pieces pieces_;
  std::vector<Point2> inside_, outside_, scratch_;  // of the piece in hand
  std::vector<double> values_;
  bool is_dark_ = false;
};

}  // namespace vantage::internal::query
