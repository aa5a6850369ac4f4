#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "app/point_json.h"
#include "core/text.h"
#include "io/georeference_text.h"
#include "request/describe_spheres.h"
#include "request/json_object.h"
#include "vantage/result.h"
#include "vantage/version.h"
#include "vantage/volume.h"

namespace vantage {
namespace {

using Json = nlohmann::ordered_json;

Json box_json(const Box& box) {
  if (box.empty()) return nullptr;
  return {{"min", point_json(box.min)}, {"max", point_json(box.max)}};
}

Json json_of(const std::vector<Cause>& causes) {
  Json list = Json::array();
  for (const Cause& cause : causes) {
    Json entry = {{"name", cause.name}, {"kind", name_of(cause.kind)}, {"area_m2", cause.area_m2}};
    if (cause.object) {
      entry["object"] = *cause.object;
      if (!cause.source_id.empty()) entry["source_id"] = cause.source_id;
      entry["object_kind"] = name_of(cause.object_kind);
    }
    list.push_back(std::move(entry));
  }
  return list;
}

Json json_of(const StageCounts& counts) {
  return {{"scene_polygons", counts.scene_polygons},     {"candidate_blockers", counts.candidate_blockers},
          {"visible_blockers", counts.visible_blockers}, {"visible_facets", counts.visible_facets},
          {"constraint_edges", counts.constraint_edges}, {"boolean_fallbacks", counts.boolean_fallbacks}};
}

Json json_of(const Seconds& seconds) {
  return {{"read", seconds.read},     {"prepare", seconds.prepare},
          {"engine", seconds.engine}, {"navigation", seconds.navigation},
          {"write", seconds.write},   {"total", seconds.total}};
}

Json json_of(const SpheresRun& run) {
  const SpheresOptions& options = run.options;
  const SpheresReport& report = run.report;
  Json json;
  json["device"] = {
      {"kind", name_of(report.device.kind)}, {"name", report.device.name}, {"driver", report.device.driver}};
  if (!report.device_note.empty()) json["device"]["note"] = report.device_note;
  // Numbers without a fraction stay whole ones.
  const auto number_as = [](auto value) { return Json(value); };
  internal::request::JsonObject<Json, decltype(number_as)> object(number_as);
  describe(options, object);
  json.update(object.json());
  json.erase(options.resolution ? "cubemap" : "resolution");  // the one that does not count
  json["spheres"] = report.spheres;
  json["pairs"] = report.pairs;
  json["splits"] = report.splits;
  json["unresolved_pairs"] = report.unresolved_pairs;
  json["render_seconds"] = report.render_seconds;
  json["boolean_seconds"] = report.boolean_seconds;
  return json;
}

}  // namespace

std::string spheres_json(const SpheresRun& run) {
  return internal::core::escaped_json(json_of(run).dump(2, ' ', false, Json::error_handler_t::replace));
}

std::string report_json(const Volume& volume, const MeshMeasures& measures, const ReportSource& source) {
  Json report;
  report["version"] = VANTAGE_VERSION;
  const std::array<std::pair<const char*, const std::string*>, 4> sources = {
      {{"mission", &source.mission}, {"scene", &source.scene}, {"target", &source.target}, {"volume", &source.volume}}};
  for (const auto& [key, text] : sources) {
    if (!text->empty()) report[key] = *text;
  }
  report["method"] = source.spheres ? "spheres" : "exact";
  report["outcome"] = name_of(volume.outcome);
  report["reason"] = volume.reason;
  report["hint"] = volume.hint;
  report["notes"] = Json::array();
  report["note_codes"] = Json::array();
  for (const Warning& note : volume.notes) {
    report["notes"].push_back(note.text);
    report["note_codes"].push_back(name_of(note.code));
  }
  report["volume_m3"] = measures.volume_m3;
  report["area_m2"] = measures.area_m2;
  report["pieces"] = measures.pieces;
  report["vertices"] = measures.vertices;
  report["facets"] = measures.facets;
  report["euler"] = measures.euler;
  report["closed"] = measures.closed;
  report["oriented"] = measures.oriented;
  if (volume.provenance && !volume.provenance->scene_hash.empty()) {
    report["scene_hash"] = volume.provenance->scene_hash;
    report["mission_hash"] = volume.provenance->mission_hash;
    report["volume_hash"] = volume_hash(volume.mesh);
  }
  report["tolerance_m"] = volume.tolerance_m;
  report["lift_m"] = volume.lift_m.empty() ? 0 : *std::max_element(volume.lift_m.begin(), volume.lift_m.end());
  report["lift_of_part_m"] = volume.lift_m;
  if (volume.georeference) report["georeference"] = internal::io::georeference_json(*volume.georeference);
  if (!volume.attribution.empty()) report["attribution"] = volume.attribution;
  report["bounding_box"] = box_json(measures.bounds);
  report["causes"] = json_of(volume.causes);
  if (source.spheres) report["spheres"] = json_of(*source.spheres);
  report["counts"] = json_of(volume.counts);
  report["seconds"] = json_of(volume.seconds);
  return internal::core::escaped_json(report.dump(2, ' ', false, Json::error_handler_t::replace)) + "\n";
}

}  // namespace vantage
