#include "flight/view_json.h"

#include <optional>

namespace vantage::internal::flight {
namespace {

Json or_null(const std::optional<double>& value) { return value ? Json(*value) : Json(); }

}  // namespace

void add_view(Json& row, const ViewDescription& view) {
  row["position"] = {view.position.x(), view.position.y(), view.position.z()};
  row["longitude_deg"] = or_null(view.longitude_deg);
  row["latitude_deg"] = or_null(view.latitude_deg);
  row["above_ground_m"] = or_null(view.above_ground_m);
  row["above_sea_m"] = or_null(view.above_sea_m);
  row["yaw_deg"] = view.yaw_deg;
  row["pitch_deg"] = view.pitch_deg;
  row["is_centred"] = view.is_centred;
  row["distance_m"] = view.distance_m;
  row["pixel_m"] = or_null(view.pixel_m);
  row["incidence_deg"] = or_null(view.incidence_deg);
  row["obstacle_distance_m"] = or_null(view.obstacle_distance_m);
  row["obstacle"] = view.obstacle_distance_m ? Json(view.obstacle) : Json();
}

std::string dumped(const Json& json) {
  return json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

}  // namespace vantage::internal::flight
