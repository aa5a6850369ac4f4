#include "support/sweep_oracle.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>

namespace vantage::testing {
namespace {

using Real = long double;
using Point = Eigen::Matrix<Real, 3, 1>;
using Flat = Eigen::Matrix<Real, 2, 1>;
using Outline = std::vector<Flat>;

Point widened(const Vec3& v) { return v.cast<Real>(); }

Point lifted(const Flat& t) { return {t.x(), t.y(), 0}; }

std::vector<Point> clipped(const std::vector<Point>& polygon, const Point& inward, Real height) {
  std::vector<Point> result;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Point &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const Real va = inward.dot(a) - height, vb = inward.dot(b) - height;
    if (va >= 0) result.push_back(a);
    if ((va < 0) != (vb < 0)) result.push_back(a + va / (va - vb) * (b - a));
  }
  return result;
}

Real cross(const Flat& a, const Flat& b) { return a.x() * b.y() - a.y() * b.x(); }

struct Side {
  Flat from, to;  // from.x < to.x
  Real at(Real x) const {
    const Real y = from.y() + (x - from.x()) / (to.x() - from.x()) * (to.y() - from.y());
    return std::clamp(y, std::min(from.y(), to.y()), std::max(from.y(), to.y()));
  }
};

std::vector<Side> sides_of(const Outline& outline) {
  std::vector<Side> sides;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Flat &a = outline[i], &b = outline[(i + 1) % outline.size()];
    if (a.x() < b.x()) sides.push_back({a, b});
    if (b.x() < a.x()) sides.push_back({b, a});
  }
  return sides;
}

/// The lower and the upper side of a convex outline at x.
struct Span {
  const Side *low, *high;
};

std::optional<Span> span_at(const std::vector<Side>& sides, Real x) {
  Span span{nullptr, nullptr};
  for (const Side& side : sides) {
    if (side.from.x() > x || side.to.x() < x) continue;
    if (!span.low || side.at(x) < span.low->at(x)) span.low = &side;
    if (!span.high || side.at(x) > span.high->at(x)) span.high = &side;
  }
  if (!span.low || span.low == span.high) return std::nullopt;
  return span;
}

std::vector<Real> stops_of(const std::vector<std::vector<Side>>& outlines, Real first, Real last) {
  std::vector<Real> stops{first, last};
  const auto add = [&](Real x) {
    if (x > first && x < last) stops.push_back(x);
  };
  std::vector<Side> all;
  for (const auto& sides : outlines) all.insert(all.end(), sides.begin(), sides.end());
  for (std::size_t i = 0; i < all.size(); ++i) {
    add(all[i].from.x());
    add(all[i].to.x());
    for (std::size_t j = 0; j < i; ++j) {
      const Flat a = all[i].to - all[i].from, b = all[j].to - all[j].from;
      const Real turn = cross(a, b);
      if (turn == 0) continue;
      const Real s = cross(all[j].from - all[i].from, b) / turn, t = cross(all[j].from - all[i].from, a) / turn;
      if (s >= 0 && s <= 1 && t >= 0 && t <= 1) add(all[i].from.x() + s * a.x());
    }
  }
  std::sort(stops.begin(), stops.end());
  return stops;
}

/// Measures of outlines in the target's plane, as the eye has them.
class Ruler {
 public:
  Ruler(const Point& eye, const Outline& target) : eye_(eye), axis_(axis_about(eye, target)) {
    right_ = axis_.unitOrthogonal();
    up_ = axis_.cross(right_);
  }

  void add(const Outline& outline, SweptMeasures& sum) const {
    Real twice = 0, angle = 0, twice_image = 0;
    for (std::size_t i = 0; i < outline.size(); ++i) {
      const Flat &a = outline[i], &b = outline[(i + 1) % outline.size()];
      twice += cross(a - outline[0], b - outline[0]);
      angle += angle_under(a, b);
      twice_image += cross(image(a) - image(outline[0]), image(b) - image(outline[0]));
    }
    sum.area += std::abs(twice) / 2;
    sum.solid_angle += std::abs(angle);
    sum.pixels += std::abs(twice_image) / 2;
  }

 private:
  /// Of the triangle between the foot of the eye and a side: that of two right triangles in closed form.
  Real angle_under(const Flat& a, const Flat& b) const {
    const Flat foot = eye_.head<2>(), side = b - a;
    if (!(side.norm() > 0)) return 0;
    const Flat along = side.normalized();
    const Real away = cross(a - foot, along), h = eye_.z();
    if (away == 0) return 0;
    const auto until = [&](Real s) {
      return std::atan(s / away) - std::atan(h * s / (away * std::sqrt(h * h + away * away + s * s)));
    };
    return until(along.dot(b - foot)) - until(along.dot(a - foot));
  }

  Flat image(const Flat& t) const {
    const Point off = lifted(t) - eye_;
    return Flat(right_.dot(off), up_.dot(off)) / axis_.dot(off);
  }

  /// Of all cones through two or three directions, that which holds all and is narrowest.
  static Point axis_about(const Point& eye, const Outline& target) {
    std::vector<Point> directions;
    for (const Flat& t : target) directions.push_back((lifted(t) - eye).normalized());
    Point best = directions[0];
    Real widest = -2;
    const auto offer = [&](const Point& sum) {
      if (!(sum.norm() > 0)) return;
      Real least = 2;
      for (const Point& d : directions) least = std::min(least, d.dot(sum.normalized()));
      if (least > widest) {
        widest = least;
        best = sum.normalized();
      }
    };
    for (std::size_t i = 0; i < directions.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        offer(directions[i] + directions[j]);
        for (std::size_t k = 0; k < j; ++k) {
          const Point normal = (directions[j] - directions[i]).cross(directions[k] - directions[i]);
          offer(normal);
          offer(-normal);
        }
      }
    }
    return best;
  }

  Point eye_, axis_, right_, up_;
};

}  // namespace

SweepOracle::SweepOracle(const Mesh& scene, const TargetFrame& frame) : frame_(frame) {
  for (const auto& t : frame.polygon) polygon_.push_back(t.cast<Real>());
  for (const Triangle& t : scene.triangles) {
    triangles_.push_back({local(scene.vertices[t[0]]), local(scene.vertices[t[1]]), local(scene.vertices[t[2]])});
  }
}

SweepOracle::Point SweepOracle::local(const Vec3& point) const {
  const Point off = widened(point) - widened(frame_.origin);
  return {widened(frame_.axis_u).dot(off), widened(frame_.axis_v).dot(off), widened(frame_.normal).dot(off)};
}

std::vector<SweepOracle::Flat> SweepOracle::shadow_of(const std::array<Point, 3>& triangle, const Point& eye) const {
  std::vector<Point> rest = clipped({triangle.begin(), triangle.end()}, Point(0, 0, 1), 0);
  for (std::size_t i = 0; i < polygon_.size() && rest.size() >= 3; ++i) {
    const Point a = lifted(polygon_[i]), b = lifted(polygon_[(i + 1) % polygon_.size()]);
    const Point inward = -(a - eye).cross(b - eye).normalized();
    rest = clipped(rest, inward, inward.dot(eye));
  }
  if (rest.size() < 3) return {};
  Outline shadow;
  for (const Point& o : rest) shadow.push_back((eye + eye.z() / (eye.z() - o.z()) * (o - eye)).head<2>());
  return shadow;
}

SweptFraction SweepOracle::look_from(const Vec3& scene_eye) const {
  const Point eye = local(scene_eye);
  const Ruler ruler(eye, polygon_);
  SweptFraction result;
  ruler.add(polygon_, result.all);
  std::vector<std::vector<Side>> outlines{sides_of(polygon_)};
  for (const auto& triangle : triangles_) {
    const Outline shadow = shadow_of(triangle, eye);
    if (!shadow.empty()) outlines.push_back(sides_of(shadow));
  }
  Real first = polygon_[0].x(), last = first;
  for (const Flat& t : polygon_) {
    first = std::min(first, t.x());
    last = std::max(last, t.x());
  }
  const std::vector<Real> stops = stops_of(outlines, first, last);
  for (std::size_t i = 0; i + 1 < stops.size(); ++i) {
    const Real x0 = stops[i], x1 = stops[i + 1], middle = (x0 + x1) / 2;
    if (!(x1 > x0)) continue;
    const auto whole = span_at(outlines[0], middle);
    if (!whole) continue;
    std::vector<Span> dark;
    for (std::size_t k = 1; k < outlines.size(); ++k) {
      if (const auto span = span_at(outlines[k], middle)) dark.push_back(*span);
    }
    std::sort(dark.begin(), dark.end(),
              [&](const Span& a, const Span& b) { return a.low->at(middle) < b.low->at(middle); });
    const Side* from = whole->low;
    const auto add_gap = [&](const Side& low, const Side& high) {
      if (low.at(middle) >= high.at(middle)) return;
      ruler.add({{x0, low.at(x0)}, {x1, low.at(x1)}, {x1, high.at(x1)}, {x0, high.at(x0)}}, result.seen);
    };
    for (const Span& span : dark) {
      const bool ends_higher = span.low->at(middle) > whole->high->at(middle);
      add_gap(*from, ends_higher ? *whole->high : *span.low);
      if (span.high->at(middle) > from->at(middle)) from = span.high;
    }
    add_gap(*from, *whole->high);
  }
  return result;
}

}  // namespace vantage::testing
