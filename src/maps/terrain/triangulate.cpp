#include "maps/terrain/triangulate.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

#include "core/progress_reporter.h"
#include "maps/terrain/post_positions.h"
#include "maps/terrain/tin.h"
#include "maps/terrain/tin_mesh.h"
#include "vantage/error.h"

namespace vantage::internal::terrain {
namespace {

constexpr double kOnBorder_m = 0.01;  // a post so near counts as on the border: facets must not be slivers

Vec3 lifted(const Eigen::Vector2d& place, double height) { return {place.x(), place.y(), height}; }

/// Places strictly between two, from the first to the second, where the line between them crosses the lines of posts:
/// between these the grid is almost linear along it.
void add_crossings(const HeightGrid& grid, const geo::LocalFrame& frame, const Eigen::Vector2d& from,
                   const Eigen::Vector2d& to, std::vector<Vec3>& points) {
  const auto cell_at = [&](double part) { return grid.column_row(frame.to_lonlat(from + part * (to - from))); };
  const double length = (to - from).norm();
  const auto steps = static_cast<int>(std::ceil((cell_at(1) - cell_at(0)).norm())) + 1;
  std::vector<double> parts;
  Eigen::Vector2d before = cell_at(0);
  for (int i = 1; i <= steps; ++i) {
    const Eigen::Vector2d after = cell_at(static_cast<double>(i) / steps);
    for (int axis = 0; axis < 2; ++axis) {
      const double low = std::min(before[axis], after[axis]), high = std::max(before[axis], after[axis]);
      for (double line = std::ceil(low); line < high; ++line) {
        parts.push_back((i - 1 + (line - before[axis]) / (after[axis] - before[axis])) / steps);
      }
    }
    before = after;
  }
  std::sort(parts.begin(), parts.end());
  double last = 0;
  for (const double part : parts) {
    if ((part - last) * length < kOnBorder_m || (1 - part) * length < kOnBorder_m) continue;
    const Eigen::Vector2d place = from + part * (to - from);  // to the last bit on a border along an axis
    points.push_back(lifted(place, grid.height_m(cell_at(part))));
    last = part;
  }
}

struct Samples {
  std::array<Vec3, 4> corners;
  std::vector<Vec3> border;               ///< between the corners
  std::vector<Vec3> posts;                ///< in the rectangle
  std::vector<Vec3> inner;                ///< of these, those that are not on its border
  std::vector<std::uint32_t> inner_post;  ///< per post of the grid, its index in `inner`, or Tin::kNone
};

Samples sample(const HeightGrid& grid, const geo::LocalFrame& frame, const Eigen::Vector2d& min,
               const Eigen::Vector2d& max, const core::ProgressReporter& progress) {
  Samples samples;
  const std::array<Eigen::Vector2d, 4> corners = {min, {max.x(), min.y()}, max, {min.x(), max.y()}};
  for (std::size_t i = 0; i < 4; ++i) {
    const Eigen::Vector2d at = grid.column_row(frame.to_lonlat(corners[i]));
    const Eigen::Vector2d last(grid.columns - 1, grid.rows - 1);
    if (at.minCoeff() < -0.5 - 1e-6 || (last - at).minCoeff() < -0.5 - 1e-6) {
      throw Error(ErrorCode::region_outside, "the raster does not cover the area of the terrain", grid.file.string(),
                  "read it with the area as its window");
    }
    samples.corners[i] = lifted(corners[i], grid.height_m(at));
    add_crossings(grid, frame, corners[i], corners[(i + 1) % 4], samples.border);
  }
  const std::vector<Eigen::Vector2d> places = post_positions(grid, frame);
  samples.inner_post.resize(places.size(), Tin::kNone);
  for (std::size_t i = 0; i < places.size(); ++i) {
    progress.tick();
    const double inside_m = std::min((places[i] - min).minCoeff(), (max - places[i]).minCoeff());
    if (inside_m < 0) continue;
    samples.posts.push_back(lifted(places[i], static_cast<double>(grid.heights_m[i])));
    if (inside_m < kOnBorder_m) continue;
    samples.inner_post[i] = static_cast<std::uint32_t>(samples.inner.size());
    samples.inner.push_back(samples.posts.back());
  }
  return samples;
}

/// The middles of the sides of the cells between inner posts, and of their higher diagonals: there the surface is not
/// known, and is taken to run straight from post to post. `first`: index of the first inner post among the candidates.
std::vector<Tin::Middle> middles(const HeightGrid& grid, const Samples& samples, std::uint32_t first) {
  std::vector<Tin::Middle> middles;
  const auto columns = static_cast<std::size_t>(grid.columns);
  const auto add = [&](std::initializer_list<std::size_t> posts) {
    Tin::Middle middle;
    auto candidate = middle.candidates.begin();
    for (const std::size_t post : posts) {
      if (samples.inner_post[post] == Tin::kNone) return;
      *candidate++ = first + samples.inner_post[post];
    }
    middles.push_back(middle);
  };
  for (std::size_t post = 0; post < samples.inner_post.size(); ++post) {
    const std::size_t right = post + 1, below = post + columns, across = below + 1;
    const bool has_right = right % columns != 0, has_below = below < samples.inner_post.size();
    if (has_right) add({post, right});
    if (has_below) add({post, below});
    if (!has_right || !has_below) continue;
    const auto& z = grid.heights_m;
    if (z[post] + z[across] >= z[right] + z[below]) {
      add({post, across, right, below});
    } else {
      add({right, below, post, across});
    }
  }
  return middles;
}

}  // namespace

Triangulation triangulate(const HeightGrid& grid, const geo::LocalFrame& frame, const Eigen::Vector2d& min,
                          const Eigen::Vector2d& max, double max_error_m, const Progress& callback) {
  if (!min.allFinite() || !max.allFinite() || !((max - min).minCoeff() > 2 * kOnBorder_m)) {
    throw Error(ErrorCode::region_invalid, "the area of the terrain has no extent", grid.file.string(),
                "give it a width and a length");
  }
  if (!(max_error_m >= 0)) {
    throw Error(ErrorCode::value_out_of_range, "the error allowed to the terrain is negative or not a number",
                grid.file.string(), "give metres, 0 or more");
  }
  core::ProgressReporter progress(callback, grid.file);
  progress.begin("triangulating the terrain");
  const Samples samples = sample(grid, frame, min, max, progress);
  Tin tin(samples.corners);
  tin.add_candidates(samples.border);
  const std::uint32_t first = tin.add_candidates(samples.inner);
  progress.check();
  tin.add_middles(middles(grid, samples, first));
  // Half of the error on either side, and then up by as much: all of it lies above the posts.
  grow(tin, max_error_m / 2, progress);
  tin.fold_up(max_error_m / 2, progress);
  const std::vector<bool> all(tin.facets().size(), true);
  Triangulation result{
      raised_over(TriangulatedTerrain(mesh_of(tin, all), progress), {samples.border, samples.posts}, progress), 0,
      samples.posts.size()};
  result.largest_error_m = std::max(largest_error(result.surface, samples.border, progress),
                                    largest_error(result.surface, samples.posts, progress));
  return result;
}

}  // namespace vantage::internal::terrain
