#include "flight/plans/json_text.h"

#include <string>

#include "io/json_text.h"

namespace vantage::internal::flight::plans {

nlohmann::json parse_plan_json(const PlanSource& source) {
  core::ReadLimits limits;
  limits.json_values = 5'000'000;  // an item of a plan has some 20
  limits.json_bytes = std::uint64_t{1} << 29;
  try {
    nlohmann::json root = io::parse_json(source.text, source.progress, limits);
    if (root.is_object()) return root;
  } catch (const io::JsonProblem& problem) {
    const std::string place =
        problem.line == 0 ? "" : "line " + std::to_string(problem.line) + ", column " + std::to_string(problem.column);
    source.fail(ErrorCode::plan_syntax, place, "the JSON cannot be read: " + problem.text, "save the plan anew");
  }
  source.fail(ErrorCode::plan_syntax, "", "the JSON is not an object", "give a .plan of QGroundControl, or GeoJSON");
}

FlightPlan read_json(const PlanSource& source) {
  const nlohmann::json root = parse_plan_json(source);
  const bool is_geojson = root.contains("features") || root.contains("geometry") || root.contains("geometries") ||
                          root.contains("coordinates");
  if (is_geojson && root.contains("mission")) {
    source.fail(ErrorCode::plan_syntax, "", "the file is a plan of QGroundControl and GeoJSON in one",
                "make two files of it");
  }
  return is_geojson ? read_geojson(root, source) : read_qgroundcontrol(root, source);
}

}  // namespace vantage::internal::flight::plans
