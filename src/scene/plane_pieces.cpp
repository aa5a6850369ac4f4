#include "scene/plane_pieces.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "core/edges.h"

namespace vantage::internal::scene {
namespace {

using Polygon = std::vector<Vec3>;

// A part of the extent: what two pieces may turn the wrong way where they are joined. A tenth of what a target may.
constexpr double kBent = 1e-10;
constexpr std::size_t kMostCorners = 64;  // of a target's part
// A part of the extent: no part of a target is so narrow, and no two of its corners are so near. Twice what is refused.
constexpr double kNarrow = 2e-9;

/// Twice the area vector.
Vec3 turned_area(const Polygon& polygon) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
    sum += (polygon[i] - polygon[0]).cross(polygon[i + 1] - polygon[0]);
  }
  return sum;
}

/// A convex polygon on either side of a line in its plane; corners on the line belong to both.
struct Halves {
  Polygon left, right;
};

/// `inward`: unit, in the plane, to the left of the line through `on`.
Halves split(const Polygon& polygon, const Vec3& inward, const Vec3& on, double slack) {
  Halves halves;
  std::vector<double> height;
  for (const Vec3& corner : polygon) {
    const double value = inward.dot(corner - on);
    height.push_back(std::abs(value) <= slack ? 0 : value);
  }
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const std::size_t next = (i + 1) % polygon.size();
    if (height[i] >= 0) halves.left.push_back(polygon[i]);
    if (height[i] <= 0) halves.right.push_back(polygon[i]);
    if (height[i] * height[next] >= 0) continue;
    const Vec3 crossing = polygon[i] + (polygon[next] - polygon[i]) * (height[i] / (height[i] - height[next]));
    halves.left.push_back(crossing);
    halves.right.push_back(crossing);
  }
  const auto is_on_side = [&](double sign) {
    return std::any_of(height.begin(), height.end(), [&](double value) { return value * sign > 0; });
  };
  if (!is_on_side(1)) halves.left.clear();
  if (!is_on_side(-1)) halves.right.clear();
  return halves;
}

/// Whether a segment has a length in a convex polygon, deeper than `depth` from its sides.
bool passes_through(const Polygon& polygon, const Vec3& from, const Vec3& along, const Vec3& normal, double depth) {
  double enter = 0, leave = 1;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec3 side = polygon[(i + 1) % polygon.size()] - polygon[i];
    const Vec3 inward = normal.cross(side).normalized();
    const double at = inward.dot(from - polygon[i]) - depth, rise = inward.dot(along);
    if (std::abs(rise) <= depth) {
      if (at + std::max(rise, 0.0) <= 0) return false;
      continue;
    }
    if (rise > 0) {
      enter = std::max(enter, -at / rise);
    } else {
      leave = std::min(leave, -at / rise);
    }
  }
  return (leave - enter) * along.norm() > depth;
}

double extent_of(const Polygon& polygon) {
  Box box;
  for (const Vec3& corner : polygon) box.extend(corner);
  return (box.max - box.min).norm();
}

/// Positive on the left of the line from a to c.
double left_of(const Vec3& a, const Vec3& c, const Vec3& b, const Vec3& normal) {
  const Vec3 along = c - a;
  return normal.cross(along).dot(b - a) / std::max(along.norm(), 1e-300);
}

/// Two polygons joined across the side from corner i of `a`, which `b` runs the other way from corner j on.
std::optional<Polygon> joined(const Polygon& a, std::size_t i, const Polygon& b, std::size_t j, const Vec3& normal) {
  const double slack = kBent * std::min(extent_of(a), extent_of(b));
  Polygon result;
  for (std::size_t k = 0; k < a.size(); ++k) result.push_back(a[(i + 1 + k) % a.size()]);  // ends with a[i]
  for (std::size_t k = 2; k < b.size(); ++k) result.push_back(b[(j + k) % b.size()]);
  const std::size_t n = result.size();
  for (const std::size_t seam : {std::size_t{0}, a.size() - 1}) {
    if (left_of(result[(seam + n - 1) % n], result[seam], result[(seam + 1) % n], normal) < -slack) return std::nullopt;
  }
  // In the middle of a straight side a corner says nothing, but for those that stick out.
  Polygon corners;
  for (std::size_t k = 0; k < n; ++k) {
    const bool is_seam = k == 0 || k == a.size() - 1;
    const Vec3 &before = result[(k + n - 1) % n], &after = result[(k + 1) % n];
    if (is_seam && std::abs(left_of(before, after, result[k], normal)) <= slack &&
        (result[k] - before).dot(after - result[k]) > 0) {
      continue;
    }
    corners.push_back(result[k]);
  }
  return corners.size() < 3 ? std::nullopt : std::optional(corners);
}

std::optional<Polygon> joined(const Polygon& a, const Polygon& b, const Vec3& normal, double slack) {
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t j = 0; j < b.size(); ++j) {
      const bool is_shared =
          (a[i] - b[(j + 1) % b.size()]).norm() <= slack && (a[(i + 1) % a.size()] - b[j]).norm() <= slack;
      if (!is_shared) continue;
      auto result = joined(a, i, b, j, normal);
      if (result && result->size() > kMostCorners) return std::nullopt;
      return result;
    }
  }
  return std::nullopt;
}

/// Whether two sides lie on one another over a length of more than `slack`.
bool share_length(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d, double slack) {
  const Vec3 along = b - a;
  const double length = along.norm();
  if (length <= slack) return false;
  const Vec3 unit = along / length;
  const auto off = [&](const Vec3& p) { return (p - a - unit * unit.dot(p - a)).norm(); };
  if (off(c) > slack || off(d) > slack) return false;
  const double first = unit.dot(c - a), second = unit.dot(d - a);
  return std::min(length, std::max(first, second)) - std::max(0.0, std::min(first, second)) > slack;
}

bool touch(const Polygon& a, const Polygon& b, double slack) {
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t j = 0; j < b.size(); ++j) {
      if (share_length(a[i], a[(i + 1) % a.size()], b[j], b[(j + 1) % b.size()], slack)) return true;
    }
  }
  return false;
}

}  // namespace

bool is_sliver(const std::vector<Vec3>& polygon, double sliver) {
  if (polygon.size() < 3) return true;
  double longest = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    for (std::size_t j = i + 1; j < polygon.size(); ++j) longest = std::max(longest, (polygon[i] - polygon[j]).norm());
  }
  return turned_area(polygon).norm() <= sliver * longest;
}

double area_of(const std::vector<Vec3>& polygon) { return turned_area(polygon).norm() / 2; }

void subtract(PlanePieces& pieces, const std::vector<Vec3>& taken, const Vec3& normal, double sliver) {
  if (is_sliver(taken, sliver)) return;
  Polygon outline = taken;
  if (turned_area(outline).dot(normal) < 0) std::reverse(outline.begin(), outline.end());
  PlanePieces left;
  for (Polygon& piece : pieces) {
    Polygon inside = piece;
    PlanePieces kept;
    for (std::size_t i = 0; i < outline.size() && !inside.empty(); ++i) {
      const Vec3 side = outline[(i + 1) % outline.size()] - outline[i];
      if (side.norm() <= sliver) continue;
      Halves halves = split(inside, normal.cross(side).normalized(), outline[i], sliver / 2);
      if (!is_sliver(halves.right, sliver)) kept.push_back(std::move(halves.right));
      inside = std::move(halves.left);
    }
    // What is taken is next to nothing: the piece stays in one.
    if (is_sliver(inside, sliver)) {
      left.push_back(std::move(piece));
    } else {
      std::move(kept.begin(), kept.end(), std::back_inserter(left));
    }
  }
  pieces = std::move(left);
}

void split_along(PlanePieces& pieces, const Vec3& a, const Vec3& b, const Vec3& normal, double sliver) {
  const Vec3 along = b - a;
  if (along.norm() <= sliver) return;
  const Vec3 inward = normal.cross(along).normalized();
  PlanePieces result;
  for (Polygon& piece : pieces) {
    if (!passes_through(piece, a, along, normal, sliver)) {
      result.push_back(std::move(piece));
      continue;
    }
    Halves halves = split(piece, inward, a, sliver / 2);
    for (Polygon* half : {&halves.left, &halves.right}) {
      if (!is_sliver(*half, sliver)) result.push_back(std::move(*half));
    }
  }
  pieces = std::move(result);
}

void join_convex(PlanePieces& pieces, const Vec3& normal, double slack) {
  constexpr std::size_t kMost = 256;
  if (pieces.size() > kMost) return;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    for (std::size_t j = i + 1; j < pieces.size();) {
      auto both = joined(pieces[i], pieces[j], normal, slack);
      if (!both) {
        ++j;
        continue;
      }
      pieces[i] = std::move(*both);
      pieces.erase(pieces.begin() + static_cast<std::ptrdiff_t>(j));
      j = i + 1;
    }
  }
}

PlanePieces usable(const PlanePieces& pieces) {
  PlanePieces result;
  for (const Polygon& piece : pieces) {
    const double least = kNarrow * extent_of(piece);
    Polygon corners;
    for (const Vec3& corner : piece) {
      if (corners.empty() || (corner - corners.back()).norm() > least) corners.push_back(corner);
    }
    while (corners.size() > 1 && (corners.back() - corners.front()).norm() <= least) corners.pop_back();
    if (is_sliver(corners, least)) continue;
    while (corners.size() > kMostCorners) {
      const auto middle = corners.begin() + kMostCorners - 1;
      result.emplace_back(corners.begin(), middle + 1);
      corners.erase(corners.begin() + 1, middle);
    }
    result.push_back(std::move(corners));
  }
  return result;
}

std::vector<PlanePieces> connected(const PlanePieces& pieces, double slack) {
  core::DisjointSets sets(pieces.size());
  for (std::uint32_t i = 0; i < pieces.size(); ++i) {
    for (std::uint32_t j = i + 1; j < pieces.size(); ++j) {
      if (sets.find(i) != sets.find(j) && touch(pieces[i], pieces[j], slack)) sets.join(i, j);
    }
  }
  std::vector<PlanePieces> groups;
  std::vector<std::size_t> group_of(pieces.size(), pieces.size());
  for (std::uint32_t i = 0; i < pieces.size(); ++i) {
    std::size_t& group = group_of[sets.find(i)];
    if (group == pieces.size()) {
      group = groups.size();
      groups.emplace_back();
    }
    groups[group].push_back(pieces[i]);
  }
  return groups;
}

double distance_to(const std::vector<Vec3>& polygon, const Vec3& normal, const Vec3& point) {
  bool is_over = true;
  double least = INFINITY;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec3 &a = polygon[i], side = polygon[(i + 1) % polygon.size()] - a;
    is_over = is_over && normal.cross(side).dot(point - a) >= 0;
    const double at = std::clamp(side.dot(point - a) / std::max(side.squaredNorm(), 1e-300), 0.0, 1.0);
    least = std::min(least, (point - a - at * side).norm());
  }
  return is_over ? std::abs(normal.dot(point - polygon[0])) : least;
}

}  // namespace vantage::internal::scene
