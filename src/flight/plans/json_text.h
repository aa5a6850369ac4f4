// JSON of plans.
#pragma once

#include <nlohmann/json.hpp>

#include "flight/plans/plan_source.h"

namespace vantage::internal::flight::plans {

/// The object that the whole text is. Throws Error(plan_syntax) with line and column.
nlohmann::json parse_plan_json(const PlanSource& source);

FlightPlan read_qgroundcontrol(const nlohmann::json& root, const PlanSource& source);
FlightPlan read_geojson(const nlohmann::json& root, const PlanSource& source);

}  // namespace vantage::internal::flight::plans
