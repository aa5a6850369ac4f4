// libFuzzer target: any bytes as a scene, a target and a volume to prove. Whatever is proved must be free for a few
// segments, and a witness must be hidden, by plain arithmetic.
#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "fuzz/bytes.h"
#include "vantage/prove.h"
#include "vantage/target.h"

namespace vantage::fuzzing {
namespace {

using Corners = std::array<Vec3, 3>;

/// Where a segment passes through a triangle: the least of what it is away from missing it, in parts of the triangle
/// and the segment. At most 0 where it misses.
double passes_by(const Vec3& from, const Vec3& to, const Corners& triangle) {
  const auto& [a, b, c] = triangle;
  const Vec3 way = to - from, ab = b - a, ac = c - a, p = way.cross(ac);
  const double determinant = ab.dot(p);
  if (!(std::abs(determinant) > 1e-6 * way.norm() * ab.norm() * ac.norm())) return 0;
  const Vec3 s = from - a, q = s.cross(ab);
  const double u = s.dot(p) / determinant, v = way.dot(q) / determinant, t = ac.dot(q) / determinant;
  return std::min({u, v, 1 - u - v, t, 1 - t});
}

struct Drawn {
  Scene scene;
  Target target;
  Sensor sensor;
  Navigation navigation;
  Mesh volume;
  ProveOptions options;

  explicit Drawn(Bytes& bytes) {
    scene.objects.push_back({"only"});
    for (std::uint32_t triangles = bytes.below(8); triangles > 0; --triangles) {
      const auto first = static_cast<std::uint32_t>(scene.mesh.vertices.size());
      for (int k = 0; k < 3; ++k) scene.mesh.vertices.push_back(bytes.point());
      scene.mesh.triangles.push_back({first, first + 1, first + 2});
      scene.object_of.push_back(0);
    }
    const double half = 0.25 + bytes.below(8) / 4.0;
    target.parts[0] = {{-half, -half, 0}, {half, -half, 0}, {half, half, 0}};
    if (bytes.below(2) == 0) target.parts[0].push_back({-half, half, 0});
    if (bytes.below(8) == 0) target.parts[0][bytes.below(3)] = bytes.point();
    sensor.max_range_m = 4 + bytes.byte();
    if (bytes.below(4) == 0) navigation.altitude = Navigation::Altitude{0, 1.0 + bytes.below(16)};
    if (bytes.below(4) == 0) {
      const Vec3 low = bytes.point();
      navigation.keep_out = {vantage::Box{low, low + Vec3(1, 1, 1) * (1 + bytes.below(4))}};
    }
    volume = draw_solid(bytes);
    if (bytes.below(8) == 0) options.shrink = bytes.number();
    if (bytes.below(8) == 0) options.rounding_m = bytes.number();
    options.maximal = bytes.below(2) == 0;
    options.certificate = bytes.below(2) == 0;
  }

  Corners triangle(std::uint32_t t) const {
    const auto& [a, b, c] = scene.mesh.triangles[t];
    return {scene.mesh.vertices[a], scene.mesh.vertices[b], scene.mesh.vertices[c]};
  }
};

constexpr double kClearly = 1e-3;

/// From the middles of facets, shrunk, to the target's middle: which is far from all that the proof leaves out.
void check_proved(const Drawn& drawn, const ProofReport& report) {
  const std::vector<Vec3>& corners = drawn.target.parts[0];
  Vec3 middle = Vec3::Zero();
  for (const Vec3& corner : corners) middle += corner / static_cast<double>(corners.size());
  for (const Triangle& facet : drawn.volume.triangles) {
    Vec3 from = Vec3::Zero();
    for (const std::uint32_t v : facet) from += drawn.volume.vertices[v] / 3;
    from = middle + (1 - report.shrink) * (from - middle);
    const Vec3 to = middle + 0.01 * (from - middle);
    for (std::uint32_t t = 0; t < drawn.scene.mesh.triangles.size(); ++t) {
      require(passes_by(from, to, drawn.triangle(t)) < kClearly, "what is proved is free");
    }
    const double farthest = drawn.sensor.max_range_m + report.rounding_m;
    require((from - middle).norm() < farthest * (1 + kClearly), "what is proved is within range");
  }
}

void check_report(const Drawn& drawn, const ProofReport& report) {
  if (report.verdict() == ProofVerdict::proved) check_proved(drawn, report);
  require(report.unproved.empty() == (report.claims[0].verdict == ProofVerdict::proved), "open facets are not proved");
  if (report.witness) {
    require(report.claims[0].verdict == ProofVerdict::wrong, "a witness is of what is wrong");
    const HiddenView& view = *report.witness;
    require(passes_by(view.viewpoint, view.target_point, drawn.triangle(view.triangle)) > -kClearly,
            "a witness is hidden");
  }
  if (report.maximal) {
    require(report.maximal->facets.size() == drawn.volume.triangles.size(), "each facet has a row");
    require(report.maximal->proved_share >= 0 && report.maximal->proved_share < 1 + kClearly, "a share is one");
  }
  if (report.certificate) {
    require(report.verdict() != ProofVerdict::wrong, "what is wrong has no certificate");
    require(!certificate_text(*report.certificate, {}).empty(), "a certificate has a text");
  }
}

}  // namespace
}  // namespace vantage::fuzzing

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  vantage::fuzzing::Bytes bytes(data, size);
  const vantage::fuzzing::Drawn drawn(bytes);
  try {
    check_report(drawn,
                 prove_volume(drawn.scene, drawn.target, drawn.sensor, drawn.navigation, drawn.volume, drawn.options));
  } catch (const vantage::Error& error) {
    vantage::fuzzing::check_refusal(error);
  }
  return 0;
}
