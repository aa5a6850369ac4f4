#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

#include "core/progress_reporter.h"
#include "geo/local_frame.h"
#include "maps/terrain/height_grid.h"
#include "maps/terrain/post_positions.h"
#include "maps/terrain/raster_ground.h"
#include "maps/terrain/tin.h"
#include "maps/terrain/tin_mesh.h"
#include "maps/terrain/triangulate.h"
#include "vantage/error.h"
#include "vantage/ground.h"

namespace vantage::internal::terrain {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void refuse(ErrorCode code, const std::string& problem, const fs::path& file, const std::string& fix) {
  throw Error(code, problem, file.string(), fix);
}

void check(const RasterOptions& options, const fs::path& file) {
  const RasterRegion& region = options.region;
  if (static_cast<int>(region.center_deg.has_value()) + static_cast<int>(region.bbox_deg.has_value()) +
          static_cast<int>(region.pixels.has_value()) >
      1) {
    refuse(ErrorCode::conflicting_keys, "the region is given in more than one way", file,
           "give a centre, a box or pixels");
  }
  if (region.center_deg && !(region.radius_m > 0 && region.radius_m < 1e6)) {
    refuse(ErrorCode::region_invalid, "the region has no extent", file, "give a radius above 0 and below 1000 km");
  }
  if (!(options.max_error_m >= 0)) {
    refuse(ErrorCode::value_out_of_range, "the error allowed to the surface is negative or not a number", file,
           "give metres, 0 or more");
  }
}

/// The rectangle of the frame about the middle of a box that holds the box.
Window window_round(const std::array<double, 4>& bbox_deg, const fs::path& file) {
  const auto [west, south, given_east, north] = bbox_deg;
  const double east = given_east < west ? given_east + 360 : given_east;
  const bool valid = std::abs(west) <= 180 && std::abs(given_east) <= 180 && south >= -90 && north <= 90 &&
                     south < north && east > west;
  if (!valid) {
    refuse(ErrorCode::region_invalid, "the box has no area or is not on the earth", file,
           "give west, south, east and north in degrees, in this order");
  }
  const double middle = std::remainder((west + east) / 2, 360);
  const geo::LonLat origin{middle, (south + north) / 2};
  const geo::LocalFrame frame(origin);
  Window window{origin, Eigen::Vector2d::Constant(1e9), Eigen::Vector2d::Constant(-1e9)};
  constexpr int kSamples = 16;  // a side is curved in the frame
  for (int i = 0; i <= kSamples; ++i) {
    const double longitude = west + (east - west) * i / kSamples, latitude = south + (north - south) * i / kSamples;
    for (const geo::LonLat position :
         {geo::LonLat{longitude, south}, {longitude, north}, {west, latitude}, {east, latitude}}) {
      window.min = window.min.cwiseMin(frame.to_local(position));
      window.max = window.max.cwiseMax(frame.to_local(position));
    }
  }
  return window;
}

HeightGrid read(const fs::path& file, const RasterOptions& options, const Progress& progress) {
  const RasterRegion& region = options.region;
  const HeightReading reading{options.crs, options.heights, options.missing};
  if (region.pixels) {
    const auto [column, row, columns, rows] = *region.pixels;
    return read_height_pixels(file, {column, row, columns, rows}, progress, reading);
  }
  if (region.bbox_deg) return read_height_grid(file, window_round(*region.bbox_deg, file), progress, reading);
  if (region.center_deg) {
    const Eigen::Vector2d half = Eigen::Vector2d::Constant(region.radius_m);
    return read_height_grid(file, Window{{(*region.center_deg)[1], (*region.center_deg)[0]}, -half, half}, progress,
                            reading);
  }
  return read_height_grid(file, std::nullopt, progress, reading);
}

geo::LonLat origin_of(const HeightGrid& grid, const RasterOptions& options, const std::filesystem::path& file) {
  const geo::LonLat position = grid.position({(grid.columns - 1) / 2.0, (grid.rows - 1) / 2.0});
  const geo::LonLat middle{std::remainder(position.longitude_deg, 360), position.latitude_deg};
  if (!options.origin_deg) return middle;
  const geo::LonLat origin{(*options.origin_deg)[1], (*options.origin_deg)[0]};
  geo::check_origin(origin, middle, file.string());
  return origin;
}

std::vector<Vec3> posts_of(const HeightGrid& grid, const geo::LocalFrame& frame) {
  std::vector<Vec3> posts;
  posts.reserve(grid.heights_m.size());
  const std::vector<Eigen::Vector2d> places = post_positions(grid, frame);
  for (std::size_t i = 0; i < places.size(); ++i) {
    posts.emplace_back(places[i].x(), places[i].y(), static_cast<double>(grid.heights_m[i]));
  }
  return posts;
}

/// Posts are right to 0.1 mm: nearer to each other than a millimetre, their order is not known.
void check_spacing(const HeightGrid& grid, const std::vector<Vec3>& posts, const fs::path& file) {
  constexpr double kLeastM = 1e-3;
  const auto columns = static_cast<std::size_t>(grid.columns);
  const auto is_near = [&](std::size_t a, std::size_t b) {
    return (posts[a] - posts[b]).head<2>().squaredNorm() < kLeastM * kLeastM;
  };
  for (std::size_t i = 0; i < posts.size(); ++i) {
    const bool has_right = (i + 1) % columns != 0, has_next_row = i + columns < posts.size();
    if ((has_right && is_near(i, i + 1)) || (has_next_row && is_near(i, i + columns))) {
      refuse(ErrorCode::raster_grid_unsupported, "posts of the raster are less than a millimetre apart", file,
             "check the size of its pixels and its reference system; at a pole give a region without it");
    }
  }
}

/// Indices of the outermost posts, counter-clockwise seen from above when the rows run south and the columns east.
std::vector<std::uint32_t> border_of(const HeightGrid& grid) {
  const auto columns = static_cast<std::uint32_t>(grid.columns), rows = static_cast<std::uint32_t>(grid.rows);
  std::vector<std::uint32_t> border;
  for (std::uint32_t row = 0; row + 1 < rows; ++row) border.push_back(row * columns);
  for (std::uint32_t column = 0; column + 1 < columns; ++column) border.push_back((rows - 1) * columns + column);
  for (std::uint32_t row = rows - 1; row > 0; --row) border.push_back(row * columns + columns - 1);
  for (std::uint32_t column = columns - 1; column > 0; --column) border.push_back(column);
  return border;
}

/// Two triangles for each square of four posts, split along the diagonal whose ends are nearer in height.
Mesh every_post(const HeightGrid& grid, std::vector<Vec3> posts) {
  Mesh mesh{std::move(posts), {}};
  const bool turned = grid.step.x() * grid.step.y() > 0;  // the rows run north
  for (int row = 0; row + 1 < grid.rows; ++row) {
    for (int column = 0; column + 1 < grid.columns; ++column) {
      const auto a = static_cast<std::uint32_t>(row) * static_cast<std::uint32_t>(grid.columns) +
                     static_cast<std::uint32_t>(column);
      const std::uint32_t b = a + static_cast<std::uint32_t>(grid.columns), c = b + 1, d = a + 1;
      const double falling = std::abs(mesh.vertices[a].z() - mesh.vertices[c].z());
      const double rising = std::abs(mesh.vertices[b].z() - mesh.vertices[d].z());
      std::array<Triangle, 2> pair = falling <= rising ? std::array<Triangle, 2>{{{a, b, c}, {a, c, d}}}
                                                       : std::array<Triangle, 2>{{{a, b, d}, {b, c, d}}};
      for (Triangle& triangle : pair) {
        if (turned) std::swap(triangle[1], triangle[2]);
        mesh.triangles.push_back(triangle);
      }
    }
  }
  return mesh;
}

/// The facets inside the border, whose posts are the vertices that follow the four corners of the network: all that
/// cannot be reached from those without crossing it. `places`: where along the border each of these vertices lies.
std::vector<bool> inside_border(const Tin& tin, const std::vector<std::uint32_t>& places, const fs::path& file) {
  const auto& facets = tin.facets();
  const auto border_size = static_cast<std::uint32_t>(places.size());
  const auto on_border = [&](std::uint32_t from, std::uint32_t to) {
    if (from < 4 || to < 4 || from >= 4 + border_size || to >= 4 + border_size) return false;
    const auto [first, last] = std::minmax(places[from - 4], places[to - 4]);
    return last - first == 1 || last - first == border_size - 1;
  };
  std::vector<bool> inside(facets.size(), true);
  std::vector<std::uint32_t> open;
  for (std::uint32_t f = 0; f < facets.size(); ++f) {
    if (*std::min_element(facets[f].corner.begin(), facets[f].corner.end()) >= 4) continue;
    inside[f] = false;
    open.push_back(f);
  }
  std::size_t crossings = 0;
  while (!open.empty()) {
    const Tin::Facet& facet = facets[open.back()];
    open.pop_back();
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t beyond = facet.neighbour[i];
      if (beyond == Tin::kNone || !inside[beyond]) continue;
      if (on_border(facet.corner[(i + 1) % 3], facet.corner[(i + 2) % 3])) {
        ++crossings;
      } else {
        inside[beyond] = false;
        open.push_back(beyond);
      }
    }
  }
  if (crossings != border_size) {
    refuse(ErrorCode::raster_grid_unsupported,
           "the posts of the raster do not lie side by side: it goes round a pole or half the earth", file,
           "give a smaller region, with --center and --radius, or check the size of its pixels");
  }
  return inside;
}

Mesh beneath_voids(const HeightGrid& grid, const std::vector<Vec3>& posts) {
  if (grid.lowest_m.empty()) return {};
  std::vector<Eigen::Vector2d> places;
  for (const Vec3& post : posts) places.push_back(post.head<2>());
  const Eigen::Vector2d far = Eigen::Vector2d::Constant(std::numeric_limits<double>::infinity());
  return lowest_in_voids(grid, places, -far, far);
}

Mesh simplified(const HeightGrid& grid, const std::vector<Vec3>& posts, double max_error_m, const fs::path& file,
                const core::ProgressReporter& progress) {
  Box box;
  for (const Vec3& post : posts) box.extend(post);
  // Far round the posts, so that the border's edges are those of the network; dropped in the end.
  const Vec3 middle = (box.min + box.max) / 2;
  const double far = 10 * (box.max - box.min).head<2>().maxCoeff();
  Tin tin({middle + Vec3(-far, -far, 0), middle + Vec3(far, -far, 0), middle + Vec3(far, far, 0),
           middle + Vec3(-far, far, 0)});
  const auto columns = static_cast<std::size_t>(grid.columns), rows = static_cast<std::size_t>(grid.rows);
  // From one end of the raster to the other: a post of a long side would else replace the facets of all of the
  // opposite.
  const std::vector<std::uint32_t> border = border_of(grid);
  std::vector<std::uint32_t> places(border.size());
  std::iota(places.begin(), places.end(), 0U);
  const auto along = [&](std::uint32_t place) {
    return rows > columns ? border[place] / columns : border[place] % columns;
  };
  std::stable_sort(places.begin(), places.end(), [&](auto a, auto b) { return along(a) < along(b); });
  for (const std::uint32_t place : places) {
    progress.tick();
    tin.insert(posts[border[place]]);
  }
  std::vector<Vec3> candidates;
  for (std::size_t row = 1; row + 1 < rows; ++row) {
    const auto first = posts.begin() + static_cast<std::ptrdiff_t>(row * columns);
    candidates.insert(candidates.end(), first + 1, first + static_cast<std::ptrdiff_t>(columns) - 1);
  }
  tin.add_candidates(candidates);
  grow(tin, max_error_m, progress);
  return mesh_of(tin, inside_border(tin, places, file));
}

}  // namespace
}  // namespace vantage::internal::terrain

namespace vantage {

RasterScene scene_from_raster(const std::filesystem::path& file, const RasterOptions& options,
                              const Progress& callback) {
  using namespace internal::terrain;
  check(options, file);
  const HeightGrid grid = read(file, options, callback);
  if (grid.columns < 2 || grid.rows < 2) {
    refuse(ErrorCode::region_invalid, "the region has a single row or column of posts, which is not a surface", file,
           "give a larger region");
  }
  const internal::geo::LocalFrame frame(origin_of(grid, options, file));
  internal::core::ProgressReporter progress(callback, file);
  progress.begin("triangulating the surface");
  std::vector<Vec3> posts = posts_of(grid, frame);
  check_spacing(grid, posts, file);

  RasterScene result;
  result.report.columns = static_cast<std::size_t>(grid.columns);
  result.report.rows = static_cast<std::size_t>(grid.rows);
  result.report.voids = grid.voids;
  const auto [lowest, highest] = std::minmax_element(grid.heights_m.begin(), grid.heights_m.end());
  result.report.lowest_m = static_cast<double>(*lowest);
  result.report.highest_m = static_cast<double>(*highest);
  Scene& scene = result.scene;
  const Mesh beneath = beneath_voids(grid, posts);
  if (options.max_error_m > 0) {
    // Half of the error on either side, and then up by as much: all of it lies above the posts.
    const TriangulatedTerrain surface =
        raised_over(TriangulatedTerrain(simplified(grid, posts, options.max_error_m / 2, file, progress), progress),
                    {posts}, progress);
    result.report.largest_error_m = largest_error(surface, posts, progress);
    scene.mesh = surface.mesh();
  } else {
    scene.mesh = every_post(grid, std::move(posts));
  }
  scene.object_of.assign(scene.mesh.triangles.size(), 0);
  scene.objects = {{"surface", "", ObjectKind::surface}};
  add_voids(scene, 0, options.missing, void_entries(grid, frame, ObjectKind::surface), beneath);
  scene.source = file;
  scene.georeference = Georeference{frame.origin().latitude_deg, frame.origin().longitude_deg, grid.vertical,
                                    grid.crs.code().empty() ? grid.crs.name() : grid.crs.code()};
  return result;
}

}  // namespace vantage
