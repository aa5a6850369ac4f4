#include "spheres/sphere_mesh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>

#include "core/parallel.h"
#include "spheres/cube_grid.h"
#include "spheres/merge.h"
#include "spheres/numerics.h"
#include "spheres/texel_depths.h"

namespace vantage::internal::spheres {
namespace {

/// The point t d with t = 1 / w, no nearer than the floor and no farther than the range.
void set_ray(StarMesh& star, std::size_t vertex, const Vec3& direction, double inverse_depth, double range_m,
             double shorten) {
  const double at_range = range_m / direction.norm();
  const double depth = inverse_depth > 0 ? 1 / inverse_depth : std::numeric_limits<double>::infinity();
  star.at_range[vertex] = depth >= at_range;
  star.rays[vertex] = std::max(std::min(depth, at_range) * shorten, numerics::kFloor) * direction;
}

void resize(StarMesh& star, std::size_t vertices) {
  star.rays.resize(vertices);
  star.at_range.resize(vertices);
}

std::size_t row_grain(int n) { return std::max<std::size_t>(1, std::size_t{1 << 13} / n); }

/// Runs `body(face, row)` for rows 0 to rows - 1 of all faces.
template <typename Body>
void for_face_rows(int rows, int n, const Body& body) {
  parallel::for_ranges(6 * static_cast<std::size_t>(rows), row_grain(n), [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) body(static_cast<int>(k / rows), static_cast<int>(k % rows));
  });
}

/// Turned so that it is seen from outside counter-clockwise: the corners' rays make a right-handed system.
Triangle outward(const StarMesh& star, Triangle t) {
  if (star.rays[t[0]].dot(star.rays[t[1]].cross(star.rays[t[2]])) < 0) std::swap(t[1], t[2]);
  return t;
}

/// Strips between the faces along the cube's edges, and a triangle at each of its corners.
void stitch(const CubeGrid& grid, StarMesh& star) {
  const int n = grid.size();
  for (int face = 0; face < 6; ++face) {
    for (int side = 0; side < 4; ++side) {
      if (grid.across(face, side, 0).face < face) continue;
      for (int k = 0; k + 1 < n; ++k) {
        const std::uint32_t a = grid.texel_index(grid.at_side(face, side, k)),
                            b = grid.texel_index(grid.at_side(face, side, k + 1)),
                            c = grid.texel_index(grid.across(face, side, k + 1)),
                            d = grid.texel_index(grid.across(face, side, k));
        star.triangles.push_back(outward(star, {a, b, c}));
        star.triangles.push_back(outward(star, {a, c, d}));
      }
    }
  }
  for (int corner = 0; corner < 8; ++corner) {
    const auto texel = [&](int axis) {  // of the face along this axis, a little off the corner
      Vec3 d;
      for (int a = 0; a < 3; ++a) d[a] = (corner >> a & 1 ? 1 : -1) * (a == axis ? 1 : 1 - 1.0 / n);
      return grid.texel_index(grid.texel_at(d));
    };
    star.triangles.push_back(outward(star, {texel(0), texel(1), texel(2)}));
  }
}

/// The greatest inverse depth of the texels that meet in a corner.
float nearest_about(const CubeGrid& grid, const TexelDepths& depths, const Lattice& at) {
  float nearest = 0;
  for (int face = 0; face < 6; ++face) {
    int column, row;
    if (!grid.on_face(at, face, column, row)) continue;
    for (int j = std::max(row - 1, 0); j <= std::min(row, grid.size() - 1); ++j) {
      for (int i = std::max(column - 1, 0); i <= std::min(column, grid.size() - 1); ++i)
        nearest = std::max(nearest, depths.nearest({face, i, j}));
    }
  }
  return nearest;
}

/// The diagonal whose ends have the smaller inverse depths: inverse depth is linear on a facet, so the texel's middle
/// is farther away then.
void set_texel_triangles(StarMesh& star, std::size_t at, const std::array<std::uint32_t, 4>& c) {
  const auto inverse = [&](std::uint32_t v) { return 1 / star.rays[v].lpNorm<Eigen::Infinity>(); };
  // right x up = -forward: counter-clockwise on the face is clockwise from outside.
  if (inverse(c[0]) + inverse(c[2]) <= inverse(c[1]) + inverse(c[3])) {
    star.triangles[at] = {c[0], c[2], c[1]};
    star.triangles[at + 1] = {c[0], c[3], c[2]};
  } else {
    star.triangles[at] = {c[0], c[3], c[1]};
    star.triangles[at + 1] = {c[1], c[3], c[2]};
  }
}

/// The texels' centres, face by face.
std::vector<FaceGrid> centre_grids(const CubeGrid& grid) {
  const int n = grid.size();
  std::vector<FaceGrid> faces(6, {n - 1, 2.0 / n, {}});
  for (int face = 0; face < 6; ++face) {
    for (int row = 0; row < n; ++row)
      for (int column = 0; column < n; ++column) faces[face].vertex.push_back(grid.texel_index({face, column, row}));
  }
  return faces;
}

/// The texels' corners, face by face.
std::vector<FaceGrid> corner_grids(const CubeGrid& grid) {
  const int n = grid.size();
  std::vector<FaceGrid> faces(6, {n, 2.0 / n, {}});
  for (int face = 0; face < 6; ++face) {
    for (int row = 0; row <= n; ++row) {
      for (int column = 0; column <= n; ++column)
        faces[face].vertex.push_back(grid.corner_index(grid.lattice({face, column, row})));
    }
  }
  return faces;
}

void add_centre_facets(const CubeGrid& grid, StarMesh& star) {
  const int n = grid.size();
  const std::size_t inner = static_cast<std::size_t>(n - 1) * (n - 1);
  star.triangles.resize(12 * inner);
  for_face_rows(n - 1, n, [&](int face, int row) {
    for (int column = 0; column + 1 < n; ++column) {
      const std::uint32_t a = grid.texel_index({face, column, row}), b = a + 1, d = a + n, c = d + 1;
      const std::size_t at = 2 * (face * inner + static_cast<std::size_t>(row) * (n - 1) + column);
      star.triangles[at] = {a, c, b};
      star.triangles[at + 1] = {a, d, c};
    }
  });
}

void add_texel_facets(const CubeGrid& grid, StarMesh& star) {
  const int n = grid.size();
  star.triangles.resize(12 * static_cast<std::size_t>(n) * n);
  for_face_rows(n, n, [&](int face, int row) {
    for (int column = 0; column < n; ++column) {
      const auto corner = [&](int i, int j) { return grid.corner_index(grid.lattice({face, column + i, row + j})); };
      set_texel_triangles(star, 2 * static_cast<std::size_t>(grid.texel_index({face, column, row})),
                          {corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)});
    }
  });
}

}  // namespace

StarMesh join_centers(const CubeMap& cube, double range_m, double merge) {
  const int n = cube.face_size;
  const CubeGrid grid(n);
  StarMesh star;
  resize(star, 6 * static_cast<std::size_t>(n) * n);
  for_face_rows(n, n, [&](int face, int row) {
    for (int column = 0; column < n; ++column) {
      const std::uint32_t vertex = grid.texel_index({face, column, row});
      set_ray(star, vertex, grid.texel_direction({face, column, row}), cube.inverse_depths[vertex], range_m, 1);
    }
  });
  if (merge > 0 && n > 1) {
    add_merged_facets(star, centre_grids(grid), {merge, false, true});
  } else {
    add_centre_facets(grid, star);
  }
  stitch(grid, star);
  if (merge > 0) drop_unused_vertices(star);
  return star;
}

StarMesh bound_corners(const CubeMap& cube, double range_m, const Vec3* front, double merge) {
  const int n = cube.face_size;
  const CubeGrid grid(n);
  const TexelDepths depths(cube, grid, front);
  StarMesh star;
  resize(star, grid.corner_count());
  for_face_rows(n + 1, n, [&](int face, int row) {
    for (int column = 0; column <= n; ++column) {
      const Lattice at = grid.lattice({face, column, row});
      const bool is_inner = column > 0 && column < n && row > 0 && row < n;
      if (!is_inner && grid.owner(at) != face) continue;
      float nearest;
      if (is_inner) {
        nearest = std::max({depths.nearest({face, column - 1, row - 1}), depths.nearest({face, column, row - 1}),
                            depths.nearest({face, column - 1, row}), depths.nearest({face, column, row})});
      } else {
        nearest = nearest_about(grid, depths, at);
      }
      set_ray(star, grid.corner_index(at), grid.direction(at), nearest, range_m, 1 - numerics::kShrink);
    }
  });
  if (merge > 0) {
    add_merged_facets(star, corner_grids(grid), {merge, true, false});
    drop_unused_vertices(star);
  } else {
    add_texel_facets(grid, star);
  }
  return star;
}

}  // namespace vantage::internal::spheres
