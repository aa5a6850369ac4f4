#include "prove/layer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/parallel.h"
#include "prove/shallow.h"

namespace vantage::internal::prove {
namespace {

/// Layers that are tried, in roundings: the volume before it was rounded sees all from what is deeper than one. The
/// second is the last resort.
constexpr std::array<double, 5> kDepths = {1, 8, 1.5, 2, 4};
constexpr std::size_t kBlock = 4096, kMostOpen = 500;  // pairs; where so many stay open the others are not looked at

/// Numbers are rounded whatever the file: a corner where three planes meet by a few units in its last place.
constexpr double kUnits = 8;

}  // namespace

LayerProof prove_less_layer(const OpenVolume& volume, const View& view, const Scene& scene, const SceneTree& obstacles,
                            const core::ProgressReporter& progress) {
  LayerProof proof;
  if (volume.open.empty()) return proof;
  std::vector<std::uint32_t> numbers;
  for (const OpenFacet& one : volume.open) numbers.push_back(one.facet);
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
  std::vector<Triangle> facets;
  for (const std::uint32_t number : numbers) facets.push_back(volume.facets[number]);
  const std::vector<OpenFacet> pairs =
      prove_sight(volume.vertices, facets, view, scene, obstacles, {.tells_all = true}, progress.part(0, 0.5)).open;
  const Shallow shallow(volume.whole, view);
  const auto depth_of = [&](const OpenFacet& pair) {
    std::array<Vec3, 3> corners;
    double reach = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      corners[k] = volume.vertices[facets[pair.facet][k]];
      reach = std::max(reach, corners[k].cwiseAbs().maxCoeff());
    }
    const double unit = std::numeric_limits<double>::epsilon() / 2 * (view.origin.cwiseAbs().maxCoeff() + reach);
    const double rounding = volume.rounding_m + kUnits * unit;
    const auto is_shallow = [&](double depth) {
      return shallow.is_shallow(corners, obstacles.pieces[pair.piece], depth * rounding);
    };
    if (is_shallow(kDepths[0])) return kDepths[0] * rounding;
    if (!is_shallow(kDepths[1])) return std::numeric_limits<double>::infinity();
    const auto least = std::find_if(kDepths.begin() + 2, kDepths.end(), is_shallow);
    return rounding * (least == kDepths.end() ? kDepths[1] : *least);
  };
  std::vector<double> depths(pairs.size(), std::numeric_limits<double>::infinity());
  const core::ProgressReporter second_half = progress.part(0.5, 1);
  core::ProgressCounter done(second_half, pairs.size());
  std::size_t open = 0;
  for (std::size_t first = 0; first < pairs.size() && open < kMostOpen; first += kBlock) {
    const std::size_t count = std::min(kBlock, pairs.size() - first);
    parallel::for_ranges(count, 16, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = first + begin; i < first + end; ++i) {
        depths[i] = depth_of(pairs[i]);
        done.add(1);
      }
    });
    for (std::size_t i = first; i < first + count; ++i) open += std::isfinite(depths[i]) ? 0 : 1;
  }
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (std::isfinite(depths[i])) {
      proof.depth_m = std::max(proof.depth_m, depths[i]);
    } else {
      proof.open.push_back({numbers[pairs[i].facet], pairs[i].piece});
    }
  }
  return proof;
}

}  // namespace vantage::internal::prove
