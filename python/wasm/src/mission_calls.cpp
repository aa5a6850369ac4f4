// Missions and their results: as python/src/mission.cpp and points.cpp.
#include <algorithm>
#include <cmath>
#include <span>

#include "held.h"
#include "vantage/error.h"
#include "vantage/fraction.h"
#include "vantage/navigation.h"
#include "vantage/result.h"

namespace vantage::wasm {
namespace {

/// Points per call into the engine: so often progress is told.
constexpr std::size_t kPortion = 20'000;

std::vector<KeepInMesh> meshes_of(const Json& rows) {
  std::vector<KeepInMesh> meshes;
  for (const Json& row : rows) meshes.push_back({mesh_of(row), row.at("name").get<std::string>()});
  return meshes;
}

Mission resolved(const Json& a, const HeldScene& scene) {
  MissionFile file = read_mission_text(a.at("text").get<std::string>(), a.at("name").get<std::string>(), scene.source);
  file.sea_level_m = scene.sea_level_m;
  Mission mission = resolve_mission(file, scene.loaded, tell_progress);
  for (KeepInMesh& mesh : meshes_of(a.at("meshes"))) mission.navigation.meshes.push_back(std::move(mesh));
  return mission;
}

Json keep_mission(std::shared_ptr<HeldScene> scene, Mission mission, bool is_part = false) {
  return keep(std::make_shared<HeldMission>(
      HeldMission{std::move(scene), std::make_shared<const Mission>(std::move(mission)), is_part}));
}

Json resolve(const Json& a) {
  const auto scene = held<HeldScene>(a, "scene");
  return keep_mission(scene, resolved(a, *scene));
}

Json check(const Json& a) {
  const auto scene = held<HeldScene>(a, "scene");
  const Mission mission = resolved(a, *scene);
  check_navigation(mission.navigation, tell_progress);
  if (!a.at("prepares").get<bool>()) return volume_count(mission);
  const bool is_in_scene = mission.loaded == scene->loaded;
  const PreparedScene prepared =
      is_in_scene ? scene->prepared(tell_progress) : PreparedScene(mission.scene(), tell_progress);
  for (std::size_t i = 0; i < volume_count(mission); ++i) prepare_views(one_volume(mission, i), prepared);
  return volume_count(mission);
}

Json read(const Json& a) {
  const MissionFile file = read_mission(a.at("file").get<std::string>());
  Mission mission = resolve_mission(file, tell_progress);
  auto scene = std::make_shared<HeldScene>();
  scene->loaded = mission.loaded;
  scene->source = file.scene;
  scene->sea_level_m = file.sea_level_m;
  return {keep_mission(scene, std::move(mission)), keep(scene)};
}

std::shared_ptr<HeldMission> one(const std::shared_ptr<HeldMission>& mission, std::size_t index) {
  const bool is_part = mission->is_part || volume_count(*mission->mission) > 1;
  return std::make_shared<HeldMission>(
      HeldMission{mission->scene, std::make_shared<const Mission>(one_volume(*mission->mission, index)), is_part});
}

Json facts(const Json& a) {
  const Mission& mission = *held<HeldMission>(a, "mission")->mission;
  Json parts = Json::array();
  for (const std::vector<Vec3>& part : mission.target.parts) {
    Json corners = Json::array();
    for (const Vec3& corner : part) corners.push_back(json(corner));
    parts.push_back(std::move(corners));
  }
  const double range_m = range_limit_m(mission.sensor);
  return {{"count", volume_count(mission)},
          {"target_name", mission.target.name},
          {"target_parts", std::move(parts)},
          {"range_m", std::isfinite(range_m) ? Json(range_m) : Json()},
          {"tolerance_m", mission.as_written.exact.tolerance_m},
          {"method", name_of(mission.as_written.method)}};
}

/// The handles of a result, of its mission and of its volume.
Json keep_result(std::shared_ptr<HeldMission> mission, Result result) {
  auto made = std::make_shared<HeldResult>();
  made->mission = std::move(mission);
  made->volume = std::make_shared<HeldVolume>();
  made->volume->volume = std::make_shared<const Volume>(std::move(result.volume));
  made->result = std::move(result);
  Json spheres;
  if (made->result.spheres) spheres = spheres_json({made->mission->mission->as_written.spheres, *made->result.spheres});
  return {
      {"result", keep(made)}, {"mission", keep(made->mission)}, {"volume", keep(made->volume)}, {"spheres", spheres}};
}

Json run(const Json& a) {
  const auto mission = held<HeldMission>(a, "mission");
  std::vector<Result> results = run_missions(*mission->mission, mission->run_options(tell_progress), tell_progress);
  Json made = Json::array();
  for (std::size_t i = 0; i < results.size(); ++i) {
    made.push_back(keep_result(results.size() == 1 ? mission : one(mission, i), std::move(results[i])));
  }
  return made;
}

Json try_each(const Json& a) {
  const auto mission = held<HeldMission>(a, "mission");
  std::vector<Attempt> attempts = try_missions(*mission->mission, mission->run_options(tell_progress), tell_progress);
  Json made = Json::array();
  for (std::size_t i = 0; i < attempts.size(); ++i) {
    if (attempts[i].error) {
      made.push_back({{"error", error_json(*attempts[i].error)}});
    } else {
      made.push_back(keep_result(one(mission, i), std::move(*attempts[i].result)));
    }
  }
  return made;
}

Json report(const Json& a) {
  const auto result = held<HeldResult>(a, "result");
  const Volume& volume = *result->volume->volume;
  return report_json(volume, measure(volume.mesh),
                     result_request(*result->mission->mission, result->whole(), {}).source);
}

Json save(const Json& a) {
  const auto result = held<HeldResult>(a, "result");
  const Mission& mission = *result->mission->mission;
  std::vector<std::filesystem::path> files;
  for (const Json& file : a.at("files")) files.emplace_back(file.get<std::string>());
  check_result_files(files, input_files(mission.as_written));
  const Result whole = result->whole();
  Volume volume = whole.volume;
  const WrittenResults written = write_results(volume, result_request(mission, whole, files), tell_progress);
  Json reports = Json::array();
  for (const std::filesystem::path& file : written.reports) reports.push_back(file.string());
  return reports;
}

// ---- what points see

Json query(const Json& a) {
  const auto mission = held<HeldMission>(a, "mission");
  if (volume_count(*mission->mission) != 1) {
    throw Error(ErrorCode::not_applicable, "the mission asks for a volume for each of its targets", "",
                "ask for one of them: mission.one(index)");
  }
  const auto views = prepare_views(*mission->mission, mission->prepared(tell_progress));
  return keep(std::make_shared<HeldQuery>(HeldQuery{ViewsQuery(views, mission->mission->navigation, tell_progress)}));
}

template <typename Ask>
void for_portions(const std::vector<Vec3>& points, const Ask& ask) {
  for (std::size_t done = 0; done < points.size(); done += kPortion) {
    if (!tell_progress("points", static_cast<double>(done) / static_cast<double>(points.size()))) {
      throw Error(ErrorCode::cancelled, "cancelled", "", "");
    }
    ask(std::span(points).subspan(done, std::min(kPortion, points.size() - done)));
  }
}

Json answers(const Json& a) {
  const auto asked = held<HeldQuery>(a, "query");
  std::vector<std::uint8_t> inside, out_of_range, behind;
  std::vector<double> margins;
  Json blocked_by = Json::array(), outside_of = Json::array();
  for_portions(points_of(a.at("points")), [&](std::span<const Vec3> portion) {
    for (const PointAnswer& one : asked->query.answer(portion)) {
      inside.push_back(one.inside);
      out_of_range.push_back(one.out_of_range);
      behind.push_back(one.behind_target);
      margins.push_back(one.margin_m);
      blocked_by.push_back(one.blocked_by);
      outside_of.push_back(one.outside_of);
    }
  });
  return {{"inside", answer_array(std::move(inside))},
          {"margin_m", answer_array(std::move(margins))},
          {"blocked_by", std::move(blocked_by)},
          {"out_of_range", answer_array(std::move(out_of_range))},
          {"behind_target", answer_array(std::move(behind))},
          {"outside_of", std::move(outside_of)}};
}

Json rings_json(const SeenPolygon& polygon) {
  const auto ring = [](const std::vector<Vec3>& points) {
    Json corners = Json::array();
    for (const Vec3& point : points) corners.push_back(json(point));
    return corners;
  };
  Json rings = Json::array({ring(polygon.outer)});
  for (const std::vector<Vec3>& hole : polygon.holes) rings.push_back(ring(hole));
  return rings;
}

Json fractions(const Json& a) {
  const auto measure = fraction_measure(a.at("measure").get<std::string>());
  if (!measure) {
    throw Error(ErrorCode::unknown_choice, "there is no such measure", "measure",
                "choose 'area', 'solid_angle' or 'pixels'");
  }
  PointQuery* const single = held<HeldQuery>(a, "query")->query.single();
  if (!single) {
    throw Error(ErrorCode::not_applicable, "the share seen is that of one target, and the mission has several", "",
                "ask for each of the targets");
  }
  const bool with_polygons = a.at("polygons").get<bool>();
  std::vector<double> shares;
  Json seen = Json::array();
  for_portions(points_of(a.at("points")), [&](std::span<const Vec3> portion) {
    for (const PointFraction& one : single->fractions(portion, {*measure, with_polygons})) {
      shares.push_back(one.fraction);
      if (!with_polygons) continue;
      Json of_point = Json::array();
      for (const SeenPolygon& polygon : one.seen) of_point.push_back(rings_json(polygon));
      seen.push_back(std::move(of_point));
    }
  });
  return {answer_array(std::move(shares)), std::move(seen)};
}

}  // namespace

void add_mission_calls(Calls& calls) {
  calls["resolve"] = &resolve;
  calls["check"] = &check;
  calls["read_mission"] = &read;
  calls["mission_facts"] = &facts;
  calls["mission_hash"] = [](const Json& a) -> Json { return mission_hash(*held<HeldMission>(a, "mission")->mission); };
  calls["mission_notes"] = [](const Json& a) {
    return json(mission_warnings(*held<HeldMission>(a, "mission")->mission));
  };
  calls["one_mission"] = [](const Json& a) -> Json {
    return keep(one(held<HeldMission>(a, "mission"), a.at("index").get<std::size_t>()));
  };
  calls["mission_text"] = [](const Json& a) -> Json {
    return mission_text(held<HeldMission>(a, "mission")->mission->as_written, a.at("folder").get<std::string>());
  };
  calls["run"] = &run;
  calls["try_each"] = &try_each;
  calls["result_report"] = &report;
  calls["save_result"] = &save;
  calls["query"] = &query;
  calls["answers"] = &answers;
  calls["fractions"] = &fractions;
  calls["free_mission"] = [](const Json& a) -> Json {
    return table<HeldMission>().erase(a.at("object").get<Handle>());
  };
  calls["free_result"] = [](const Json& a) -> Json { return table<HeldResult>().erase(a.at("object").get<Handle>()); };
  calls["free_query"] = [](const Json& a) -> Json { return table<HeldQuery>().erase(a.at("object").get<Handle>()); };
}

}  // namespace vantage::wasm
