// What ViewDescriber knows.
#pragma once

#include <memory>
#include <optional>

#include "flight/obstacles.h"
#include "flight/target_view.h"
#include "flight/view_aim.h"
#include "geo/on_globe.h"
#include "vantage/ground.h"
#include "vantage/standpoints.h"

namespace vantage::internal::flight {

/// What follows from the scene alone: shared by the targets in it.
struct Surroundings {
  explicit Surroundings(const Mission& mission);

  Obstacles obstacles;
  std::optional<GroundLevels> ground;
  std::optional<geo::OnGlobe> earth;
  std::optional<double> sea_level_m;
};

}  // namespace vantage::internal::flight

namespace vantage {

struct ViewDescriber::Data {
  internal::flight::TargetView target;
  internal::flight::ViewAim aim;
  std::shared_ptr<const internal::flight::Surroundings> around;
};

}  // namespace vantage
