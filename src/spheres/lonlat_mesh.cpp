// Sphere meshes on a grid of longitudes and latitudes.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "core/parallel.h"
#include "spheres/cube_grid.h"
#include "spheres/numerics.h"
#include "spheres/sphere_mesh.h"
#include "spheres/texel_depths.h"

namespace vantage::internal::spheres {
namespace {

constexpr double kPi = std::numbers::pi;
/// Rounding of the sine of a latitude, generously.
constexpr double kSine = 1e-12;

/// Rings 1 to bands - 1 of `columns` vertices, from the north pole (vertex 0) to the south pole (the last one).
class LonLatGrid {
 public:
  explicit LonLatGrid(const std::array<int, 2>& grid) : columns_(grid[0]), bands_(grid[1]) {}

  int columns() const { return columns_; }
  int bands() const { return bands_; }
  double step() const { return 2 * kPi / columns_; }
  std::uint32_t south() const { return 1 + static_cast<std::uint32_t>(columns_) * (bands_ - 1); }
  std::uint32_t vertex(int ring, int column) const {
    if (ring == 0) return 0;
    if (ring == bands_) return south();
    return 1 + static_cast<std::uint32_t>(ring - 1) * columns_ + static_cast<std::uint32_t>(column % columns_);
  }
  double latitude(int ring) const { return kPi * (0.5 - static_cast<double>(ring) / bands_); }

  Vec3 direction(int ring, int column) const {
    if (ring == 0) return Vec3::UnitZ();
    if (ring == bands_) return -Vec3::UnitZ();
    const double longitude = step() * column, colatitude = kPi * ring / bands_;
    return {std::sin(colatitude) * std::cos(longitude), std::sin(colatitude) * std::sin(longitude),
            2 * ring == bands_ ? 0.0 : std::cos(colatitude)};
  }

  void add_triangles(StarMesh& star) const {
    for (int ring = 0; ring < bands_; ++ring) {
      for (int column = 0; column < columns_; ++column) {
        const std::uint32_t a = vertex(ring, column), b = vertex(ring, column + 1), c = vertex(ring + 1, column + 1),
                            d = vertex(ring + 1, column);
        if (ring > 0) star.triangles.push_back({a, c, b});
        if (ring + 1 < bands_) star.triangles.push_back({a, d, c});
      }
    }
  }

 private:
  int columns_, bands_;
};

void set_unit_ray(StarMesh& star, std::uint32_t vertex, const Vec3& unit, double radius, double range_m,
                  double shorten) {
  star.at_range[vertex] = radius >= range_m;
  // The floor is along the longest axis, as in the other meshes.
  const double floor = numerics::kFloor / unit.lpNorm<Eigen::Infinity>();
  star.rays[vertex] = std::max(std::min(radius, range_m) * shorten, floor) * unit;
}

StarMesh make_mesh(const LonLatGrid& grid) {
  StarMesh star;
  star.rays.resize(grid.south() + 1);
  star.at_range.resize(grid.south() + 1);
  star.triangles.reserve(2 * static_cast<std::size_t>(grid.columns()) * (grid.bands() - 1));
  grid.add_triangles(star);
  return star;
}

/// The least radius at which something may hide a direction of a cell's facets, for every cell.
class CellBounds {
 public:
  explicit CellBounds(const LonLatGrid& grid)
      : grid_(grid),
        bound_(static_cast<std::size_t>(grid.columns()) * grid.bands(), std::numeric_limits<double>::infinity()) {
    const auto bulged = [&](double latitude) { return std::atan(std::tan(latitude) / std::cos(grid.step() / 2)); };
    for (int band = 0; band < grid.bands(); ++band) {
      const double north = grid.latitude(band), south = grid.latitude(band + 1);
      north_.push_back(band == 0 ? 1 : std::sin(north > 0 ? bulged(north) : north));
      south_.push_back(band + 1 == grid.bands() ? -1 : std::sin(south < 0 ? bulged(south) : south));
    }
  }

  /// Nothing nearer than `radius` hides the directions through the square [u0, u1] x [v0, v1] of a face.
  void add_texel(const CubeGrid& cube, const FaceCell& texel, float inverse_depth) {
    if (inverse_depth == 0) return;
    const int n = cube.size();
    const Vec3 centre = cube.texel_direction(texel);
    Vec3 low = centre, high = centre;
    for (int a = 0; a < 3; ++a) {
      if (a != texel.face / 2) {
        low[a] -= 1.0 / n;
        high[a] += 1.0 / n;
      }
    }
    const Vec3 nearest = Vec3::Zero().cwiseMax(low).cwiseMin(high);
    const double radius = nearest.norm() / static_cast<double>(inverse_depth);

    // The sine of the latitude, z / |d|, is monotone in z, and in the distance from the axis: its extremes are at the
    // ends of z, with the nearest and the farthest point from the axis.
    const double near = nearest.head<2>().squaredNorm();
    const double far = low.cwiseAbs().cwiseMax(high.cwiseAbs()).head<2>().squaredNorm();
    const auto sine = [](double z, double across) { return z / std::sqrt(z * z + across); };
    const double top = std::max(sine(high.z(), near), sine(high.z(), far)) + kSine;
    const double bottom = std::min(sine(low.z(), near), sine(low.z(), far)) - kSine;
    // Bands run from north to south.
    const auto first = std::partition_point(south_.begin(), south_.end(), [&](double s) { return s > top; });
    const auto last = std::partition_point(north_.begin(), north_.end(), [&](double s) { return s >= bottom; });

    double from = 0, to = 2 * kPi;
    if (near > 0) longitudes(low, high, from, to);
    const auto column = [&](double longitude) { return static_cast<int>(std::floor(longitude / grid_.step())); };
    const int begin = column(from - numerics::kAngle), count = column(to + numerics::kAngle) - begin + 1;
    for (auto band = static_cast<int>(first - south_.begin()); band < static_cast<int>(last - north_.begin()); ++band)
      for (int k = 0; k < std::min(count, grid_.columns()); ++k) lower(band, begin + k, radius);
  }

  /// The least bound of the cells about a vertex.
  double at_vertex(int ring, int column) const {
    double least = std::numeric_limits<double>::infinity();
    const bool is_pole = ring == 0 || ring == grid_.bands();
    for (int band = std::max(ring - 1, 0); band <= std::min(ring, grid_.bands() - 1); ++band) {
      for (int k = 0; k < (is_pole ? grid_.columns() : 2); ++k)
        least = std::min(least, bound_[cell(band, column - 1 + k)]);
    }
    return least;
  }

 private:
  std::size_t cell(int band, int column) const {
    const int n = grid_.columns();
    return static_cast<std::size_t>(band) * n + static_cast<std::size_t>((column % n + n) % n);
  }

  // The least of what all threads say: the same in any order.
  void lower(int band, int column, double radius) {
    const std::atomic_ref<double> bound(bound_[cell(band, column)]);
    double known = bound.load(std::memory_order_relaxed);
    while (radius < known && !bound.compare_exchange_weak(known, radius, std::memory_order_relaxed)) {
    }
  }

  /// The longitudes of a rectangle beside the axis: those of its corners, counted from that of its first one.
  static void longitudes(const Vec3& low, const Vec3& high, double& from, double& to) {
    const double base = std::atan2(low.y(), low.x());
    double least = 0, most = 0;
    for (int corner = 1; corner < 4; ++corner) {
      const double x = corner & 1 ? high.x() : low.x(), y = corner & 2 ? high.y() : low.y();
      const double turn = std::remainder(std::atan2(y, x) - base, 2 * kPi);
      least = std::min(least, turn);
      most = std::max(most, turn);
    }
    from = base + least;
    to = base + most;
  }

  const LonLatGrid& grid_;
  std::vector<double> bound_;          // by cell
  std::vector<double> north_, south_;  // sines of the latitudes between which the facets of a band are
};

}  // namespace

StarMesh join_lonlat(const CubeMap& cube, const std::array<int, 2>& size, double range_m) {
  const LonLatGrid grid(size);
  const CubeGrid texels(cube.face_size);
  StarMesh star = make_mesh(grid);
  for (int ring = 0; ring <= grid.bands(); ++ring) {
    for (int column = 0; column < (ring == 0 || ring == grid.bands() ? 1 : grid.columns()); ++column) {
      const Vec3 unit = grid.direction(ring, column);
      const double inverse = cube.inverse_depths[texels.texel_index(texels.texel_at(unit))];
      const double depth = inverse > 0 ? 1 / inverse : std::numeric_limits<double>::infinity();
      set_unit_ray(star, grid.vertex(ring, column), unit, depth / unit.lpNorm<Eigen::Infinity>(), range_m, 1);
    }
  }
  return star;
}

StarMesh bound_lonlat(const CubeMap& cube, const std::array<int, 2>& size, double range_m, const Vec3* front) {
  const LonLatGrid grid(size);
  const CubeGrid texels(cube.face_size);
  const TexelDepths depths(cube, texels, front);
  CellBounds bounds(grid);
  const int n = cube.face_size;
  parallel::for_ranges(6 * static_cast<std::size_t>(n), 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      for (int column = 0; column < n; ++column) {
        const FaceCell texel{static_cast<int>(k) / n, column, static_cast<int>(k) % n};
        bounds.add_texel(texels, texel, depths.nearest(texel));
      }
    }
  });
  StarMesh star = make_mesh(grid);
  for (int ring = 0; ring <= grid.bands(); ++ring) {
    for (int column = 0; column < (ring == 0 || ring == grid.bands() ? 1 : grid.columns()); ++column) {
      set_unit_ray(star, grid.vertex(ring, column), grid.direction(ring, column), bounds.at_vertex(ring, column),
                   range_m, 1 - numerics::kShrink);
    }
  }
  return star;
}

}  // namespace vantage::internal::spheres
