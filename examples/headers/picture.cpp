// A picture of a scene and a volume.
#include "vantage/picture.h"

namespace example {

void draw(const vantage::Scene& scene, const vantage::Target& target, const vantage::Volume& volume) {
  vantage::PictureRequest request;
  request.target = &target;
  request.volume = &volume;
  request.title = "From here all of it is seen";
  vantage::write_png(vantage::render_picture(scene, request), "volume.png");
}

}  // namespace example
