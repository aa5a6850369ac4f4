#include "flight/plans/point_details.h"

#include <cmath>
#include <set>

#include "common/input.h"
#include "core/text.h"
#include "flight/plans/text_lines.h"

namespace vantage::internal::flight::plans {
namespace {

constexpr int kDecimals = 3;

bool is_same_place(const PlanPosition& a, const PlanPosition& b) {
  constexpr double kSameDeg = 1e-9, kSameM = 1e-4;
  const bool is_same_height =
      std::isnan(a.height_m) ? std::isnan(b.height_m) : std::abs(a.height_m - b.height_m) < kSameM;
  const double across_deg = std::remainder(a.horizontal.x() - b.horizontal.x(), 360);  // 180 is -180
  return is_same_height && std::abs(across_deg) < kSameDeg && std::abs(a.horizontal.y() - b.horizontal.y()) < kSameDeg;
}

/// `stated`: whether it was said before.
void refuse_second(std::string_view name, double value, bool stated, double before, const PlanItem& item) {
  if (!stated || before == value) return;
  PlanSource::fail_at(ErrorCode::conflicting_keys, item.place,
                      in_quotes(name) + " is given twice: " + shortest(before) + " and " + shortest(value),
                      "keep one of them");
}

bool is_known(std::string_view name) {
  return name == "hold_s" || name == "speed_m_s" || name == "yaw_deg" || name == "gimbal_pitch_deg";
}

}  // namespace

std::vector<std::pair<const char*, std::string>> details_of(const OutPoint& point) {
  std::vector<std::pair<const char*, std::string>> details;
  const CameraAngles angles = camera_angles(point);
  if (point.hold_s > 0) details.emplace_back("hold_s", hold_text(point.hold_s));
  if (!std::isnan(point.speed_m_s)) details.emplace_back("speed_m_s", decimal(point.speed_m_s, kDecimals));
  if (angles.yaw_deg) details.emplace_back("yaw_deg", decimal(*angles.yaw_deg, kDecimals));
  if (angles.pitch_deg) details.emplace_back("gimbal_pitch_deg", decimal(*angles.pitch_deg, kDecimals));
  if (point.action.photo) details.emplace_back("photo", "1");
  if (point.action.video) details.emplace_back("video", "1");
  if (!point.action.sees.empty()) details.emplace_back("sees", point.action.sees);
  return details;
}

void set_detail(std::string_view name, double value, PlanItem& item, std::size_t* number) {
  if (name == "hold_s") {
    refuse_second(name, value, item.hold_s != 0, item.hold_s, item);
    item.hold_s = value;
  }
  if (name == "speed_m_s") {
    refuse_second(name, value, !std::isnan(item.speed_m_s), item.speed_m_s, item);
    item.speed_m_s = value;
  }
  if (name == "yaw_deg") {
    refuse_second(name, value, item.yaw_deg.has_value(), item.yaw_deg.value_or(0), item);
    item.yaw_deg = value;
  }
  if (name == "gimbal_pitch_deg") {
    refuse_second(name, value, item.gimbal_pitch_deg.has_value(), item.gimbal_pitch_deg.value_or(0), item);
    item.gimbal_pitch_deg = value;
  }
  const bool is_number = value >= 1 && value <= static_cast<double>(kMostPlanItems) && value == std::floor(value);
  if (name == "point" && number && is_number) *number = static_cast<std::size_t>(value);
}

void set_detail(std::string_view name, std::string_view text, PlanItem& item, std::size_t* number) {
  text = without_blanks(text);
  if (text.empty()) return;
  const ParsedNumber parsed = parse_number(text);
  if (parsed.fault == NumberFault::none) return set_detail(name, parsed.value, item, number);
  if (!is_known(name)) return;
  PlanSource::fail_at(ErrorCode::not_a_number, item.place, in_quotes(name) + " is not a number: " + in_quotes(text),
                      number_advice(text, parsed.fault));
}

void take_details(DetailPoints points, std::vector<PlanTrack>& lines, const PlanSource& source, FlightPlan& plan) {
  if (points.track.items.empty()) return;
  if (lines.empty()) {
    lines.push_back(std::move(points.track));
    return;
  }
  std::size_t lost = 0, beside = 0;
  std::set<std::pair<double, double>> places;
  for (const PlanTrack& line : lines) {
    for (const PlanItem& item : line.items) places.emplace(item.position.horizontal.x(), item.position.horizontal.y());
  }
  std::vector<bool> is_told(lines.front().items.size(), false);
  for (std::size_t i = 0; i < points.track.items.size(); ++i) {
    const PlanItem& point = points.track.items[i];
    const std::size_t number = points.numbers[i];
    std::vector<PlanItem>& items = lines.front().items;
    const bool fits = lines.size() == 1 && number >= 1 && number <= items.size() &&
                      is_same_place(point.position, items[number - 1].position);
    if (!fits) {
      lost += point.hold_s > 0 ? 1 : 0;
      beside += point.hold_s == 0 && !places.contains({point.position.horizontal.x(), point.position.horizontal.y()});
      continue;
    }
    PlanItem& item = items[number - 1];
    if (is_told[number - 1] && point.hold_s != item.hold_s) {
      PlanSource::fail_at(
          ErrorCode::conflicting_keys, point.place,
          "another point says what is done at position " + std::to_string(number) + " of the line, with another stay",
          "keep one of them");
    }
    is_told[number - 1] = true;
    item.hold_s = point.hold_s;
    item.speed_m_s = point.speed_m_s;
    item.yaw_deg = point.yaw_deg;
    item.gimbal_pitch_deg = point.gimbal_pitch_deg;
  }
  if (beside > 0) {
    plan.notes.push_back({WarningCode::plan_left_out, source.name + ": the line is flown, and not to " +
                                                          core::count_text(beside, "point", "points") + " beside it"});
  }
  if (lost == 0) return;
  plan.notes.push_back(
      {WarningCode::plan_left_out,
       source.name + ": " +
           core::count_text(lost, "stay at a point beside the line is", "stays at points beside the line are") +
           " left out: the point has to say, as 'point', which position of the line it lies at"});
}

}  // namespace vantage::internal::flight::plans
