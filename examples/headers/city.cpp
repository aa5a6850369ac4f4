// The buildings within 300 m of a place, as a scene.
#include "vantage/city.h"

namespace example {

vantage::Scene city_centre(const char* map) {
  vantage::CityOptions options;
  options.region.center_deg = {48.137, 11.575};
  options.region.radius_m = 300;
  return vantage::build_city(map, options).scene;
}

}  // namespace example
