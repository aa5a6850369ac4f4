#include "spheres/cube_grid.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "depth/depth.h"

namespace vantage::internal::spheres {
namespace {

std::array<int, 3> whole(const Vec3& v) {
  return {static_cast<int>(v.x()), static_cast<int>(v.y()), static_cast<int>(v.z())};
}

Vec3 real(const std::array<int, 3>& v) {
  return {static_cast<double>(v[0]), static_cast<double>(v[1]), static_cast<double>(v[2])};
}

}  // namespace

CubeGrid::CubeGrid(int face_size) : n_(face_size) {
  for (std::size_t f = 0; f < 6; ++f) {
    const depth::CubeFace& face = depth::cube_faces()[f];
    axes_[f] = {whole(face.forward), whole(face.right), whole(face.up)};
  }
}

Lattice CubeGrid::lattice(const FaceCell& corner) const {
  const Axes& axes = axes_[corner.face];
  Lattice at;
  for (int a = 0; a < 3; ++a) {
    // n (forward + u right + v up + 1) / 2 with u = 2 column / n - 1.
    const int doubled =
        n_ * (axes.forward[a] + 1) + (2 * corner.column - n_) * axes.right[a] + (2 * corner.row - n_) * axes.up[a];
    at[a] = doubled / 2;
  }
  return at;
}

// The bottom square, row by row; then the rings above it; then the top square.
std::uint32_t CubeGrid::corner_index(const Lattice& at) const {
  const auto [x, y, z] = at;
  const std::uint32_t side = static_cast<std::uint32_t>(n_) + 1, square = side * side,
                      ring = 4 * static_cast<std::uint32_t>(n_);
  if (z == 0) return y * side + x;
  if (z == n_) return square + ring * (n_ - 1) + y * side + x;
  int along;
  if (y == 0) {
    along = x;
  } else if (x == n_) {
    along = n_ + y;
  } else if (y == n_) {
    along = 3 * n_ - x;
  } else {
    along = 4 * n_ - y;
  }
  return square + ring * (z - 1) + along % (4 * n_);
}

bool CubeGrid::on_face(const Lattice& at, int face, int& column, int& row) const {
  const Axes& axes = axes_[face];
  int forward = 0, right = 0, up = 0;
  for (int a = 0; a < 3; ++a) {
    const int d = 2 * at[a] - n_;
    forward += d * axes.forward[a];
    right += d * axes.right[a];
    up += d * axes.up[a];
  }
  column = (right + n_) / 2;
  row = (up + n_) / 2;
  return forward == n_;
}

int CubeGrid::owner(const Lattice& at) const {
  int column, row, face = 0;
  while (!on_face(at, face, column, row)) ++face;
  return face;
}

Vec3 CubeGrid::direction(const Lattice& at) const {
  return {2.0 * at[0] / n_ - 1, 2.0 * at[1] / n_ - 1, 2.0 * at[2] / n_ - 1};
}

Vec3 CubeGrid::texel_direction(const FaceCell& texel) const {
  const Axes& axes = axes_[texel.face];
  const double u = (2.0 * texel.column + 1) / n_ - 1, v = (2.0 * texel.row + 1) / n_ - 1;
  return real(axes.forward) + u * real(axes.right) + v * real(axes.up);
}

FaceCell CubeGrid::texel_at(const Vec3& direction) const {
  Eigen::Index axis;
  const double longest = direction.cwiseAbs().maxCoeff(&axis);
  FaceCell cell{static_cast<int>(2 * axis) + (direction[axis] < 0), 0, 0};
  const Axes& axes = axes_[cell.face];
  const auto index = [&](const std::array<int, 3>& along) {
    return std::clamp(static_cast<int>(std::floor((real(along).dot(direction) / longest + 1) * n_ / 2)), 0, n_ - 1);
  };
  cell.column = index(axes.right);
  cell.row = index(axes.up);
  return cell;
}

FaceCell CubeGrid::at_side(int face, int side, int k) const {
  const int end = side % 2 == 0 ? n_ - 1 : 0;
  return side < 2 ? FaceCell{face, end, k} : FaceCell{face, k, end};
}

FaceCell CubeGrid::across(int face, int side, int k) const {
  const Axes& axes = axes_[face];
  const Vec3 out = (side % 2 == 0 ? 1 : -1) * real(side < 2 ? axes.right : axes.up);
  const Vec3 along = real(side < 2 ? axes.up : axes.right);
  // A little beyond the edge, so that the other face is the one that is looked through.
  return texel_at(real(axes.forward) * (1 - 0.5 / n_) + out + ((2.0 * k + 1) / n_ - 1) * (1 - 0.1 / n_) * along);
}

}  // namespace vantage::internal::spheres
