#include "query/shadow.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <tuple>

namespace vantage::internal::query {
namespace {

/// Roundings of a line's value, of the sum of its terms: three differences, five products and their sums, and two for
/// the place of a corner that is a crossing.
constexpr double kRoundings = 8 * std::numeric_limits<double>::epsilon();

double area_of(std::span<const Point2> polygon) {
  double twice = 0;
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
    const Point2 a = polygon[i] - polygon[0], b = polygon[i + 1] - polygon[0];
    twice += a.x() * b.y() - a.y() * b.x();
  }
  return 0.5 * twice;
}

Pieces::Bounds bounds_of(std::span<const Point2> polygon) {
  Pieces::Bounds bounds{polygon[0], polygon[0]};
  for (const Point2& t : polygon) {
    bounds.min = bounds.min.cwiseMin(t);
    bounds.max = bounds.max.cwiseMax(t);
  }
  return bounds;
}

/// Positive where c is on the left of the plane through the eye, a and b: which way a, b, c turn as the eye sees them.
double turn_of(const Vec3& eye, const Vec3& a, const Vec3& b, const Vec3& c) {
  return (a - eye).cross(b - a).dot(c - b);
}

/// Whether the eye sees the polygon convex. If not, it looks along a polygon that is planar to rounding only.
bool looks_convex(const Vec3& eye, std::span<const Vec3> polygon) {
  bool left = false, right = false;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const std::size_t next = i + 1 == polygon.size() ? 0 : i + 1, last = next + 1 == polygon.size() ? 0 : next + 1;
    const double turn = turn_of(eye, polygon[i], polygon[next], polygon[last]);
    left = left || turn > 0;
    right = right || turn < 0;
  }
  return !(left && right);
}

}  // namespace

void Pieces::add(std::span<const Point2> corners) {
  pieces_.push_back({corners_.size(), corners.size(), bounds_of(corners)});
  corners_.insert(corners_.end(), corners.begin(), corners.end());
}

void Pieces::remove(std::size_t i) {
  pieces_[i] = pieces_.back();
  pieces_.pop_back();
}

void Pieces::shrink_to(std::size_t count) {
  if (count < pieces_.size()) corners_.resize(pieces_[count].first);
  pieces_.resize(count);
}

void Shadows::begin(std::span<const Point2> target, const Vec3& eye) {
  target_ = target;
  eye_ = eye;
  reach_.setZero();
  for (const Point2& t : target) reach_ = reach_.cwiseMax(t.cwiseAbs());
  shadows_.clear();
  lines_.clear();
  is_dark_ = false;
}

bool Shadows::add(std::span<const Vec3> polygon, std::uint32_t name) {
  if (polygon.size() == 3 || looks_convex(eye_, polygon)) return add_one(polygon, name, 0);
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
    const std::array<Vec3, 3> triangle = {polygon[0], polygon[i], polygon[i + 1]};
    if (!add_one(triangle, name, static_cast<std::uint32_t>(i))) return false;
  }
  return true;
}

bool Shadows::add_one(std::span<const Vec3> corners, std::uint32_t name, std::uint32_t triangle) {
  if (is_dark_) return false;
  double turn = 0;
  for (std::size_t i = 1; i + 1 < corners.size(); ++i) turn += turn_of(eye_, corners[0], corners[i], corners[i + 1]);
  if (turn == 0) return true;  // seen from its edge
  Shadow shadow;
  shadow.first_line = static_cast<std::uint32_t>(lines_.size());
  inside_.assign(target_.begin(), target_.end());
  bool is_all = true;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    add_line(corners[i], corners[i + 1 == corners.size() ? 0 : i + 1], turn);
    if (!split(lines_.back())) {
      lines_.resize(shadow.first_line);
      return true;
    }
    if (outside_.empty()) {
      lines_.pop_back();  // has all of the target, or what is left of it, on its inner side
    } else {
      is_all = false;
    }
  }
  is_dark_ = is_all;
  shadow.line_count = static_cast<std::uint32_t>(lines_.size()) - shadow.first_line;
  shadow.area = area_of(inside_);
  shadow.bounds = bounds_of(inside_);
  shadow.polygon = name;
  shadow.triangle = triangle;
  shadows_.push_back(shadow);
  return !is_dark_;
}

// The plane through the eye and an edge, in which two polygons that share it must agree.
void Shadows::add_line(const Vec3& a, const Vec3& b, double turn) {
  const bool is_turned = std::tuple(b.x(), b.y(), b.z()) < std::tuple(a.x(), a.y(), a.z());
  const Vec3 &from = is_turned ? b : a, &to = is_turned ? a : b;
  const Vec3 d = from - eye_, e = to - from;
  const double sign = (turn > 0) != is_turned ? 1 : -1;
  const Vec3 normal = sign * d.cross(e), u = d.cwiseAbs(), v = e.cwiseAbs();
  const Vec3 size(u.y() * v.z() + u.z() * v.y(), u.z() * v.x() + u.x() * v.z(), u.x() * v.y() + u.y() * v.x());
  Shadow::Line line;
  line.along = normal.head<2>();
  line.through = from.head<2>();
  line.height = normal.z() * from.z();
  line.noise = kRoundings * (size.x() * (std::abs(from.x()) + reach_.x()) +
                             size.y() * (std::abs(from.y()) + reach_.y()) + size.z() * from.z());
  lines_.push_back(line);
}

// Cuts `inside_` in two; `outside_` stays empty where nothing of it is outside. Returns whether something is inside.
bool Shadows::split(const Shadow::Line& line) {
  outside_.clear();
  values_.clear();
  bool is_in = false, is_out = false;
  for (const Point2& t : inside_) {
    const double value = line.value(t);
    is_in = is_in || value > line.noise;
    is_out = is_out || value < -line.noise;
    values_.push_back(value);
  }
  if (!is_out) return true;
  if (!is_in) return false;
  scratch_.clear();
  for (std::size_t i = 0; i < inside_.size(); ++i) {
    const std::size_t next = i + 1 == inside_.size() ? 0 : i + 1;
    const double a = values_[i], b = values_[next];
    if (a >= -line.noise) scratch_.push_back(inside_[i]);
    if (a <= line.noise) outside_.push_back(inside_[i]);
    if ((a > line.noise && b < -line.noise) || (a < -line.noise && b > line.noise)) {
      const Point2 crossing = inside_[i] + a / (a - b) * (inside_[next] - inside_[i]);
      scratch_.push_back(crossing);
      outside_.push_back(crossing);
    }
  }
  inside_.swap(scratch_);
  return true;
}

// The outer sides of the lines, one after another. Where the shadow turns out to miss the piece it stays whole.
void Shadows::subtract(const Shadow& shadow, std::size_t piece) {
  const std::size_t before = pieces_.count();
  const std::span<const Point2> corners = pieces_[piece];
  inside_.assign(corners.begin(), corners.end());
  for (const Shadow::Line& line : lines_of(shadow)) {
    if (!split(line)) return pieces_.shrink_to(before);
    if (!outside_.empty()) pieces_.add(outside_);
  }
  pieces_.remove(piece);
}

const Pieces& Shadows::seen() {
  pieces_.clear();
  if (is_dark_) return pieces_;
  // The largest first: they leave least to do to the others.
  std::sort(shadows_.begin(), shadows_.end(), [](const Shadow& a, const Shadow& b) {
    return std::tuple(-a.area, a.polygon, a.triangle) < std::tuple(-b.area, b.polygon, b.triangle);
  });
  pieces_.add(target_);
  for (const Shadow& shadow : shadows_) {
    for (std::size_t i = pieces_.count(); i-- > 0;) {
      if (!pieces_.bounds(i).apart(shadow.bounds)) subtract(shadow, i);
    }
    if (pieces_.count() == 0) break;
  }
  return pieces_;
}

}  // namespace vantage::internal::query
