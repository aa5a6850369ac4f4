// What every back end asks of a request before it begins.
#pragma once

#include "depth/depth.h"

namespace vantage::internal::depth {

/// Throws Error(input) for a face size beyond the device's, a viewpoint that is not finite or beyond 1e9 m, a range
/// that is not positive.
void check_request(const DepthRequest& request, const RenderDevice& device);

}  // namespace vantage::internal::depth
