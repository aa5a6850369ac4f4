// All sections of a mission file, in the order of docs/mission-file.md.
#pragma once

#include "request/describe_mission.h"
#include "request/describe_navigation.h"
#include "request/describe_scene.h"
#include "request/describe_sensor.h"
#include "request/describe_spheres.h"
#include "request/describe_target.h"
#include "request/describe_tour.h"
#include "vantage/spheres.h"
#include "vantage/tour.h"

namespace vantage::internal::request {

/// Calls `work` with settings by default of each section.
template <typename Work>
void each_section(Work&& work) {
  work(MissionKeys());
  work(SceneKeys());
  work(TargetKeys());
  work(Sensor());
  work(NavigationKeys());
  work(ZoneKeys());
  work(NavigationMeshKeys());
  work(ExactOptions());
  work(SpheresOptions());
  work(TourSettings());
  work(LinkKeys());
}

}  // namespace vantage::internal::request
