// Whether the numbers of a camera can be those of a camera.
#pragma once

#include <optional>
#include <string>

#include "vantage/camera.h"

namespace vantage::internal::camera {

/// A sentence without a full stop, and what to do.
struct CameraFault {
  std::string problem, fix;
};

/// What is wrong with the numbers that are known (not 0); nothing if all can be true at once.
std::optional<CameraFault> fault_of(const Camera& camera);

}  // namespace vantage::internal::camera
