#include "common/json.h"

#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "app/point_json.h"
#include "core/text.h"
#include "io/georeference_text.h"

namespace vantage {
namespace {

using Json = nlohmann::ordered_json;

Json json_of(const Box& box) { return {{"min", point_json(box.min)}, {"max", point_json(box.max)}}; }

std::string dumped(const Json& json, int indentation) {
  return internal::core::escaped_json(json.dump(indentation, ' ', false, Json::error_handler_t::replace)) + "\n";
}

Json record_json(const CityRecord& record) {
  Json json;
  json["object"] = record.object.source_id;
  if (!record.object.name.empty()) json["name"] = record.object.name;
  json["kind"] = name_of(record.object.kind);
  if (!record.building.empty()) json["building"] = record.building;
  for (const CityRemark& remark : record.remarks) json["remarks"].push_back(remark.text);
  json["ground_m"] = record.ground_m;
  json["base_m"] = record.base_m;
  json["top_m"] = record.top_m;
  json["footprint_m2"] = record.footprint_m2;
  return json;
}

void add_city(Json& json, const CityReport& report) {
  json["kinds"] = kinds_of(report);
  json["outside"] = report.outside;
  json["map_bounds_deg"] = report.bounds_deg;  // west, south, east, north
  json["seconds"] = {{"read", report.read_seconds}, {"build", report.build_seconds}};
  json["records"] = Json::array();
  for (const CityRecord& record : report.records) json["records"].push_back(record_json(record));
  json["passed_over"] = Json::array();
  for (const CityPassedOver& one : report.passed_over) {
    json["passed_over"].push_back(
        {{"object", one.object.source_id}, {"kind", name_of(one.object.kind)}, {"reason", one.reason}});
  }
}

Json number_json(double number) { return std::isfinite(number) ? Json(number) : Json(nullptr); }

/// Corners that are not known are null.
Json open_box_json(const Box& box) {
  Json json;
  for (const auto& [key, corner] : {std::pair{"min", box.min}, {"max", box.max}}) {
    json[key] = {number_json(corner.x()), number_json(corner.y()), number_json(corner.z())};
  }
  return json;
}

Json entry_json(const LedgerEntry& entry) {
  Json json;
  json["object"] = entry.object.source_id.empty() ? Json(nullptr) : Json(entry.object.source_id);
  json["name"] = entry.object.name.empty() ? Json(nullptr) : Json(entry.object.name);
  json["kind"] = name_of(entry.object.kind);
  json["what"] = entry.what;
  json["reason"] = entry.reason;
  json["box"] = entry.box ? open_box_json(*entry.box) : Json(nullptr);
  json["outlines"] = entry.outlines;
  json["height_m"] = entry.height_m ? Json(*entry.height_m) : Json(nullptr);
  json["stand_in"] = entry.stand_in ? Json(*entry.stand_in) : Json(nullptr);  // index of the scene's object
  json["instead"] = entry.instead;
  json["may_be_larger"] = entry.may_be_larger;
  json["without"] = entry.without.empty() ? Json(nullptr) : Json(entry.without);
  return json;
}

Json ledger_json(const std::vector<LedgerEntry>& ledger) {
  Json json = Json::array();
  for (const LedgerEntry& entry : ledger) json.push_back(entry_json(entry));
  return json;
}

void add_raster(Json& json, const RasterReport& report) {
  json["raster"] = {{"columns", report.columns},     {"rows", report.rows},
                    {"voids", report.voids},         {"lowest_m", report.lowest_m},
                    {"highest_m", report.highest_m}, {"largest_error_m", report.largest_error_m}};
}

void add_tileset(Json& json, const TilesetReport& report) {
  json["tileset"] = {
      {"documents", report.documents},
      {"tiles", report.tiles},
      {"contents", report.contents},
      {"without_surfaces", report.without_surfaces},
      {"bytes", report.bytes},
      {"objects_outside", report.objects_outside},
      {"holes", report.holes},
      {"first_hole", report.first_hole.empty() ? Json(nullptr) : Json(report.first_hole)},
      {"coarser_kept", report.coarser_kept},
      {"unreadable_properties", report.unreadable_properties},
      {"first_unreadable", report.first_unreadable.empty() ? Json(nullptr) : Json(report.first_unreadable)},
      {"features_by_texture", report.features_by_texture},
      {"largest_error_m", report.largest_error_m},
      {"coarse", report.coarse},
      {"rim_drop_m", report.rim_drop_m},
      {"rim_shift_m", report.rim_shift_m}};
}

void add_credit(Json& json, const Scene& scene) {
  if (std::string credit = attribution_of(scene); !credit.empty()) json["attribution"] = std::move(credit);
}

void add_source(Json& json, const LoadedScene& loaded) {
  if (loaded.city) add_city(json, *loaded.city);
  if (loaded.raster) add_raster(json, *loaded.raster);
  if (loaded.tileset) add_tileset(json, *loaded.tileset);
}

Json known_or_null(double number) { return number == 0 ? Json(nullptr) : Json(number); }

template <typename Value>
Json value_or_null(const std::optional<Value>& value) {
  return value ? Json(*value) : Json(nullptr);
}

Json json_of(const CameraCarrier& carrier) {
  return {{"pitch_deg", value_or_null(carrier.pitch_deg)},
          {"roll_deg", value_or_null(carrier.roll_deg)},
          {"yaw_deg", value_or_null(carrier.yaw_deg)},
          {"rate_deg_s", value_or_null(carrier.rate_deg_s)},
          {"dji_drone", value_or_null(carrier.dji_drone)},
          {"dji_drone_sub_type", value_or_null(carrier.dji_drone_sub_type)},
          {"dji_payload", value_or_null(carrier.dji_payload)},
          {"climb_m_s", value_or_null(carrier.climb_m_s)},
          {"descent_m_s", value_or_null(carrier.descent_m_s)},
          {"speed_m_s", value_or_null(carrier.speed_m_s)},
          {"source", carrier.source.empty() ? Json(nullptr) : Json(carrier.source)}};
}

Json camera_json(const ListedCamera& listed) {
  const Camera& camera = listed.camera;
  Json json;
  json["name"] = camera.name;
  json["maker"] = camera.maker.empty() ? Json(nullptr) : Json(camera.maker);
  json["model"] = camera.model.empty() ? Json(nullptr) : Json(camera.model);
  json["width_px"] = camera.width_px == 0 ? Json(nullptr) : Json(camera.width_px);
  json["height_px"] = camera.height_px == 0 ? Json(nullptr) : Json(camera.height_px);
  json["sensor_width_mm"] = known_or_null(camera.sensor_width_mm);
  json["sensor_height_mm"] = known_or_null(camera.sensor_height_mm);
  json["focal_length_mm"] = known_or_null(camera.focal_length_mm);
  const std::optional<Pinhole> pinhole = pinhole_if_known(listed);
  json["fov_deg"] = pinhole ? Json(pinhole->fov_deg()) : Json(nullptr);  // horizontal, vertical
  json["focal_px"] = pinhole && pinhole->focal_px ? Json(*pinhole->focal_px) : Json(nullptr);
  json["source"] = camera.source;
  json["carrier"] = json_of(camera.carrier);
  json["problem"] = listed.problem.empty() ? Json(nullptr) : Json(listed.problem);
  return json;
}

double percent(double part, double whole) { return 100 * part / whole; }

Json json_of(const MaximalProof& proof) {
  Json json;
  json["proved_share"] = proof.proved_share;
  json["witnesses"] = Json::array();
  for (const MaximalProof::Row& row : proof.rows) {
    json["witnesses"].push_back({{"kind", name_of(row.kind)},
                                 {"limit", row.limit.empty() ? Json(nullptr) : Json(row.limit)},
                                 {"facets", row.facets},
                                 {"area_share", row.area_share}});
  }
  json["conditions"] = Json::array();
  for (const MaximalCondition& condition : proof.conditions) {
    json["conditions"].push_back({{"text", condition.text}, {"holds", condition.holds}});
  }
  json["conditions_hold"] = proof.conditions_hold();
  json["open"] = proof.open;
  json["sampled"] = proof.sampled;
  json["grow"] = proof.grow;
  json["range_m"] = std::isfinite(proof.range_m) ? Json(proof.range_m) : Json(nullptr);
  json["tolerance_m"] = proof.tolerance_m;
  json["point_radius_m"] = proof.point_radius_m;
  json["seconds"] = proof.seconds;
  return json;
}

Json json_of(const ProofReport& report) {
  Json json;
  json["verdict"] = name_of(report.verdict());
  json["claims"] = Json::array();
  for (const ClaimProof& claim : report.claims) {
    Json one = {{"name", claim.name}, {"verdict", name_of(claim.verdict)}, {"text", claim.text}};
    if (claim.place) {
      one["place"] = point_json(*claim.place);
      one["broken_by_m"] = claim.broken_by_m;
    }
    json["claims"].push_back(std::move(one));
  }
  json["facets"] = report.facets;
  json["tested_facets"] = report.tested_facets;
  json["unproved"] = report.unproved;
  json["unproved_area_share"] = report.unproved_area_share;
  json["witness"] = nullptr;
  if (report.witness) {
    const HiddenView& hidden = *report.witness;
    json["witness"] = {{"viewpoint", point_json(hidden.viewpoint)},
                       {"target_point", point_json(hidden.target_point)},
                       {"triangle", hidden.triangle},
                       {"object", hidden.object},
                       {"facet", hidden.facet},
                       {"depth_m", hidden.depth_m}};
  }
  json["maximal"] = report.maximal ? json_of(*report.maximal) : Json(nullptr);
  json["separations"] = report.separations;
  json["shrink"] = report.shrink;
  json["margin_m"] = report.margin_m;
  json["limit_tolerance_m"] = report.limit_tolerance_m;
  json["rounding_m"] = report.rounding_m;
  json["layer_m"] = report.layer_m;
  json["lift_m"] = report.lift_m;
  json["scene_incomplete"] = report.scene_incomplete.empty() ? Json(nullptr) : Json(report.scene_incomplete);
  json["lift_of_part_m"] = report.lift_of_part_m;
  json["seconds"] = report.seconds;
  return json;
}

/// Closed, as GeoJSON has it.
Json ring_json(const AreaPolygon::Ring& ring) {
  Json json = ring;
  if (!ring.empty()) json.push_back(ring.front());
  return json;
}

Json polygon_json(const AreaPolygon& polygon) {
  Json json = Json::array({ring_json(polygon.outer)});
  for (const AreaPolygon::Ring& hole : polygon.holes) json.push_back(ring_json(hole));
  return json;
}

Json feature_json(const MapArea& area) {
  Json polygons = Json::array();
  for (const AreaPolygon& polygon : area.polygons) polygons.push_back(polygon_json(polygon));
  const bool is_one = polygons.size() == 1;
  Json tags = Json::object();
  for (const auto& [key, value] : area.tags) tags[key] = value;
  return {
      {"type", "Feature"},
      {"id", area.source_id},
      {"properties",
       {{"osm", area.source_id},
        {"name", area.name},
        {"area_m2", area.area_m2},
        {"center", area.center_deg},
        {"tags", std::move(tags)}}},
      {"geometry", {{"type", is_one ? "Polygon" : "MultiPolygon"}, {"coordinates", is_one ? polygons[0] : polygons}}}};
}

}  // namespace

std::string json_text(std::string_view text) {
  return internal::core::escaped_json(Json(text).dump(-1, ' ', false, Json::error_handler_t::replace));
}

std::string json_text(const std::vector<std::string>& texts) {
  return internal::core::escaped_json(Json(texts).dump(-1, ' ', false, Json::error_handler_t::replace));
}

std::map<std::string, std::size_t> kinds_of(const CityReport& report) {
  std::map<std::string, std::size_t> kinds;
  for (const CityRecord& record : report.records) ++kinds[name_of(record.object.kind)];
  return kinds;
}

std::string json_text(const std::vector<LedgerEntry>& ledger) { return dumped(ledger_json(ledger), 2); }

std::string json_text(const LoadedScene& loaded) {
  Json json;
  json["source"] = loaded.scene.source.string();
  if (const auto& place = loaded.scene.georeference) json["georeference"] = internal::io::georeference_json(*place);
  add_credit(json, loaded.scene);
  json["triangles"] = loaded.scene.mesh.triangles.size();
  json["objects"] = loaded.scene.objects.size();
  const Box box = bounding_box(loaded.scene.mesh);
  json["bounds"] = json_of(box);
  json["notes"] = notes_of(loaded);
  json["ledger"] = ledger_json(loaded.scene.ledger);
  add_source(json, loaded);
  return dumped(json, 1);
}

std::string json_text(const LoadedScene& loaded, const SceneStatistics& found) {
  const Scene& scene = loaded.scene;
  Json json;
  json["file"] = scene.source.string();
  json["triangles"] = found.triangles;
  json["vertices"] = found.vertices;
  json["objects"] = found.objects;
  json["dropped_faces"] = scene.dropped_faces;
  json["welded_vertices"] = found.welded_vertices;
  json["degenerate_triangles"] = found.degenerate_triangles;
  json["duplicate_triangles"] = found.duplicate_triangles;
  json["open_edges"] = found.open_edges;
  json["nonmanifold_edges"] = found.nonmanifold_edges;
  json["misoriented_edges"] = found.misoriented_edges;
  json["polygons"] = found.polygons;
  json["bounds"] = json_of(found.bounds);
  if (scene.georeference) json["georeference"] = internal::io::georeference_json(*scene.georeference);
  add_credit(json, scene);
  json["notes"] = notes_of(loaded);
  json["ledger"] = ledger_json(loaded.scene.ledger);
  add_source(json, loaded);
  return dumped(json, 2);
}

std::string json_text(const VerifyReport& report, const ProofReport* proof) {
  Json json;
  json["right"] = report.is_right() && !(proof && proof->verdict() == ProofVerdict::wrong);
  json["closed"] = report.closed;
  json["open_edges"] = report.open_edges.count;
  json["open_edge_at"] = report.open_edges.count > 0 ? point_json(report.open_edges.middle_of_first) : Json(nullptr);
  json["oriented"] = report.oriented;
  json["flat_facets"] = report.flat_facets;
  json["euler"] = report.euler;
  json["points"] = report.points;
  json["inside"] = report.inside;
  json["rays"] = report.rays;
  json["undecided"] = report.undecided;
  json["over_claimed"] = report.over_claimed;
  json["under_claimed"] = report.under_claimed;
  if (report.share_unclaimed) json["share_unclaimed"] = *report.share_unclaimed;
  json["worst_over_depth_m"] = report.worst_over_depth_m;
  json["worst_over_point"] = point_json(report.worst_over_point);
  json["worst_over_cause"] = report.worst_over_cause;
  json["worst_under_depth_m"] = report.worst_under_depth_m;
  json["worst_under_point"] = point_json(report.worst_under_point);
  json["over_claim_bound"] = report.over_claim_bound;
  json["bound_points"] = report.bound_points;
  json["seed"] = report.seed;
  json["lift_m"] = report.lift_m;
  json["rounding_m"] = report.rounding_m;
  json["scene_incomplete"] = report.scene_incomplete.empty() ? Json(nullptr) : Json(report.scene_incomplete);
  json["proof"] = proof ? json_of(*proof) : Json();
  return dumped(json, 2);
}

std::string json_text(const ProofReport& report, const std::string& certificate) {
  Json json = json_of(report);
  json["certificate"] = certificate.empty() ? Json(nullptr) : Json(certificate);
  return dumped(json, 2);
}

std::string json_text(const Comparison& c, const std::string& file_a, const std::string& file_b,
                      const std::vector<std::string>& written) {
  const auto point = [](double distance, const Vec3& p) -> Json {
    if (distance == 0) return nullptr;
    return {p.x(), p.y(), p.z()};
  };
  Json json;
  json["a"] = file_a;
  json["b"] = file_b;
  json["volume_a_m3"] = c.volume_a_m3;
  json["volume_b_m3"] = c.volume_b_m3;
  json["intersection_m3"] = c.intersection_m3;
  json["intersection_percent_of_a"] = percent(c.intersection_m3, c.volume_a_m3);
  json["intersection_percent_of_b"] = percent(c.intersection_m3, c.volume_b_m3);
  json["only_a_m3"] = c.only_a_m3;
  json["only_a_percent"] = percent(c.only_a_m3, c.volume_a_m3);
  json["only_b_m3"] = c.only_b_m3;
  json["only_b_percent"] = percent(c.only_b_m3, c.volume_b_m3);
  json["worst_only_a_m"] = c.worst_only_a_m;
  json["worst_only_a_bound_m"] = c.worst_only_a_bound_m;
  json["worst_only_a_point"] = point(c.worst_only_a_m, c.worst_only_a_point);
  json["worst_only_b_m"] = c.worst_only_b_m;
  json["worst_only_b_bound_m"] = c.worst_only_b_bound_m;
  json["worst_only_b_point"] = point(c.worst_only_b_m, c.worst_only_b_point);
  json["written"] = written;
  return dumped(json, 2);
}

std::string json_text(const SimplifiedVolume& s, const std::string& volume, const std::string& output,
                      const WrittenVolume& written) {
  Json json;
  json["volume"] = volume;
  json["facets_before"] = s.facets_before;
  json["facets"] = written.facets;
  json["reached"] = s.reached;
  json["volume_before_m3"] = s.volume_before_m3;
  json["volume_after_m3"] = s.volume_after_m3;
  json["kept_percent"] = percent(s.volume_after_m3, s.volume_before_m3);
  json["lost_bound_m"] = s.lost_bound_m;
  json["lost_measured_m"] = s.lost_measured_m;
  json["pieces"] = s.pieces;
  json["pieces_dropped"] = s.pieces_dropped;
  json["rounding_m"] = written.rounding_m;
  json["written"] = output;
  return dumped(json, 2);
}

std::string json_text(const RenderDevices& found, const ChosenDevice& chosen, const std::string& reason) {
  Json json;
  json["devices"] = Json::array();
  for (const RenderDevice& device : found.devices) {
    json["devices"].push_back({{"index", device.index},
                               {"kind", name_of(device.kind)},
                               {"name", device.name},
                               {"driver", device.driver},
                               {"memory_bytes", device.memory_bytes},
                               {"largest_face_size", device.largest_face_size}});
  }
  json["used"] = chosen.device.index;
  json["why"] = reason;
  json["why_no_opengl"] = found.why_no_opengl;
  return dumped(json, 2);
}

std::string json_text(const std::vector<ListedCamera>& cameras) {
  Json json;
  json["cameras"] = Json::array();
  for (const ListedCamera& camera : cameras) json["cameras"].push_back(camera_json(camera));
  return dumped(json, 2);
}

std::string json_text(const std::vector<ListedObject>& objects) {
  Json json;
  json["objects"] = Json::array();
  for (const ListedObject& one : objects) {
    Json row = {{"name", one.object.name},          {"source_id", one.object.source_id},
                {"kind", name_of(one.object.kind)}, {"triangles", one.triangles},
                {"min_z_m", one.min_z_m},           {"max_z_m", one.max_z_m},
                {"height_m", one.height_m}};
    row["footprint_m2"] = one.footprint_m2 ? Json(*one.footprint_m2) : Json();
    row["mission"] = one.mission;
    json["objects"].push_back(std::move(row));
  }
  return dumped(json, 2);
}

std::string json_text(const std::vector<MapArea>& areas) {
  std::string text = "{\"type\": \"FeatureCollection\", \"features\": [";
  for (std::size_t i = 0; i < areas.size(); ++i) {
    const std::string feature = dumped(feature_json(areas[i]), -1);
    text.append(i == 0 ? "\n" : ",\n").append(feature, 0, feature.size() - 1);
  }
  return text + "\n]}\n";
}

}  // namespace vantage
