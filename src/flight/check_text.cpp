// What a check found, as JSON and as a table.
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "common/input.h"
#include "core/format.h"
#include "core/text.h"
#include "geo/on_globe.h"
#include "vantage/flight_check.h"
#include "vantage/georeference.h"

namespace vantage {
namespace {

using Json = nlohmann::ordered_json;

/// JSON has no number for what is not known or infinite.
Json number_json(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

/// Positions as they are told: with longitude and latitude where these are known.
class PositionJson {
 public:
  explicit PositionJson(const Georeference* georeference) {
    if (georeference != nullptr) globe_.emplace(*georeference);
  }

  Json operator()(const Vec3& position) const {
    Json json = {{"x_m", position.x()}, {"y_m", position.y()}, {"z_m", position.z()}};
    if (!globe_) return json;
    const internal::geo::LonLat place = globe_->to_geodetic(position).place;
    json["lon_deg"] = place.longitude_deg;
    json["lat_deg"] = place.latitude_deg;
    return json;
  }

 private:
  std::optional<internal::geo::OnGlobe> globe_;
};

Json span_json(const FlightSpan& span, const PositionJson& position) {
  return {{"begin_m", span.begin_m},          {"end_m", span.end_m},           {"begin_s", number_json(span.begin_s)},
          {"end_s", number_json(span.end_s)}, {"begin", position(span.begin)}, {"end", position(span.end)}};
}

Json spans_json(const std::vector<FlightSpan>& spans, const PositionJson& position) {
  Json json = Json::array();
  for (const FlightSpan& span : spans) json.push_back(span_json(span, position));
  return json;
}

Json reasons_json(const std::vector<NotSeen>& reasons, const PositionJson& position) {
  Json json = Json::array();
  for (const NotSeen& reason : reasons) {
    json.push_back({{"kind", name_of(reason.kind)},
                    {"name", reason.name},
                    {"length_m", reason.length_m()},
                    {"spans", spans_json(reason.spans, position)}});
  }
  return json;
}

Json target_json(const TargetCheck& target, const PositionJson& position) {
  Json json;
  json["name"] = target.name;
  if (target.is_volume) json["volume"] = true;
  json["parts"] = Json::array();
  for (const std::vector<Vec3>& part : target.parts) {
    Json corners = Json::array();
    for (const Vec3& corner : part) corners.push_back(position(corner));
    json["parts"].push_back(std::move(corners));
  }
  json["seen"] = spans_json(target.seen, position);
  json["longest"] = target.longest ? span_json(target.seen[*target.longest], position) : Json(nullptr);
  json["followed"] = target.followed ? span_json(*target.followed, position) : Json(nullptr);
  json["gimbal"] = nullptr;
  if (target.gimbal) {
    json["gimbal"] = {{"min_pitch_deg", target.gimbal->min_pitch_deg},
                      {"max_pitch_deg", target.gimbal->max_pitch_deg},
                      {"begin_yaw_deg", target.gimbal->begin_yaw_deg},
                      {"end_yaw_deg", target.gimbal->end_yaw_deg},
                      {"rate_deg_s", number_json(target.gimbal->rate_deg_s)}};
  }
  json["not_seen"] = reasons_json(target.not_seen, position);
  return json;
}

Json link_json(const LinkCheck& link, const PositionJson& position) {
  Json json;
  json["name"] = link.name;
  json["point"] = position(link.point);
  json["max_range_m"] = link.max_range_m ? Json(*link.max_range_m) : Json(nullptr);
  json["frequency_ghz"] = link.radio ? Json(link.radio->frequency_ghz) : Json(nullptr);
  json["clear"] = link.radio ? Json(link.radio->clear) : Json(nullptr);
  json["holds"] = link.holds();
  json["linked"] = spans_json(link.linked, position);
  json["lost"] = spans_json(link.lost, position);
  json["reasons"] = reasons_json(link.reasons, position);
  json["farthest_m"] = link.farthest_m;
  json["farthest_at_m"] = link.farthest_at_m;
  json["farthest_at"] = position(link.farthest_at);
  return json;
}

void append_rows(std::string& table, const std::string& target, std::string_view state, const std::string& what,
                 const std::vector<FlightSpan>& spans) {
  const auto seconds = [](double value) { return std::isnan(value) ? std::string() : shortest(value); };
  for (const FlightSpan& span : spans) {
    table +=
        internal::core::format("{},{},{},{},{},{},{},{},{},{},{},{},{}\n", csv_field(target), state, csv_field(what),
                               shortest(span.begin_m), shortest(span.end_m), seconds(span.begin_s), seconds(span.end_s),
                               shortest(span.begin.x()), shortest(span.begin.y()), shortest(span.begin.z()),
                               shortest(span.end.x()), shortest(span.end.y()), shortest(span.end.z()));
  }
}

}  // namespace

std::string json_text(const FlightCheck& check, const Georeference* georeference) {
  const PositionJson position(georeference);
  Json json;
  json["passes"] = check.passes();
  json["failures"] = check.failures;
  json["not_judged"] = check.not_judged;
  json["notes"] = check.notes;
  json["length_m"] = check.length_m;
  json["duration_s"] = number_json(check.duration_s);
  json["tube_radius_m"] = check.tube_radius_m;
  json["targets"] = Json::array();
  for (const TargetCheck& target : check.targets) json["targets"].push_back(target_json(target, position));
  json["links"] = Json::array();
  for (const LinkCheck& link : check.links) json["links"].push_back(link_json(link, position));
  json["broken"] = Json::array();
  for (const BrokenLimit& limit : check.broken) {
    json["broken"].push_back({{"limit", limit.name},
                              {"worst", number_json(limit.worst)},
                              {"unit", limit.unit},
                              {"worst_at_m", limit.worst_at_m},
                              {"worst_at", position(limit.worst_at)},
                              {"spans", spans_json(limit.spans, position)}});
  }
  json["nearest"] = nullptr;
  if (std::isfinite(check.nearest.distance_m)) {
    json["nearest"] = {{"distance_m", check.nearest.distance_m},
                       {"at_m", check.nearest.at_m},
                       {"object", check.nearest.object},
                       {"position", position(check.nearest.position)},
                       {"point", position(check.nearest.point)}};
  }
  json["points"] = Json::array();
  for (std::size_t i = 0; i < check.point_at_m.size(); ++i) {
    json["points"].push_back({{"at_m", check.point_at_m[i]},
                              {"arrival_s", number_json(check.arrival_s[i])},
                              {"departure_s", number_json(check.departure_s[i])},
                              {"position", position(check.positions[i])}});
  }
  constexpr int kIndentation = 2;
  return internal::core::escaped_json(json.dump(kIndentation, ' ', false, Json::error_handler_t::replace)) + "\n";
}

std::string csv_text(const FlightCheck& check) {
  std::string table =
      "target,state,what,begin_m,end_m,begin_s,end_s,begin_x_m,begin_y_m,begin_z_m,end_x_m,end_y_m,end_z_m\n";
  for (const TargetCheck& target : check.targets) {
    append_rows(table, target.name, "seen", "", target.seen);
    for (const NotSeen& reason : target.not_seen) {
      append_rows(table, target.name, name_of(reason.kind), reason.name, reason.spans);
    }
  }
  for (const LinkCheck& link : check.links) {
    append_rows(table, link.name, "linked", "", link.linked);
    for (const NotSeen& reason : link.reasons) {
      append_rows(table, link.name, std::string("link_") + name_of(reason.kind), reason.name, reason.spans);
    }
  }
  for (const BrokenLimit& limit : check.broken) append_rows(table, "", "broken", limit.name, limit.spans);
  for (const std::string& what : check.not_judged) table += ",not_judged," + csv_field(what) + ",,,,,,,,,,\n";
  return table;
}

std::vector<SeenTarget> seen_targets(const FlightCheck& check) {
  std::vector<SeenTarget> targets;
  for (const TargetCheck& of : check.targets) {
    SeenTarget& target = targets.emplace_back(SeenTarget{of.name, of.parts, {}});
    for (const FlightSpan& span : of.seen) {
      if (std::isfinite(span.begin_s) && std::isfinite(span.end_s)) target.seen_s.push_back({span.begin_s, span.end_s});
    }
  }
  return targets;
}

}  // namespace vantage
