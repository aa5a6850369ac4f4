#include "session.h"

#include <chrono>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "vantage/camera.h"
#include "vantage/error.h"
#include "vantage/hash.h"
#include "vantage/json.h"
#include "vantage/slice.h"
#include "vantage/version.h"

namespace vantage::live {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kFile = "mission.yaml";

class Stopwatch {
 public:
  /// Milliseconds since it was made or asked last.
  double lap() {
    const auto now = std::chrono::steady_clock::now();
    const std::chrono::duration<double, std::milli> time = now - last_;
    last_ = now;
    return time.count();
  }

 private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

Json json(const Vec3& point) { return {point.x(), point.y(), point.z()}; }

Json json(const std::vector<Warning>& notes) {
  Json list = Json::array();
  for (const Warning& note : notes) list.push_back({{"code", name_of(note.code)}, {"text", note.text}});
  return list;
}

ViewMesh view_of(const Mesh& mesh, const std::vector<std::uint32_t>& label_of, const Vec3& origin) {
  ViewMesh view;
  view.positions.reserve(3 * mesh.vertices.size());
  for (const Vec3& vertex : mesh.vertices) {
    const Vec3 at = vertex - origin;
    for (int axis = 0; axis < 3; ++axis) view.positions.push_back(static_cast<float>(at[axis]));
  }
  view.triangles.reserve(3 * mesh.triangles.size());
  for (const auto& triangle : mesh.triangles)
    view.triangles.insert(view.triangles.end(), triangle.begin(), triangle.end());
  view.label_of = label_of;
  return view;
}

Json objects_of(const Scene& scene) {
  Json list = Json::array();
  for (const SceneObject& object : scene.objects)
    list.push_back({{"name", display_name(object)}, {"kind", name_of(object.kind)}});
  return list;
}

Json parts_of(const Target& target) {
  Json parts = Json::array();
  for (const auto& part : target.parts) {
    Json corners = Json::array();
    for (const Vec3& corner : part) corners.push_back(json(corner));
    parts.push_back(std::move(corners));
  }
  return parts;
}

Json json(const Box& box) { return {{"min", json(box.min)}, {"max", json(box.max)}}; }

/// What the page has controls for.
Json limits_of(const Mission& mission) {
  const auto& altitude = mission.navigation.altitude;
  Json boxes = Json::array();
  for (const Box& box : mission.navigation.keep_out) boxes.push_back(json(box));
  const double range = range_limit_m(mission.sensor);
  return {{"max_range", std::isfinite(range) ? Json(range) : Json()},
          {"min_range", mission.sensor.min_range_m},
          {"incidence", mission.sensor.incidence_deg ? Json(*mission.sensor.incidence_deg) : Json()},
          {"altitude", altitude ? Json{altitude->min_m, altitude->max_m} : Json()},
          {"keep_out", std::move(boxes)}};
}

Json causes_of(const Volume& volume) {
  Json list = Json::array();
  for (const Cause& cause : volume.causes) list.push_back({{"kind", name_of(cause.kind)}, {"name", cause.name}});
  return list;
}

}  // namespace

std::string about() {
  Json cameras = Json::array();
  for (const Camera& camera : known_cameras()) {
    cameras.push_back({{"name", camera.name},
                       {"maker", camera.maker},
                       {"model", camera.model},
                       {"fov_deg", pinhole_of(camera).fov_deg()}});
  }
  return Json{{"version", VANTAGE_VERSION}, {"cameras", std::move(cameras)}}.dump();
}

std::string Session::open(std::string_view text) {
  Stopwatch time;
  MissionFile file = read_scene_text(text, kFile);
  auto loaded = std::make_shared<const LoadedScene>(load_scene(file.scene));
  const double read_ms = time.lap();
  PreparedScene prepared(loaded->scene);
  const double prepare_ms = time.lap();

  scene_file_ = std::move(file);
  loaded_ = std::move(loaded);
  prepared_.emplace(std::move(prepared));
  scene_hash_ = scene_hash(loaded_->scene);
  mission_.reset();
  result_.reset();
  query_.reset();
  volume_view_ = {};

  const Scene& scene = loaded_->scene;
  const Box box = bounding_box(scene.mesh);
  origin_ = (box.min + box.max) / 2;
  scene_view_ = view_of(scene.mesh, scene.object_of, origin_);
  return Json{{"hash", scene_hash_},         {"triangles", scene.mesh.triangles.size()},
              {"origin", json(origin_)},     {"min", json(box.min)},
              {"max", json(box.max)},        {"objects", objects_of(scene)},
              {"notes", notes_of(*loaded_)}, {"read_ms", read_ms},
              {"prepare_ms", prepare_ms}}
      .dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string Session::compute(std::string_view text) {
  if (!loaded_) throw Error(ErrorCode::nothing_given, "no scene is open", "", "open a mesh first");
  Stopwatch time;
  MissionFile file = read_mission_text(text, kFile, scene_file_.scene);
  file.sea_level_m = scene_file_.sea_level_m;
  Mission mission = resolve_mission(file, loaded_);
  const double resolve_ms = time.lap();
  Result result = run_mission(mission, {.prepared = prepared_, .scene_hash = scene_hash_});
  const double compute_ms = time.lap();

  text_ = text;
  mission_.emplace(std::move(mission));
  result_.emplace(std::move(result));
  query_.reset();
  const Volume& volume = result_->volume;
  volume_view_ = view_of(volume.mesh, volume.cause_of, origin_);
  const MeshMeasures measures = measure(volume.mesh);
  return Json{{"outcome", name_of(volume.outcome)},
              {"reason", volume.reason},
              {"hint", volume.hint},
              {"target", parts_of(mission_->target)},
              {"center", json(volume.frame.origin)},
              {"normal", json(volume.frame.normal)},
              {"range_m", range_limit_m(mission_->sensor)},
              {"limits", limits_of(*mission_)},
              {"volume_m3", measures.volume_m3},
              {"area_m2", measures.area_m2},
              {"facets", volume.mesh.triangles.size()},
              {"causes", causes_of(volume)},
              {"notes", json(volume.notes)},
              {"resolve_ms", resolve_ms},
              {"compute_ms", compute_ms},
              {"view_ms", time.lap()}}
      .dump(-1, ' ', false, Json::error_handler_t::replace);
}

const Mission& Session::mission() const {
  if (!mission_) throw Error(ErrorCode::nothing_given, "there is no volume yet", "", "choose a target first");
  return *mission_;
}

std::string Session::query(const std::vector<double>& coordinates) {
  if (!query_) query_.emplace(prepare_target(mission(), *prepared_), mission().navigation);
  std::vector<Vec3> points;
  for (std::size_t i = 0; i + 2 < coordinates.size(); i += 3)
    points.emplace_back(coordinates[i], coordinates[i + 1], coordinates[i + 2]);
  Json answers = Json::array();
  for (const PointAnswer& answer : query_->answer(points)) {
    answers.push_back({{"inside", answer.inside},
                       {"margin_m", std::isfinite(answer.margin_m) ? Json(answer.margin_m) : Json()},
                       {"blocked_by", answer.blocked_by},
                       {"out_of_range", answer.out_of_range},
                       {"behind_target", answer.behind_target},
                       {"outside_of", answer.outside_of}});
  }
  return Json{{"answers", answers}}.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string Session::prove() {
  return json_text(prove_volume(mission(), result_->volume.mesh, {.lift_m = result_->volume.lift_m}));
}

std::string Session::slice(double z_m) {
  mission();
  Json polygons = Json::array();
  const auto ring_json = [](const PlanPolygon::Ring& ring) {
    Json corners = Json::array();
    for (const Eigen::Vector2d& corner : ring) corners.push_back({corner.x(), corner.y()});
    return corners;
  };
  double area = 0;
  for (const PlanPolygon& polygon : slice_mesh(result_->volume.mesh, z_m)) {
    Json rings = Json::array({ring_json(polygon.outer)});
    for (const PlanPolygon::Ring& hole : polygon.holes) rings.push_back(ring_json(hole));
    polygons.push_back(std::move(rings));
    area += area_m2(polygon);
  }
  return Json{{"z_m", z_m}, {"area_m2", area}, {"polygons", polygons}}.dump();
}

std::string Session::save(const std::string& file) {
  mission();
  const std::vector<std::filesystem::path> files{file};
  check_result_files(files, {});
  Volume volume = result_->volume;
  const WrittenResults written = write_results(volume, result_request(mission(), *result_, files));
  Json reports = Json::array();
  for (const auto& report : written.reports) reports.push_back(report.string());
  return Json{{"reports", reports}}.dump();
}

}  // namespace vantage::live
