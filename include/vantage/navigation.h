// Where the vehicle may fly.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "vantage/export.h"
#include "vantage/geometry.h"
#include "vantage/ground.h"
#include "vantage/progress.h"
#include "vantage/scene.h"
#include "vantage/sensor.h"

namespace vantage {

/// How far a viewpoint is above the ground at its x and y. Where pieces of ground lie over each other there, it is that
/// far above each of them. Where there is no ground, nothing is.
struct AboveGround {
  double min_m = 0.0, max_m = 0.0;  ///< min < max
  Ground ground;
};

/// How far a viewpoint must be from obstacles.
struct Clearance {
  double distance_m = 0;                       ///< > 0, at most 1e9; viewpoints at this distance are allowed
  std::shared_ptr<const Mesh> obstacles = {};  ///< scene frame, metres: any triangle soup; see obstacles_of. Shared,
                                               ///< since it may be as large as the scene
};

/// The triangles of all objects but those of ObjectKind::ground and those in `ground` (indices of objects), where that
/// leaves none, those of all objects; and of Scene::overhead. Throws Error(input) for arrays that PreparedScene
/// refuses. Cost: linear.
VANTAGE_API std::shared_ptr<const Mesh> obstacles_of(const Scene& scene, const std::vector<std::uint32_t>& ground = {});

/// A closed mesh to stay in.
struct KeepInMesh {
  Mesh mesh;         ///< closed, outward oriented, free of self-intersections; scene frame, metres
  std::string name;  ///< for messages and for causes in reports
};

/// What lies straight above and below a polygon, between two heights; or a box along the axes.
struct Zone {
  using Ring = std::vector<Eigen::Vector2d>;

  Zone() = default;
  Zone(const Box& box)  // NOLINT(google-explicit-constructor): a box is a zone
      : outer({{box.min.x(), box.min.y()},
               {box.max.x(), box.min.y()},
               {box.max.x(), box.max.y()},
               {box.min.x(), box.max.y()}}),
        min_z_m(box.min.z()),
        max_z_m(box.max.z()),
        is_box(true) {}

  /// Scene frame, x and y, metres: 3 corners or more, either turn, the first one not repeated. No side may cross or
  /// touch another one, of the same ring or of another; the sides of `holes` lie inside `outer`, and in no other hole.
  /// At most kMostCorners in all, none farther from 0 than 1e9 m.
  Ring outer;
  std::vector<Ring> holes;
  double min_z_m = -std::numeric_limits<double>::infinity();  ///< scene z; infinite: without bound
  double max_z_m = std::numeric_limits<double>::infinity();   ///< likewise; above min_z_m
  /// For messages and for causes in reports: "2" is "zone 2" there. Empty: the index in its list.
  std::string name;
  /// Made of a Box: `outer` are its corners in the order above, heights are finite, and there is nothing else.
  bool is_box = false;

  /// Besides the bounds of z; may be infinite. Where there is no ground, a zone to stay in holds nothing, and one to
  /// stay out of all between the bounds of z. Where pieces of ground lie over each other, a zone to stay out of begins
  /// at its height above the lowest one and ends at its height above the highest one.
  std::optional<AboveGround> above_ground = {};

  static constexpr std::size_t kMostCorners = 20'000;

  /// Of one that is a box.
  Box box() const { return {{outer[0].x(), outer[0].y(), min_z_m}, {outer[2].x(), outer[2].y(), max_z_m}}; }
};

/// As reports call a zone of a list: "zone 2", "zone park.kml NFZ6547".
inline std::string zone_name(const std::vector<Zone>& zones, std::size_t index) {
  return "zone " + (zones[index].name.empty() ? std::to_string(index) : zones[index].name);
}

/// Where the vehicle may fly: the intersection of all that is given. Empty: everywhere. The borders of limits belong to
/// what is allowed.
struct Navigation {
  struct Altitude {
    double min_m = 0.0, max_m = 0.0;  ///< scene z, min < max
  };
  std::optional<Altitude> altitude;
  std::vector<Zone> keep_in;       ///< the volume is cut to their union
  std::vector<Zone> keep_out;      ///< each is taken away
  std::vector<KeepInMesh> meshes;  ///< the volume is cut to each
  std::optional<AboveGround> above_ground = {};
  std::optional<Clearance> clearance = {};

  static constexpr std::size_t kMostZones = 10'000;  ///< to stay in and out of, together: 100,000 would take minutes

  VANTAGE_API bool empty() const;
};

/// Throws Error(input) for a limit that is wrong in itself, with its name in the words of this file as the place
/// ("navigation.keep_out[1]"): a band or a box that is reversed, empty or not finite, a zone that is none, ground or
/// obstacles with a coordinate that is not finite or an index out of range, a clearance that is not positive, a mesh
/// that is open, inside out or passes through itself. What cuts, asks, verifies or proves begins with this check, so
/// that all refuse the same limits in the same words. Error(cancelled) when told to stop. Cost: linear, but for zones
/// (O(n log n) in the corners where sides are short) and meshes (O(n log n) in the triangles as they are drawn).
VANTAGE_API void check_navigation(const Navigation& navigation, const Progress& progress = {});

}  // namespace vantage
