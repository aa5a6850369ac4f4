#include <algorithm>
#include <cmath>
#include <utility>

#include "core/enclosing_circle.h"
#include "target/equal_cells.h"
#include "target/prepared_target_data.h"
#include "target/range_check.h"
#include "target/range_region.h"
#include "target/target_check.h"
#include "vantage/error.h"

namespace vantage {
namespace {

using Part = PreparedTarget::Data::Part;

Part prepare(const PreparedScene::Data& scene, const Target& target, const Sensor& sensor,
             std::vector<Warning>& notes) {
  Part part;
  part.given = part.frame = make_target_frame(target);
  std::vector<Warning> own;
  if (target.is_point()) {
    part.sides = internal::target::make_point_sides(scene, target, part.frame, range_limit_m(sensor));
    part.lift_m = part.sides->lift;
    own = part.sides->notes;
    part.frame.origin = part.sides->front.origin;
    part.is_reachable = true;
  } else {
    internal::target::Clearance clearance =
        internal::target::clear_target(scene, target, part.frame, range_limit_m(sensor));
    part.lift_m = clearance.lift_m;
    own = std::move(clearance.notes);
    part.frame.origin += part.frame.normal * part.lift_m;
    part.is_reachable = internal::target::can_reach(part.frame, sensor);
    if (part.is_reachable) internal::target::move_into_range(part.frame, range_limit_m(sensor));
  }
  for (Warning& note : own) {
    if (std::find(notes.begin(), notes.end(), note) == notes.end()) notes.push_back(std::move(note));
  }
  return part;
}

/// A frame in the same plane about the middle of a cell. What rounding does to its place in the scene is taken out of
/// its coordinates, so that cells that touch still touch.
TargetFrame cell_frame(const TargetFrame& whole, const std::vector<Eigen::Vector2d>& polygon) {
  TargetFrame frame = whole;
  const auto circle = internal::core::smallest_enclosing_circle(polygon);
  const Eigen::Vector2d centre = 0.5 * (circle.centre + internal::core::centroid(polygon));
  frame.origin = whole.to_scene({centre.x(), centre.y(), 0});
  const Eigen::Vector2d moved = whole.to_local(frame.origin).head<2>();
  frame.polygon = polygon;
  for (Eigen::Vector2d& p : frame.polygon) p -= moved;
  frame.enclosing_radius_m = circle.radius;
  return frame;
}

Part cell_part(const Part& whole, const std::vector<Eigen::Vector2d>& polygon, const Sensor& sensor) {
  Part part;
  part.frame = cell_frame(whole.frame, polygon);
  part.given = part.frame;
  part.given.origin -= part.frame.normal * whole.lift_m;
  part.lift_m = whole.lift_m;
  part.is_reachable = internal::target::can_reach(part.frame, sensor);
  if (part.is_reachable) internal::target::move_into_range(part.frame, range_limit_m(sensor));
  return part;
}

}  // namespace

PreparedTarget::PreparedTarget(const PreparedScene& scene, const Target& target, const Sensor& sensor) {
  if (target.is_volume() || target.parts.empty()) make_target_frame(target);  // throws
  check_sensor(sensor);
  const bool needs_normal = sensor.incidence_deg || (sensor.pixel && sensor.pixel->kind == PixelLimit::Kind::worst);
  if (needs_normal && target.is_point() && !target.front) {
    throw Error(ErrorCode::not_applicable, "a point that is seen from all sides has no normal to measure angles from",
                "sensor", "leave out incidence and a pixel of kind worst, or give the target a front");
  }
  if (sensor.link && !target.is_point()) {
    throw Error(ErrorCode::not_applicable, "a radio link ends in an antenna, and the target is no point", "sensor.link",
                "give the antenna's place as a target of one point, or leave out the link");
  }
  if (sensor.visible && target.is_point()) {
    throw Error(ErrorCode::not_applicable, "a point has no area of which a part could be seen", "sensor.visible",
                "leave 'visible' out, or give the target a polygon");
  }
  auto data = std::make_shared<Data>(Data{scene, target, sensor, {}, {}});
  for (std::size_t i = 0; i < target.parts.size(); ++i) {
    if (target.parts.size() > 1) make_target_frame(target, i);  // a point among parts
    data->parts.push_back(prepare(scene.data(), target.part(i), sensor, data->notes));
  }
  data_ = std::move(data);
}

const PreparedScene& PreparedTarget::scene() const { return data_->scene; }
const Target& PreparedTarget::target() const { return data_->target; }
const Sensor& PreparedTarget::sensor() const { return data_->sensor; }
std::size_t PreparedTarget::part_count() const { return data_->parts.size(); }
const TargetFrame& PreparedTarget::frame(std::size_t part) const { return data_->parts.at(part).frame; }
double PreparedTarget::lift_m(std::size_t part) const { return data_->parts.at(part).lift_m; }
const std::vector<Warning>& PreparedTarget::notes() const { return data_->notes; }

double PreparedTarget::lift_m() const {
  double most = 0;
  for (const Data::Part& part : data_->parts) most = std::max(most, part.lift_m);
  return most;
}

PreparedTarget PreparedTarget::part(std::size_t index) const {
  if (index == 0 && part_count() == 1) return *this;
  return PreparedTarget(std::make_shared<const Data>(
      Data{data_->scene, data_->target.part(index), data_->sensor, {data_->parts.at(index)}, data_->notes}));
}

std::vector<PreparedTarget> PreparedTarget::cells(std::size_t part, std::size_t count, double max_range_m) const {
  if (data_->target.is_point()) {
    throw Error(ErrorCode::not_applicable, "a point has no cells", "target \"" + data_->target.name + "\"",
                "give the target a polygon");
  }
  const Part& whole = data_->parts.at(part);
  Sensor sensor;
  sensor.max_range_m = max_range_m;
  check_sensor(sensor);
  std::vector<PreparedTarget> result;
  for (const auto& polygon : internal::target::equal_cells(whole.frame.polygon, count)) {
    Part cell = cell_part(whole, polygon, sensor);
    Target target;
    target.name = data_->target.name + ", cell " + std::to_string(result.size() + 1);
    target.front_by_order = true;
    for (const auto& p : cell.given.polygon) target.parts[0].push_back(cell.given.to_scene({p.x(), p.y(), 0}));
    result.push_back(PreparedTarget(
        std::make_shared<const Data>(Data{data_->scene, std::move(target), sensor, {std::move(cell)}, {}})));
  }
  return result;
}

PreparedTarget PreparedTarget::alone() const {
  return PreparedTarget(std::make_shared<const Data>(
      Data{PreparedScene(Scene()), data_->target, data_->sensor, data_->parts, data_->notes}));
}

}  // namespace vantage
