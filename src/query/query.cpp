// query_points: the gauge of docs/theory.md along one line, straight from the scene's hierarchy.
#include "vantage/query.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <set>

#include "exact/blocker.h"
#include "exact/collect.h"
#include "exact/lengths.h"
#include "exact/point_target.h"
#include "exact/range_check.h"
#include "exact/range_region.h"
#include "exact/segment_cover.h"
#include "exact/target_check.h"
#include "parallel/parallel.h"
#include "query/limits.h"
#include "vantage/error.h"

namespace vantage {
namespace {

using namespace exact;

/// Finds what stands between a point and the target; one a thread.
class LineOfSight {
 public:
  LineOfSight(const PreparedScene::Data& scene, const TargetFrame& frame, const LocalTarget& target)
      : scene_(scene), frame_(frame), target_(target), builder_(target) {}

  /// Blocker planes of every polygon that may hide part of the target from a point between the centre and `apex`
  /// (local). `visit` gets the polygon and its planes.
  template <typename Visit>
  void for_each(const Vec3& apex, const Visit& visit) {
    Box pyramid;
    const Vec3 shift = scene_.origin;
    pyramid.extend(Vec3(frame_.to_scene(apex) - shift));
    for (const auto& t : target_.vertices) pyramid.extend(Vec3(frame_.to_scene({t.x(), t.y(), 0}) - shift));
    stack_.assign(scene_.bvh.nodes.empty() ? 0 : 1, 0);
    while (!stack_.empty()) {
      const scene::BvhNode& node = scene_.bvh.nodes[stack_.back()];
      stack_.pop_back();
      bool apart = false;
      for (int a = 0; a < 3; ++a)
        apart = apart || node.bounds.min[a] > pyramid.max[a] || node.bounds.max[a] < pyramid.min[a];
      if (apart) continue;
      if (!node.leaf()) {
        stack_.push_back(node.first + 1);
        stack_.push_back(node.first);
        continue;
      }
      for (std::uint32_t polygon = node.first; polygon < node.first + node.count; ++polygon) {
        local_polygon(scene_, frame_, polygon, corners_);
        planes_.clear();
        clipped_.clear();
        if (builder_.build(corners_, planes_, clipped_)) visit(polygon, planes_);
      }
    }
  }

 private:
  const PreparedScene::Data& scene_;
  const TargetFrame& frame_;
  const LocalTarget& target_;
  BlockerBuilder builder_;
  std::vector<std::uint32_t> stack_;
  std::vector<Vec3> corners_, clipped_;
  std::vector<Plane> planes_;
};

/// What one side of a target asks of the scene; shared by all threads.
struct Question {
  const PreparedScene::Data& scene;
  const Navigation& navigation;
  TargetFrame frame;
  LocalTarget target;
  RangeRegion range;
  bool is_reachable;  // else no point at all is in range
};

/// Inverse of the distance up to which the target is seen along `direction` (local). Adds to `names` what hides some of
/// it from the point at `distance`.
double gauge_along(const Question& question, LineOfSight& sight, const Vec3& direction, double distance,
                   std::set<std::string>& names) {
  double gauge = question.range.gauge(direction);
  const PreparedScene::Data& scene = question.scene;
  sight.for_each(direction * std::max(distance, 1 / gauge),
                 [&](std::uint32_t polygon, const std::vector<Plane>& planes) {
                   double least = std::numeric_limits<double>::infinity(), margin = 0;
                   for (const Plane& plane : planes) {
                     least = std::min(least, plane.dot(direction));
                     margin = std::max(margin, tie_margin(plane, distance));
                   }
                   gauge = std::max(gauge, least);
                   if (least * distance > 1 + margin) names.insert(scene.objects[scene.polygon_object[polygon]]);
                 });
  return gauge;
}

PointAnswer look(const Question& question, LineOfSight& sight, const Vec3& scene_point) {
  PointAnswer answer;
  const TargetFrame& frame = question.frame;
  const Vec3 point = frame.to_local(scene_point);
  const double distance = point.norm();
  answer.out_of_range = !question.is_reachable || !question.range.contains(point);
  answer.behind_target = !frame.all_sides && point.z() <= 0;
  answer.outside_of = query::limits_broken(question.navigation, scene_point);

  // The line goes to the front always: for a point behind the target it is the other half of the line through it.
  const double side = answer.behind_target ? -1 : 1;
  const Vec3 direction = distance > 0 ? Vec3(side * point / distance) : Vec3::UnitZ();
  std::set<std::string> names;
  const double gauge = gauge_along(question, sight, direction, answer.behind_target ? 0 : distance, names);
  answer.blocked_by.assign(names.begin(), names.end());
  answer.inside =
      !answer.behind_target && !answer.out_of_range && answer.blocked_by.empty() && answer.outside_of.empty();
  const query::SightLine line{
      frame.origin, frame.axis_u * direction.x() + frame.axis_v * direction.y() + frame.normal * direction.z(),
      question.is_reachable ? 1 / gauge : 0};
  answer.margin_m = query::signed_margin(question.navigation, line, side * distance, answer.inside);
  return answer;
}

/// One side; both of a point that is seen from all sides, the front first.
std::vector<Question> make_questions(const PreparedScene::Data& scene, const Target& target, double max_range,
                                     const Navigation& navigation) {
  TargetFrame frame = make_target_frame(target);
  const auto local_target = [&](const TargetFrame& f) {
    const Lengths lengths = lengths_of(scene, f, max_range);
    return make_local_target(f.polygon, lengths.slack, lengths.rounding);
  };
  std::vector<Question> questions;
  if (target.is_point()) {
    const PointSides sides = make_point_sides(scene, target, frame, max_range);
    const RangeRegion range(frame.polygon, max_range);
    questions.push_back({scene, navigation, sides.front, local_target(sides.front), range, true});
    if (sides.back) questions.push_back({scene, navigation, *sides.back, local_target(*sides.back), range, true});
    return questions;
  }
  frame.origin += frame.normal * clear_target(scene, target, frame, max_range).lift_m;
  // Where no point at all is in range the centre may be out of range itself: look from the circle's centre, as the
  // engine does.
  const bool reachable = can_reach(frame, {max_range});
  if (reachable) move_into_range(frame, max_range);
  const RangeRegion range(frame.polygon, reachable ? max_range : 2 * frame.enclosing_radius_m);
  questions.push_back({scene, navigation, frame, local_target(frame), range, reachable});
  return questions;
}

}  // namespace

std::vector<PointAnswer> query_points(const PreparedScene& scene, const Target& target, const Sensor& sensor,
                                      const Navigation& navigation, const std::vector<Vec3>& points) {
  check_sensor(sensor);
  for (std::size_t i = 0; i < points.size(); ++i)
    if (!points[i].allFinite())
      throw Error(ErrorKind::input, "a coordinate is not finite", "point " + std::to_string(i), "give three numbers");
  const std::vector<Question> sides = make_questions(scene.data(), target, sensor.max_range_m, navigation);
  std::vector<PointAnswer> answers(points.size());
  parallel::for_ranges(points.size(), 64, [&](std::size_t begin, std::size_t end) {
    std::vector<LineOfSight> sights;
    for (const Question& side : sides) sights.emplace_back(scene.data(), side.frame, side.target);
    for (std::size_t i = begin; i < end; ++i) {
      const std::size_t side = sides.size() > 1 && sides[0].frame.to_local(points[i]).z() < 0 ? 1 : 0;
      answers[i] = look(sides[side], sights[side], points[i]);
    }
  });
  return answers;
}
}  // namespace vantage
