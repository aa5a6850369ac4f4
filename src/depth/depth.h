// Depth cube maps: the one interface of all back ends, and the place that chooses among them (choose.cpp).
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>

#include "vantage/devices.h"
#include "vantage/geometry.h"
#include "vantage/scene.h"

namespace vantage::internal::depth {

/// A face of the cube: texel (column i, row j) of an n x n face looks along
///   forward + u * right + v * up,  u = (2 i + 1) / n - 1,  v = (2 j + 1) / n - 1,
/// and its footprint is u +- 1/n, v +- 1/n. Vectors are axes of the scene frame; right x up = -forward.
struct CubeFace {
  Vec3 forward, right, up;
};

/// +x, -x, +y, -y, +z, -z.
const std::array<CubeFace, 6>& cube_faces();

enum class Sampling {
  centers,  ///< depth along each texel's centre
  nearest,  ///< a bound on the nearest depth over each texel's whole footprint: never farther than the truth
};

struct DepthRequest {
  std::span<const Vec3> viewpoints;  ///< scene frame, metres
  int face_size = 0;                 ///< texels along a side
  Sampling sampling = Sampling::centers;
  double range_m = 0;  ///< what is farther than this from the viewpoint (Euclidean) may be left out of the map
};

/// Called on the calling thread, in the order of the viewpoints, with 6 n n inverse depths: [(face * n + row) * n +
/// column], 1/m. An inverse depth is 1 over the distance along the face's `forward`; 0: nothing there. Valid during the
/// call only.
using DepthSink = std::function<void(std::size_t viewpoint, std::span<const float> inverse_depths)>;

/// Depth cube maps of one scene, which was uploaded once. Not for several threads at once.
class DepthRenderer {
 public:
  virtual ~DepthRenderer() = default;
  virtual const RenderDevice& device() const = 0;

  /// May render ahead, also while `sink` runs. Throws Error(input) for a face size beyond the device's, a viewpoint
  /// that is not finite or a range that is not positive; DeviceFailure when the device cannot go on (memory, lost).
  virtual void render(const DepthRequest& request, const DepthSink& sink) = 0;
};

/// A device that cannot hold the scene or the images, or was lost. Who did not insist on it goes on with the CPU.
class DeviceFailure : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct ChosenRenderer {
  std::unique_ptr<DepthRenderer> renderer;
  std::string note;  ///< why it is not the device that one would hope for; empty when it is
};

/// The renderer of the device that `choice` asks for. Where it does not insist, falls back to the CPU, also later, in
/// the middle of a request, and `note` or the renderer's device() says so. Throws Error(input) where it insists and the
/// device is not there or cannot hold the scene.
ChosenRenderer make_depth_renderer(const PreparedScene& scene, const DeviceChoice& choice);

}  // namespace vantage::internal::depth
