// One scene and one mission in it, for the page: the public API behind arrays and JSON texts.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "vantage/mission.h"
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

/// Texts are those of docs/mission-file.md; JSON is one object. Throws Error.
class Session {
 public:
  /// `text`: the section `scene` of a mission alone; its file lies in the folder of the program. A session keeps its
  /// scene when it cannot open another one.
  std::string open(std::string_view text);

  /// `text`: a mission without `scene`. Computes the volume; a session keeps the last one when that fails.
  std::string compute(std::string_view text);

  /// What the points (x, y, z in turn) see of the target of the last volume.
  std::string query(const std::vector<double>& coordinates);

  /// Proves the last volume, or refutes it.
  std::string prove();

  /// Polygons in which a plane at the height z meets the last volume.
  std::string slice(double z_m);

  /// Writes the last volume to a file, and its report beside it.
  std::string save(const std::string& file);

  const ViewMesh& scene_view() const { return scene_view_; }
  const ViewMesh& volume_view() const { return volume_view_; }

 private:
  const Mission& mission() const;

  MissionFile scene_file_;
  std::shared_ptr<const LoadedScene> loaded_;
  std::optional<PreparedScene> prepared_;
  std::string scene_hash_;
  Vec3 origin_ = Vec3::Zero();
  ViewMesh scene_view_, volume_view_;
  std::string text_;  ///< of the last mission
  std::optional<Mission> mission_;
  std::optional<Result> result_;
  std::optional<PointQuery> query_;
};

}  // namespace vantage::live
