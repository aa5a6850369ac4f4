#include "depth/depth_request.h"

#include <string>

#include "core/format.h"
#include "vantage/error.h"

namespace vantage::internal::depth {

void check_request(const DepthRequest& request, const RenderDevice& device) {
  if (request.face_size < 1 || request.face_size > device.largest_face_size) {
    throw Error(ErrorCode::value_out_of_range,
                "a face of a depth image cannot have " + std::to_string(request.face_size) + " texels",
                "device " + device.name, "take 1 to " + std::to_string(device.largest_face_size) + " texels a side");
  }
  if (!(request.range_m > 0)) {
    throw Error(ErrorCode::value_out_of_range, "the range of a depth image must be positive",
                core::format("range {:f}", request.range_m), "give a range in metres");
  }
  constexpr double kFarthest = 1e9;  // as for the vertices of a scene
  for (std::size_t i = 0; i < request.viewpoints.size(); ++i) {
    const Vec3& v = request.viewpoints[i];
    if (v.allFinite() && v.cwiseAbs().maxCoeff() <= kFarthest) continue;
    throw Error(v.allFinite() ? ErrorCode::coordinate_too_large : ErrorCode::coordinate_not_finite,
                "a viewpoint is not finite or is farther than 1e9 m from the origin", "viewpoint " + std::to_string(i),
                "check its coordinates");
  }
}

}  // namespace vantage::internal::depth
