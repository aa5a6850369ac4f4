#include "exact/target_check.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>

#include "exact/blocker.h"
#include "exact/collect.h"
#include "exact/facet_polygon.h"
#include "exact/number_text.h"
#include "exact/numerics.h"
#include "vantage/error.h"

namespace vantage::exact {
namespace {

using numerics::kClear;
using numerics::kMaxLift;
using numerics::kOnPlane;
using numerics::kSeparation;

/// The heights at which a scene polygon crosses the column over the target.
struct Crossing {
  double low, high;
  std::uint32_t polygon;
  Vec3 place;  // local, at the lowest point
};

class Column {
 public:
  /// Polygons that reach nowhere above `floor` do not count.
  Column(const PreparedScene::Data& scene, const TargetFrame& frame, double floor = kOnPlane)
      : scene_(scene), frame_(frame), target_(make_local_target(frame.polygon)), floor_(floor) {}

  /// Crossings that begin below `ceiling` and end above the target's plane, or just below it if the polygon stands
  /// above the plane elsewhere; with a floor below the plane, those that end above the floor.
  std::vector<Crossing> crossings(double ceiling) {
    std::vector<Crossing> found;
    if (!scene_.bvh.nodes.empty()) visit(0, ceiling, found);
    return found;
  }

 private:
  void visit(std::uint32_t at, double ceiling, std::vector<Crossing>& found) {
    const scene::BvhNode& node = scene_.bvh.nodes[at];
    if (!meets(node.bounds, ceiling)) return;
    if (!node.leaf()) {
      visit(node.first, ceiling, found);
      visit(node.first + 1, ceiling, found);
      return;
    }
    for (std::uint32_t polygon = node.first; polygon < node.first + node.count; ++polygon)
      add_crossing(polygon, ceiling, found);
  }

  bool meets(const scene::Bounds& bounds, double ceiling) const {
    const Vec3 centre = frame_.origin - scene_.origin;
    std::array<Vec3, 8> corners;
    double lowest = INFINITY, highest = -INFINITY;
    for (int i = 0; i < 8; ++i) {
      Vec3 corner;
      for (int a = 0; a < 3; ++a) corner[a] = (i >> a & 1 ? bounds.max[a] : bounds.min[a]) - centre[a];
      corners[i] = {frame_.axis_u.dot(corner), frame_.axis_v.dot(corner), frame_.normal.dot(corner)};
      lowest = std::min(lowest, corners[i].z()), highest = std::max(highest, corners[i].z());
    }
    if (lowest > ceiling || highest <= floor_) return false;
    for (const LocalTarget::Edge& edge : target_.edges) {
      const bool outside = std::all_of(corners.begin(), corners.end(),
                                       [&](const Vec3& c) { return edge.outward.dot(c.head<2>()) >= edge.distance; });
      if (outside) return false;
    }
    return true;
  }

  // Walls that only touch the target's outline do not cross its column.
  void add_crossing(std::uint32_t polygon, double ceiling, std::vector<Crossing>& found) {
    local_polygon(scene_, frame_, polygon, clipped_.corners);
    const bool stands =
        std::any_of(clipped_.corners.begin(), clipped_.corners.end(), [this](const Vec3& c) { return c.z() > floor_; });
    if (!stands) return;
    clipped_.makers.assign(clipped_.corners.size(), 0);
    for (const LocalTarget::Edge& edge : target_.edges) {
      clip_facet(clipped_, {-edge.outward.x(), -edge.outward.y(), 0}, kSeparation - edge.distance, 0, 0, scratch_);
      if (clipped_.empty()) return;
    }
    Crossing crossing{INFINITY, -INFINITY, polygon, {}};
    for (const Vec3& c : clipped_.corners) {
      if (c.z() < crossing.low) crossing.low = c.z(), crossing.place = c;
      crossing.high = std::max(crossing.high, c.z());
    }
    if (crossing.high > std::min(floor_, -kClear) && crossing.low <= ceiling) found.push_back(crossing);
  }

  const PreparedScene::Data& scene_;
  const TargetFrame& frame_;
  LocalTarget target_;
  double floor_;
  FacetPolygon clipped_, scratch_;
};

bool crosses(const Crossing& crossing, double height) {
  return crossing.low <= height + kOnPlane && crossing.high > height + kOnPlane;
}

/// How far a target at some height is raised to clear its surface, and what crosses it there.
struct Lift {
  double lift = 0;
  const Crossing* pierced_by = nullptr;
};

Lift lift_at(const std::vector<Crossing>& crossings, double height) {
  Lift result;
  for (const Crossing& c : crossings)
    if (c.high > height - kClear && c.high <= height + kMaxLift)
      result.lift = std::max(result.lift, c.high + kClear - height);
  for (const Crossing& c : crossings)
    if (!result.pierced_by && crosses(c, height + result.lift)) result.pierced_by = &c;
  return result;
}

// The next whole millimetre.
double past(double height) { return std::floor(height * 1000 + 1) / 1000; }

// The smallest height from `height` on, in whole millimetres, at which nothing crosses.
double clear_height(const std::vector<Crossing>& crossings, double height = 0) {
  for (;;) {
    const Lift lift = lift_at(crossings, height);
    if (!lift.pierced_by) return height;
    height = past(lift.pierced_by->high);
  }
}

std::string describe(const Vec3& place) {
  return "(" + fixed_text(place.x(), 3) + ", " + fixed_text(place.y(), 3) + ", " + fixed_text(place.z(), 3) + ")";
}

// A point without a front may lie on a wall, of which the user alone knows the outer side.
std::string advice_for_point(const PreparedScene::Data& scene, std::uint32_t polygon) {
  const std::uint32_t begin = scene.first_vertex[polygon], end = scene.first_vertex[polygon + 1];
  const auto corner = [&](std::uint32_t k) -> const Vec3& { return scene.vertices[scene.polygon_vertices[k]]; };
  Vec3 normal = Vec3::Zero();
  for (std::uint32_t k = begin + 1; k + 1 < end; ++k)
    normal += (corner(k) - corner(begin)).cross(corner(k + 1) - corner(begin));
  normal.normalize();
  std::string text;
  for (int axis = 0; axis < 3; ++axis) {
    if (axis > 0) text += ", ";
    text += fixed_text(std::round(normal[axis] * 1000) / 1000 + 0.0, 3);  // the sum keeps "-0.000" out
  }
  return "if the point lies on that surface, say which side is looked at: front: [" + text +
         "] or its opposite; else move it off";
}

// Raising a target by more than this (metres) makes another one of it.
constexpr double kMostRaise = 3;

[[noreturn]] void refuse_pierced(const PreparedScene::Data& scene, const Target& target, const TargetFrame& frame,
                                 const Crossing& crossing, double clear) {
  const std::uint32_t object = scene.polygon_object[crossing.polygon];
  const std::string name = "\"" + scene.objects[object] + "\"";
  std::string fix = "move the target, or raise it: offset: " + fixed_text(target.offset_m + clear, 3) + " clears it";
  if (clear > kMostRaise) {
    fix = "move the target off it, or give a polygon that leaves it out: over the target nothing is clear for " +
          fixed_text(clear, 0) + " m";
  }
  if (frame.all_sides) fix = advice_for_point(scene, crossing.polygon);
  throw PiercedTarget(name + " stands on or passes through the target",
                      "target \"" + target.name + "\", at " + describe(frame.to_scene(crossing.place)), fix, object);
}

// What of the scene is straight over and under a point: the nearest over it, and whether anything, or anything of
// `object`, is under it.
class Plumb {
 public:
  Plumb(const PreparedScene::Data& scene, const Vec3& point, std::optional<std::uint32_t> object = std::nullopt)
      : scene_(scene), point_(point - scene.origin), object_(object) {
    if (!scene.bvh.nodes.empty()) visit(0);
  }
  bool anything_below = false, object_below = false;
  double nearest_above = INFINITY;
  std::uint32_t polygon_above = 0;

 private:
  void visit(std::uint32_t at) {
    const scene::BvhNode& node = scene_.bvh.nodes[at];
    for (int a = 0; a < 2; ++a)
      if (point_[a] < node.bounds.min[a] || point_[a] > node.bounds.max[a]) return;
    if (!node.leaf()) {
      visit(node.first);
      visit(node.first + 1);
      return;
    }
    for (std::uint32_t polygon = node.first; polygon < node.first + node.count; ++polygon) test(polygon);
  }

  void test(std::uint32_t polygon) {
    const std::uint32_t begin = scene_.first_vertex[polygon], end = scene_.first_vertex[polygon + 1];
    const auto corner = [&](std::uint32_t k) -> const Vec3& { return scene_.vertices[scene_.polygon_vertices[k]]; };
    int left = 0, right = 0;
    Vec3 area = Vec3::Zero();
    for (std::uint32_t k = begin; k < end; ++k) {
      const Vec3 a = corner(k) - point_, b = corner(k + 1 == end ? begin : k + 1) - point_;
      const double side = a.x() * b.y() - a.y() * b.x();
      left += side >= 0, right += side <= 0;
      area += a.cross(b);
    }
    if ((left != int(end - begin) && right != int(end - begin)) || area.z() == 0) return;
    const double height = area.dot(corner(begin) - point_) / area.z();
    if (height <= kMaxLift) {
      anything_below = true;
      object_below |= object_ == scene_.polygon_object[polygon];
    } else if (height < nearest_above) {
      nearest_above = height;
      polygon_above = polygon;
    }
  }

  const PreparedScene::Data& scene_;
  Vec3 point_;
  std::optional<std::uint32_t> object_;
};

Box object_bounds(const PreparedScene::Data& scene, std::uint32_t object) {
  Box box;
  for (std::size_t polygon = 0; polygon < scene.polygon_count(); ++polygon)
    if (scene.polygon_object[polygon] == object)
      for (std::uint32_t k = scene.first_vertex[polygon]; k < scene.first_vertex[polygon + 1]; ++k)
        box.extend(scene.vertices[scene.polygon_vertices[k]]);
  return box;
}

// The smallest height, in whole millimetres, at which nothing crosses the target and the ground is below it. An upright
// target, which moves sideways, has none: it stays below, or comes out beside the scene.
std::optional<double> height_over_ground(const PreparedScene::Data& scene, const TargetFrame& frame, Column& column,
                                         std::uint32_t ground) {
  const std::vector<Crossing> crossings = column.crossings(INFINITY);
  std::vector<double> tops;
  for (const Crossing& c : crossings) tops.push_back(c.high);
  std::sort(tops.begin(), tops.end());
  double tried = 0;
  for (const double top : tops) {
    if (past(top) <= tried) continue;
    const double height = clear_height(crossings, past(top));
    if (height <= tried) continue;
    tried = height;
    if (Plumb(scene, frame.origin + height * frame.normal, ground).object_below) return height;
  }
  return std::nullopt;
}

// A roof or a bridge over the target is fine. A target is under the ground when nothing of the scene is below it, and
// what is above all of it is either everything there is or spreads over most of the scene.
void refuse_underground(const PreparedScene::Data& scene, const Target& target, const TargetFrame& frame,
                        Column& column) {
  std::vector<Vec3> probes{frame.origin};
  double highest = frame.origin.z();
  for (const auto& v : frame.polygon) {
    probes.push_back(frame.to_scene({0.999 * v.x(), 0.999 * v.y(), 0}));
    highest = std::max(highest, probes.back().z());
  }
  Plumb first(scene, probes[0]);
  for (const Vec3& probe : probes) {
    const Plumb plumb(scene, probe);
    if (plumb.anything_below || !std::isfinite(plumb.nearest_above)) return;
  }
  const Box all = scene.statistics.bounds;
  const std::uint32_t ground = scene.polygon_object[first.polygon_above];
  const Box over = object_bounds(scene, ground);
  const Vec3 extent = over.max - over.min, whole = all.max - all.min;
  const bool ground_like = extent.x() >= 0.5 * whole.x() && extent.y() >= 0.5 * whole.y();
  if (highest >= all.min.z() - kMaxLift && !ground_like) return;
  std::string fix = "raise the target, and check the scene's up axis and scale";
  const auto height = height_over_ground(scene, frame, column, ground);
  if (height && *height <= kMostRaise)
    fix = "check the scene's up axis and scale, or raise the target: " +
          (frame.all_sides ? "z = " + fixed_text(frame.origin.z() + *height, 3)
                           : "offset: " + fixed_text(target.offset_m + *height, 3)) +
          " clears it";
  throw Error(ErrorKind::input, "the target is under the ground",
              "target \"" + target.name + "\": \"" + scene.objects[ground] + "\" is " +
                  fixed_text(first.nearest_above, 3) + " m above " + describe(frame.origin),
              fix);
}

/// Finds how high polygons rise above the target's plane that hardly do.
class LowSurfaces {
 public:
  LowSurfaces(const PreparedScene::Data& scene, const TargetFrame& frame, double reach)
      : scene_(scene), frame_(frame), centre_(frame.origin - scene.origin), reach_(reach) {}

  /// Of polygons within reach: their highest corners that are above the plane by at most kMostHeight, ascending.
  std::vector<double> tops() {
    if (!scene_.bvh.nodes.empty()) visit(0);
    std::sort(tops_.begin(), tops_.end());
    return std::move(tops_);
  }

 private:
  static constexpr double kMostHeight = kMaxLift + 2 * kClear;

  void visit(std::uint32_t at) {
    const scene::BvhNode& node = scene_.bvh.nodes[at];
    double middle = 0, half = 0, square = 0;
    for (int a = 0; a < 3; ++a) {
      const double low = node.bounds.min[a] - centre_[a], high = node.bounds.max[a] - centre_[a];
      middle += frame_.normal[a] * 0.5 * (low + high);
      half += std::abs(frame_.normal[a]) * 0.5 * (high - low);
      const double away = std::max({0.0, low, -high});
      square += away * away;
    }
    if (middle + half <= kOnPlane || middle - half > kMostHeight || square > reach_ * reach_) return;
    if (!node.leaf()) {
      visit(node.first);
      visit(node.first + 1);
      return;
    }
    for (std::uint32_t polygon = node.first; polygon < node.first + node.count; ++polygon) add_top(polygon);
  }

  void add_top(std::uint32_t polygon) {
    double top = -INFINITY;
    for (std::uint32_t v : scene_.corners_of(polygon)) {
      top = std::max(top, frame_.normal.dot(scene_.vertices[v] - centre_));
      if (top > kMostHeight) return;
    }
    if (top > kOnPlane) tops_.push_back(top);
  }

  const PreparedScene::Data& scene_;
  const TargetFrame& frame_;
  Vec3 centre_;
  double reach_;
  std::vector<double> tops_;
};

// Raises the target above surfaces that all but continue its plane: what they hide is too flat for doubles.
double clear_low_surfaces(double lift, const std::vector<double>& tops) {
  for (double top : tops)
    if (top > lift + kOnPlane && top <= lift + kClear) lift = top + kClear;
  return lift;
}

}  // namespace

double clearing_lift(const PreparedScene::Data& scene, const Target& target, const TargetFrame& frame, double reach) {
  Column column(scene, frame);
  const std::vector<Crossing> low = column.crossings(2 * kMaxLift);
  const Lift lift = lift_at(low, 0);
  if (lift.pierced_by) refuse_pierced(scene, target, frame, *lift.pierced_by, clear_height(column.crossings(INFINITY)));
  refuse_underground(scene, target, frame, column);
  const double raised = clear_low_surfaces(lift.lift, LowSurfaces(scene, frame, reach).tops());
  const bool pierced = std::any_of(low.begin(), low.end(), [&](const Crossing& c) { return crosses(c, raised); });
  return pierced ? lift.lift : raised;
}

double height_off_surface(const PreparedScene::Data& scene, const TargetFrame& frame) {
  // So high over a ridge all of the polygon, however it is turned, is seen along its slopes, up to 60 degrees.
  const double clear = kClear + 4 * frame.enclosing_radius_m;
  double height = 0;
  for (const Crossing& c : Column(scene, frame, -clear).crossings(kMaxLift))
    if (c.high <= kMaxLift) height = std::max(height, c.high + clear);
  return height;
}

void refuse_steep_nearby(const PreparedScene::Data& scene, const Target& target, const TargetFrame& frame) {
  constexpr double kSteep = 0.5;  // of the normal: more than 60 degrees
  TargetFrame around = frame;
  around.polygon = {{-kMaxLift, -kMaxLift}, {kMaxLift, -kMaxLift}, {kMaxLift, kMaxLift}, {-kMaxLift, kMaxLift}};
  std::vector<Vec3> corners;
  for (const Crossing& c : Column(scene, around, -kMaxLift).crossings(kMaxLift)) {
    local_polygon(scene, frame, c.polygon, corners);
    Vec3 area = Vec3::Zero();
    for (std::size_t i = 1; i + 1 < corners.size(); ++i)
      area += (corners[i] - corners[0]).cross(corners[i + 1] - corners[0]);
    if (std::abs(area.z()) < kSteep * area.norm()) refuse_pierced(scene, target, frame, c, 0);
  }
}

}  // namespace vantage::exact
