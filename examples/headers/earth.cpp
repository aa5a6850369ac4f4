// Where a place with a height lies in a scene.
#include "vantage/earth.h"

namespace example {

vantage::Vec3 in_scene_with_height() {
  vantage::Georeference place;
  place.latitude_deg = 48.137;
  place.longitude_deg = 11.575;
  return vantage::scene_point(place, 11.58, 48.14, 560);
}

}  // namespace example
