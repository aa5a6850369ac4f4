#include "options/spheres_options.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numbers>
#include <string>

#include "vantage/error.h"

namespace vantage::internal::options {
namespace {

constexpr int kLargestFace = 8192;
constexpr int kMostSplits = 16;
/// Peak memory of a run with three spheres cut to the front, over the facets of one whole sphere: 620 to 710 bytes
/// (Charlotte, 300 m range, faces of 300 and 200 texels).
constexpr double kBytesPerFacet = 700;
constexpr double kLargestMerge = 0.05;

[[noreturn]] void refuse(ErrorCode code, const std::string& problem, const std::string& fix) {
  throw Error(code, problem, "spheres", fix);
}

void check_grid(const std::array<int, 2>& grid) {
  if (grid[0] < 3 || grid[1] < 2) {
    refuse(ErrorCode::value_out_of_range,
           "resolution must be at least [3, 2], not [" + std::to_string(grid[0]) + ", " + std::to_string(grid[1]) + "]",
           "give the samples in longitude and latitude, such as [160, 80]");
  }
  constexpr int kMost = 4 * kLargestFace;  // beyond it face_size_for might overflow
  if (grid[0] > kMost || grid[1] > kMost || face_size_for(grid) > kLargestFace) {
    refuse(ErrorCode::value_out_of_range,
           "resolution is too fine: [" + std::to_string(grid[0]) + ", " + std::to_string(grid[1]) +
               "] needs cube faces of more than " + std::to_string(kLargestFace) + " texels a side",
           "give at most [12800, 6400]");
  }
}

/// Of the machine, or as much of it as the control group (a container, a batch job) may use; version 2, "max" for all.
double memory_bytes() {
  const double machine = static_cast<double>(::sysconf(_SC_PHYS_PAGES)) * static_cast<double>(::sysconf(_SC_PAGESIZE));
  double group = 0;
  std::ifstream limit("/sys/fs/cgroup/memory.max");
  return limit >> group ? std::min(machine, group) : machine;
}

void check_memory(const SpheresOptions& options) {
  const double texels = 6 * std::pow(static_cast<double>(face_size(options)), 2);
  const double needed = kBytesPerFacet * static_cast<double>(facet_count(options)) + 4 * texels;
  const double there = memory_bytes();
  if (needed <= there) return;
  const auto gigabytes = [](double bytes) { return std::to_string(std::lround(std::ceil(bytes / 1e9))) + " GB"; };
  refuse(ErrorCode::out_of_memory,
         "spheres of " + std::to_string(facet_count(options)) + " facets need some " + gigabytes(needed) +
             " of memory, and " + gigabytes(there) + " are there",
         "lower cubemap or resolution");
}

}  // namespace

int face_size_for(const std::array<int, 2>& grid) {
  const double step = std::min(2 * std::numbers::pi / grid[0], std::numbers::pi / grid[1]);
  // A texel is widest in the middle of its face: 2 / n.
  return 2 * static_cast<int>(std::ceil(2 / step));
}

int face_size(const SpheresOptions& options) {
  return options.resolution ? face_size_for(*options.resolution) : options.cubemap;
}

std::size_t facet_count(const SpheresOptions& options) {
  if (options.resolution)
    return 2 * static_cast<std::size_t>((*options.resolution)[0]) * ((*options.resolution)[1] - 1);
  return 12 * static_cast<std::size_t>(options.cubemap) * options.cubemap;
}

void check_options(const SpheresOptions& options) {
  if (options.resolution) {
    check_grid(*options.resolution);
  } else if (options.cubemap < 1 || options.cubemap > kLargestFace) {
    refuse(ErrorCode::value_out_of_range,
           "cubemap must be from 1 to " + std::to_string(kLargestFace) + ", not " + std::to_string(options.cubemap),
           "give the texels along a face's side, such as 200");
  }
  if (options.max_splits < 0 || options.max_splits > kMostSplits) {
    refuse(
        ErrorCode::value_out_of_range,
        "max_splits must be from 0 to " + std::to_string(kMostSplits) + ", not " + std::to_string(options.max_splits),
        "give how often an edge may be halved, such as 6");
  }
  if (!(options.min_edge_m > 0) || !std::isfinite(options.min_edge_m)) {
    refuse(ErrorCode::value_out_of_range, "min_edge must be a positive, finite number of metres",
           "give for example 0.5");
  }
  if (!(options.merge >= 0) || options.merge > kLargestMerge) {
    refuse(ErrorCode::value_out_of_range, "merge must be from 0 to 0.05",
           "give the part of its distance that a facet may be off, such as 0.00025");
  }
  check_memory(options);
}

}  // namespace vantage::internal::options
