// How wide one pixel is on a wall that is looked at face on, from 60 m.
#include "vantage/camera.h"

namespace example {

double pixel_m() {
  const vantage::Pinhole camera = vantage::pinhole_of(vantage::find_camera("sony_a7r_iv_35mm"));
  return 60 / camera.focal_px.value();
}

}  // namespace example
