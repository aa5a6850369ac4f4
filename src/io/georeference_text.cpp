#include "io/georeference_text.h"

#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "io/text_cursor.h"

namespace vantage::internal::io {
namespace {

constexpr const char* kProblem = "the georeference of vantage in it cannot be read: ";

[[noreturn]] void fail(std::string problem) { throw GeoreferenceProblem{kProblem + std::move(problem)}; }

double degrees(const nlohmann::json& object, const char* key, double limit) {
  const auto found = object.find(key);
  if (found == object.end()) fail(std::string("\"").append(key).append("\" is missing"));
  const double value = found->is_number() ? found->get<double>() : std::nan("");
  if (!(std::abs(value) <= limit)) {
    fail(std::string("\"")
             .append(key)
             .append("\" is not a number of at most ")
             .append(std::to_string(static_cast<int>(limit))));
  }
  return value;
}

std::string text(const nlohmann::json& object, const char* key) {
  const auto found = object.find(key);
  if (found == object.end()) return {};
  if (!found->is_string()) fail(std::string("\"").append(key).append("\" is not a text"));
  return found->get<std::string>();
}

}  // namespace

nlohmann::ordered_json georeference_json(const Georeference& georeference) {
  nlohmann::ordered_json json = {{"latitude_deg", georeference.latitude_deg},
                                 {"longitude_deg", georeference.longitude_deg},
                                 {"vertical", georeference.vertical},
                                 {"source_crs", georeference.source_crs},
                                 {"projection", projection_text(georeference)}};
  if (!georeference.attribution.empty()) json["attribution"] = georeference.attribution;
  return json;
}

std::string georeference_text(const Georeference& georeference) {
  return georeference_json(georeference).dump(-1, ' ', true, nlohmann::json::error_handler_t::replace);
}

Georeference parse_georeference(const nlohmann::json& object) {
  if (!object.is_object()) fail("it is no JSON object");
  Georeference georeference;
  georeference.latitude_deg = degrees(object, "latitude_deg", 90);
  georeference.longitude_deg = degrees(object, "longitude_deg", 180);
  georeference.vertical = text(object, "vertical");
  georeference.source_crs = text(object, "source_crs");
  georeference.attribution = text(object, "attribution");
  return georeference;
}

Georeference parse_georeference(std::string_view text) {
  return parse_georeference(nlohmann::json::parse(text, nullptr, false));  // discarded, where it is no JSON
}

void read_georeference_comment(std::string_view comment, std::optional<Georeference>& known) {
  while (!comment.empty() && TextCursor::is_blank(comment.front())) comment.remove_prefix(1);
  if (!comment.starts_with(kGeoreferenceMark)) return;
  const Georeference read = parse_georeference(comment.substr(kGeoreferenceMark.size()));
  if (known && georeference_text(*known) != georeference_text(read)) {
    throw GeoreferenceProblem{"the file has two georeferences that differ"};
  }
  known = read;
}

const nlohmann::json* georeference_in(const nlohmann::json& object) {
  if (!object.is_object()) return nullptr;
  const auto ours = object.find("vantage");
  if (ours == object.end() || !ours->is_object()) return nullptr;
  const auto found = ours->find("georeference");
  return found == ours->end() ? nullptr : &*found;
}

std::string place_comment(const std::optional<Georeference>& georeference, const char* start) {
  if (!georeference) return {};
  std::string line(start);
  line.append(kGeoreferenceMark).append(" ").append(georeference_text(*georeference));
  return line.append("\n");
}

}  // namespace vantage::internal::io
