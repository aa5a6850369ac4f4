#include "spheres/sphere_maker.h"

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fstream>
#include <numbers>
#include <string>

#include "spheres/sphere_mesh.h"
#include "vantage/error.h"

namespace vantage::spheres {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kLargestFace = 8192;
constexpr int kMostSplits = 16;
/// Peak memory of a run with three spheres cut to the front, over the facets of one whole sphere: 620 to 710 bytes
/// (Charlotte, 300 m range, faces of 300 and 200 texels).
constexpr double kBytesPerFacet = 700;
constexpr double kLargestMerge = 0.05;

[[noreturn]] void refuse(ErrorCode code, const std::string& problem, const std::string& fix) {
  throw Error(code, problem, "spheres", fix);
}

int face_size(const SpheresOptions& options) {
  return options.resolution ? face_size_for(*options.resolution) : options.cubemap;
}

void check_grid(const std::array<int, 2>& grid) {
  if (grid[0] < 3 || grid[1] < 2)
    refuse(ErrorCode::value_out_of_range,
           "resolution must be at least [3, 2], not [" + std::to_string(grid[0]) + ", " + std::to_string(grid[1]) + "]",
           "give the samples in longitude and latitude, such as [160, 80]");
  constexpr int kMost = 4 * kLargestFace;  // beyond it face_size_for might overflow
  if (grid[0] > kMost || grid[1] > kMost || face_size_for(grid) > kLargestFace)
    refuse(ErrorCode::value_out_of_range,
           "resolution is too fine: [" + std::to_string(grid[0]) + ", " + std::to_string(grid[1]) +
               "] needs cube faces of more than " + std::to_string(kLargestFace) + " texels a side",
           "give at most [12800, 6400]");
}

/// Of the machine, or as much of it as the control group (a container, a batch job) may use; version 2, "max" for all.
double memory_bytes() {
  const double machine = double(::sysconf(_SC_PHYS_PAGES)) * double(::sysconf(_SC_PAGESIZE));
  double group = 0;
  std::ifstream limit("/sys/fs/cgroup/memory.max");
  return limit >> group ? std::min(machine, group) : machine;
}

void check_memory(const SpheresOptions& options) {
  const double texels = 6 * std::pow(double(face_size(options)), 2);
  const double needed = kBytesPerFacet * double(facet_count(options)) + 4 * texels;
  const double there = memory_bytes();
  if (needed <= there) return;
  const auto gigabytes = [](double bytes) { return std::to_string(std::lround(std::ceil(bytes / 1e9))) + " GB"; };
  refuse(ErrorCode::out_of_memory,
         "spheres of " + std::to_string(facet_count(options)) + " facets need some " + gigabytes(needed) +
             " of memory, and " + gigabytes(there) + " are there",
         "lower cubemap or resolution");
}

}  // namespace

void check_options(const SpheresOptions& options) {
  if (options.resolution) {
    check_grid(*options.resolution);
  } else if (options.cubemap < 1 || options.cubemap > kLargestFace) {
    refuse(ErrorCode::value_out_of_range,
           "cubemap must be from 1 to " + std::to_string(kLargestFace) + ", not " + std::to_string(options.cubemap),
           "give the texels along a face's side, such as 200");
  }
  if (options.max_splits < 0 || options.max_splits > kMostSplits)
    refuse(
        ErrorCode::value_out_of_range,
        "max_splits must be from 0 to " + std::to_string(kMostSplits) + ", not " + std::to_string(options.max_splits),
        "give how often an edge may be halved, such as 6");
  if (!(options.min_edge_m > 0) || !std::isfinite(options.min_edge_m))
    refuse(ErrorCode::value_out_of_range, "min_edge must be a positive, finite number of metres",
           "give for example 0.5");
  if (!(options.merge >= 0) || options.merge > kLargestMerge)
    refuse(ErrorCode::value_out_of_range, "merge must be from 0 to 0.05",
           "give the part of its distance that a facet may be off, such as 0.00025");
  check_memory(options);
}

double range_tolerance(const SpheresOptions& options, double range_m) {
  // Half the diagonal of the widest cell of directions.
  double half_diagonal = std::numbers::sqrt2 / options.cubemap;
  if (options.resolution) {
    const double longitude = 2 * std::numbers::pi / (*options.resolution)[0];
    const double latitude = std::numbers::pi / (*options.resolution)[1];
    half_diagonal = 0.5 * std::hypot(longitude, latitude);
  }
  const double sagitta = 1 - std::cos(std::min(half_diagonal, std::numbers::pi / 2));
  // A joined facet is off its cells by the tolerance of joining, and drawn in by as much.
  const double joined = options.resolution ? 0 : 2 * options.merge;
  return range_m * std::min(sagitta + joined, 1.0);
}

std::size_t facet_count(const SpheresOptions& options) {
  if (options.resolution) return 2 * std::size_t((*options.resolution)[0]) * ((*options.resolution)[1] - 1);
  return 12 * std::size_t(options.cubemap) * options.cubemap;
}

SphereMaker::SphereMaker(depth::DepthRenderer& renderer, const SpheresOptions& options, double range_m,
                         const TargetFrame& frame, bool front_only)
    : renderer_(renderer),
      options_(options),
      range_m_(range_m),
      frame_(frame),
      front_only_(front_only),
      face_size_(face_size(options)) {}

StarMesh SphereMaker::tessellated(std::span<const float> inverse_depths) const {
  const CubeMap cube{face_size_, inverse_depths};
  const Vec3* front = front_only_ ? &frame_.normal : nullptr;
  if (options_.sphere == SpheresOptions::Sphere::centers)
    return options_.resolution ? join_lonlat(cube, *options_.resolution, range_m_)
                               : join_centers(cube, range_m_, options_.merge);
  return options_.resolution ? bound_lonlat(cube, *options_.resolution, range_m_, front)
                             : bound_corners(cube, range_m_, front, options_.merge);
}

void SphereMaker::make(const std::vector<Vec3>& points, const std::function<void(std::size_t, Sphere)>& sink) const {
  std::vector<Vec3> viewpoints;
  for (const Vec3& p : points) viewpoints.push_back(frame_.to_scene(p));
  depth::DepthRequest request;
  request.viewpoints = viewpoints;
  request.face_size = face_size_;
  request.sampling =
      options_.sphere == SpheresOptions::Sphere::centers ? depth::Sampling::centers : depth::Sampling::nearest;
  request.range_m = range_m_;
  Placement placement;
  placement.to_mesh.row(0) = frame_.axis_u;
  placement.to_mesh.row(1) = frame_.axis_v;
  placement.to_mesh.row(2) = frame_.normal;
  placement.front_only = front_only_;
  auto start = Clock::now();
  renderer_.render(request, [&](std::size_t index, std::span<const float> inverse_depths) {
    const StarMesh star = tessellated(inverse_depths);
    placement.viewpoint = points[index];
    Sphere sphere{placed(star, placement), reach(star, placement), 0};
    sphere.seconds = std::chrono::duration<double>(Clock::now() - start).count();
    sink(index, std::move(sphere));
    start = Clock::now();
  });
}

}  // namespace vantage::spheres
