#include <algorithm>
#include <cmath>
#include <utility>

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

}  // namespace

PreparedTarget::PreparedTarget(const PreparedScene& scene, const Target& target, const Sensor& sensor) {
  check_sensor(sensor);
  const bool needs_normal = sensor.incidence_deg || (sensor.pixel && sensor.pixel->kind == PixelLimit::Kind::worst);
  if (needs_normal && target.is_point() && !target.front) {
    throw Error(ErrorCode::not_applicable, "a point that is seen from all sides has no normal to measure angles from",
                "sensor", "leave out incidence and a pixel of kind worst, or give the target a front");
  }
  auto data = std::make_shared<Data>(Data{scene, target, sensor, {}, {}});
  if (target.parts.empty()) make_target_frame(target);  // throws
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

}  // namespace vantage
