// PointQuery: the gauge of docs/theory.md along one line, straight from the scene's hierarchy.
#include "vantage/query.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <atomic>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>

#include "core/parallel.h"
#include "core/walk_bvh.h"
#include "exact/blocker.h"
#include "exact/collect.h"
#include "exact/segment_cover.h"
#include "query/blocker_index.h"
#include "query/limits.h"
#include "target/lengths.h"
#include "target/prepared_target_data.h"
#include "target/range_region.h"
#include "vantage/error.h"

namespace vantage {
namespace {

using namespace internal::exact;
using namespace internal::target;
using internal::query::BlockerIndex;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// Squares of larger coordinates may overflow.
constexpr double kSquarable = 1e150;

bool overlap(const internal::core::Bounds& bounds, const Box& box) {
  bool apart = false;
  for (int a = 0; a < 3; ++a) apart = apart || bounds.min[a] > box.max[a] || bounds.max[a] < box.min[a];
  return !apart;
}

/// Calls visit(polygon) for the polygons of the leaves that overlap a box relative to the scene's origin.
template <typename Visit>
void for_each_polygon(const PreparedScene::Data& scene, const Box& box, const Visit& visit) {
  internal::core::walk_bvh(
      scene.bvh, [&](const internal::core::BvhNode& node) { return overlap(node.bounds, box); }, visit);
}

/// Those leaves themselves.
std::vector<std::uint32_t> leaves_in(const PreparedScene::Data& scene, const Box& box) {
  std::vector<std::uint32_t> leaves;
  const auto enter = [&](const internal::core::BvhNode& node) {
    if (!overlap(node.bounds, box)) return false;
    if (node.leaf()) leaves.push_back(static_cast<std::uint32_t>(&node - scene.bvh.nodes.data()));
    return !node.leaf();
  };
  internal::core::walk_bvh(scene.bvh, enter, [](std::uint32_t) {});
  return leaves;
}

/// What blocks from points up to some distance.
struct Reach {
  double metres = kInfinity;            ///< from the target's centre
  std::unique_ptr<BlockerIndex> index;  ///< once it pays
  std::vector<std::uint32_t> leaves;    ///< that the index is to hold; found when it is first thought of
  std::size_t polygons = 0;             ///< in them
  std::atomic<std::size_t> work = 0;    ///< blockers built without the index
};

internal::target::LocalTarget local_target(const PreparedScene::Data& scene, const TargetFrame& frame,
                                           double max_range) {
  const Lengths lengths = lengths_of(scene, frame, max_range);
  return internal::target::make_local_target(frame.polygon, lengths.slack, lengths.rounding);
}

/// What one side of a target asks of the scene; shared by all threads.
struct Side {
  /// `range_region` is about the frame's origin.
  Side(const PreparedScene::Data& scene_data, const internal::query::Limits& navigation,
       const TargetFrame& target_frame, const RangeRegion& range_region, double max_range, bool reachable)
      : scene(scene_data),
        limits(navigation),
        frame(target_frame),
        target(local_target(scene_data, target_frame, max_range)),
        range(range_region),
        is_reachable(reachable) {
    // All that is in range is this near to the centre, which is a mean of the target's vertices.
    reaches[0].metres = range.radius() * (1 + 1e-9);
  }

  const PreparedScene::Data& scene;
  const internal::query::Limits& limits;
  TargetFrame frame;
  internal::target::LocalTarget target;
  RangeRegion range;
  bool is_reachable;  // else no point at all is in range
  std::array<Reach, 2> reaches;

  /// Of all that may hide the target from points within reach. Relative to the scene's origin.
  Box box_within(double metres) const {
    Box box;
    for (const auto& t : target.vertices) box.extend(Vec3(frame.to_scene({t.x(), t.y(), 0}) - scene.origin));
    const double room = metres * (1 + 1e-6) + 1e-6 + 1e-12 * frame.origin.norm();
    box.extend(Vec3(frame.origin - scene.origin - Vec3::Constant(room)));
    box.extend(Vec3(frame.origin - scene.origin + Vec3::Constant(room)));
    return box;
  }
};

/// Which objects of the scene were named for the point that is looked at. One a thread, kept from point to point.
class NamedObjects {
 public:
  void clear(std::size_t object_count) {
    if (stamps_.size() < object_count) stamps_.resize(object_count, 0);
    ++stamp_;
    named_.clear();
  }
  bool has(std::uint32_t object) const { return stamps_[object] == stamp_; }
  void add(std::uint32_t object) {
    if (has(object)) return;
    stamps_[object] = stamp_;
    named_.push_back(object);
  }
  std::size_t count() const { return named_.size(); }
  std::vector<std::string> names(const std::vector<SceneObject>& objects) const {
    std::vector<std::string> result;
    for (const std::uint32_t object : named_) result.push_back(display_name(objects[object]));
    std::sort(result.begin(), result.end());
    result.erase(std::unique(result.begin(), result.end()), result.end());
    return result;
  }

 private:
  std::vector<std::uint64_t> stamps_;
  std::vector<std::uint32_t> named_;
  std::uint64_t stamp_ = 0;
};

/// Looks along one line from the target's centre.
class RayQuery {
 public:
  /// `direction` is local and of unit length. What hides some of the target from the point at `distance` is named.
  RayQuery(Side& side, const Vec3& direction, double distance, NamedObjects& named)
      : side_(side), direction_(direction), distance_(distance), named_(named), gauge_(side.range.gauge(direction)) {
    named_.clear(side.scene.objects.size());
    const double farthest = std::max(distance, 1 / gauge_);
    const Vec3 shift = side.scene.origin;
    pyramid_.extend(Vec3(side.frame.to_scene(direction * farthest) - shift));
    for (const auto& t : side.target.vertices) {
      pyramid_.extend(Vec3(side.frame.to_scene({t.x(), t.y(), 0}) - shift));
    }
    Reach& reach = side.reaches[farthest <= side.reaches[0].metres ? 0 : 1];
    if (reach.index) {
      look_up(*reach.index);
    } else {
      walk(reach);
    }
  }

  /// Inverse of the distance up to which the target is seen.
  double gauge() const { return gauge_; }

 private:
  void walk(Reach& reach) {
    BlockerBuilder builder(side_.target);
    std::vector<Vec3> corners, clipped;
    std::vector<Plane> planes;
    std::size_t work = 0;
    for_each_polygon(side_.scene, pyramid_, [&](std::uint32_t polygon) {
      internal::target::local_polygon(side_.scene, side_.frame, polygon, corners);
      planes.clear();
      clipped.clear();
      ++work;
      if (!builder.build(corners, planes, clipped)) return;
      double least = kInfinity;
      for (const Plane& plane : planes) least = std::min(least, plane.dot(direction_));
      take(least, planes, side_.scene.polygon_object[polygon]);
    });
    reach.work += work;
  }

  void look_up(BlockerIndex& index) {
    index.for_each(direction_, [&](const BlockerIndex::Entry& entry, double bound) {
      const bool can_raise = bound > gauge_;
      if (!can_raise && (!(bound * distance_ > 1) || named_.count() == side_.scene.objects.size())) return false;
      const BlockerIndex::Blocker& blocker = index.blocker(entry.blocker);
      if (!can_raise && named_.has(blocker.object)) return true;
      const auto is_low = [&](double value) { return value <= gauge_ && value * distance_ <= 1; };
      double least = kInfinity;
      if (blocker.plane_count > 0) least = index.plane(entry.plane).dot(direction_);
      for (std::uint32_t p = 0; p < blocker.plane_count && !is_low(least); ++p) {
        least = std::min(least, index.plane(blocker.first_plane + p).dot(direction_));
      }
      if (!is_low(least) && overlap(side_.scene.bvh.nodes[blocker.leaf].bounds, pyramid_)) {
        take(least, index.planes_of(blocker), blocker.object);
      }
      return true;
    });
  }

  /// A blocker that begins at 1 / least along the line. It hides the target from what is behind all of its planes; each
  /// is sure to its own rounding, which of a plane that passes the centre of a thin target within nanometres is wide.
  void take(double least, std::span<const Plane> planes, std::uint32_t object) {
    gauge_ = std::max(gauge_, least);
    if (!(least * distance_ > 1) || named_.has(object)) return;
    const bool hides = std::all_of(planes.begin(), planes.end(), [&](const Plane& plane) {
      return plane.dot(direction_) * distance_ > 1 + tie_margin(plane, distance_);
    });
    if (hides) named_.add(object);
  }

  Side& side_;
  Vec3 direction_;
  double distance_;
  NamedObjects& named_;
  double gauge_;
  Box pyramid_;
};

/// A point as seen from the target's centre.
struct Bearing {
  Vec3 direction = Vec3::Zero();  ///< local, unit length; zero at the centre
  double distance = 0;
  bool in_front = false, in_range = false;
};

Bearing bearing_of(const Side& side, const Vec3& scene_point) {
  const TargetFrame& frame = side.frame;
  const double largest = scene_point.cwiseAbs().maxCoeff();
  if (largest < kSquarable) {
    const Vec3 point = frame.to_local(scene_point);
    const double distance = point.norm();
    return {distance > 0 ? Vec3(point / distance) : Vec3(Vec3::Zero()), distance, point.z() > 0,
            side.is_reachable && side.range.contains(point)};
  }
  // So far away the centre is where the origin is.
  const Vec3 unit = scene_point / largest;
  const Vec3 direction = Vec3(frame.axis_u.dot(unit), frame.axis_v.dot(unit), frame.normal.dot(unit)).normalized();
  return {direction, std::min(unit.norm() * largest, std::numeric_limits<double>::max()), direction.z() > 0, false};
}

PointAnswer look(Side& side, const Vec3& scene_point) {
  thread_local NamedObjects named;
  PointAnswer answer;
  const TargetFrame& frame = side.frame;
  const Bearing bearing = bearing_of(side, scene_point);
  answer.out_of_range = !bearing.in_range;
  answer.behind_target = !frame.all_sides && !bearing.in_front;
  answer.outside_of = side.limits.broken(scene_point);

  // The line goes to the front always: for a point behind the target it is the other half of the line through it.
  const double sign = answer.behind_target ? -1 : 1;
  const Vec3 direction = bearing.distance > 0 ? Vec3(sign * bearing.direction) : Vec3::UnitZ();
  const RayQuery ray(side, direction, answer.behind_target ? 0 : bearing.distance, named);
  answer.blocked_by = named.names(side.scene.objects);
  answer.inside =
      !answer.behind_target && !answer.out_of_range && answer.blocked_by.empty() && answer.outside_of.empty();
  const internal::query::ViewRay line{
      frame.origin, frame.axis_u * direction.x() + frame.axis_v * direction.y() + frame.normal * direction.z(),
      side.is_reachable ? 1 / ray.gauge() : 0};
  answer.margin_m = side.limits.signed_margin(line, sign * bearing.distance, answer.inside);
  return answer;
}

using Sides = std::vector<std::unique_ptr<Side>>;

/// One side; both of a point that is seen from all sides, the front first.
Sides make_sides(const PreparedTarget::Data& target, const PreparedTarget::Data::Part& part,
                 const internal::query::Limits& limits) {
  const PreparedScene::Data& scene = target.scene.data();
  const double max_range = target.sensor.max_range_m;
  Sides result;
  if (part.sides) {
    const PointSides& sides = *part.sides;
    const RangeRegion range(part.frame.polygon, max_range);  // of the point, not of the triangle that stands for it
    result.push_back(std::make_unique<Side>(scene, limits, sides.front, range, max_range, true));
    if (sides.back) result.push_back(std::make_unique<Side>(scene, limits, *sides.back, range, max_range, true));
    return result;
  }
  // Where no point at all is in range the centre may be out of range itself: look from the circle's centre, as the
  // engine does.
  const RangeRegion range(part.frame.polygon, part.is_reachable ? max_range : 2 * part.frame.enclosing_radius_m);
  result.push_back(std::make_unique<Side>(scene, limits, part.frame, range, max_range, part.is_reachable));
  return result;
}

/// The index is made as soon as building blockers for single points has cost as much: so no one who asks about a few
/// points waits for it, and no one pays much more than the cheaper of the two.
void consider_index(const Side& side, Reach& reach) {
  constexpr std::size_t kLittle = 1000;  // blockers, about a millisecond
  if (reach.index || reach.work < kLittle) return;
  if (reach.leaves.empty()) {
    reach.leaves = leaves_in(side.scene, side.box_within(reach.metres));
    for (const std::uint32_t leaf : reach.leaves) reach.polygons += side.scene.bvh.nodes[leaf].count;
  }
  if (reach.work < reach.polygons) return;
  reach.index = std::make_unique<BlockerIndex>(side.scene, side.frame, side.target, reach.leaves, reach.metres);
}

void look_from_all(const Sides& sides, std::span<const Vec3> points, std::span<PointAnswer> answers) {
  // Portions that grow, as what the first ones cost decides about the index.
  for (std::size_t done = 0, portion = 16; done < points.size(); done += portion, portion *= 2) {
    const std::size_t count = std::min(portion, points.size() - done);
    internal::parallel::for_ranges(count, 64, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = done + begin; i < done + end; ++i) {
        const bool is_behind = sides.size() > 1 && sides[0]->frame.to_local(points[i]).z() < 0;
        answers[i] = look(*sides[is_behind ? 1 : 0], points[i]);
      }
    });
    for (const auto& side : sides) {
      for (Reach& reach : side->reaches) consider_index(*side, reach);
    }
  }
}

/// The whole target is seen where all its parts are.
void narrow(PointAnswer& answer, const PointAnswer& other) {
  answer.inside = answer.inside && other.inside;
  answer.margin_m = std::min(answer.margin_m, other.margin_m);
  std::vector<std::string> blockers;
  std::set_union(answer.blocked_by.begin(), answer.blocked_by.end(), other.blocked_by.begin(), other.blocked_by.end(),
                 std::back_inserter(blockers));
  answer.blocked_by = std::move(blockers);
  answer.out_of_range = answer.out_of_range || other.out_of_range;
  answer.behind_target = answer.behind_target || other.behind_target;
}

}  // namespace

struct PointQuery::Data {
  PreparedTarget target;
  internal::query::Limits limits;
  std::vector<Sides> parts;
};

PointQuery::PointQuery(const PreparedTarget& target, const Navigation& navigation)
    : data_(std::make_unique<Data>(Data{target, internal::query::Limits(navigation), {}})) {
  const PreparedTarget::Data& prepared = data_->target.data();
  for (const PreparedTarget::Data::Part& part : prepared.parts) {
    data_->parts.push_back(make_sides(prepared, part, data_->limits));
  }
}
PointQuery::~PointQuery() = default;
PointQuery::PointQuery(PointQuery&&) noexcept = default;
PointQuery& PointQuery::operator=(PointQuery&&) noexcept = default;

std::vector<PointAnswer> PointQuery::answer(std::span<const Vec3> points) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points[i].allFinite()) continue;
    throw Error(ErrorCode::coordinate_not_finite, "a coordinate is not finite", "point " + std::to_string(i),
                "give three numbers");
  }
  std::vector<PointAnswer> answers(points.size()), of_part;
  for (std::size_t part = 0; part < data_->parts.size(); ++part) {
    if (part == 0) {
      look_from_all(data_->parts[0], points, answers);
      continue;
    }
    of_part.resize(points.size());
    look_from_all(data_->parts[part], points, of_part);
    for (std::size_t i = 0; i < points.size(); ++i) narrow(answers[i], of_part[i]);
  }
  return answers;
}

std::vector<PointAnswer> query_points(const PreparedTarget& target, const Navigation& navigation,
                                      const std::vector<Vec3>& points) {
  return PointQuery(target, navigation).answer(points);
}

}  // namespace vantage
