// Where a longitude and a latitude lie in a scene.
#include "vantage/georeference.h"

namespace example {

Eigen::Vector2d in_scene() {
  vantage::Georeference place;
  place.latitude_deg = 48.137;
  place.longitude_deg = 11.575;
  return vantage::scene_position(place, 11.58, 48.14);
}

}  // namespace example
