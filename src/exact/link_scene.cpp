#include "exact/link_scene.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/bounds_distance.h"
#include "core/walk_bvh.h"
#include "exact/blocker.h"
#include "exact/direction_tree.h"
#include "target/fresnel_zone.h"
#include "target/lengths.h"
#include "target/local_target.h"
#include "target/point_target.h"
#include "target/prepared_target_data.h"

namespace vantage::internal::exact {
namespace {

double farthest_in(const core::Bounds& bounds, const Vec3& point) {
  double sum = 0;
  for (int a = 0; a < 3; ++a) {
    const double d = std::max(point[a] - bounds.min[a], bounds.max[a] - point[a]);
    sum += d * d;
  }
  return std::sqrt(sum);
}

void append(const std::vector<Vec3>& polygon, std::uint32_t object, Scene& scene) {
  const auto first = static_cast<std::uint32_t>(scene.mesh.vertices.size());
  scene.mesh.vertices.insert(scene.mesh.vertices.end(), polygon.begin(), polygon.end());
  for (std::uint32_t i = 2; i < polygon.size(); ++i) {
    scene.mesh.triangles.push_back({first, first + i - 1, first + i});
    scene.object_of.push_back(object);
  }
}

/// What is hidden behind polygons that were found before. These are not grown: what a polygon hides, its grown pieces
/// hide too, or what hid them. So nothing is left out that is seen (docs/theory.md, "Only what is seen can hide").
class Hidden {
 public:
  Hidden(const TargetFrame& frame, const target::RangeRegion& range, const target::Lengths& lengths)
      : target_(target::make_local_target(frame.polygon, lengths.slack, lengths.rounding)),
        builder_(target_),
        tree_(blockers_, range) {
    for (int a = 0; a < 3; ++a) axes_[a] = {frame.axis_u[a], frame.axis_v[a], frame.normal[a]};
  }

  /// Whether all of a box about the antenna, grown by `radius`, is hidden, or behind the antenna.
  bool hides_box(const Vec3& low, const Vec3& high, double radius) const {
    Vec3 middle = Vec3::Zero();
    std::array<Vec3, 3> half;
    double above = 0;
    for (int a = 0; a < 3; ++a) {
      middle += axes_[a] * (0.5 * (low[a] + high[a]));
      half[a] = axes_[a] * (0.5 * (high[a] - low[a]) + radius);
      above += std::abs(half[a].z());
    }
    return middle.z() + above <= target_.slack || tree_.hides_box(middle, half);
  }

  /// Whether the convex hull of points about the antenna is hidden, or behind the antenna.
  bool hides_hull(const std::vector<Vec3>& points) {
    to_local(points);
    const bool is_behind = std::all_of(local_.begin(), local_.end(), [&](const Vec3& p) { return p.z() <= 0; });
    return is_behind || tree_.hides_hull(local_);
  }

  void add(const std::vector<Vec3>& polygon) {
    to_local(polygon);
    if (!builder_.build(local_, blockers_.planes, blockers_.corners)) return;
    if (blockers_.planes.size() == blockers_.first.back()) {  // it hides everything; the engine will say so
      blockers_.corners.resize(blockers_.first_corner.back());
      return;
    }
    blockers_.close(0);
    if (!tree_.insert(static_cast<std::uint32_t>(blockers_.count() - 1))) blockers_.drop_last();
  }

 private:
  void to_local(const std::vector<Vec3>& points) {
    local_.clear();
    for (const Vec3& p : points) local_.push_back(axes_[0] * p.x() + axes_[1] * p.y() + axes_[2] * p.z());
  }

  target::LocalTarget target_;
  BlockerBuilder builder_;
  BlockerSet blockers_;
  DirectionTree tree_;
  std::array<Vec3, 3> axes_;  // the scene's, in the target's frame
  std::vector<Vec3> local_;
};

}  // namespace

LinkScene::LinkScene(const PreparedTarget& target, const target::RangeRegion& range)
    : scene_(target.scene()),
      range_(range),
      antenna_(target.frame().origin - scene_.data().origin),
      radius_(target::zone_excess_m(*target.sensor().link), range.radius()),
      clear_(4 * target::kPointRadius * std::min(1.0, range.radius() / 20)) {}

std::vector<Vec3> LinkScene::corners_of(std::uint32_t polygon) const {
  const PreparedScene::Data& data = scene_.data();
  std::vector<Vec3> corners;
  for (const std::uint32_t vertex : data.corners_of(polygon)) corners.push_back(data.vertices[vertex] - antenna_);
  return corners;
}

std::optional<std::uint32_t> LinkScene::polygon_at_antenna() const {
  // A piece that all but holds the antenna is no farther than 1.45 sqrt(2 e d) and `clear`.
  const double near = 8 * radius_.excess() + 10 * clear_;
  std::optional<std::uint32_t> found;
  ZonePieces pieces(radius_, clear_);
  core::walk_bvh(
      scene_.data().bvh, [&](const core::BvhNode& node) { return core::distance_to(node.bounds, antenna_) <= near; },
      [&](std::uint32_t polygon) {
        if (!pieces.for_each(corners_of(polygon), [](const GrownPiece&) {})) found = polygon;
        return !found;
      });
  return found;
}

LinkScene::Grown LinkScene::grow(const TargetFrame& frame, const core::ProgressReporter& progress) const {
  const PreparedScene::Data& data = scene_.data();
  Grown grown;
  Hidden hidden(frame, range_, target::lengths_of(data, frame, range_.radius()));
  ZonePieces pieces(radius_, clear_);
  std::size_t steps = 0;
  const auto may_show = [&](const core::BvhNode& node, double distance) {
    if (++steps % 1024 == 0) progress.check();
    if (distance > radius_.reach()) return false;
    if (data.bvh.is_above_groups(node)) return true;
    Vec3 low, high;
    for (int a = 0; a < 3; ++a) {
      low[a] = node.bounds.min[a] - antenna_[a];
      high[a] = node.bounds.max[a] - antenna_[a];
    }
    const double radius = radius_.largest(distance, std::min(farthest_in(node.bounds, antenna_), radius_.reach()));
    return !hidden.hides_box(low, high, radius);
  };
  const auto add = [&](std::uint32_t polygon) {
    std::vector<Vec3> corners = corners_of(polygon);
    const auto object = static_cast<std::uint32_t>(grown.polygon_of.size());
    bool is_shown = false;
    pieces.for_each(corners, [&](const GrownPiece& piece) {
      if (++steps % 64 == 0) progress.check();
      if (hidden.hides_hull(piece.hull)) return;
      is_shown = true;
      for (const std::vector<Vec3>& surface : piece.surfaces) append(surface, object, grown.scene);
    });
    if (is_shown) grown.polygon_of.push_back(polygon);
    hidden.add(corners);
  };
  const auto distance = [&](const core::Bounds& bounds) { return core::distance_to(bounds, antenna_); };
  core::walk_nearest_first(data.bvh, distance, radius_.reach(), may_show, add);
  for (std::size_t i = 0; i < grown.polygon_of.size(); ++i) grown.scene.objects.push_back({});
  return grown;
}

/// An object of the grown scene is a polygon of the original one.
void LinkScene::name_originals(const Grown& grown, HalfSpaceVolume& side) const {
  constexpr std::uint32_t kNone = ~0u;
  std::vector<std::uint32_t> of_object(scene_.objects().size(), kNone), renamed;
  std::vector<Cause> causes;
  for (const Cause& cause : side.causes) {
    if (cause.kind != CauseKind::scene) {
      renamed.push_back(static_cast<std::uint32_t>(causes.size()));
      causes.push_back(cause);
      continue;
    }
    const std::uint32_t object = scene_.data().polygon_object[grown.polygon_of[*cause.object]];
    if (of_object[object] == kNone) {
      of_object[object] = static_cast<std::uint32_t>(causes.size());
      causes.push_back(cause_of_object(object, scene_.objects()[object]));
    }
    renamed.push_back(of_object[object]);
    causes[of_object[object]].area_m2 += cause.area_m2;
  }
  for (std::size_t i = 0; i < side.cause_of.size(); ++i) {
    const Cause& cause = side.causes[side.cause_of[i]];
    if (cause.kind == CauseKind::scene) side.polygon_of[i] = grown.polygon_of[*cause.object];
    side.cause_of[i] = renamed[side.cause_of[i]];
  }
  side.causes = std::move(causes);
}

HalfSpaceVolume LinkScene::compute_half_space(const TargetFrame& frame, const ExactOptions& options,
                                              const core::ProgressReporter& progress) const {
  progress.begin("growing the scene");
  Grown grown = grow(frame, progress);
  progress.begin("preparing the grown scene");
  const PreparedScene prepared(grown.scene);
  TargetFrame about_antenna = frame;
  about_antenna.origin = Vec3::Zero();
  HalfSpaceVolume side = exact::compute_half_space(prepared, about_antenna, range_, options, progress);
  name_originals(grown, side);
  side.counts.scene_polygons = scene_.data().polygon_count();
  return side;
}

}  // namespace vantage::internal::exact
