// Fraction fields from depth images: each sample of the target looks at all voxels at once.
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/parallel.h"
#include "core/progress_reporter.h"
#include "depth/depth.h"
#include "vantage/error.h"
#include "vantage/fraction.h"
#include "vantage/query.h"

namespace vantage {
namespace {

using internal::core::ProgressReporter;
namespace depth = internal::depth;
namespace parallel = internal::parallel;

constexpr std::size_t kMostSamples = 65535;
constexpr int kLargestFace = 8192;

/// Voxels of one row along x that follow each other, and whose share is open.
struct Run {
  std::size_t first_count;  ///< of the first voxel, in `counts`
  std::size_t first_voxel;  ///< in the grid
  std::size_t length;
};

struct Triangle2 {
  std::size_t part;
  Eigen::Vector2d a, b, c;
  double area_before;  ///< of all triangles before it
  double area;
};

std::vector<Triangle2> triangles_of(const PreparedTarget& target) {
  std::vector<Triangle2> triangles;
  double sum = 0;
  for (std::size_t part = 0; part < target.part_count(); ++part) {
    const auto& polygon = target.frame(part).polygon;
    for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
      const Eigen::Vector2d u = polygon[i] - polygon[0], v = polygon[i + 1] - polygon[0];
      const double area = 0.5 * (u.x() * v.y() - u.y() * v.x());
      triangles.push_back({part, polygon[0], polygon[i], polygon[i + 1], sum, area});
      sum += area;
    }
  }
  return triangles;
}

/// The samples of each part, and the side that it is seen from.
struct Sample {
  Vec3 place, front;
};

std::vector<Sample> samples_of(const PreparedTarget& target, std::size_t count) {
  const std::vector<Triangle2> triangles = triangles_of(target);
  const double all = triangles.back().area_before + triangles.back().area;
  std::vector<Sample> samples;
  samples.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    // 1 / g and 1 / g^2 for the root g of g^3 = g + 1.
    const auto n = static_cast<double>(i);
    const double first = std::fmod(0.5 + 0.75487766624669276 * n, 1.0);
    const double second = std::fmod(0.5 + 0.56984029099805327 * n, 1.0);
    const double area = first * all;
    const auto after = std::find_if(triangles.begin() + 1, triangles.end(),
                                    [&](const Triangle2& one) { return one.area_before > area; });
    const Triangle2& triangle = *(after - 1);
    const double along = std::sqrt(std::clamp((area - triangle.area_before) / triangle.area, 0.0, 1.0));
    const Eigen::Vector2d t = triangle.a + along * ((triangle.b - triangle.a) + second * (triangle.c - triangle.b));
    const TargetFrame& frame = target.frame(triangle.part);
    samples.push_back({frame.to_scene({t.x(), t.y(), 0}), frame.normal});
  }
  return samples;
}

std::vector<Run> open_runs(const VoxelGrid& grid, std::span<const KnownShare> known) {
  constexpr std::size_t kLongest = 64;  // so that threads share the work evenly
  std::vector<Run> runs;
  std::size_t count = 0;
  for (std::size_t v = 0; v < known.size(); ++v) {
    if (known[v] != KnownShare::unknown) continue;
    const bool goes_on = !runs.empty() && runs.back().first_voxel + runs.back().length == v && v % grid.count[0] != 0 &&
                         runs.back().length < kLongest;
    if (goes_on) {
      ++runs.back().length;
    } else {
      runs.push_back({count, v, 1});
    }
    ++count;
  }
  return runs;
}

/// A depth cube map, and what is seen in it.
class SeenBy {
 public:
  SeenBy(const Sample& sample, std::span<const float> inverse_depths, int size)
      : sample_(sample), depths_(inverse_depths), size_(size), half_(0.5 * size) {
    for (std::size_t f = 0; f < faces_.size(); ++f) {
      const depth::CubeFace& face = depth::cube_faces()[f];
      faces_[f] = {axis_of(face.right), axis_of(face.up)};
    }
  }

  bool sees(const Vec3& point) const {
    const Vec3 d = point - sample_.place;
    if (!(sample_.front.dot(d) > 0)) return false;
    const double x = std::abs(d.x()), y = std::abs(d.y()), z = std::abs(d.z());
    const int axis = x >= y ? (x >= z ? 0 : 2) : (y >= z ? 1 : 2);
    const double forward = std::abs(d[axis]);
    const int face = 2 * axis + (d[axis] < 0 ? 1 : 0);
    const Axes& axes = faces_[static_cast<std::size_t>(face)];
    const double scale = half_ / forward;
    const int column = texel(axes.right.sign * d[axes.right.axis] * scale);
    const int row = texel(axes.up.sign * d[axes.up.axis] * scale);
    const float q = depths_[(static_cast<std::size_t>(face) * size_ + row) * size_ + column];
    return static_cast<double>(q) * forward < 1 - kDepthError;
  }

 private:
  struct Axis {
    int axis;
    double sign;
  };
  struct Axes {
    Axis right, up;
  };
  static Axis axis_of(const Vec3& v) {
    Eigen::Index axis;
    v.cwiseAbs().maxCoeff(&axis);
    return {static_cast<int>(axis), v[axis]};
  }
  int texel(double from_middle) const { return std::clamp(static_cast<int>(from_middle + half_), 0, size_ - 1); }

  const Sample& sample_;
  std::span<const float> depths_;
  int size_;
  double half_;
  std::array<Axes, 6> faces_;
};

/// Adds to the count of each open voxel whether its centre is seen.
void count_seen(const SeenBy& seen, const VoxelGrid& grid, const std::vector<Run>& runs,
                const ProgressReporter& progress, std::vector<std::uint16_t>& counts) {
  parallel::for_ranges(runs.size(), 2048, [&](std::size_t begin, std::size_t end) {
    progress.check();
    for (std::size_t r = begin; r < end; ++r) {
      const Run& run = runs[r];
      const std::size_t row = run.first_voxel / grid.count[0], i = run.first_voxel % grid.count[0];
      Vec3 centre = grid.centre(i, row % grid.count[1], row / grid.count[1]);
      for (std::size_t n = 0; n < run.length; ++n) {
        centre.x() = grid.centre(0, i + n);
        counts[run.first_count + n] += seen.sees(centre) ? 1 : 0;
      }
    }
  });
}

double reach_of(const VoxelGrid& grid, const std::vector<Sample>& samples) {
  double reach = 0;
  for (const Sample& sample : samples) {
    Vec3 farthest;
    for (int a = 0; a < 3; ++a) {
      const double high = grid.low[a] + grid.step_m * static_cast<double>(grid.count[a]);
      farthest[a] = std::max(std::abs(grid.low[a] - sample.place[a]), std::abs(high - sample.place[a]));
    }
    reach = std::max(reach, farthest.norm());
  }
  return reach * (1 + 1e-9);
}

void check_options(const PreparedTarget& target, const SampleOptions& options) {
  constexpr const char* kFix = "take 1 to 65535 samples, and 1 to 8192 texels";
  if (options.samples < 1 || options.samples > kMostSamples) {
    throw Error(ErrorCode::value_out_of_range, std::to_string(options.samples) + " samples cannot be taken", "samples",
                kFix);
  }
  if (options.cubemap < 1 || options.cubemap > kLargestFace) {
    throw Error(ErrorCode::value_out_of_range,
                "a face of a depth image cannot have " + std::to_string(options.cubemap) + " texels", "cubemap", kFix);
  }
  if (target.target().is_point()) {
    throw Error(ErrorCode::not_applicable, "the target is a point, which is seen or not: there is nothing to sample",
                "samples", "leave out the samples");
  }
}

}  // namespace

std::vector<Vec3> target_samples(const PreparedTarget& target, std::size_t count) {
  SampleOptions options;
  options.samples = count;
  check_options(target, options);
  std::vector<Vec3> places;
  for (const Sample& sample : samples_of(target, count)) places.push_back(sample.place);
  return places;
}

SampledField estimate_fraction_field(const PreparedTarget& target, const VoxelGrid& grid, const SampleOptions& options,
                                     const Progress& callback) {
  check_grid(grid);
  check_options(target, options);
  depth::ChosenRenderer chosen = depth::make_depth_renderer(target.scene(), options.device);
  const std::vector<KnownShare> known = PointQuery(target).known_shares(grid, options.max_range_m, callback);
  const std::vector<Run> runs = open_runs(grid, known);
  std::vector<std::uint16_t> counts(runs.empty() ? 0 : runs.back().first_count + runs.back().length);
  const std::vector<Sample> samples = samples_of(target, options.samples);
  std::vector<Vec3> places;
  for (const Sample& sample : samples) places.push_back(sample.place);

  const ProgressReporter progress(callback);
  progress.begin("looking from samples");
  if (!counts.empty()) {
    chosen.renderer->render({places, options.cubemap, depth::Sampling::centers, reach_of(grid, samples)},
                            [&](std::size_t i, std::span<const float> inverse_depths) {
                              count_seen(SeenBy(samples[i], inverse_depths, options.cubemap), grid, runs, progress,
                                         counts);
                              progress.report(i + 1, samples.size());
                            });
  }
  SampledField result{{grid, std::vector<double>(known.size()), counts.size()}, chosen.renderer->device(), chosen.note};
  for (std::size_t v = 0; v < known.size(); ++v) result.field.shares[v] = known[v] == KnownShare::whole ? 1 : 0;
  for (const Run& run : runs) {
    for (std::size_t n = 0; n < run.length; ++n) {
      const double seen = counts[run.first_count + n];
      result.field.shares[run.first_voxel + n] = seen / static_cast<double>(samples.size());
    }
  }
  progress.finish();
  return result;
}

}  // namespace vantage
