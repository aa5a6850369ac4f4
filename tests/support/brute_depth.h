// Depth cube maps the obvious way: every triangle against every texel. Shares nothing with the back ends.
#pragma once

#include <limits>
#include <vector>

#include "depth/depth.h"
#include "support/internals.h"
#include "vantage/scene.h"

namespace vantage::testing {

/// Distance along `direction` (any length, in units of it) to the first triangle; infinity if there is none.
double first_hit(const Mesh& mesh, const Vec3& from, const Vec3& direction);

/// Sampling::nearest is exact: each triangle is clipped to the texel's pyramid, and its nearest corner counts.
class BruteDepth : public depth::DepthRenderer {
 public:
  explicit BruteDepth(Mesh mesh);
  const RenderDevice& device() const override { return device_; }
  void render(const depth::DepthRequest& request, const depth::DepthSink& sink) override;

  int requests = 0, images = 0;  ///< so far

 private:
  Mesh mesh_;
  RenderDevice device_;
};

}  // namespace vantage::testing
