// The limits that a leg with its tube breaks: one class for each kind of limit.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/bvh.h"
#include "core/progress_reporter.h"
#include "core/triangle_tree.h"
#include "query/leg_intervals.h"
#include "vantage/navigation.h"
#include "vantage/query.h"

namespace vantage::internal::query {

/// A leg, and the radius about it.
struct Tube {
  Leg leg;
  double radius = 0;
  core::ProgressReporter progress = {};  ///< asked within a leg that takes long

  Vec3 at(double share) const { return leg.from + share * (leg.to - leg.from); }
  double length() const { return (leg.to - leg.from).norm(); }
  Box box() const;  ///< holds the tube
  Tube moved(const Vec3& by) const { return {{leg.from + by, leg.to + by}, radius, progress}; }
};

/// By how much a place of the leg breaks a limit; negative where it keeps it.
using Amount = std::function<double(double)>;

/// Adds the break to the list, if there is one.
void add_break(std::vector<LegBreak>& breaks, const std::string& limit, LegBreak::Unit unit, LegIntervals intervals,
               const Amount& amount);

/// Triangles by place, about an origin near them.
class LegTriangles {
 public:
  /// Indexes a mesh with triangles. `in_plan`: their hierarchy leaves z aside.
  explicit LegTriangles(const Mesh& mesh, bool in_plan = false);

  const Vec3& origin() const { return origin_; }
  const Mesh& mesh() const { return mesh_; }  ///< relative to the origin

  /// Calls visit(triangle) for those whose boxes come within `reach` of the leg (relative to the origin), and maybe for
  /// others.
  void near(const Leg& leg, double reach, const std::function<void(std::uint32_t)>& visit) const;

  std::array<Vec3, 3> corners(std::uint32_t triangle) const;
  /// Distance from the nearest triangle; in plan, where it is by plan.
  double distance(const Vec3& place) const;

 private:
  Mesh mesh_;
  Vec3 origin_;
  bool in_plan_;
  std::vector<std::uint32_t> order_;
  core::Bvh bvh_;
};

/// Heights above ground.
class LegGround {
 public:
  explicit LegGround(const Ground& ground);

  /// Where some of the tube is lower than that above a piece of ground, or higher; infinite: everywhere there, or
  /// nowhere.
  LegIntervals below(const Tube& tube, double above_m) const { return beyond(tube, above_m, 1); }
  LegIntervals over(const Tube& tube, double above_m) const { return beyond(tube, above_m, -1); }
  /// Where some of it has no ground below or above.
  LegIntervals beside(const Tube& tube) const;

  /// How far a place is above the highest piece of ground there, and above the lowest; nothing beside the ground.
  struct Heights {
    double above_highest, above_lowest;
  };
  std::optional<Heights> heights(const Vec3& place) const;
  double plan_distance(const Vec3& place) const;  ///< from the ground

 private:
  LegIntervals beyond(const Tube& tube, double above_m, double sign) const;
  void add_borders_near(const Tube& local, LegIntervals& out) const;

  double plane_z_;
  std::unique_ptr<LegTriangles> triangles_;    ///< null: the plane
  std::vector<std::array<bool, 3>> is_inner_;  ///< per triangle: sides between two that lie side by side
};

/// A closed mesh to stay in.
class LegMesh {
 public:
  explicit LegMesh(const KeepInMesh& mesh);

  LegIntervals broken(const Tube& tube) const;
  double outside(const Vec3& place) const;  ///< distance from the mesh; negative inside

 private:
  bool is_inside(const Vec3& local) const;

  LegTriangles triangles_;
  core::TriangleTree tree_;
};

/// Where the tube comes nearer to triangles than a distance.
LegIntervals too_near(const LegTriangles& triangles, const Tube& tube, double distance);

}  // namespace vantage::internal::query
