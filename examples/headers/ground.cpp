// How high a place of a raster lies.
#include "vantage/ground.h"

namespace example {

double height_m(const char* raster) {
  const vantage::Scene scene = vantage::scene_from_raster(raster).scene;
  return vantage::GroundLevels(vantage::ground_of(scene, 0)).at(0, 0).value().highest_m;
}

}  // namespace example
