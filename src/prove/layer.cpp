#include "prove/layer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/parallel.h"
#include "prove/shallow.h"

namespace vantage::internal::prove {
namespace {

/// Layers that are tried, in roundings. The volume before it was rounded sees all from what is deeper than one, and
/// that is nearly always enough; the second is for the ways out of sharp corners.
constexpr std::array<double, 2> kDepths = {1, 2};
constexpr std::size_t kMostPairs = 4000;            // of facets and obstacles: a second or a few
constexpr std::size_t kBlock = 16, kMostOpen = 20;  // pairs; where so many stay open the others are not looked at

/// The corners of what is cut here, about the target, are rounded a few times each.
constexpr double kUnitsOfCuts = 8192;

/// The depth of a layer that hides what a facet is open for; infinite where there is none.
class LayerDepth {
 public:
  LayerDepth(const OpenVolume& volume, const View& view, const SceneTree& obstacles)
      : volume_(volume),
        obstacles_(obstacles),
        largest_(view.origin.cwiseAbs().maxCoeff()),
        most_(thickest_layer_m(volume.whole)),
        shallow_(volume.whole, view) {}

  double of(const Triangle& facet, std::uint32_t piece) const {
    std::array<Vec3, 3> corners;
    for (std::size_t k = 0; k < 3; ++k) corners[k] = volume_.vertices[facet[k]];
    const auto is_shallow = [&](double roundings) {
      const double depth = depth_of(corners, roundings);
      return depth <= most_ && shallow_.is_shallow(corners, obstacles_.pieces[piece], depth);
    };
    for (const double roundings : kDepths) {
      if (is_shallow(roundings)) return depth_of(corners, roundings);
    }
    return std::numeric_limits<double>::infinity();
  }

 private:
  double depth_of(const std::array<Vec3, 3>& corners, double roundings) const {
    constexpr double kUnit = std::numeric_limits<double>::epsilon() / 2;
    double reach = 0;
    for (const Vec3& corner : corners) reach = std::max(reach, corner.cwiseAbs().maxCoeff());
    return roundings * (volume_.rounding_m + rounding_of_numbers_m(largest_ + reach)) + kUnitsOfCuts * kUnit * reach;
  }

  const OpenVolume& volume_;
  const SceneTree& obstacles_;
  double largest_, most_;
  Shallow shallow_;
};

}  // namespace

double thickest_layer_m(const Mesh& volume) {
  Box box;
  for (const Triangle& triangle : volume.triangles) {
    for (const std::uint32_t v : triangle) box.extend(volume.vertices[v]);
  }
  return box.empty() ? 0 : kThickestLayer * (box.max - box.min).minCoeff();
}

LayerProof prove_less_layer(const OpenVolume& volume, const View& view, const Scene& scene, const SceneTree& obstacles,
                            const core::ProgressReporter& progress) {
  LayerProof proof;
  if (volume.open.empty()) return proof;
  if (volume.rounding_m > thickest_layer_m(volume.whole)) {
    proof.open = volume.open;
    proof.is_too_thick = true;
    return proof;
  }
  std::vector<std::uint32_t> numbers;
  for (const OpenFacet& one : volume.open) numbers.push_back(one.facet);
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
  const auto all_open = [&] {
    proof.open = volume.open;
    proof.has_too_many = true;
    return proof;
  };
  if (numbers.size() > kMostPairs) return all_open();
  std::vector<Triangle> facets;
  for (const std::uint32_t number : numbers) facets.push_back(volume.facets[number]);
  const std::vector<OpenFacet> pairs =
      prove_sight(volume.vertices, facets, view, scene, obstacles, {.most_pieces = kMostPairs}, progress.part(0, 0.5))
          .open;
  if (pairs.size() > kMostPairs) return all_open();
  const LayerDepth depth(volume, view, obstacles);
  std::vector<double> depths(pairs.size(), std::numeric_limits<double>::infinity());
  const core::ProgressReporter second_half = progress.part(0.5, 1);
  core::ProgressCounter done(second_half, pairs.size());
  std::size_t open = 0;
  for (std::size_t first = 0; first < pairs.size() && open < kMostOpen; first += kBlock) {
    const std::size_t count = std::min(kBlock, pairs.size() - first);
    parallel::for_ranges(count, 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = first + begin; i < first + end; ++i) {
        depths[i] = depth.of(facets[pairs[i].facet], pairs[i].piece);
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
