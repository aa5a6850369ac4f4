#include "target/target_check.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "core/format.h"
#include "core/text.h"
#include "core/walk_bvh.h"
#include "target/buried.h"
#include "target/column.h"
#include "target/numerics.h"
#include "vantage/error.h"

namespace vantage::internal::target {
namespace {

// A point without a front may lie on a wall, of which the user alone knows the outer side.
std::string advice_for_point(const PreparedScene::Data& scene, std::uint32_t polygon) {
  const std::uint32_t begin = scene.first_vertex[polygon], end = scene.first_vertex[polygon + 1];
  const auto corner = [&](std::uint32_t k) -> const Vec3& { return scene.vertices[scene.polygon_vertices[k]]; };
  Vec3 normal = Vec3::Zero();
  for (std::uint32_t k = begin + 1; k + 1 < end; ++k)
    normal += (corner(k) - corner(begin)).cross(corner(k + 1) - corner(begin));
  normal.normalize();
  for (double& along : normal) along = std::round(along * 1000) / 1000 + 0.0;  // the sum keeps "-0.000" out
  return core::format(
      "if the point lies on that surface, say which side is looked at: front: [{:.3f}, {:.3f}, {:.3f}] or its "
      "opposite; else move it off",
      normal.x(), normal.y(), normal.z());
}

[[noreturn]] void refuse_pierced(const PreparedScene::Data& scene, const Target& target, const TargetFrame& frame,
                                 const Lengths& lengths, const Crossing& crossing, double clear) {
  const std::uint32_t object = scene.polygon_object[crossing.polygon];
  const std::string name = "\"" + display_name(scene.objects[object]) + "\"";
  const int decimals = HeightStep(lengths).decimals;
  std::string fix =
      core::format("move the target, or raise it: offset: {:.{}f} clears it", target.offset_m + clear, decimals);
  if (clear > numerics::kMostRaise) {
    fix = core::format(
        "move the target off it, or give a polygon that leaves it out: over the target nothing is clear for {:.0f} m",
        clear);
  }
  if (frame.all_sides) fix = advice_for_point(scene, crossing.polygon);
  throw Error(ErrorCode::target_pierced, name + " stands on or passes through the target",
              "target \"" + target.name + "\", at " + core::fixed_text(frame.to_scene(crossing.place), decimals), fix,
              object);
}

/// Finds how high polygons rise above the target's plane that hardly do.
class LowSurfaces {
 public:
  LowSurfaces(const PreparedScene::Data& scene, const TargetFrame& frame, const Lengths& lengths, double reach)
      : scene_(scene),
        frame_(frame),
        centre_(frame.origin - scene.origin),
        slack_(lengths.slack),
        most_(lengths.lift + 2 * lengths.clear),
        reach_(reach) {}

  /// The highest corners of polygons within reach that are above the plane by at most what the target may be raised by,
  /// ascending.
  std::vector<double> tops() {
    core::walk_bvh(
        scene_.bvh, [this](const core::BvhNode& node) { return is_low_and_near(node.bounds); },
        [this](std::uint32_t polygon) { add_top(polygon); });
    std::sort(tops_.begin(), tops_.end());
    return std::move(tops_);
  }

 private:
  bool is_low_and_near(const core::Bounds& bounds) const {
    double middle = 0, half = 0, square = 0;
    for (int a = 0; a < 3; ++a) {
      const double low = bounds.min[a] - centre_[a], high = bounds.max[a] - centre_[a];
      middle += frame_.normal[a] * 0.5 * (low + high);
      half += std::abs(frame_.normal[a]) * 0.5 * (high - low);
      const double away = std::max({0.0, low, -high});
      square += away * away;
    }
    return middle + half > slack_ && middle - half <= most_ && square <= reach_ * reach_;
  }

  void add_top(std::uint32_t polygon) {
    double top = -INFINITY;
    for (std::uint32_t v : scene_.corners_of(polygon)) {
      top = std::max(top, frame_.normal.dot(scene_.vertices[v] - centre_));
      if (top > most_) return;
    }
    if (top > slack_) tops_.push_back(top);
  }

  const PreparedScene::Data& scene_;
  const TargetFrame& frame_;
  Vec3 centre_;
  double slack_, most_, reach_;
  std::vector<double> tops_;
};

// Raises the target above surfaces that all but continue its plane: what they hide is too flat for doubles.
double clear_low_surfaces(double lift, const std::vector<double>& tops, const Lengths& lengths) {
  for (double top : tops)
    if (top > lift + lengths.slack && top <= lift + lengths.clear) lift = top + lengths.clear;
  return lift;
}

}  // namespace

Clearance clear_target(const PreparedScene::Data& scene, const Target& target, const TargetFrame& frame,
                       double max_range, bool is_off_surface) {
  const Lengths lengths = lengths_of(scene, frame, max_range);
  Lengths own = lengths;
  if (is_off_surface) own.lift = own.clear;
  Column column(scene, frame, lengths, lengths.slack);
  const std::vector<Crossing> low = column.crossings(2 * own.lift);
  const Lift lift = lift_at(low, 0, own);
  if (lift.pierced_by) {
    const double clear = clear_height(column.crossings(INFINITY), lengths);
    refuse_pierced(scene, target, frame, lengths, *lift.pierced_by, clear);
  }
  Clearance result;
  if (auto note = buried_note(scene, target, frame, lengths)) result.notes.push_back(std::move(*note));
  const double raised = clear_low_surfaces(lift.lift, LowSurfaces(scene, frame, own, max_range).tops(), lengths);
  const bool pierced =
      std::any_of(low.begin(), low.end(), [&](const Crossing& c) { return crosses(c, raised, lengths); });
  result.lift_m = pierced ? lift.lift : raised;
  return result;
}

double height_off_surface(const PreparedScene::Data& scene, const TargetFrame& frame, double max_range) {
  const Lengths lengths = lengths_of(scene, frame, max_range);
  // So high over a ridge all of the polygon, however it is turned, is seen along its slopes, up to 60 degrees.
  const double clear = lengths.clear + 4 * frame.enclosing_radius_m;
  double height = 0;
  for (const Crossing& c : Column(scene, frame, lengths, -clear).crossings(lengths.lift))
    if (c.high <= lengths.lift) height = std::max(height, c.high + clear);
  return height;
}

void refuse_steep_nearby(const PreparedScene::Data& scene, const Target& target, const TargetFrame& frame,
                         double max_range) {
  constexpr double kSteep = 0.5;  // of the normal: more than 60 degrees
  const Lengths lengths = lengths_of(scene, frame, max_range);
  const double near = lengths.lift;
  TargetFrame around = frame;
  around.polygon = {{-near, -near}, {near, -near}, {near, near}, {-near, near}};
  std::vector<Vec3> corners;
  for (const Crossing& c : Column(scene, around, lengths, -near).crossings(near)) {
    local_polygon(scene, frame, c.polygon, corners);
    Vec3 area = Vec3::Zero();
    for (std::size_t i = 1; i + 1 < corners.size(); ++i)
      area += (corners[i] - corners[0]).cross(corners[i + 1] - corners[0]);
    if (std::abs(area.z()) < kSteep * area.norm()) refuse_pierced(scene, target, frame, lengths, c, 0);
  }
}

}  // namespace vantage::internal::target
