#include "options/spheres_options.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/system_files.h"
#include "request/checker.h"
#include "request/describe_spheres.h"
#include "vantage/error.h"

namespace vantage::internal::options {
namespace {

constexpr int kLargestFace = 8192;
/// Peak memory of a run with three spheres cut to the front, over the facets of one whole sphere: 620 to 710 bytes
/// (Charlotte, 300 m range, faces of 300 and 200 texels).
constexpr double kBytesPerFacet = 700;

[[noreturn]] void refuse(ErrorCode code, const std::string& problem, const std::string& fix) {
  throw Error(code, problem, "spheres", fix);
}

void check_grid(const std::array<int, 2>& grid) {
  if (face_size_for(grid) <= kLargestFace) return;
  refuse(ErrorCode::value_out_of_range,
         "resolution is too fine: [" + std::to_string(grid[0]) + ", " + std::to_string(grid[1]) +
             "] needs cube faces of more than " + std::to_string(kLargestFace) + " texels a side",
         "give at most [12800, 6400]");
}

void check_memory(const SpheresOptions& options) {
  const double texels = 6 * std::pow(static_cast<double>(face_size(options)), 2);
  const double needed = kBytesPerFacet * static_cast<double>(facet_count(options)) + 4 * texels;
  const double there = core::memory_bytes();
  if (needed <= there) return;
  const auto gigabytes = [](double bytes) { return std::to_string(std::lround(std::ceil(bytes / 1e9))) + " GB"; };
  refuse(ErrorCode::out_of_memory,
         "spheres of " + std::to_string(facet_count(options)) + " facets need some " + gigabytes(needed) +
             " of memory, and " + gigabytes(there) + " are there",
         "lower cubemap or resolution");
}

}  // namespace

void check_options(const SpheresOptions& options) {
  request::Checker checker(request::kSection<SpheresOptions>);
  describe(options, checker);
  if (options.resolution) check_grid(*options.resolution);
  check_memory(options);
}

}  // namespace vantage::internal::options
