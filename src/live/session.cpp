#include "live/session.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <tuple>
#include <variant>

#include "common/input.h"
#include "common/json.h"
#include "common/ledger.h"
#include "common/output.h"
#include "common/shown_address.h"
#include "common/temporary_folder.h"
#include "live/file_bytes.h"
#include "live/limit_list.h"
#include "vantage/camera.h"
#include "vantage/error.h"
#include "vantage/ground.h"
#include "vantage/mission_tour.h"
#include "vantage/solid.h"
#include "vantage/tileset.h"
#include "vantage/version.h"
#include "vantage/volume.h"

namespace vantage::live {
namespace {

using Json = nlohmann::ordered_json;

std::string text_of(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }

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

constexpr std::size_t kMostListed = 500;

/// Nothing, or not all, holds their place; then the largest.
bool is_worse(const LedgerEntry& a, const LedgerEntry& b) {
  const auto rank = [](const LedgerEntry& entry) {
    const Vec3 size = entry.box ? Vec3(entry.box->max - entry.box->min) : Vec3::Zero();
    return std::tuple(badness(entry), -size.head<2>().norm());
  };
  return rank(a) < rank(b);
}

/// Where it is, as a zone: rings, and heights that end where the scene does where nobody knows them.
Json place_of(const LedgerEntry& entry, const Box& scene) {
  Json rings = Json::array();
  for (const auto& outline : entry.outlines) rings.push_back(outline);
  if (!entry.box) return {{"rings", std::move(rings)}, {"low", scene.min.z()}, {"high", scene.max.z()}};
  const auto& [min, max] = *entry.box;
  if (rings.empty()) rings.push_back({{min.x(), min.y()}, {max.x(), min.y()}, {max.x(), max.y()}, {min.x(), max.y()}});
  const double low = std::isfinite(min.z()) ? min.z() : scene.min.z();
  const double high = std::isfinite(max.z()) ? max.z() : entry.height_m ? low + *entry.height_m : scene.max.z();
  return {{"rings", std::move(rings)}, {"low", low}, {"high", high}};
}

/// What is not built as it stands: how much, and the worst of it.
Json ledger_of(const Scene& scene, const Box& box) {
  std::vector<const LedgerEntry*> worst;
  std::size_t held = 0;
  for (const LedgerEntry& entry : scene.ledger) {
    worst.push_back(&entry);
    if (entry.stand_in) ++held;
  }
  std::stable_sort(worst.begin(), worst.end(), [](const auto* a, const auto* b) { return is_worse(*a, *b); });
  Json list = Json::array();
  for (const LedgerEntry* entry : worst) {
    if (list.size() == kMostListed) break;
    const std::string name = display_name(entry->object);
    Json told = {{"name", name.empty() ? entry->what : name},
                 {"what", entry->what},
                 {"reason", entry->reason},
                 {"instead", entry->instead},
                 {"held", entry->stand_in.has_value()},
                 {"may_be_larger", entry->may_be_larger}};
    told.update(place_of(*entry, box));
    list.push_back(std::move(told));
  }
  return {{"count", scene.ledger.size()}, {"held", held}, {"worst", std::move(list)}};
}

/// Where they are looked at: moved by the target's offset. A volume to fly through has none.
void add_parts(const Target& target, Json& parts) {
  if (target.is_volume()) return;
  for (std::size_t i = 0; i < target.parts.size(); ++i) {
    const Vec3 offset =
        target.offset_m == 0 ? Vec3::Zero() : Vec3(target.offset_m * make_target_frame(target, i).normal);
    Json corners = Json::array();
    for (const Vec3& corner : target.parts[i]) corners.push_back(json(Vec3(corner + offset)));
    parts.push_back(std::move(corners));
  }
}

Json parts_of(const Mission& mission) {
  Json parts = Json::array();
  for (const std::vector<Target>& list : mission.views) {
    for (const Target& target : list) add_parts(target, parts);
  }
  if (mission.views.empty()) add_parts(mission.target, parts);
  return parts;
}

/// Where on the earth its origin lies, where it says so.
Json place_of(const Scene& scene) {
  if (!scene.georeference) return {};
  return {{"latitude_deg", scene.georeference->latitude_deg},
          {"longitude_deg", scene.georeference->longitude_deg},
          {"vertical", scene.georeference->vertical}};
}

Json json(const Box& box) { return {{"min", json(box.min)}, {"max", json(box.max)}}; }

Json json(const DrawnZone& zone) {
  Json rings = Json::array();
  for (const Zone::Ring& ring : zone.rings) {
    Json corners = Json::array();
    for (const Eigen::Vector2d& corner : ring) corners.push_back({corner.x(), corner.y()});
    rings.push_back(std::move(corners));
  }
  return {{"kept_out", zone.is_kept_out},
          {"name", zone.name},
          {"rings", std::move(rings)},
          {"low", zone.low_m},
          {"high", zone.high_m}};
}

/// What the page has controls for, and all limits: in words, and the zones to be drawn.
Json limits_of(const Mission& mission) {
  const auto& altitude = mission.navigation.altitude;
  const auto& above_ground = mission.navigation.above_ground;
  Json boxes = Json::array();
  for (const Zone& zone : mission.navigation.keep_out) {
    if (zone.is_box) boxes.push_back(json(zone.box()));
  }
  Json lines = Json::array(), zones = Json::array();
  for (const LimitLine& line : limit_lines(mission)) lines.push_back({{"name", line.name}, {"text", line.text}});
  for (const DrawnZone& zone : drawn_zones(mission)) zones.push_back(json(zone));
  const double range = mission.sensor.max_range_m;
  return {{"max_range", std::isfinite(range) ? Json(range) : Json()},
          {"min_range", mission.sensor.min_range_m},
          {"incidence", mission.sensor.incidence_deg ? Json(*mission.sensor.incidence_deg) : Json()},
          {"altitude", altitude ? Json{altitude->min_m, altitude->max_m} : Json()},
          {"agl", above_ground ? Json{above_ground->min_m, above_ground->max_m} : Json()},
          {"keep_out", std::move(boxes)},
          {"all", std::move(lines)},
          {"zones", std::move(zones)}};
}

/// What a position of the volume sees at least.
Json claim_of(const Mission& mission) {
  const auto& visible = mission.sensor.visible;
  const bool is_any =
      std::any_of(mission.views.begin(), mission.views.end(), [](const auto& targets) { return targets.size() > 1; });
  return {{"visible", visible ? visible->share : 1.0}, {"combine", name_of(is_any ? Combine::any : Combine::all)}};
}

Json causes_of(const Volume& volume) {
  Json list = Json::array();
  for (const Cause& cause : volume.causes) list.push_back({{"kind", name_of(cause.kind)}, {"name", cause.name}});
  return list;
}

/// Throws for an open mesh. A mesh without causes gets one.
void check_shown(Volume& volume, const std::string& where) {
  if (const OpenEdges open = find_open_edges(volume.mesh); open.count > 0) {
    throw Error(ErrorCode::mesh_not_closed, std::to_string(open.count) + " edges of the volume are open", where,
                "give a volume that 'vantage compute' wrote");
  }
  if (!volume.cause_of.empty()) return;
  volume.causes.resize(1);
  volume.cause_of.assign(volume.mesh.triangles.size(), 0);
}

/// Of `mission`, whose frame has this normal.
Json mission_json(const Mission& mission, const Vec3& normal) {
  return {{"name", mission.target.name},
          {"target", parts_of(mission)},
          {"normal", json(normal)},
          {"range_m", range_limit_m(mission.sensor)},
          {"limits", limits_of(mission)}};
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
  return text_of(Json{{"version", VANTAGE_VERSION}, {"cameras", std::move(cameras)}, {"formats", mesh_format_words()}});
}

Session Session::fork() const {
  Session other = *this;
  other.kept_ = std::make_shared<KeptVolumes>();
  other.query_.reset();
  return other;
}

void Session::take_scene(const MissionFile& file, std::shared_ptr<const LoadedScene> loaded) {
  Stopwatch time;
  PreparedScene prepared(loaded->scene);
  prepare_ms_ = time.lap();
  std::string hash = scene_hash(loaded->scene);
  take_scene(file.scene,
             std::make_shared<const ReadyScene>(ReadyScene{std::move(loaded), std::move(prepared), std::move(hash)}));
  sea_level_m_ = file.sea_level_m;
}

void Session::take_scene(const SceneSource& source, ScenePointer opened) {
  opened_ = std::move(opened);
  source_ = source;
  mission_.reset();
  computed_in_.reset();
  result_.reset();
  proof_.reset();
  query_.reset();
  volume_view_ = {};

  const Scene& scene = opened_->loaded->scene;
  const Box box = bounding_box(scene.mesh);
  origin_ = (box.min + box.max) / 2;
  scene_view_ = std::make_shared<const ViewMesh>(view_of(scene.mesh, scene.object_of, origin_));
}

Session::ScenePointer Session::scene_of(const Mission& mission) const {
  if (mission.loaded == opened_->loaded) return opened_;
  const Scene& scene = mission.loaded->scene;
  return std::make_shared<const ReadyScene>(ReadyScene{mission.loaded, PreparedScene(scene), scene_hash(scene)});
}

std::string Session::open(std::string_view text) {
  Stopwatch time;
  const MissionFile file = read_scene_text(text, file_);
  auto loaded = std::make_shared<const LoadedScene>(load_scene(file.scene));
  read_ms_ = time.lap();
  take_scene(file, std::move(loaded));
  return scene_json();
}

void Session::open_file(const std::filesystem::path& mission, const Progress& progress) {
  Stopwatch time;
  const MissionFile file = read_mission(mission);
  auto loaded = std::make_shared<const LoadedScene>(load_scene(file.scene, progress));
  Mission resolved = resolve_mission(file, loaded, progress);  // says what is wrong before anything is shown
  read_ms_ = time.lap();
  file_ = std::filesystem::absolute(mission);
  opened_file_ = file;
  text_ = bytes_of(file_);
  take_scene(file, std::move(loaded));
  computed_in_ = scene_of(resolved);
  mission_ = std::make_shared<const Mission>(std::move(resolved));
}

void Session::open_tileset(const std::filesystem::path& tileset, const Progress& progress) {
  Stopwatch time;
  const bool is_web = is_web_address(tileset);
  const std::string name = is_web ? tileset.string() : tileset.filename().string();
  file_ = is_web ? "mission.yaml" : std::filesystem::absolute(tileset).parent_path() / "mission.yaml";
  text_ = "scene: {tiles: " + text_of(Json(name)) + "}\n";
  const MissionFile file = read_scene_text(text_, file_);
  auto loaded = std::make_shared<const LoadedScene>(load_scene(file.scene, progress));
  read_ms_ = time.lap();
  opened_file_ = file;
  take_scene(file, std::move(loaded));
}

RunOptions Session::options(const ReadyScene& scene) const {
  return {.prepared = scene.prepared, .scene_hash = scene.hash, .kept = kept_};
}

void Session::run(const Progress& progress) {
  Stopwatch time;
  Result result = run_mission(*mission_, options(*computed_in_), progress);
  compute_ms_ = time.lap();
  take_volume(*mission_, computed_in_, std::move(result));
}

void Session::show_volume(const std::filesystem::path& volume, const Progress& progress) {
  Mission mission = *mission_;
  VolumeFile file = read_volume(volume, mission.scene(), progress);
  const bool has_causes = !file.volume.cause_of.empty();
  const VerifyOptions known = verify_options(file, mission);
  const std::vector<Warning> warnings = volume_warnings(file, mission);
  Volume& read = file.volume;
  read.notes = mission_warnings(mission, &read);
  compute_ms_ = 0;
  read.notes.insert(read.notes.end(), file.notes.begin(), file.notes.end());
  read.notes.insert(read.notes.end(), warnings.begin(), warnings.end());
  check_shown(read, volume.string());
  read.frame = prepare_views(mission, computed_in_->prepared).front().front().frame();  // of several targets, the first
  Result result;
  result.volume = std::move(read);
  take_volume(std::move(mission), computed_in_, std::move(result));
  has_causes_ = has_causes;
  prove_options_ = {.rounding_m = known.rounding_m, .lift_m = known.lift_m};
}

void Session::show(const ViewerRequest& request, const Progress& progress) {
  Volume volume = *request.volume;
  const bool has_causes = !volume.cause_of.empty();
  check_shown(volume, "volume");
  for (const Warning& note : mission_warnings(*request.mission, &volume)) {
    if (std::find(volume.notes.begin(), volume.notes.end(), note) == volume.notes.end()) volume.notes.push_back(note);
  }
  file_ = request.name;
  take_scene(request.source, std::make_shared<const ReadyScene>(
                                 ReadyScene{request.loaded, request.prepared, scene_hash(request.loaded->scene)}));
  ScenePointer scene = scene_of(*request.mission);
  if (progress && !progress("drawing", 0)) throw Error(ErrorCode::cancelled, "stopped", "", "");
  if (volume.frame.polygon.empty() && !request.mission->target.is_volume()) {  // it was read, or made of arrays
    volume.frame = prepare_views(*request.mission, scene->prepared).front().front().frame();
  }
  Result result;
  result.volume = std::move(volume);
  take_volume(*request.mission, std::move(scene), std::move(result));
  has_causes_ = has_causes;
  prove_options_ = {.rounding_m = request.rounding_m, .lift_m = result_->volume.lift_m};
}

void Session::show_flight(GivenFlight given, const Progress& progress) {
  flight_ = std::make_shared<const GivenFlight>(std::move(given));
  flight_text_ = std::make_shared<const std::string>(judged(*mission_, progress));
}

Mission Session::for_each_target(const Mission& mission, const Progress& progress) const {
  if (!mission.as_written.lists_targets()) return mission;
  MissionFile file = mission.as_written;
  file.combine = Combine::each;
  return resolve_mission(file, opened_->loaded, progress);
}

std::string Session::judged(const Mission& mission, const Progress& progress) const {
  const Mission each = for_each_target(mission, progress);
  return judged_flight(*flight_, each, scene_of(each)->prepared, progress);
}

std::string Session::target_volumes(const Progress& progress) {
  const Mission each = for_each_target(last_mission(), progress);
  const ScenePointer scene = scene_of(each);
  Mesh all;
  std::vector<std::uint32_t> target_of;
  Json volumes = Json::array();
  for (std::uint32_t i = 0; i < volume_count(each); ++i) {
    const Mission one = one_volume(each, i);
    const Volume volume = one.target.is_volume() && one.views.empty()
                              ? volume_to_fly_through(one, progress)
                              : run_mission(one, {.prepared = scene->prepared}, progress).volume;
    const auto first = static_cast<std::uint32_t>(all.vertices.size());
    all.vertices.insert(all.vertices.end(), volume.mesh.vertices.begin(), volume.mesh.vertices.end());
    for (const auto& triangle : volume.mesh.triangles) {
      all.triangles.push_back({triangle[0] + first, triangle[1] + first, triangle[2] + first});
      target_of.push_back(i);
    }
    volumes.push_back({{"name", one.target.name}, {"reason", volume.reason}});
  }
  target_volumes_view_ = view_of(all, target_of, origin_);
  return text_of(Json{{"volumes", std::move(volumes)}});
}

std::string Session::flight(const Progress& progress) {
  if (!flight_) throw Error(ErrorCode::nothing_given, "no flight is shown", "", "start the program with --flight");
  return judged(last_mission(), progress);
}

void Session::hide_keys() {
  MissionFile file = last_mission().as_written;
  const std::filesystem::path folder =
      std::filesystem::weakly_canonical(std::filesystem::absolute(file_)).parent_path();
  for (std::filesystem::path* const named : {&file.scene.file, &file.scene.city.terrain, &file.scene.terrain}) {
    if (is_web_address(*named)) {
      *named = shown_address(*named);
    } else if (!named->empty()) {
      *named = std::filesystem::absolute(*named).lexically_relative(folder);
    }
  }
  for (MissionTarget& one : file.targets) {
    if (auto* const target = std::get_if<TargetFile>(&one.source)) target->file = target->name;
  }
  for (NavigationMeshFile& mesh : file.navigation_meshes) mesh.file = mesh.name;
  for (std::vector<ZoneFile>* const zones : {&file.keep_in_files, &file.keep_out_files}) {
    for (ZoneFile& zone : *zones) zone.file = zone.name;
  }
  text_ = mission_text(file, folder);
}

std::string Session::hello() const {
  // Put together as text: a flight of a million points is not read again for each window.
  std::string text = R"({"about":)" + about() + R"(,"scene":)" + scene_json();
  text += R"(,"mission":)" + text_of(text_) + R"(,"name":)" + text_of(file_.filename().string());
  text += R"(,"volume":)" + (result_ ? volume_json() : "null") + R"(,"flight":)";
  text += flight_ ? *flight_text_ : "null";
  return text + "}";
}

std::string Session::scene_json() const {
  const Scene& scene = opened_->loaded->scene;
  const Box box = bounding_box(scene.mesh);
  return text_of(Json{{"hash", opened_->hash},
                      {"triangles", scene.mesh.triangles.size()},
                      {"origin", json(origin_)},
                      {"min", json(box.min)},
                      {"max", json(box.max)},
                      {"objects", objects_of(scene)},
                      {"has_ground", ground_of(scene).has_value()},
                      {"has_areas", source_.kind == SceneSource::Kind::map},
                      {"place", place_of(scene)},
                      {"attribution", attribution_of(scene)},
                      {"notes", notes_of(*opened_->loaded)},
                      {"ledger", ledger_of(scene, box)},
                      {"read_ms", read_ms_},
                      {"prepare_ms", prepare_ms_}});
}

Mission Session::resolved(std::string_view text, const Progress& progress) const {
  if (!opened_) throw Error(ErrorCode::nothing_given, "no scene is open", "", "open a mesh first");
  MissionFile file =
      opened_file_ ? read_mission_text(text, file_, source_, *opened_file_) : read_mission_text(text, file_, source_);
  file.sea_level_m = sea_level_m_;
  return resolve_mission(file, opened_->loaded, progress);
}

std::string Session::read(std::string_view text, const Progress& progress) const {
  const Mission mission = resolved(text, progress);
  const bool has_frame = !mission.target.parts.empty() && mission.target.parts.front().size() > 2;
  return text_of(mission_json(mission, has_frame ? make_target_frame(mission.target).normal : Vec3::Zero()));
}

std::string Session::compute(std::string_view text, const Progress& progress) {
  Stopwatch time;
  Mission mission = resolved(text, progress);
  ScenePointer scene = scene_of(mission);
  const double resolve_ms = time.lap();
  Result result = run_mission(mission, options(*scene), progress);
  const double compute_ms = time.lap();
  // The last volume stays where this one was stopped, however late.
  if (progress && !progress("drawing", 0)) throw Error(ErrorCode::cancelled, "stopped", "", "");
  take_volume(std::move(mission), std::move(scene), std::move(result));
  view_ms_ = time.lap();
  resolve_ms_ = resolve_ms;
  compute_ms_ = compute_ms;
  return volume_json();
}

void Session::take_volume(Mission mission, ScenePointer scene, Result result) {
  // First what may fail for want of memory: then the last volume stays whole.
  ViewMesh view = view_of(result.volume.mesh, result.volume.cause_of, origin_);
  mission_ = std::make_shared<const Mission>(std::move(mission));
  computed_in_ = std::move(scene);
  result_.emplace(std::move(result));
  has_causes_ = true;
  prove_options_ = {.lift_m = result_->volume.lift_m};
  proof_.reset();
  query_.reset();
  volume_view_ = std::move(view);
}

std::string Session::volume_json() const {
  const Volume& volume = result_->volume;
  Json told = mission_json(*mission_, volume.frame.normal);
  told.update(Json{{"outcome", name_of(volume.outcome)},
                   {"reason", volume.reason},
                   {"hint", volume.hint},
                   {"center", json(volume.frame.origin)},
                   {"claim", claim_of(*mission_)},
                   {"volume_m3", enclosed_volume(volume.mesh)},
                   {"area_m2", surface_area(volume.mesh)},
                   {"facets", volume.mesh.triangles.size()},
                   {"causes", has_causes_ ? causes_of(volume) : Json{{{"kind", "unknown"}, {"name", ""}}}},
                   {"notes", json(volume.notes)},
                   {"resolve_ms", resolve_ms_},
                   {"compute_ms", compute_ms_},
                   {"view_ms", view_ms_}});
  return text_of(told);
}

const Mission& Session::mission() const {
  if (!result_) throw Error(ErrorCode::nothing_given, "there is no volume yet", "", "choose a target first");
  return *mission_;
}

const Mission& Session::last_mission() const { return mission_ ? *mission_ : mission(); }

std::string Session::query(const std::vector<double>& coordinates) {
  if (!query_) {
    query_ = std::make_shared<ViewsQuery>(prepare_views(mission(), computed_in_->prepared), mission().navigation);
  }
  std::vector<Vec3> points;
  for (std::size_t i = 0; i + 2 < coordinates.size(); i += 3) {
    points.emplace_back(coordinates[i], coordinates[i + 1], coordinates[i + 2]);
  }
  Json answers = Json::array();
  for (const PointAnswer& answer : query_->answer(points)) {
    answers.push_back({{"inside", answer.inside},
                       {"margin_m", std::isfinite(answer.margin_m) ? Json(answer.margin_m) : Json()},
                       {"blocked_by", answer.blocked_by},
                       {"out_of_range", answer.out_of_range},
                       {"behind_target", answer.behind_target},
                       {"outside_of", answer.outside_of}});
  }
  return text_of(Json{{"answers", std::move(answers)}});
}

std::string Session::prove(const Progress& progress) {
  const Mission& proved = mission();
  if (!proof_) proof_ = prove_volume(proved, result_->volume.mesh, prove_options_, progress);
  return json_text(*proof_);
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
  return text_of(Json{{"z_m", z_m}, {"area_m2", area}, {"polygons", std::move(polygons)}});
}

std::string Session::save(const std::string& format) {
  const std::vector<std::string> formats = mesh_format_words();
  if (std::find(formats.begin(), formats.end(), format) == formats.end()) {
    throw Error(ErrorCode::output_format_unknown, in_quotes(format) + " is not a format of volumes", "",
                "take " + mesh_format_words_text());
  }
  const Mission& saved = mission();
  if (const Volume& last = result_->volume; last.outcome != Outcome::computed) {
    throw Error(ErrorCode::nothing_given, "there is no volume to save: " + last.reason, saved.target.name, last.hint);
  }
  const TemporaryFolder folder;
  const std::vector<std::filesystem::path> files{folder.path() / ("volume." + format)};
  Volume volume = result_->volume;
  write_results(volume, result_request(saved, *result_, files));
  bytes_ = bytes_of(files.front());
  return text_of(Json{{"size", bytes_.size()}});
}

}  // namespace vantage::live
