// What is done at the points of a flight, by name: in KML, GPX and GeoJSON.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "flight/plans/plan_source.h"
#include "flight/plans/plan_writer.h"

namespace vantage::internal::flight::plans {

// ---- writing ----

/// "hold_s" and "3": what is stated of it, numbers to a thousandth, and a stay never shorter than it is.
std::vector<std::pair<const char*, std::string>> details_of(const OutPoint& point);

// ---- reading ----

/// Points that may say what is done at the positions of a line.
struct DetailPoints {
  PlanTrack track;
  std::vector<std::size_t> numbers;  ///< of each item: which position of the line it is, from 1; 0: it does not say
};

/// Takes "hold_s", "speed_m_s", "yaw_deg", "gimbal_pitch_deg", and for `number` "point"; other names are passed over.
void set_detail(std::string_view name, double value, PlanItem& item, std::size_t* number = nullptr);
/// The same of a text; an empty one is nothing. Throws Error(not_a_number) with the item's place.
void set_detail(std::string_view name, std::string_view text, PlanItem& item, std::size_t* number = nullptr);

/// What the points say goes to the items of the one line: where a point lies at the position that it numbers. Without a
/// line the points are the flight. A note counts those whose stay is lost.
void take_details(DetailPoints points, std::vector<PlanTrack>& lines, const PlanSource& source, FlightPlan& plan);

}  // namespace vantage::internal::flight::plans
