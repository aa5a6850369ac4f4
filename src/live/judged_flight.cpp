#include "live/judged_flight.h"

#include <nlohmann/json.hpp>

namespace vantage::live {

std::string judged_flight(const GivenFlight& given, const Mission& mission, const PreparedScene& prepared,
                          const Progress& progress) {
  using Json = nlohmann::ordered_json;
  const LocatedPlan located = locate_flight(mission, given.plan, given.locate);
  FlightCheckOptions options;
  options.speed_m_s = given.speed_m_s;
  options.prepared = prepared;
  const FlightCheck check = check_flight(mission, located.flight, options, progress);
  Json notes = Json::array();
  for (const auto* list : {&given.plan.notes, &located.notes}) {
    for (const Warning& note : *list) notes.push_back(note.text);
  }
  Json home;
  if (located.home) home = {located.home->x(), located.home->y(), located.home->z()};
  return Json{{"name", given.name},
              {"home", std::move(home)},
              {"notes", std::move(notes)},
              {"check", Json::parse(json_text(check))}}
      .dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace vantage::live
