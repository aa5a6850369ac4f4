// Volumes: as python/src/volume.cpp, sections.cpp and outer.cpp.
#include <algorithm>

#include "common/json.h"
#include "common/output.h"
#include "held.h"
#include "vantage/error.h"
#include "vantage/georeference.h"
#include "vantage/result.h"
#include "vantage/simplify.h"

namespace vantage::wasm {
namespace {

const Volume& volume_at(const Json& a, const char* key = "volume") { return *held<HeldVolume>(a, key)->volume; }

Json causes_json(const Volume& volume) {
  Json rows = Json::array();
  for (const Cause& cause : volume.causes) {
    rows.push_back({name_of(cause.kind), cause.name, cause.area_m2, cause.object ? Json(*cause.object) : Json(),
                    cause.source_id, static_cast<int>(cause.object_kind)});
  }
  return rows;
}

Json provenance_json(const Volume& volume) {
  if (!volume.provenance) return nullptr;
  const VolumeProvenance& from = *volume.provenance;
  return {{"version", from.version},
          {"method", from.method},
          {"target", from.target.name},
          {"scene_hash", from.scene_hash},
          {"mission_hash", from.mission_hash}};
}

Json facts(const Json& a) {
  const auto held_volume = held<HeldVolume>(a, "volume");
  const Volume& volume = *held_volume->volume;
  const Seconds& s = volume.seconds;
  return {{"vertices", array_at(volume.mesh.vertices, 3)},
          {"faces", array_at(volume.mesh.triangles, 3)},
          {"cause_of", array_at(volume.cause_of)},
          {"polygon_of", array_at(volume.polygon_of)},
          {"causes", causes_json(volume)},
          {"outcome", name_of(volume.outcome)},
          {"reason", volume.reason},
          {"hint", volume.hint},
          {"notes", json(volume.notes)},
          {"tolerance_m", volume.tolerance_m},
          {"lift_m", volume.lift_m},
          {"rounding_m", held_volume->rounding_m},
          {"stated_hash", held_volume->stated_hash},
          {"seconds", Json{{"read", s.read},
                           {"prepare", s.prepare},
                           {"engine", s.engine},
                           {"navigation", s.navigation},
                           {"write", s.write},
                           {"total", s.total}}},
          {"provenance", provenance_json(volume)},
          {"place", place_json(volume.georeference)},
          {"projection", projection_json(volume.georeference)}};
}

Json measures(const Json& a) {
  const MeshMeasures m = measure(volume_at(a).mesh);
  return {{"vertices", m.vertices},
          {"facets", m.facets},
          {"pieces", m.pieces},
          {"euler", m.euler},
          {"closed", m.closed},
          {"oriented", m.oriented},
          {"volume_m3", m.volume_m3},
          {"area_m2", m.area_m2},
          {"bounds", m.bounds.empty() ? Json() : Json{json(m.bounds.min), json(m.bounds.max)}}};
}

Json read(const Json& a) {
  const std::filesystem::path file = a.at("file").get<std::string>();
  SceneReadOptions options;
  options.up = a.at("up") == "y" ? UpAxis::y : UpAxis::z;
  options.scale = a.at("scale").get<double>();
  VolumeFile read = a.at("scene").is_null() ? read_volume(file, options, {}, tell_progress)
                                            : read_volume(file, held<HeldScene>(a, "scene")->scene(), tell_progress);
  for (Warning& note : read.notes) read.volume.notes.push_back(std::move(note));
  return keep_volume(std::move(read.volume), read.rounding_m, std::move(read.volume_hash));
}

Json save(const Json& a) {
  const Json& level = a.at("sea_level_m");
  std::vector<StagedVolume> staged;
  staged.push_back(stage_volume(volume_at(a), a.at("file").get<std::string>(),
                                a.at("up") == "y" ? UpAxis::y : UpAxis::z, a.at("scale").get<double>(),
                                level.is_null() ? std::nullopt : std::optional(level.get<double>())));
  const WrittenVolume written = staged.front().report;
  commit_volumes(std::move(staged));
  return {written.rounding_m, written.facets};
}

Json compare(const Json& a) {
  const auto name = a.at("name").get<std::string>(), other_name = a.at("other_name").get<std::string>();
  Comparison found = compare_volumes(volume_at(a).mesh, volume_at(a, "other").mesh, name, other_name, tell_progress);
  const std::string text = json_text(found, name, other_name, {});
  return {text, keep_volume(volume_of_mesh(std::move(found.only_a), "only in " + name)),
          keep_volume(volume_of_mesh(std::move(found.only_b), "only in " + other_name))};
}

Json simplify(const Json& a) {
  SimplifyOptions options;
  if (!a.at("facets").is_null()) options.facets = a.at("facets").get<std::size_t>();
  if (!a.at("error_m").is_null()) options.error_m = a.at("error_m").get<double>();
  const auto volume = held<HeldVolume>(a, "volume");
  SimplifiedVolume simple = simplify_volume(volume->volume->mesh, options, tell_progress);
  const std::string text = json_text(simple, "", "", {});
  return {keep_volume(with_mesh(*volume->volume, std::move(simple)), volume->rounding_m), text};
}

Json empty(const Json& a) {
  Volume volume;
  for (const Outcome one :
       {Outcome::out_of_range, Outcome::blocked_at_once, Outcome::outside_limits, Outcome::no_common_view}) {
    if (a.at("outcome") == name_of(one)) volume.outcome = one;
  }
  volume.reason = a.at("reason").get<std::string>();
  return keep_volume(std::move(volume));
}

std::vector<Volume> volumes_at(const Json& a) {
  std::vector<Volume> all;
  for (const Json& one : a.at("volumes")) all.push_back(*table<HeldVolume>().at(one.get<Handle>())->volume);
  return all;
}

Json polygons_json(const std::vector<PlanPolygon>& polygons) {
  Json list = Json::array();
  const auto ring = [](const PlanPolygon::Ring& points) {
    Json corners = Json::array();
    for (const auto& point : points) corners.push_back({point.x(), point.y()});
    return corners;
  };
  for (const PlanPolygon& polygon : polygons) {
    Json rings = Json::array({ring(polygon.outer)});
    for (const PlanPolygon::Ring& hole : polygon.holes) rings.push_back(ring(hole));
    list.push_back(std::move(rings));
  }
  return list;
}

void add_solid_calls(Calls& calls) {
  calls["slice_volume"] = [](const Json& a) {
    return polygons_json(slice_mesh(volume_at(a).mesh, a.at("z_m").get<double>()));
  };
  calls["intersect_volumes"] = [](const Json& a) -> Json {
    return keep_volume(intersect_volumes(volumes_at(a), tell_progress));
  };
  calls["unite_volumes"] = [](const Json& a) -> Json {
    return keep_volume(unite_volumes(volumes_at(a), tell_progress));
  };
  calls["solid_index"] = [](const Json& a) -> Json { return keep(std::make_shared<SolidIndex>(volume_at(a).mesh)); };
  calls["index_depths"] = [](const Json& a) -> Json {
    return answer_array(held<SolidIndex>(a, "index")->depths_m(points_of(a.at("points"))));
  };
  calls["index_contains"] = [](const Json& a) -> Json {
    return answer_array(held<SolidIndex>(a, "index")->contains(points_of(a.at("points"))));
  };
  calls["index_comes_near"] = [](const Json& a) -> Json {
    return held<SolidIndex>(a, "index")->comes_near(*held<SolidIndex>(a, "other"), a.at("within_m").get<double>());
  };
  calls["free_index"] = [](const Json& a) -> Json { return table<SolidIndex>().erase(a.at("object").get<Handle>()); };
}

}  // namespace

void add_volume_calls(Calls& calls) {
  calls["volume_facts"] = &facts;
  calls["volume_measures"] = &measures;
  calls["volume_hash"] = [](const Json& a) -> Json { return volume_hash(volume_at(a).mesh); };
  calls["volume_report"] = [](const Json& a) -> Json { return report_json(volume_at(a), measure(volume_at(a).mesh)); };
  calls["read_volume"] = &read;
  calls["save_volume"] = &save;
  calls["volume_from_arrays"] = [](const Json& a) -> Json {
    return keep_volume(volume_of_mesh(mesh_of(a), a.at("cause").get<std::string>()));
  };
  calls["empty_volume"] = &empty;
  calls["compare_volumes"] = &compare;
  calls["simplify_volume"] = &simplify;
  calls["free_volume"] = [](const Json& a) -> Json { return table<HeldVolume>().erase(a.at("object").get<Handle>()); };
  add_solid_calls(calls);
}

}  // namespace vantage::wasm
