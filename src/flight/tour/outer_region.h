// What bounds of tours are over: sets that hold all places where a target counts as visited. A bound over anything
// smaller is none, so that such sets are made of outer volumes only, and of regions that are given as they are.
#pragma once

#include <cstdint>
#include <string>

#include "vantage/geometry.h"
#include "vantage/result.h"
#include "vantage/volume.h"

namespace vantage::internal::flight::tour {

class OuterRegion {
 public:
  enum class Kind : std::uint8_t {
    outer,  ///< the outer volume of a mission
    given,  ///< the region itself, by definition: a mesh that somebody drew
    point,  ///< a place, such as the home
  };

  /// Throws Error(input) for a volume that was computed (it lies inside, so that no bound can be had of it), although
  /// it was put into an OuterVolume, and for one that is empty: then no tour visits it.
  static OuterRegion of(const OuterVolume& volume, std::string name);

  /// A union of closed meshes, all triangles in one, that is the region itself. Throws Error(input) for an empty mesh,
  /// an index out of range, and a coordinate that is not finite or larger than 1e9 m.
  static OuterRegion given(Mesh mesh, std::string name);
  /// The same of a mesh that was read. Throws Error(input) for one that says of itself that vantage computed it: what
  /// is to be visited is larger than what was computed.
  static OuterRegion given(const Volume& volume, std::string name);

  /// Throws Error(input) for a coordinate that is not finite or larger than 1e9 m.
  static OuterRegion point(const Vec3& place, std::string name);

  Kind kind() const { return kind_; }
  const std::string& name() const { return name_; }
  /// Without triangles, and with one vertex, for a point.
  const Mesh& mesh() const { return mesh_; }

 private:
  OuterRegion(Kind kind, Mesh mesh, std::string name);

  Kind kind_;
  Mesh mesh_;
  std::string name_;
};

/// "outer", "given", "point".
const char* name_of(OuterRegion::Kind kind);

}  // namespace vantage::internal::flight::tour
