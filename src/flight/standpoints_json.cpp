#include <string>
#include <utility>
#include <vector>

#include "flight/view_json.h"
#include "vantage/standpoints.h"

namespace vantage {

std::string json_text(const std::vector<NamedStandpoints>& targets) {
  using internal::flight::Json;
  Json rows = Json::array();
  for (const NamedStandpoints& target : targets) {
    Json row = {{"target", target.target},
                {"margin_m", target.standpoints.margin_m},
                {"reason", target.standpoints.reason},
                {"notes", target.standpoints.notes}};
    row["standpoints"] = Json::array();
    for (const Standpoint& point : target.standpoints.found) {
      Json one = {
          {"kind", name_of(point.kind)}, {"value", point.value}, {"bound", point.bound}, {"margin_m", point.margin_m}};
      internal::flight::add_view(one, point.view);
      row["standpoints"].push_back(std::move(one));
    }
    rows.push_back(std::move(row));
  }
  return internal::flight::dumped({{"targets", std::move(rows)}});
}

}  // namespace vantage
