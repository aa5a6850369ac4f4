#include "target/buried.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "core/format.h"
#include "core/walk_bvh.h"
#include "target/column.h"
#include "target/numerics.h"

namespace vantage::internal::target {
namespace {

// What of the scene is straight over and under a point: the nearest over it, and whether anything, or anything of
// `object`, is under it. What passes through the point, up to `near`, is under it.
class VerticalProbe {
 public:
  VerticalProbe(const PreparedScene::Data& scene, const Vec3& point, double near,
                std::optional<std::uint32_t> object = std::nullopt)
      : scene_(scene), point_(point - scene.origin), near_(near), object_(object) {
    const auto is_in_line = [this](const core::BvhNode& node) {
      const core::Bounds& box = node.bounds;
      return point_.x() >= box.min[0] && point_.x() <= box.max[0] && point_.y() >= box.min[1] &&
             point_.y() <= box.max[1];
    };
    core::walk_bvh(scene.bvh, is_in_line, [this](std::uint32_t polygon) { test(polygon); });
  }
  bool anything_below = false, object_below = false;
  double nearest_above = INFINITY;
  std::uint32_t polygon_above = 0;

 private:
  void test(std::uint32_t polygon) {
    const std::uint32_t begin = scene_.first_vertex[polygon], end = scene_.first_vertex[polygon + 1];
    const auto corner = [&](std::uint32_t k) -> const Vec3& { return scene_.vertices[scene_.polygon_vertices[k]]; };
    int left = 0, right = 0;
    Vec3 area = Vec3::Zero();
    for (std::uint32_t k = begin; k < end; ++k) {
      const Vec3 a = corner(k) - point_, b = corner(k + 1 == end ? begin : k + 1) - point_;
      const double side = a.x() * b.y() - a.y() * b.x();
      left += side >= 0;
      right += side <= 0;
      area += a.cross(b);
    }
    if ((left != static_cast<int>(end - begin) && right != static_cast<int>(end - begin)) || area.z() == 0) return;
    const double height = area.dot(corner(begin) - point_) / area.z();
    if (height <= near_) {
      anything_below = true;
      object_below |= object_ == scene_.polygon_object[polygon];
    } else if (height < nearest_above) {
      nearest_above = height;
      polygon_above = polygon;
    }
  }

  const PreparedScene::Data& scene_;
  Vec3 point_;
  double near_;
  std::optional<std::uint32_t> object_;
};

Box object_bounds(const PreparedScene::Data& scene, std::uint32_t object) {
  Box box;
  for (std::size_t polygon = 0; polygon < scene.polygon_count(); ++polygon) {
    if (scene.polygon_object[polygon] == object) {
      for (std::uint32_t k = scene.first_vertex[polygon]; k < scene.first_vertex[polygon + 1]; ++k)
        box.extend(scene.vertices[scene.polygon_vertices[k]]);
    }
  }
  return box;
}

// The smallest height, in whole steps, at which nothing crosses the target and the ground is below it. An upright
// target, which moves sideways, has none: it stays below, or comes out beside the scene.
std::optional<double> height_over_ground(const PreparedScene::Data& scene, const TargetFrame& frame,
                                         const Lengths& lengths, std::uint32_t ground) {
  const std::vector<Crossing> crossings = Column(scene, frame, lengths, lengths.slack).crossings(INFINITY);
  const HeightStep step(lengths);
  std::vector<double> tops;
  for (const Crossing& c : crossings) tops.push_back(c.high);
  std::sort(tops.begin(), tops.end());
  double tried = 0;
  for (const double top : tops) {
    if (step.past(top) <= tried) continue;
    const double height = clear_height(crossings, lengths, step.past(top));
    if (height <= tried) continue;
    tried = height;
    if (VerticalProbe(scene, frame.origin + height * frame.normal, lengths.lift, ground).object_below) return height;
  }
  return std::nullopt;
}

// The object that may be the ground, and how far above the target's centre it is. A roof or a bridge over the target is
// fine.
struct Cover {
  std::uint32_t object;
  double height;
};
std::optional<Cover> cover_over(const PreparedScene::Data& scene, const TargetFrame& frame, double near) {
  std::vector<Vec3> probes{frame.origin};
  double highest = frame.origin.z();
  for (const auto& v : frame.polygon) {
    probes.push_back(frame.to_scene({0.999 * v.x(), 0.999 * v.y(), 0}));
    highest = std::max(highest, probes.back().z());
  }
  for (const Vec3& probe : probes) {
    const VerticalProbe vertical(scene, probe, near);
    if (vertical.anything_below || !std::isfinite(vertical.nearest_above)) return std::nullopt;
  }
  const VerticalProbe first(scene, probes[0], near);
  const Box all = scene.statistics.bounds;
  const std::uint32_t object = scene.polygon_object[first.polygon_above];
  const Box over = object_bounds(scene, object);
  const Vec3 extent = over.max - over.min, whole = all.max - all.min;
  const bool spreads = extent.x() >= 0.5 * whole.x() && extent.y() >= 0.5 * whole.y();
  if (highest >= all.min.z() - near && !spreads) return std::nullopt;
  return Cover{object, first.nearest_above};
}

}  // namespace

std::optional<Warning> buried_note(const PreparedScene::Data& scene, const Target& target, const TargetFrame& frame,
                                   const Lengths& lengths) {
  const std::optional<Cover> cover = cover_over(scene, frame, lengths.lift);
  if (!cover) return std::nullopt;
  const int decimals = HeightStep(lengths).decimals;
  std::string note = core::format(
      "nothing of the scene is below target \"{}\", and \"{}\" is {:.{}f} m above it: if that is the ground, the "
      "target is under it; check the scene's up axis and scale",
      target.name, display_name(scene.objects[cover->object]), cover->height, decimals);
  const auto height = height_over_ground(scene, frame, lengths, cover->object);
  if (height && *height <= numerics::kMostRaise) {
    note += core::format(", or raise the target: {}{:.{}f} clears it", frame.all_sides ? "z = " : "offset: ",
                         *height + (frame.all_sides ? frame.origin.z() : target.offset_m), decimals);
  }
  return Warning{WarningCode::target_underground, std::move(note)};
}

}  // namespace vantage::internal::target
