// PointQuery: the gauge of docs/theory.md along one line, straight from the scene's hierarchy.
#include "vantage/query.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>

#include "exact/blocker.h"
#include "query/point_query_data.h"

namespace vantage {
namespace {

using internal::core::Plane;
using internal::exact::BlockerBuilder;
using internal::query::Bearing;
using internal::query::BlockerIndex;
using internal::query::Reach;
using internal::query::Side;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

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
    pyramid_ = side.pyramid(direction, farthest);
    Reach& reach = side.reach_for(farthest);
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
    internal::query::for_each_polygon(side_.scene, pyramid_, [&](std::uint32_t polygon) {
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
      if (!is_low(least) && internal::query::overlap(side_.scene.bvh.nodes[blocker.leaf].bounds, pyramid_)) {
        take(least, index.planes_of(blocker), blocker.object);
      }
      return true;
    });
  }

  /// A blocker that begins at 1 / least along the line.
  void take(double least, std::span<const Plane> planes, std::uint32_t object) {
    gauge_ = std::max(gauge_, least);
    if (!(least * distance_ > 1) || named_.has(object)) return;
    if (internal::query::hides(planes, direction_, distance_)) named_.add(object);
  }

  Side& side_;
  Vec3 direction_;
  double distance_;
  NamedObjects& named_;
  double gauge_;
  Box pyramid_;
};

/// How far a line of sight reaches, and what is in the way of the point on it.
double look_along(Side& side, const Vec3& direction, double distance, const Vec3& scene_direction,
                  NamedObjects& named) {
  if (!side.link) return 1 / RayQuery(side, direction, distance, named).gauge();
  named.clear(side.scene.objects.size());
  side.link->for_each_entering(scene_direction, distance, [&](std::uint32_t object) { named.add(object); });
  return side.link->reach(scene_direction, 1 / side.range.gauge(direction));
}

PointAnswer look(Side& side, const Vec3& scene_point) {
  thread_local NamedObjects named;
  PointAnswer answer;
  const TargetFrame& frame = side.frame;
  const Bearing bearing = side.bearing_of(scene_point);
  answer.out_of_range = !bearing.in_range;
  answer.behind_target = side.is_behind(bearing);
  answer.outside_of = side.limits.broken(scene_point);

  // The line goes to the front always: for a point behind the target it is the other half of the line through it.
  const double sign = answer.behind_target ? -1 : 1;
  const Vec3 direction = bearing.distance > 0 ? Vec3(sign * bearing.direction) : Vec3::UnitZ();
  const Vec3 towards = frame.axis_u * direction.x() + frame.axis_v * direction.y() + frame.normal * direction.z();
  const double reach = look_along(side, direction, answer.behind_target ? 0 : bearing.distance, towards, named);
  answer.blocked_by = named.names(side.scene.objects);
  answer.inside =
      !answer.behind_target && !answer.out_of_range && answer.blocked_by.empty() && answer.outside_of.empty();
  const internal::query::ViewRay line{frame.origin, towards, side.is_reachable ? reach : 0};
  answer.margin_m = side.limits.signed_margin(line, sign * bearing.distance, answer.inside);
  return answer;
}

void answer_all(const internal::query::Sides& sides, std::span<const Vec3> points, std::span<PointAnswer> answers) {
  internal::query::look_from_all(sides, points, [&](Side& side, std::size_t i) { answers[i] = look(side, points[i]); });
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

/// What hides the target counts only where less than the share is seen.
void take_share(PointQuery& query, double share, std::span<const Vec3> points, std::span<PointAnswer> answers) {
  std::vector<std::size_t> hidden;
  std::vector<Vec3> places;
  for (std::size_t i = 0; i < points.size(); ++i) {
    answers[i].margin_m = std::numeric_limits<double>::quiet_NaN();
    if (answers[i].blocked_by.empty()) continue;
    hidden.push_back(i);
    places.push_back(points[i]);
  }
  const std::vector<PointFraction> fractions = query.fractions(places);
  for (std::size_t k = 0; k < hidden.size(); ++k) {
    if (!(fractions[k].fraction >= share)) continue;
    PointAnswer& answer = answers[hidden[k]];
    answer.blocked_by.clear();
    answer.inside = !answer.behind_target && !answer.out_of_range && answer.outside_of.empty();
  }
}

}  // namespace

PointQuery::PointQuery(std::unique_ptr<Data> data) : data_(std::move(data)) {}

PointQuery PointQuery::unchecked(const PreparedTarget& target, const Navigation& navigation) {
  auto data = std::make_unique<Data>(Data{target, internal::query::Limits(navigation, target), {}});
  const PreparedTarget::Data& prepared = data->target.data();
  for (const PreparedTarget::Data::Part& part : prepared.parts) {
    data->parts.push_back(internal::query::make_sides(prepared, part, data->limits));
  }
  return PointQuery(std::move(data));
}

PointQuery::PointQuery(const PreparedTarget& target, const Navigation& navigation) {
  check_navigation(navigation);
  *this = unchecked(target, navigation);
}
PointQuery::~PointQuery() = default;
PointQuery::PointQuery(PointQuery&&) noexcept = default;
PointQuery& PointQuery::operator=(PointQuery&&) noexcept = default;

std::vector<PointAnswer> PointQuery::answer(std::span<const Vec3> points) {
  internal::query::check_finite(points);
  std::vector<PointAnswer> answers(points.size()), of_part;
  for (std::size_t part = 0; part < data_->parts.size(); ++part) {
    if (part == 0) {
      answer_all(data_->parts[0], points, answers);
      continue;
    }
    of_part.resize(points.size());
    answer_all(data_->parts[part], points, of_part);
    for (std::size_t i = 0; i < points.size(); ++i) narrow(answers[i], of_part[i]);
  }
  const std::optional<VisibleShare>& visible = data_->target.sensor().visible;
  if (visible && visible->share < 1) take_share(*this, visible->share, points, answers);
  return answers;
}

std::vector<PointAnswer> query_points(const PreparedTarget& target, const Navigation& navigation,
                                      const std::vector<Vec3>& points) {
  return PointQuery(target, navigation).answer(points);
}

}  // namespace vantage
