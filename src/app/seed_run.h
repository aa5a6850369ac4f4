// Computes what a configuration file of the published program asks for.
#pragma once

#include <string>
#include <vector>

#include "app/seed_config.h"
#include "vantage/devices.h"
#include "vantage/progress.h"
#include "vantage/spheres.h"
#include "vantage/volume.h"

namespace vantage::app {

struct SeedResult {
  Volume volume;  ///< scene frame; causes: the scene, radius_max, up_min, up_max
  MeshMeasures measures;
  double seconds = 0;  ///< of this volume
};

struct SeedRun {
  std::vector<SeedResult> results;  ///< in the configuration's order
  RenderDevice device;
  std::string device_note;  ///< why it is not the device that one would hope for; may be empty
};

/// The volumes of a configuration. `options` gives the sphere, the device and the threads.
///
/// What the limits up_min and up_max cut away depends on the sphere. `centers` moves a vertex beyond a limit along `up`
/// onto it, as the published program does, which may claim what is not seen; `conservative` moves it towards the
/// viewpoint, which never does. Without radius_max a ray that meets nothing ends at the farthest corner of the scene's
/// bounding box.
///
/// Throws Error(input) as read_scene and visibility_sphere do, and for a viewpoint on a surface or inside a solid, with
/// the place in the file put in front.
SeedRun run_seed_config(const SeedConfig& config, const SpheresOptions& options, const Progress& progress = {});

}  // namespace vantage::app
