#include "live/judged_flight.h"

#include <algorithm>
#include <cstddef>
#include <nlohmann/json.hpp>

namespace vantage::live {
namespace {

/// The same JSON on one line: in JSON no text has a line's end in it.
std::string on_one_line(const std::string& json) {
  std::string line;
  line.reserve(json.size());
  for (std::size_t i = 0; i < json.size();) {
    if (json[i] != '\n') {
      line += json[i++];
      continue;
    }
    i = std::min(json.find_first_not_of(" \n", i), json.size());
  }
  return line;
}

}  // namespace

std::string judged_flight(const GivenFlight& given, const Mission& mission, const PreparedScene& prepared,
                          const Progress& progress) {
  using Json = nlohmann::ordered_json;
  LocateOptions locate = given.locate;
  locate.progress = progress;
  const LocatedPlan located = locate_flight(mission, given.plan, locate);
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
  const Json about{{"name", given.name}, {"home", std::move(home)}, {"notes", std::move(notes)}};
  std::string text = about.dump(-1, ' ', false, Json::error_handler_t::replace);
  text.back() = ',';
  return text + R"("check":)" + on_one_line(json_text(check)) + "}";
}

}  // namespace vantage::live
