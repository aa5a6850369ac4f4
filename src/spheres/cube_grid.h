// How the texels of the six faces of a cube map meet: numbers for texel corners and neighbours across edges.
#pragma once

#include <array>
#include <cstdint>

#include "vantage/geometry.h"

namespace vantage::internal::spheres {

/// A texel corner as a point of the lattice {0..n}^3 on the surface of the cube: n (d + 1) / 2.
using Lattice = std::array<int, 3>;

/// Column i, row j of a face.
struct FaceCell {
  int face = 0, column = 0, row = 0;
};

class CubeGrid {
 public:
  explicit CubeGrid(int face_size);

  int size() const { return n_; }
  std::size_t corner_count() const { return 6 * static_cast<std::size_t>(n_) * n_ + 2; }

  Lattice lattice(const FaceCell& corner) const;
  /// 0 to corner_count - 1, the same for all faces that have the corner.
  std::uint32_t corner_index(const Lattice& at) const;
  /// Whether the point lies on the face, and where on it.
  bool on_face(const Lattice& at, int face, int& column, int& row) const;
  /// The face that numbers it: the first that has it.
  int owner(const Lattice& at) const;
  Vec3 direction(const Lattice& at) const;  ///< longest component 1

  std::uint32_t texel_index(const FaceCell& texel) const {
    return (static_cast<std::uint32_t>(texel.face) * n_ + texel.row) * n_ + texel.column;
  }
  Vec3 texel_direction(const FaceCell& texel) const;  ///< of its centre; longest component 1
  /// The texel that holds a direction (any length).
  FaceCell texel_at(const Vec3& direction) const;
  /// The texel beyond side 0 to 3 (right, left, top, bottom) of a face, opposite the `k`-th texel of that side.
  FaceCell across(int face, int side, int k) const;
  FaceCell at_side(int face, int side, int k) const;  ///< the `k`-th texel of that side itself

 private:
  struct Axes {
    std::array<int, 3> forward, right, up;
  };
  int n_;
  std::array<Axes, 6> axes_;
};

}  // namespace vantage::internal::spheres
