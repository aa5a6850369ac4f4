// libFuzzer target: any bytes as a volume to simplify. Nothing may be added, and the result must be closed.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <utility>

#include "fuzz/bytes.h"
#include "vantage/simplify.h"

using vantage::Vec3;
using vantage::fuzzing::require;

namespace {

/// Whether each edge, by the places of its ends, is run as often in one direction as in the other.
bool is_balanced(const vantage::Mesh& mesh) {
  using Place = std::array<double, 3>;
  std::map<std::pair<Place, Place>, int> runs;
  const auto place = [&](std::uint32_t v) {
    const Vec3& at = mesh.vertices[v];
    return Place{at.x(), at.y(), at.z()};
  };
  for (const vantage::Triangle& t : mesh.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Place from = place(t[k]), to = place(t[(k + 1) % 3]);
      ++runs[{from, to}];
      --runs[{to, from}];
    }
  }
  return std::all_of(runs.begin(), runs.end(), [](const auto& run) { return run.second == 0; });
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  vantage::fuzzing::Bytes bytes(data, size);
  const vantage::Mesh volume = vantage::fuzzing::draw_solid(bytes);
  vantage::SimplifyOptions options;
  if (bytes.below(4) != 0) options.facets = 4 + bytes.byte() / 4;
  if (bytes.below(4) == 0) options.error_m = bytes.number();
  try {
    const vantage::SimplifiedVolume result = simplify_volume(volume, options);
    require(result.facet_of.size() == result.mesh.triangles.size(), "each facet comes from one of the volume");
    for (const std::uint32_t facet : result.facet_of) require(facet < volume.triangles.size(), "and is in range");
    const double rounding = 1e-9 * std::abs(result.volume_before_m3);
    require(!(result.volume_after_m3 > result.volume_before_m3 + rounding), "nothing is added");
    require(is_balanced(result.mesh), "the result is closed");
  } catch (const vantage::Error& error) {
    vantage::fuzzing::check_refusal(error);
  }
  return 0;
}
