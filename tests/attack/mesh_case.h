// A mesh that is claimed to be a volume, and what it is claimed for: `vantage_attack --meshes`.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "random.h"
#include "vantage/navigation.h"
#include "vantage/prove.h"
#include "vantage/scene.h"
#include "vantage/sensor.h"
#include "vantage/target.h"

namespace attack {

using vantage::Vec3;

struct MeshCase {
  std::string kind;  ///< "point | sun | box, lobe"
  double unit = 1;   ///< size of the drawing: the range is some tens of it
  std::uint64_t seed = 0;
  vantage::Scene scene;
  std::optional<std::uint32_t> ground;  ///< the object that heights are measured from
  vantage::Target target;
  bool both_sides = false;  ///< `target` has a front, and its back may be looked at as well
  vantage::Sensor sensor;
  std::array<double, 2> fov_deg = {0, 0};  ///< of the camera
  vantage::Navigation navigation;
  vantage::Mesh volume;
  double shrink = 1e-6;
  double rounding_m = 0;       ///< of the file that the mesh would be from
  double lift_m = 0;           ///< so far the target is said to have been raised
  std::vector<Vec3> suspects;  ///< places from which not all is as it should be
};

// ---- what the drawing of claims shares ----

inline constexpr double kClaimRange = 40;  ///< before all is moved

/// Of the target.
Vec3 middle_of(const MeshCase& c);
vantage::Mesh block(const Vec3& low, const Vec3& high);
vantage::Box box_about(Random& random, const Vec3& middle, double least, double most);
void claim_min_range(Random& random, MeshCase& c);
void claim_camera(Random& random, MeshCase& c);

/// Scene, target and limits; without volume.
MeshCase draw_claim(Random& random);

/// A point in front of the target, as often near as far, within the range or a little beyond.
Vec3 draw_place(const MeshCase& c, Random& random);

/// The case `index` of the run `seed`, the same on every machine. Nothing where the target does not suit the scene.
std::optional<MeshCase> draw_mesh_case(std::uint64_t seed, std::size_t index);

/// What a position must see: the target, or each of its two sides, of which one is enough.
std::vector<vantage::Target> sides_of(const MeshCase& c);

/// The verdicts on what is claimed, of all sides together.
struct Verdicts {
  std::vector<vantage::ProofReport> reports;  ///< one a side
  std::string refusal;                        ///< why there are none

  std::vector<std::string> names() const;
  vantage::ProofVerdict of(const std::string& claim) const;  ///< the worst
  vantage::ProofVerdict of_all() const;
};
Verdicts prove(const MeshCase& c);

/// Which claims a point breaks, as query_points sees it. Not for meshes: of lines of sight and limits alone.
class QueryOracle {
 public:
  explicit QueryOracle(const MeshCase& c);

  /// Names of claims, for each point. Of both sides: of the one that it is in front of.
  std::vector<std::vector<std::string>> broken(const std::vector<Vec3>& points);

 private:
  struct Data;
  std::shared_ptr<Data> data_;
};

/// Every bit of it, and nothing mended.
void write_ply(const vantage::Mesh& mesh, const std::filesystem::path& file);

/// Writes mission.yaml, scene.obj and volume.ply into the folder, which is made.
void write_mesh_case(const MeshCase& c, const std::filesystem::path& folder);

}  // namespace attack
