// One scene and one mission in it, for the page: the public API behind arrays and JSON texts.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/viewer_page.h"
#include "live/judged_flight.h"
#include "vantage/mission.h"
#include "vantage/progress.h"
#include "vantage/prove.h"
#include "vantage/query.h"
#include "vantage/result.h"

namespace vantage::live {

/// Positions for a graphics processor: single precision, about an origin that is told apart.
struct ViewMesh {
  std::vector<float> positions;          ///< x, y, z of each vertex less the origin, metres
  std::vector<std::uint32_t> triangles;  ///< three indices each
  std::vector<std::uint32_t> label_of;   ///< of each triangle: an object of the scene, or a cause of the volume
};

/// The version and the known cameras, as JSON.
std::string about();

/// Texts are those of docs/mission-file.md; JSON is one object. Throws Error. Copies share the scene. Not for two
/// threads at once, but a copy may be used beside its original: see fork().
class Session {
 public:
  /// A copy that shares nothing which either changes.
  Session fork() const;

  /// `text`: the section `scene` of a mission alone; its file lies in the current folder. A session keeps its scene
  /// when it cannot open another one. JSON: the scene.
  std::string open(std::string_view text);

  /// A mission file, of any scene. Later missions in this session may name the files that it names, and no others.
  void open_file(const std::filesystem::path& mission, const Progress& progress = {});
  /// A tileset without a mission: its tileset.json, or its address on the network. Later missions may name no files.
  void open_tileset(const std::filesystem::path& tileset, const Progress& progress = {});
  /// After open_file: computes the volume of that mission.
  void run(const Progress& progress = {});
  /// After open_file: a volume of that mission that is there already.
  void show_volume(const std::filesystem::path& volume, const Progress& progress = {});

  /// What is in memory: a mission, its scene, and its volume.
  void show(const ViewerRequest& request, const Progress& progress = {});

  /// After open_file: a flight to be judged by that mission and all that follow. Throws as judged_flight does.
  void show_flight(GivenFlight given, const Progress& progress = {});

  /// JSON: {about, scene, mission: the text of the file, of a tileset without a mission its scene alone, name: of it,
  /// volume: the last one, or null, flight: as flight() has it, judged by the mission that was opened, or null}.
  std::string hello() const;
  /// From here on hello() has the mission of the last volume as others may read it: written from what was read of its
  /// file, without comments, with names of files from its folder on, and without the keys and passwords of addresses.
  void hide_keys();

  /// `text`: a mission without `scene`. Computes the volume; a session keeps the last one when that fails.
  std::string compute(std::string_view text, const Progress& progress = {});
  /// What the same text says: its target and its limits, also where its volume is refused. JSON; changes nothing.
  std::string read(std::string_view text, const Progress& progress = {}) const;

  /// What the points (x, y, z in turn) see of the target of the last volume.
  std::string query(const std::vector<double>& coordinates);

  /// JSON of judged_flight: the flight that is shown, by the mission of the last volume, or else by the one that was
  /// opened, each of its targets by itself.
  std::string flight(const Progress& progress = {});

  /// The volumes of the targets of that mission, each by itself; of a target that is a volume, what the limits of
  /// navigation leave of it. target_volumes_view() has them, labelled by their targets. JSON: {volumes: [{name, reason:
  /// why it is empty, or ""}]}.
  std::string target_volumes(const Progress& progress = {});

  /// Proves the last volume, or refutes it: once.
  std::string prove(const Progress& progress = {});
  const std::optional<ProofReport>& proof() const { return proof_; }  ///< of the last volume, if it was asked for
  const std::optional<Result>& result() const { return result_; }     ///< of the last volume

  /// Polygons in which a plane at the height z meets the last volume.
  std::string slice(double z_m);

  /// The last volume as a file, one of format_words(): bytes() has it. JSON: its size.
  std::string save(const std::string& format);

  const SceneSource& source() const { return source_; }
  const Scene& scene() const { return opened_->loaded->scene; }

  const ViewMesh& scene_view() const { return *scene_view_; }
  const ViewMesh& volume_view() const { return volume_view_; }
  const ViewMesh& target_volumes_view() const { return target_volumes_view_; }
  const std::string& bytes() const { return bytes_; }

 private:
  struct ReadyScene {
    std::shared_ptr<const LoadedScene> loaded;
    PreparedScene prepared;
    std::string hash;
  };
  using ScenePointer = std::shared_ptr<const ReadyScene>;

  const Mission& mission() const;       ///< of the last volume
  const Mission& last_mission() const;  ///< the same, or the one that was opened where there is no volume yet
  /// With a volume for each target.
  Mission for_each_target(const Mission& mission, const Progress& progress) const;
  std::string judged(const Mission& mission, const Progress& progress) const;
  /// The scene that is open, or one with more ground, out to where the mission's target needs it.
  ScenePointer scene_of(const Mission& mission) const;
  RunOptions options(const ReadyScene& scene) const;
  void take_scene(const MissionFile& file, std::shared_ptr<const LoadedScene> loaded);
  void take_scene(const SceneSource& source, ScenePointer scene);
  void take_volume(Mission mission, ScenePointer scene, Result result);
  Mission resolved(std::string_view text, const Progress& progress) const;
  std::string scene_json() const;
  std::string volume_json() const;

  /// Where the mission is, from which the names of files start, and what it says.
  std::filesystem::path file_ = "mission.yaml";
  std::string text_;
  /// What was opened: missions may name its files. Nothing: any.
  std::optional<MissionFile> opened_file_;

  SceneSource source_;
  std::optional<double> sea_level_m_;
  ScenePointer opened_;
  std::shared_ptr<KeptVolumes> kept_ = std::make_shared<KeptVolumes>();
  Vec3 origin_ = Vec3::Zero();
  double read_ms_ = 0, prepare_ms_ = 0;
  std::shared_ptr<const ViewMesh> scene_view_ = std::make_shared<const ViewMesh>();

  std::shared_ptr<const Mission> mission_;
  ScenePointer computed_in_;
  std::optional<Result> result_;
  ProveOptions prove_options_;
  bool has_causes_ = true;  ///< some formats of files have no room for them
  std::optional<ProofReport> proof_;
  std::shared_ptr<ViewsQuery> query_;               ///< of the last volume; null: nothing was asked yet
  std::shared_ptr<const GivenFlight> flight_;       ///< null: none is shown
  std::shared_ptr<const std::string> flight_text_;  ///< judged by the mission that was opened
  double resolve_ms_ = 0, compute_ms_ = 0, view_ms_ = 0;
  ViewMesh volume_view_, target_volumes_view_;
  std::string bytes_;
};

}  // namespace vantage::live
